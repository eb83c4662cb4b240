"""Recorded input gives the same game again; files with mistakes name the line."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tifo
from tifo import (
    AssetError,
    HotReload,
    InputEvent,
    InputEventAction,
    InputEventJoypadButton,
    InputEventJoypadMotion,
    InputEventKey,
    InputEventMouseButton,
    InputEventMouseMotion,
    InputLog,
    Node3D,
    SceneTree,
    Vector3,
)

STEP = 1 / 60
EVENTS: tuple[InputEvent, ...] = (
    InputEventKey("SPACE", shift=True),
    InputEventMouseButton("LEFT", False, 3.0, 4.5),
    InputEventMouseMotion(1.0, 2.0, -1.0, 0.25, frozenset({"LEFT", "RIGHT"})),
    InputEventJoypadButton("A", True, 1),
    InputEventJoypadMotion("LEFT_X", -0.5, 0),
    InputEventAction("go", True, 0.75),
)


class Walker(Node3D):
    """Where it is at the end depends on every tick of every key."""

    heard: int = 0

    def _physics_process(self, delta: float) -> None:
        push = self.tree.input.get_axis("left", "right")
        self.position = self.position * 0.97 + Vector3(push * delta, 0, 0)
        if self.tree.input.is_action_just_pressed("right"):
            self.get_node("../Stadium/Crowd", tifo.nodes.Crowd).send(tifo.Goal(side=0))

    def _unhandled_input(self, event: InputEvent) -> None:
        self.heard = (31 * self.heard + self.tree.tick) % 1_000_003


def game() -> tuple[SceneTree, Walker, Any]:
    tree = SceneTree()
    tree.input_map.add_action("left", InputEventKey("LEFT"))
    tree.input_map.add_action("right", InputEventKey("RIGHT"), InputEventJoypadButton("A"))
    main = tree.root.add_child(Node3D(name="Main"))
    stadium = main.add_child(
        tifo.Stadium(name="Stadium", layout="stand", rows=3, columns=6, streams=16, history=14)
    )
    crowd = stadium.add_child(tifo.nodes.Crowd(name="Crowd"))
    walker = main.add_child(Walker(name="Walker"))
    return tree, walker, crowd


def state(walker: Walker, crowd: Any) -> tuple[Any, ...]:
    data = crowd.data
    return (
        (*walker.position, walker.heard),
        data.behaviour.reacting.tobytes(),
        np.asarray(data.motion.wanted).tobytes(),
    )


def test_a_recorded_game_is_played_again_at_another_frame_rate(tmp_path: Path) -> None:
    tree, walker, crowd = game()
    log = InputLog()
    log.record(tree)
    dice = random.Random(7)
    while tree.tick < 240:
        if dice.random() < 0.2:
            tree.push_input(InputEventKey(dice.choice(["LEFT", "RIGHT"]), dice.random() < 0.6))
        tree.advance(dice.choice([0.0, 1 / 144, 1 / 60, 1 / 25]))
    tree.advance(0.0)
    log.stop()
    tree.push_input(InputEventKey("LEFT"))
    assert len(log.events) > 20
    assert log.ticks == tree.tick
    expected = state(walker, crowd)
    tree.close()
    log.save(tmp_path / "log.toml")

    again = InputLog.load(tmp_path / "log.toml")
    assert again.ticks == log.ticks
    tree, walker, crowd = game()
    again.play(tree)
    second = InputLog()
    second.record(tree)
    tree.run(again.ticks * STEP)
    assert state(walker, crowd) == expected
    assert second.events == log.events
    tree.close()

    # Without it, and with one event missing, the game is another one.
    again.events.pop(len(again.events) // 2)
    tree, walker, crowd = game()
    again.play(tree)
    tree.run(again.ticks * STEP)
    assert state(walker, crowd) != expected
    tree.close()


def test_every_kind_of_event_is_read_as_it_was_written(tree: SceneTree, tmp_path: Path) -> None:
    log = InputLog()
    log.record(tree)
    for event in EVENTS:
        tree.push_input(event)
        tree.advance(STEP)
    log.save(tmp_path / "log.toml")
    assert log.events == [*enumerate(EVENTS, start=1)]
    assert InputLog.load(tmp_path / "log.toml").events == log.events
    assert repr(log) == "<InputLog, 6 events in 6 ticks>"


def test_replayed_events_come_before_what_is_pressed_in_their_tick(tree: SceneTree) -> None:
    log, heard = InputLog(), []
    log.events = [(2, EVENTS[0]), (2, EVENTS[3]), (4, EVENTS[5])]
    log.play(tree)
    tree.input_taken.connect(lambda event: heard.append((tree.tick, event)))
    tree.advance(STEP)
    tree.push_input(EVENTS[4])
    tree.run(4 * STEP)
    assert heard == [(2, EVENTS[0]), (2, EVENTS[3]), (2, EVENTS[4]), (4, EVENTS[5])]
    with pytest.raises(ValueError, match="has passed tick 2, in which the log begins"):
        log.play(tree)


def test_changed_scripts_count_from_the_next_tick_and_are_noted(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tifo.scripting import hot_reload

    now = [0.0]
    monkeypatch.setattr(hot_reload, "monotonic", lambda: now[0])
    script = (
        "from tifo import Node\n\nclass Fan(Node):\n    log: str = ''\n"
        "    def _process(self, delta: float) -> None:\n        self.log += 'a'\n"
    )
    (folder / "logged_fan.py").write_text(script)
    (folder / "m.toml").write_text('[[node]]\nname = "F"\ntype = "res://logged_fan.py:Fan"\n')
    tree = SceneTree("res://m.toml")
    reload, log = HotReload(tree), InputLog()
    log.record(tree)
    with pytest.raises(ValueError, match="records a tree already"):
        log.record(tree)
    fan: Any = tree.current_scene
    tree.advance(STEP)
    (folder / "logged_fan.py").write_text(script.replace("'a'", "'bb'[:1]"))
    now[0] += 1.0
    reload.poll()
    tree.advance(STEP / 4)
    assert fan.log == "aa", "there was no tick since"
    tree.advance(STEP)
    assert fan.log == "aab"
    assert log.changes == [(2, "res://logged_fan.py")]
    log.save(tmp_path / "log.toml")
    assert InputLog.load(tmp_path / "log.toml").changes == log.changes
    tree.close()


@pytest.mark.parametrize(
    ("text", "place", "cause"),
    [
        ("ticks = -1\n", "line 1", "ticks is -1, expected a whole number from 0 on"),
        ("ticks = 1\ntick = 1\n", "line 2", "'tick'; did you mean ticks?"),
        ("ticks = 1\nchanges = [1]\n", "line 2", "expected a list of [tick, path]"),
        ("ticks = 1\nevent = 3\n", "line 2", "expected tables [[event]]"),
        ('ticks = 9\n[[event]]\ntick = 0\ntype = "Key"\nkey = "A"\n', "line 3", "from 1 on"),
        ('ticks = 9\n[[event]]\ntick = 1\ntype = "Kee"\n', "line 4", "did you mean Key?"),
        ('ticks = 9\n[[event]]\ntick = 1\ntype = "Key"\nkei = "A"\n', "line 5", "mean key?"),
        ('ticks = 9\n[[event]]\ntick = 1\ntype = "Key"\nkey = 1\n', "line 5", "expected a text"),
        ('ticks = 9\n[[event]]\ntick = 1\ntype = "Key"\nkey = "AA"\n', "line 2", "key is 'AA'"),
        ('ticks = 9\n[[event]]\ntick = 1\ntype = "Key"\n', "line 2", "missing 1 required"),
        ("ticks = 1 2\n", "line 1, column 11", "not valid TOML"),
    ],
)
def test_mistakes_name_their_line(tmp_path: Path, text: str, place: str, cause: str) -> None:
    (tmp_path / "log.toml").write_text(text)
    with pytest.raises(AssetError) as caught:
        InputLog.load(tmp_path / "log.toml")
    assert caught.value.place == place
    assert cause in caught.value.cause


def test_ticks_in_disorder_are_refused(tmp_path: Path) -> None:
    event = '[[event]]\ntick = {}\ntype = "Key"\nkey = "A"\n'
    (tmp_path / "log.toml").write_text("ticks = 9\n" + event.format(5) + event.format(4))
    with pytest.raises(AssetError, match="line 7: tick is 4, expected a whole number from 5 on"):
        InputLog.load(tmp_path / "log.toml")
