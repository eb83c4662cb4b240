"""Files that change while the game runs: what is taken over, what is kept, what is refused."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tifo import HotReload, Node, Resource, SceneTree, ScriptError, export, load, load_scene

Write = Callable[[str, str], None]

FAN = """
from tifo import Node, Signal, export

LOUD = 2

class Fan(Node):
    shouted = Signal[str]()
    energy: float = export(default=1.0, range=(0, 10))
    shouts: int = 0

    def _process(self, delta):
        self.shouts += volume()

    def told(self, word):
        self.word = word

    @property
    def mood(self):
        return "calm"

    def base(self):
        return super().can_process()

def volume():
    return LOUD
"""
SCENE = """
[[node]]
name = "Main"
type = "Node"

[[node]]
name = "Fan"
parent = "."
type = "res://fan.py:Fan"
[node.exports]
energy = 2.0

[[connection]]
signal = "shouted"
from = "Fan"
to = "Fan"
method = "told"
"""


@pytest.fixture
def write(folder: Path) -> Write:
    """Write a file of ``res://`` with a time of its own."""
    clock = [1_000_000_000]

    def put(name: str, text: str) -> None:
        (folder / name).write_text(text)
        clock[0] += 5
        os.utime(folder / name, (clock[0], clock[0]))

    return put


@pytest.fixture
def reload(tree: SceneTree, write: Write) -> HotReload:
    write("fan.py", FAN)
    write("main.toml", SCENE)
    tree.change_scene("res://main.toml")
    tree.advance(1 / 60)
    return HotReload(tree)


def fan_of(tree: SceneTree) -> Any:
    assert tree.current_scene is not None
    return tree.current_scene["Fan"]


def test_nothing_happens_while_nothing_changes(tree: SceneTree, reload: HotReload) -> None:
    assert reload.check() == []
    reload.poll()
    tree.advance(1 / 60)
    assert fan_of(tree).shouts == 2


def test_a_script_gets_new_code_and_keeps_its_state(
    tree: SceneTree, reload: HotReload, write: Write, errors: list[ScriptError]
) -> None:
    tree.run(0.1)
    fan, cls = fan_of(tree), type(fan_of(tree))
    before, told = fan.shouts, fan.told
    assert before == 12
    names: list[str] = []
    reload.reloaded.connect(names.append)
    changed = FAN.replace("LOUD = 2", "LOUD = 5").replace(
        "self.word = word", "self.word = word * 2"
    )
    changed = changed.replace('"calm"', "'wild' + str(self.shouts)")
    changed += (
        "\n    \nclass Singer(Fan):\n    def told(self, word):\n        super().told(word + '!')\n"
    )
    write("fan.py", changed)
    assert reload.check() == names == ["res://fan.py"]
    assert fan_of(tree) is fan
    assert type(fan) is cls is load("res://fan.py").Fan
    tree.run(0.1)
    assert fan.shouts == before + 6 * 5
    fan.shouted.emit("la")
    assert fan.word == "lala", "connections that exist run the new code"
    told("x")
    assert fan.word == "xx"
    assert fan.mood == f"wild{fan.shouts}"
    assert fan.base() is True, "super() knows the class"
    singer = load("res://fan.py").Singer()
    singer.told("a")
    assert singer.word == "a!a!"
    assert isinstance(singer, cls)
    assert not errors


def test_callbacks_come_and_go(
    tree: SceneTree, reload: HotReload, write: Write, errors: list[ScriptError]
) -> None:
    fan = fan_of(tree)
    write("fan.py", FAN.replace("def _process(self, delta)", "def _physics_process(self, delta)"))
    reload.check()
    fan.shouts = 0
    tree.advance(3 / 60)
    assert fan.shouts == 3 * 2, "three ticks in one frame"
    without = FAN.replace("    def mood(self)", "    def temper(self)")
    write("fan.py", without)
    reload.check()
    assert not hasattr(fan, "mood")
    assert fan.temper == "calm"
    assert not errors


def test_exports_are_checked_again(
    tree: SceneTree, reload: HotReload, write: Write, errors: list[ScriptError]
) -> None:
    fan = fan_of(tree)
    fan.energy = 8.0
    write("fan.py", FAN.replace("range=(0, 10)", "range=(0, 10), group='Body'") + "\n#")
    reload.check()
    assert fan.energy == 8.0
    assert not errors
    write(
        "fan.py", FAN.replace("range=(0, 10)", "range=(0, 5)").replace("default=1.0", "default=3.0")
    )
    reload.check()
    assert "Fan.energy is 8.0, expected a number from 0 to 5" in str(errors[0])
    assert fan.energy == 3.0
    with pytest.raises(ValueError, match="from 0 to 5"):
        fan.energy = 6.0


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        ("class Fan(Node:\n", "res://fan.py, line 1: SyntaxError"),
        ("from tifo import Node\n\nclass Fan(Nod):\n    pass\n", "line 3: NameError: name 'Nod'"),
        (FAN + "\nraise OSError('no')\n", "OSError: no"),
    ],
)
def test_what_is_broken_is_told_and_the_old_code_stays(
    tree: SceneTree,
    reload: HotReload,
    write: Write,
    errors: list[ScriptError],
    broken: str,
    said: str,
) -> None:
    fan = fan_of(tree)
    write("fan.py", broken)
    assert reload.check() == []
    assert said in str(errors[0])
    assert "the change of 'res://fan.py'" in str(errors[0])
    assert reload.check() == []
    assert len(errors) == 1, "told once for each change"
    before = fan.shouts
    tree.advance(1 / 60)
    assert fan.shouts == before + 2
    assert load("res://fan.py").LOUD == 2
    write("fan.py", FAN.replace("LOUD = 2", "LOUD = 3"))
    assert reload.check() == ["res://fan.py"]
    tree.advance(1 / 60)
    assert fan.shouts == before + 2 + 3


def test_scenes_change_in_their_running_instances(
    tree: SceneTree, reload: HotReload, write: Write, errors: list[ScriptError]
) -> None:
    fan = fan_of(tree)
    fan.shouts = 100
    more = SCENE.replace("energy = 2.0", "energy = 4.0") + (
        '\n[[node]]\nname = "Box"\nparent = "."\ntype = "Node"\ngroups = ["boxes"]\n'
        '\n[[node]]\nname = "Second"\nparent = "Box"\ntype = "res://fan.py:Fan"\n'
    )
    write("main.toml", more)
    assert reload.check() == ["res://main.toml"]
    main = tree.current_scene
    assert main is not None
    assert (fan_of(tree) is fan, fan.energy, fan.shouts) == (True, 4.0, 100)
    second = main["Box/Second"]
    assert second.owner is main
    assert tree.get_nodes_in_group("boxes") == [main["Box"]]
    fan.energy = 7.0
    write("main.toml", more.replace('groups = ["boxes"]', 'groups = ["cases"]'))
    reload.check()
    assert fan.energy == 7.0, "what the file doesn't change stays as the game has made it"
    assert main["Box/Second"] is second
    assert tree.get_nodes_in_group("cases") == [main["Box"]]
    write("main.toml", SCENE.partition("[[connection]]")[0].replace("energy = 2.0", ""))
    reload.check()
    assert not main.has_node("Box")
    assert second._freed
    assert fan.energy == 1.0
    assert fan.shouted.connections == ()
    write("main.toml", SCENE)
    reload.check()
    assert len(fan.shouted.connections) == 1
    assert not errors
    assert len(load_scene("res://main.toml").entries) == 2


def test_a_node_of_another_type_is_replaced(
    tree: SceneTree, reload: HotReload, write: Write, errors: list[ScriptError]
) -> None:
    fan = fan_of(tree)
    write(
        "main.toml",
        SCENE.partition("[[connection]]")[0]
        .replace("res://fan.py:Fan", "Timer")
        .replace("energy = 2.0", "wait_time = 2.0"),
    )
    assert reload.check() == ["res://main.toml"]
    assert fan._freed
    assert type(fan_of(tree)).__name__ == "Timer"
    assert fan_of(tree).wait_time == 2.0
    assert not errors


def test_a_scene_inside_another_changes_there_too(
    tree: SceneTree, write: Write, errors: list[ScriptError]
) -> None:
    write("inner.toml", '[[node]]\nname = "Inner"\ntype = "Timer"\n')
    write(
        "outer.toml",
        '[[node]]\nname = "Outer"\ntype = "Node"\n\n[[node]]\nname = "A"\n'
        'parent = "."\nscene = "res://inner.toml"\n',
    )
    tree.change_scene("res://outer.toml")
    tree.advance(0.0)
    reload = HotReload(tree)
    write(
        "inner.toml", '[[node]]\nname = "Inner"\ntype = "Timer"\n[node.exports]\nwait_time = 3.0\n'
    )
    assert reload.check() == ["res://inner.toml"]
    assert tree.current_scene is not None
    assert tree.current_scene["A"].wait_time == 3.0  # type: ignore[attr-defined]
    again = load_scene("res://outer.toml").instantiate()
    assert again["A"].wait_time == 3.0  # type: ignore[attr-defined]
    assert not errors


def test_a_broken_scene_is_told_with_its_line(
    tree: SceneTree, reload: HotReload, write: Write, errors: list[ScriptError]
) -> None:
    fan = fan_of(tree)
    write("main.toml", SCENE.replace("energy = 2.0", "enrgy = 2.0"))
    assert reload.check() == []
    line = SCENE.split("\n").index("energy = 2.0") + 1
    assert f"line {line}: Fan has no export 'enrgy'; did you mean energy?" in str(errors[0])
    assert fan_of(tree) is fan
    assert len(load_scene("res://main.toml").entries) == 2
    write("main.toml", SCENE.replace('type = "Node"', 'type = "Timer"'))
    assert reload.check() == []
    assert "the root of res://main.toml has another type" in str(errors[1])


class Strip(Resource):
    """Shared data."""

    colour: str = export(default="red")
    stripes: int = export(default=0, range=(0, 9))


def test_resources_stay_the_same_objects(
    tree: SceneTree, write: Write, errors: list[ScriptError]
) -> None:
    write("kit.toml", '[resource]\ntype = "Strip"\n\n[exports]\ncolour = "blue"\nstripes = 3\n')
    kit = load("res://kit.toml")
    reload = HotReload(tree)
    write("kit.toml", '[resource]\ntype = "Strip"\n\n[exports]\ncolour = "green"\n')
    assert reload.check() == ["res://kit.toml"]
    assert load("res://kit.toml") is kit
    assert (kit.colour, kit.stripes) == ("green", 0)
    write("kit.toml", '[resource]\ntype = "Strip"\n\n[exports]\nstripes = 12\n')
    assert reload.check() == []
    assert "Strip.stripes is 12" in str(errors[0])
    assert kit.colour == "green"


def test_a_file_that_is_gone_for_a_moment_does_no_harm(
    tree: SceneTree, reload: HotReload, write: Write, folder: Path, errors: list[ScriptError]
) -> None:
    (folder / "fan.py").unlink()
    assert reload.check() == []
    write("fan.py", FAN.replace("LOUD = 2", "LOUD = 4"))
    assert reload.check() == ["res://fan.py"]
    assert not errors


def test_files_are_looked_at_now_and_then(
    tree: SceneTree, reload: HotReload, write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tifo.scripting import hot_reload

    now = [100.0]
    monkeypatch.setattr(hot_reload, "monotonic", lambda: now[0])
    reload.poll()
    looks: list[float] = []
    monkeypatch.setattr(reload, "_look", lambda: looks.append(now[0]) or [])
    for _ in range(120):
        now[0] += 1 / 60
        reload.poll()
    assert 3 <= len(looks) <= 5


def test_subclasses_elsewhere_follow(
    tree: SceneTree, reload: HotReload, write: Write, errors: list[ScriptError]
) -> None:
    fan_class: Any = type(fan_of(tree))
    derived: Any = type("Derived", (fan_class,), {"__module__": __name__})
    made = tree.root.add_child(derived(energy=5.0))
    assert isinstance(made, Node)
    write(
        "fan.py",
        FAN.replace(
            "shouts: int = 0", "shouts: int = 0\n    songs: int = export(default=4)"
        ).replace("def _process", "def _physics_process"),
    )
    reload.check()
    assert made.songs == 4
    assert "songs" in derived._exports
    made.shouts = 0
    tree.advance(2 / 60)
    assert made.shouts == 4
    assert not errors
