"""The lists of callbacks, changed node by node, are those that a walk of the whole tree gives."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tifo import Node, SceneTree
from tifo.scripting import order


class Ticking(Node):
    def _process(self, delta: float) -> None:
        pass

    def _physics_process(self, delta: float) -> None:
        pass


class Listening(Node):
    def _process(self, delta: float) -> None:
        pass

    def _input(self, event: object) -> None:
        pass

    def _unhandled_input(self, event: object) -> None:
        pass


class Both(Ticking, Listening):
    pass


KINDS = (Node, Ticking, Listening, Both)


def below(node: Node) -> list[Node]:
    return [one for child in node.children for one in (child, *below(child))]


def agree(tree: SceneTree) -> None:
    lists = tree.order
    lists.begin()
    nodes = below(tree.root)
    has = [type(node)._overrides for node in nodes]

    def those(callback: str) -> list[Node]:
        return [node for node, names in zip(nodes, has, strict=True) if callback in names]

    assert [node for node, _ in lists.process] == those("_process")
    assert [node for node, _ in lists.physics] == those("_physics_process")
    assert lists.inputs == those("_input")[::-1]
    assert lists.unhandled == those("_unhandled_input")[::-1]
    assert lists.sorted(nodes[::-1]) == nodes
    assert all(call.__self__ is node for node, call in lists.process)
    assert all(node._tree is tree for node in lists.resting)


def subtree(shape: int) -> Node:
    """A node with up to three below it."""
    top = KINDS[shape % 4]()
    if shape % 3:
        top.add_child(KINDS[shape // 4 % 4]()).add_child(KINDS[shape // 16 % 4]())
        top.add_child(KINDS[shape // 64 % 4]())
    return top


STEPS = st.lists(
    st.tuples(
        st.sampled_from(["add", "add", "add", "free", "remove", "return", "reparent", "move"]),
        st.integers(0, 255),
        st.integers(0, 255),
        st.booleans(),
    ),
    max_size=40,
)


@given(steps=STEPS)
def test_any_changes_give_the_lists_of_a_walk(steps: Any) -> None:
    tree = SceneTree()
    out: list[Node] = []
    for what, a, b, look in steps:
        nodes = below(tree.root)
        one: Any = nodes[a % len(nodes)] if nodes else None
        other = [tree.root, *nodes][b % (len(nodes) + 1)]
        if what == "add":
            other.add_child(subtree(a))
        elif what == "return" and out:
            other.add_child(out.pop())
        elif one is None:
            continue
        elif what == "free":
            one.free()
        elif what == "remove":
            one.parent.remove_child(one)
            out.append(one)
        elif what == "reparent" and other is not one and not one.is_ancestor_of(other):
            one.reparent(other)
        elif what == "move":
            one.parent.move_child(one, b % len(one.parent.children))
        if look:
            agree(tree)
    agree(tree)
    tree.close()


def test_a_walk_is_spared_while_there_are_few_new_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    tree = SceneTree()
    first = tree.root.add_child(Node(name="First"))
    tree.root.add_child(Ticking(name="Last"))
    agree(tree)
    walks: list[int] = []
    walk = order.Order._walk

    def counted(lists: order.Order) -> None:
        walks.append(1)
        walk(lists)

    monkeypatch.setattr(order.Order, "_walk", counted)
    for _ in range(60):
        first.add_child(Both())
        agree(tree)
    assert 0 < len(walks) < 3, "about fifty halves fit between two numbers"
    walks.clear()
    for _ in range(order.FEW + 1):
        tree.root.add_child(Ticking())
    agree(tree)
    assert len(walks) == 1
    for _ in range(100):
        tree.root.add_child(Ticking())
        agree(tree)
    assert len(walks) == 1
    tree.close()


def test_added_and_freed_in_one_round(tree: SceneTree) -> None:
    class Shooter(Node):
        def _process(self, delta: float) -> None:
            self.tree.root.add_child(Ticking(name="Bullet")).queue_free()
            self.add_child(Ticking())

    shooter = tree.root.add_child(Shooter())
    tree.root.add_child(Listening())
    for count in range(1, 6):
        tree.advance(0.0)
        agree(tree)
        assert len(shooter.children) == count
        assert not tree.root.has_node("Bullet")
