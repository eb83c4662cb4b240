"""Names, paths, owners, moving about."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tifo import Node, NodePathError, SceneTree, Timer


@pytest.fixture
def main(tree: SceneTree) -> Node:
    """/root/Main with Crowd/{North,South} and Ball."""
    main = tree.root.add_child(Node(name="Main"))
    crowd = main.add_child(Node(name="Crowd"))
    crowd.add_child(Node(name="North"))
    crowd.add_child(Node(name="South"))
    main.add_child(Timer(name="Ball"))
    return main


@pytest.mark.parametrize(
    ("start", "path", "found"),
    [
        (".", "Crowd/North", "/root/Main/Crowd/North"),
        ("Ball", "../Crowd/North", "/root/Main/Crowd/North"),
        ("Ball", "..", "/root/Main"),
        ("Ball", ".", "/root/Main/Ball"),
        ("Ball", "/root/Main/Crowd", "/root/Main/Crowd"),
        ("Ball", "/root", "/root"),
        ("Crowd/North", "../../Ball", "/root/Main/Ball"),
        (".", "Crowd/../Ball", "/root/Main/Ball"),
    ],
)
def test_paths(main: Node, start: str, path: str, found: str) -> None:
    node = main.get_node(start)
    assert node[path].path == found
    assert node.has_node(path)
    assert node.get_node_or_none(path) is node[path]


@pytest.mark.parametrize(
    ("path", "cause"),
    [
        ("Crwd", r"/root/Main has no child 'Crwd'; did you mean Crowd\?"),
        ("Crowd/Nort", r"did you mean North\?"),
        ("Ball/x", "there are none"),
        ("../../..", "/root has no parent"),
        ("/Main", "absolute paths begin with /root"),
        ("%Bal", "no unique 'Bal'"),
    ],
)
def test_wrong_paths_name_what_is_near(main: Node, path: str, cause: str) -> None:
    with pytest.raises(NodePathError, match=cause):
        main.get_node(path)
    with pytest.raises(KeyError):
        main[path]
    assert main.get_node_or_none(path) is None


def test_get_node_checks_the_class(main: Node) -> None:
    assert main.get_node("Ball", Timer).wait_time == 1.0
    with pytest.raises(TypeError, match="is no Timer"):
        main.get_node("Crowd", Timer)
    with pytest.raises(ValueError, match="path is ''"):
        main.get_node("")


def test_outside_a_tree_relative_paths_work() -> None:
    a = Node(name="A")
    b = a.add_child(Node(name="B"))
    assert b["../B"] is b
    assert (a.path, b.path) == ("A", "A/B")
    with pytest.raises(NodePathError, match="not inside a tree"):
        b.get_node("/root")
    with pytest.raises(ValueError, match="not inside a tree"):
        _ = b.tree


def test_siblings_get_numbers() -> None:
    parent = Node()
    names = [parent.add_child(Node(name="Fan")).name for _ in range(4)]
    assert names == ["Fan", "Fan2", "Fan3", "Fan4"]
    parent["Fan2"].free()
    assert parent.add_child(Node(name="Fan")).name == "Fan5"
    assert parent.add_child(Node(name="Fan3")).name == "Fan6"
    assert parent.add_child(Timer()).name == "Timer"
    parent["Timer"].name = "Fan"
    assert [child.name for child in parent][-1] == "Fan7"
    assert parent["Fan7"].index == 5


@pytest.mark.parametrize("name", ["", "a/b", "a:b", "a.b", "@x", "%x", 'a"b', 3])
def test_wrong_names_are_refused(name: str) -> None:
    with pytest.raises(ValueError, match="name is"):
        Node(name=name)


def test_unique_names_are_seen_from_the_whole_scene() -> None:
    scene = Node(name="Scene")
    box = scene.add_child(Node(name="Box"))
    lamp = box.add_child(Node(name="Lamp"))
    for node in (box, lamp):
        node.owner = scene
    lamp.unique_name_in_owner = True
    assert scene["%Lamp"] is box["%Lamp"] is lamp["%Lamp"] is lamp
    lamp.name = "Light"
    assert scene["%Light"] is lamp
    assert not scene.has_node("%Lamp")
    box.remove_child(lamp)
    assert lamp.owner is None
    assert not scene.has_node("%Light")
    with pytest.raises(ValueError, match="expected a node above"):
        lamp.owner = scene


def test_reparent_keeps_owner_and_order(main: Node) -> None:
    crowd, ball = main["Crowd"], main["Ball"]
    ball.owner = main
    ball.unique_name_in_owner = True
    ball.reparent(crowd)
    assert ball.path == "/root/Main/Crowd/Ball"
    assert ball.owner is main
    assert main["%Ball"] is ball
    crowd.move_child(ball, 0)
    assert [child.name for child in crowd] == ["Ball", "North", "South"]
    crowd.move_child(ball, -1)
    assert crowd.get_child(-1) is ball
    with pytest.raises(ValueError, match="expected -3 to 2"):
        crowd.move_child(ball, 3)
    with pytest.raises(ValueError, match="no part of"):
        crowd.reparent(ball)
    with pytest.raises(ValueError, match="has no parent"):
        Node().reparent(main)


def test_find_child_and_outline(main: Node) -> None:
    assert main.find_child("*orth") is main["Crowd/North"]
    assert main.find_child("*orth", recursive=False) is None
    assert main.is_ancestor_of(main["Crowd/North"])
    assert main.tree_text().splitlines() == [
        *("Main (Node)", "  Crowd (Node)", "    North (Node)", "    South (Node)"),
        "  Ball (Timer)",
    ]


@given(st.lists(st.integers(min_value=0), max_size=30), st.data())
def test_path_to_leads_there(parents: list[int], data: st.DataObject) -> None:
    nodes = [Node(name="N")]
    for number in parents:
        nodes.append(nodes[number % len(nodes)].add_child(Node(name="N")))
    pick = st.integers(min_value=0, max_value=len(nodes) - 1)
    start, end = nodes[data.draw(pick)], nodes[data.draw(pick)]
    assert start[start.path_to(end)] is end
