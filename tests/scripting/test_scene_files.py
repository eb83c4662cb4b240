"""Scene files: reading, instancing, writing, and every mistake with its line."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Any

import pytest

from tifo import (
    AssetError,
    Node,
    Node3D,
    PackedScene,
    SceneTree,
    ScriptError,
    Signal,
    Timer,
    Vector3,
    export,
    load,
    load_scene,
    save_scene,
)
from tifo.scripting.scene_writing import scene_to_toml


class Mood(Enum):
    """Of a player."""

    CALM = 1
    WILD = 2


class ScenePlayer(Node3D):
    """A player with a target and a signal."""

    speed: float = export(default=5.0, range=(0, 10))
    mood: Mood = export(default=Mood.CALM)
    target: Node3D | None = export(default=None)
    songs: list[str] = export(default_factory=list)

    scored = Signal[str]()

    def _prepare(self) -> None:
        super()._prepare()
        self.heard: list[Any] = []

    def on_scored(self, team: str, extra: int = 0) -> None:
        self.heard.append((team, extra))


STAND = """\
[[node]]
name = "Stand"
type = "Node3D"

[[node]]
name = "Clock"
parent = "."
type = "Timer"
groups = ["clocks"]
unique = true
[node.exports]
wait_time = 2.5
"""

MATCH = """\
# A match.
[[node]]
name = "Match"
type = "Node3D"

[[node]]
name = "Ann"
parent = "."
type = "ScenePlayer"
groups = ["players", "loud"]
[node.exports]
speed = 7
mood = "WILD"
position = [1.0, 2.0, 3.0]
target = "../North"
songs = ["a", "b"]

[[node]]
name = "North"
parent = "."
scene = "res://stand.toml"
unique = true
[node.exports]
position = [0.0, 0.0, 9.0]

[[node]]
name = "Flag"
parent = "North/Clock"
type = "Node"

[[connection]]
signal = "scored"
from = "Ann"
to = "Ann"
method = "on_scored"
binds = [3]
deferred = true
"""


@pytest.fixture
def match(folder: Path) -> Path:
    (folder / "stand.toml").write_text(STAND)
    (folder / "match.toml").write_text(MATCH)
    return folder


def test_a_scene_makes_its_nodes(match: Path, tree: SceneTree, errors: list[ScriptError]) -> None:
    scene = load_scene("res://match.toml")
    root = scene.instantiate()
    assert root.tree_text().splitlines() == [
        "Match (Node3D)",
        "  Ann (ScenePlayer)",
        "  North (Node3D)",
        "    Clock (Timer)",
        "      Flag (Node)",
    ]
    ann = root.get_node("Ann", ScenePlayer)
    assert (ann.speed, ann.mood, ann.position) == (7.0, Mood.WILD, Vector3(1.0, 2.0, 3.0))
    assert ann.target is root["North"]
    assert ann.groups == ("players", "loud")
    north = root["North"]
    assert north.scene_path == "res://stand.toml"
    assert root.scene_path == "res://match.toml"
    assert root["%North"] is north
    assert north["%Clock"] is root["North/Clock"]
    assert not root.has_node("%Clock")  # it is unique in its own scene
    assert root.get_node("North/Clock", Timer).wait_time == 2.5
    assert root["North/Clock"].owner is north
    assert root["North/Clock/Flag"].owner is root
    tree.change_scene(scene)
    tree.advance(0.0)
    playing = tree.root.get_node("Match/Ann", ScenePlayer)
    playing.scored.emit("home")
    tree.advance(0.0)
    assert playing.heard == [("home", 3)]
    playing.songs.append("c")
    tree.reload_current_scene()
    tree.advance(0.0)
    assert tree.root.get_node("Match/Ann", ScenePlayer).songs == ["a", "b"]
    assert errors == []


def test_scenes_are_read_once(match: Path) -> None:
    assert load("res://match.toml") is load("res://match.toml")
    assert load(match / "match.toml") is load("res://match.toml")


def test_saving_gives_the_same_scene(match: Path) -> None:
    root = load_scene("res://match.toml").instantiate()
    root.get_node("North", Node3D).position = Vector3(0.0, 1.0, 9.0)
    saved = save_scene(root, "res://copy.toml")
    assert root.scene_path == "res://copy.toml"
    text = (match / "copy.toml").read_text()
    assert text.count("[[node]]") == 4  # the clock comes with the stand
    assert 'scene = "res://stand.toml"' in text
    again = saved.instantiate()
    assert again.tree_text() == root.tree_text()
    ann = again.get_node("Ann", ScenePlayer)
    assert (ann.speed, ann.mood, ann.songs) == (7.0, Mood.WILD, ["a", "b"])
    assert ann.target is again["North"]
    assert again.get_node("North", Node3D).position == Vector3(0.0, 1.0, 9.0)
    assert scene_to_toml(again) == text
    (connection,) = ann.scored.connections
    assert (connection.binds, connection.deferred) == ((3,), True)


def test_trees_built_by_code_are_saved_whole(folder: Path) -> None:
    root = Node(name="Root")
    a = root.add_child(ScenePlayer(name="A", speed=1.0))
    b = a.add_child(ScenePlayer(name="B", target=a))
    b.add_to_group("g")
    a.scored.connect(b.on_scored, persist=True)
    b.scored.connect(a.on_scored)
    made = save_scene(root, "res://made.toml").instantiate()
    copied = made.get_node("A/B", ScenePlayer)
    assert copied.target is made["A"]
    assert copied.groups == ("g",)
    assert len(made.get_node("A", ScenePlayer).scored.connections) == 1
    assert copied.scored.connections == ()
    defaults = (folder / "made.toml").read_text()
    assert "position" not in defaults


def test_what_files_cannot_hold_is_refused(folder: Path) -> None:
    class Holder(Node):
        thing: Any = export(default=None)

    with pytest.raises(ValueError, match="which a file can't hold"):
        scene_to_toml(Holder(thing=object()))
    player = ScenePlayer()
    player.scored.connect(player.on_scored, binds=(object(),), persist=True)
    with pytest.raises(ValueError, match="binds"):
        scene_to_toml(player)


NODE = '[[node]]\nname = "A"\ntype = "Node3D"\n'
PLAYER = '[[node]]\nname = "A"\ntype = "ScenePlayer"\n'
CONNECT = PLAYER + '[[connection]]\nsignal = "scored"\nfrom = "."\nto = "."\nmethod = "on_scored"\n'

MISTAKES: list[tuple[str, str, str]] = [
    ("a = [1", "line 1", "not valid TOML"),
    ("", "", "at least one [[node]]"),
    ("[nodes]\nx = 1\n", "line 1", "unknown table 'nodes'; did you mean node?"),
    ("[node]\nname = 1\n", "line 1", "'node' must be written [[node]]"),
    (NODE + "colour = 3\n", "line 4", "unknown key 'colour'"),
    (NODE.replace('"A"', '"A/B"'), "line 2", "name is 'A/B'"),
    ('[[node]]\ntype = "Node"\n', "line 1", "name is ''"),
    (NODE.replace("Node3D", "Nod3D"), "line 3", "no node type 'Nod3D'; did you mean Node3D"),
    (NODE.replace("Node3D", "no.such.Thing"), "line 3", "module 'no.such' can't be imported"),
    (NODE.replace("Node3D", "tifo.Nodd"), "line 3", "has no node type 'Nodd'; did you mean Node"),
    (NODE.replace("Node3D", "res://gone.py:X"), "line 3", "there is no such file"),
    (NODE.replace("Node3D", "res://gone.txt"), "line 3", "expected something like 'res://fan.py"),
    (NODE + 'parent = "."\n', "line 4", "the first node is the root"),
    (NODE + "\n" + NODE, "line 5", "node 'A' needs a parent"),
    (NODE + "\n" + NODE + 'parent = "B"\n', "line 8", "has the path 'B'"),
    (NODE + 2 * (NODE + 'parent = "."\n'), "line 9", "two nodes 'A' below '.'"),
    (NODE + 'scene = "res://x.toml"\n', "line 1", "either a type or a scene"),
    ('[[node]]\nname = "A"\nscene = "x.toml"\n', "line 3", "expected a path such as 'res://"),
    ('[[node]]\nname = "A"\nscene = "res://x.toml"\n', "line 3", "there is no such file"),
    (NODE + "groups = 3\n", "line 4", "groups is 3, expected a list of texts"),
    (NODE + "unique = 1\n", "line 4", "expected true or false"),
    (NODE + "exports = 1\n", "line 4", "expected a table"),
    (
        PLAYER + "[node.exports]\nsong = 1\nspeeed = 1\n",
        "line 5",
        "ScenePlayer has no export 'song'; did you mean songs",
    ),
    (
        PLAYER + "[node.exports]\nspeed = 1\n\nposition = [1,\n2]\n",
        "line 7",
        "Node3D.position is [1, 2], expected three numbers",
    ),
    (
        PLAYER + "[node.exports]\nspeed = 10.5\n",
        "line 5",
        "ScenePlayer.speed is 10.5, expected a number from 0 to 10",
    ),
    (PLAYER + "exports = { speed = 11 }\n", "line 4", "expected a number from 0 to 10"),
    (PLAYER + '[node.exports]\nmood = "MAD"\n', "line 5", "expected one of CALM, WILD"),
    (PLAYER + '[node.exports]\ntarget = "B"\n', "line 5", "'B' leads to no node of the scene"),
    (PLAYER + '[node.exports]\ntarget = "../.."\n', "line 5", "leads to no node"),
    (PLAYER + "[node.exports]\ntarget = 3\n", "line 5", "expected a path from this node"),
    (CONNECT.replace('"scored"', '"score"'), "line 5", "no signal 'score'; did you mean scored"),
    (CONNECT.replace('"on_scored"', '"on_score"'), "line 8", "no method 'on_score'; did you mean"),
    (CONNECT.replace('"on_scored"', '"free"'), "line 8", "can't take 1 arguments"),
    (CONNECT.replace('from = "."', 'from = "X"'), "line 6", "there is no node 'X'"),
    (CONNECT + "binds = 3\n", "line 9", "expected a list"),
    (CONNECT + "once = true\n", "line 9", "unknown key 'once'"),
    (PLAYER + '[[connection]]\nsignal = "scored"\n', "line 4", "has no 'from'"),
]


@pytest.mark.parametrize(("text", "place", "cause"), MISTAKES)
def test_mistakes_have_file_line_and_what_was_expected(
    folder: Path, text: str, place: str, cause: str
) -> None:
    (folder / "bad.toml").write_text(text)
    with pytest.raises(AssetError) as caught:
        load("res://bad.toml")
    assert caught.value.place == place
    assert cause in caught.value.cause
    assert str(caught.value).startswith("res://bad.toml")


def test_a_target_of_the_wrong_class(folder: Path) -> None:
    extra = '[[node]]\nname = "T"\nparent = "."\ntype = "Timer"\n'
    text = PLAYER + '[node.exports]\ntarget = "T"\n' + extra
    (folder / "bad.toml").write_text(text)
    with pytest.raises(AssetError, match=r"line 5: 'T' is a Timer, expected a Node3D"):
        load("res://bad.toml")


def test_scenes_in_a_circle_are_refused(folder: Path) -> None:
    for name, inner in (("a", "b"), ("b", "c"), ("c", "a")):
        text = NODE + f'[[node]]\nname = "I"\nparent = "."\nscene = "res://{inner}.toml"\n'
        (folder / f"{name}.toml").write_text(text)
    with pytest.raises(AssetError) as caught:
        load("res://a.toml")
    assert str(caught.value) == (
        "res://c.toml, line 7: scene 'res://a.toml' contains itself: "
        "res://a.toml > res://b.toml > res://c.toml > res://a.toml"
    )
    (folder / "c.toml").write_text(NODE)
    assert isinstance(load("res://a.toml"), PackedScene)


def test_a_mistake_in_an_inner_scene_names_that_file(folder: Path) -> None:
    (folder / "inner.toml").write_text(NODE + "[node.exports]\nscal = 1\n")
    (folder / "outer.toml").write_text(
        NODE + '[[node]]\nname = "I"\nparent = "."\nscene = "res://inner.toml"\n'
    )
    with pytest.raises(AssetError, match=r"res://inner.toml, line 5: .* did you mean scale"):
        load("res://outer.toml")


def test_a_constructor_that_fails_names_the_line(folder: Path) -> None:
    class FailingNode(Node):
        def __init__(self) -> None:
            raise RuntimeError("no luck")

    (folder / "f.toml").write_text('[[node]]\nname = "A"\ntype = "FailingNode"\n')
    with pytest.raises(AssetError, match=r"f.toml, line 1: .*RuntimeError: no luck"):
        load_scene("res://f.toml").instantiate()


def test_ambiguous_types_are_refused(folder: Path) -> None:
    one = type("TwiceNode", (Node,), {"__module__": "one"})
    two = type("TwiceNode", (Node,), {"__module__": "two"})
    (folder / "t.toml").write_text('[[node]]\nname = "A"\ntype = "TwiceNode"\n')
    with pytest.raises(AssetError, match=r"could be any of one.TwiceNode, two.TwiceNode"):
        load("res://t.toml")
    assert one is not two
