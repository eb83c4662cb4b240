"""Actions, events and their way through the tree."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tifo import (
    InputEvent,
    InputEventAction,
    InputEventJoypadButton,
    InputEventJoypadMotion,
    InputEventKey,
    InputEventMouseButton,
    InputEventMouseMotion,
    Node,
    ProcessMode,
    SceneTree,
    ScriptError,
)

STEP = 1 / 60
Key = InputEventKey


@pytest.fixture
def mapped(tree: SceneTree) -> SceneTree:
    add = tree.input_map.add_action
    add("jump", Key("SPACE"), InputEventJoypadButton("A"), InputEventMouseButton("LEFT"))
    add("save", Key("S", ctrl=True))
    for name, key, axis, sign in (
        *(("left", "LEFT", "LEFT_X", -1.0), ("right", "RIGHT", "LEFT_X", 1.0)),
        *(("down", "DOWN", "LEFT_Y", -1.0), ("up", "UP", "LEFT_Y", 1.0)),
    ):
        add(name, Key(key), InputEventJoypadMotion(axis, sign), deadzone=0.2)
    return tree


class Asker(Node):
    """Writes down what is just pressed and released, in ticks and frames."""

    def _prepare(self) -> None:
        super()._prepare()
        self.log: list[str] = []

    def ask(self, when: str) -> None:
        state = self.tree.input
        words = [
            word
            for word, answer in (
                ("pressed", state.is_action_pressed("jump")),
                ("just", state.is_action_just_pressed("jump")),
                ("released", state.is_action_just_released("jump")),
            )
            if answer
        ]
        self.log.append(f"{when} {' '.join(words)}".strip())

    def _physics_process(self, delta: float) -> None:
        self.ask("tick")

    def _process(self, delta: float) -> None:
        self.ask("frame")


def test_input_takes_effect_at_the_next_tick(mapped: SceneTree) -> None:
    asker = mapped.root.add_child(Asker())
    mapped.push_input(Key("SPACE"))
    assert not mapped.input.is_action_pressed("jump")
    mapped.advance(0.0)  # a frame without a tick
    mapped.advance(2 * STEP)
    mapped.advance(STEP)
    mapped.push_input(Key("SPACE", False))
    mapped.advance(STEP)
    mapped.advance(STEP)
    assert asker.log == [
        "frame",
        *("tick pressed just", "tick pressed", "frame pressed just"),
        *("tick pressed", "frame pressed"),
        *("tick released", "frame released"),
        *("tick", "frame"),
    ]


def test_a_tap_within_a_tick_is_seen(mapped: SceneTree) -> None:
    asker = mapped.root.add_child(Asker())
    mapped.push_input(Key("SPACE"))
    mapped.push_input(Key("SPACE", False))
    mapped.advance(STEP)
    assert asker.log == ["tick just released", "frame just released"]


def test_several_bindings_of_an_action(mapped: SceneTree) -> None:
    asker = mapped.root.add_child(Asker())
    for events in (
        [Key("SPACE"), InputEventJoypadButton("A", True, 0)],
        [Key("SPACE", False)],
        [InputEventJoypadButton("A", False, 0)],
    ):
        for event in events:
            mapped.push_input(event)
        mapped.advance(STEP)
    assert asker.log[::2] == ["tick pressed just", "tick pressed", "tick released"]


def test_modifiers(mapped: SceneTree) -> None:
    for event, pressed in (
        (Key("S"), False),
        (Key("S", ctrl=True, shift=True), True),
        (Key("S", False), False),
    ):
        mapped.push_input(event)
        mapped.advance(STEP)
        assert mapped.input.is_action_pressed("save") is pressed


def push(tree: SceneTree, **axes: float) -> None:
    for axis, value in axes.items():
        tree.push_input(InputEventJoypadMotion(axis, value, 0))
    tree.advance(STEP)


def test_strength_and_axes(mapped: SceneTree) -> None:
    state = mapped.input
    push(mapped, LEFT_X=0.6)
    assert state.get_action_strength("right") == pytest.approx(0.5)  # (0.6 - 0.2) / 0.8
    assert state.get_action_raw_strength("right") == pytest.approx(0.6)
    assert state.get_action_strength("left") == 0.0
    assert state.get_axis("left", "right") == pytest.approx(0.5)
    push(mapped, LEFT_X=-1.0)
    assert state.get_axis("left", "right") == -1.0
    push(mapped, LEFT_X=0.1)
    assert state.get_axis("left", "right") == 0.0
    assert not state.is_action_pressed("right")


def test_vectors_have_a_round_dead_zone(mapped: SceneTree) -> None:
    def vector(**settings: float) -> tuple[float, float]:
        return mapped.input.get_vector("left", "right", "down", "up", **settings)

    push(mapped, LEFT_X=0.15, LEFT_Y=0.1)
    assert vector() == (0.0, 0.0)
    push(mapped, LEFT_X=0.3, LEFT_Y=0.4)  # 0.5 long, (0.5 - 0.2) / 0.8 is left of it
    assert vector() == pytest.approx((0.6 * 0.375, 0.8 * 0.375))
    assert vector(deadzone=0.0) == pytest.approx((0.3, 0.4))
    push(mapped, LEFT_X=0.0, LEFT_Y=0.0)
    mapped.push_input(Key("LEFT"))
    mapped.push_input(Key("UP"))
    mapped.advance(STEP)
    assert vector() == pytest.approx((-math.sqrt(0.5), math.sqrt(0.5)))


def test_actions_pressed_by_code(mapped: SceneTree) -> None:
    mapped.input.action_press("right", 0.6)
    assert not mapped.input.is_action_pressed("right")
    mapped.advance(STEP)
    assert mapped.input.get_action_strength("right") == pytest.approx(0.5)
    mapped.input.action_release("right")
    mapped.advance(STEP)
    assert mapped.input.is_action_just_released("right")


class Hearing(Node):
    """Writes down events."""

    log: Any = None
    stops: str = ""

    def _input(self, event: InputEvent) -> None:
        self.log.append(f"{self.name} input")
        if self.stops == "input":
            self.tree.set_input_as_handled()

    def _unhandled_input(self, event: InputEvent) -> None:
        self.log.append(f"{self.name} unhandled")
        if self.stops == "unhandled":
            self.tree.set_input_as_handled()


@pytest.mark.parametrize(
    ("stops", "heard"),
    [
        ("", ["C input", "B input", "A input", "C unhandled", "B unhandled", "A unhandled"]),
        ("input", ["C input", "B input"]),
        ("unhandled", ["C input", "B input", "A input", "C unhandled", "B unhandled"]),
    ],
)
def test_events_go_through_the_tree_backwards(
    tree: SceneTree, stops: str, heard: list[str]
) -> None:
    log: list[str] = []
    a = tree.root.add_child(Hearing(name="A", log=log))
    a.add_child(Hearing(name="B", log=log, stops=stops))
    tree.root.add_child(Hearing(name="C", log=log))
    tree.push_input(InputEventMouseMotion(1.0, 2.0))
    tree.advance(STEP)
    assert log == heard


def test_who_rests_hears_nothing(tree: SceneTree) -> None:
    log: list[str] = []
    tree.root.add_child(Hearing(name="A", log=log))
    tree.root.add_child(Hearing(name="M", log=log, process_mode=ProcessMode.ALWAYS))
    off = tree.root.add_child(Hearing(name="O", log=log))
    off.set_process_input(False)
    off.set_process_unhandled_input(False)
    tree.paused = True
    tree.push_input(Key("A"))
    tree.advance(STEP)
    assert log == ["M input", "M unhandled"]


def test_a_handler_that_frees_the_next(tree: SceneTree, errors: list[ScriptError]) -> None:
    log: list[str] = []
    tree.root.add_child(Hearing(name="A", log=log))

    class Killer(Node):
        def _input(self, event: InputEvent) -> None:
            self.tree.root["A"].free()

    tree.root.add_child(Killer())
    tree.push_input(Key("A"))
    tree.advance(STEP)
    assert log == []
    assert errors == []


def test_events_know_their_actions(mapped: SceneTree) -> None:
    seen: list[tuple[bool, ...]] = []

    class Listener(Node):
        def _input(self, event: InputEvent) -> None:
            seen.append(
                (
                    event.is_action("jump"),
                    event.is_action_pressed("jump"),
                    event.is_action_pressed("jump", allow_echo=True),
                    event.is_action_released("jump"),
                )
            )

    mapped.root.add_child(Listener())
    for event in (
        *(Key("SPACE"), Key("SPACE", echo=True), Key("SPACE", False), Key("A")),
        InputEventAction("jump"),
    ):
        mapped.push_input(event)
    mapped.advance(STEP)
    assert seen == [
        (True, True, True, False),
        (True, False, True, False),
        (True, False, False, True),
        (False, False, False, False),
        (True, True, True, False),
    ]


def test_wrong_names_are_refused(mapped: SceneTree) -> None:
    for make, cause in (
        (lambda: Key("SPCE"), r"key is 'SPCE'; did you mean SPACE"),
        (lambda: Key("space"), r"did you mean SPACE"),
        (lambda: InputEventMouseButton("LEFTT"), "did you mean LEFT"),
        (lambda: InputEventJoypadButton("Q"), "button is 'Q'"),
        (lambda: InputEventJoypadMotion("LEFT_X", 2.0), "value is 2.0"),
        (lambda: InputEventAction("jump", True, 2.0), "strength is 2.0"),
        (lambda: mapped.input_map.add_action("jump"), "expected a new name"),
        (lambda: mapped.input_map.add_action("x", deadzone=1.0), "deadzone is 1.0"),
        (
            lambda: mapped.input_map.action_add_event("jump", InputEventAction("x")),
            "can't be bound",
        ),
        (lambda: mapped.input.is_action_pressed("jmp"), r"no action 'jmp'; did you mean jump\?"),
        (lambda: Key("A").is_action("jump"), "came through no tree"),
        (lambda: mapped.push_input("A"), "expected an InputEvent"),  # type: ignore[arg-type]
    ):
        with pytest.raises(ValueError, match=cause):
            make()


def test_binding_anew(mapped: SceneTree) -> None:
    mapped.input_map.action_erase_events("jump")
    mapped.input_map.action_add_event("jump", Key("J"))
    mapped.push_input(Key("SPACE"))
    mapped.advance(STEP)
    assert not mapped.input.is_action_pressed("jump")
    mapped.push_input(Key("J"))
    mapped.advance(STEP)
    assert mapped.input.is_action_pressed("jump")
    mapped.input_map.erase_action("jump")
    assert not mapped.input_map.has_action("jump")
