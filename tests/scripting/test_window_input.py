"""Events of pyglet arrive as events of the tree; windows and gamepads are played by dispatchers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pyglet
import pytest

from tifo import (
    InputEvent,
    InputEventJoypadButton,
    InputEventJoypadMotion,
    InputEventKey,
    InputEventMouseButton,
    InputEventMouseMotion,
    SceneTree,
    WindowInput,
)


class FakeWindow(pyglet.event.EventDispatcher):
    """Dispatches what a window does."""


for name in (
    *("on_key_press", "on_key_release", "on_mouse_press", "on_mouse_release", "on_mouse_motion"),
    *("on_mouse_drag", "on_mouse_scroll", "on_deactivate"),
):
    FakeWindow.register_event_type(name)


class FakeController(pyglet.event.EventDispatcher):
    """Dispatches what a gamepad does."""

    is_open = False

    def open(self) -> None:
        self.is_open = True

    def close(self) -> None:
        self.is_open = False


for name in (
    *("on_button_press", "on_button_release", "on_stick_motion", "on_trigger_motion"),
    "on_dpad_motion",
):
    FakeController.register_event_type(name)


@pytest.fixture
def window() -> FakeWindow:
    return FakeWindow()


@pytest.fixture
def adapter(tree: SceneTree, window: FakeWindow) -> Iterator[WindowInput]:
    made = WindowInput(window, tree, gamepads=False)
    yield made
    made.close()


@pytest.fixture
def key(gl: Any) -> Any:
    from pyglet.window import key

    return key


def taken(tree: SceneTree) -> list[InputEvent]:
    events, tree.events = tree.events, []
    return events


@pytest.mark.gl
def test_keys(tree: SceneTree, window: FakeWindow, adapter: WindowInput, key: Any) -> None:
    window.dispatch_event("on_key_press", key.SPACE, key.MOD_SHIFT)
    window.dispatch_event("on_key_press", key.SPACE, 0)
    window.dispatch_event("on_key_release", key.SPACE, 0)
    for symbol in (key.ENTER, key._1, key.NUM_3, key.LSHIFT, key.F5, 123456):
        window.dispatch_event("on_key_release", symbol, key.MOD_CTRL | key.MOD_NUMLOCK)
    first, echo, *rest = taken(tree)
    assert first == InputEventKey("SPACE", shift=True)
    assert echo == InputEventKey("SPACE", echo=True)
    assert rest[0] == InputEventKey("SPACE", False)
    assert [event.key for event in rest[1:] if isinstance(event, InputEventKey)] == [
        *("ENTER", "1", "NUM_3", "LSHIFT", "F5", "UNKNOWN")
    ]
    assert all(isinstance(event, InputEventKey) and event.ctrl for event in rest[1:])


@pytest.mark.gl
def test_every_letter_digit_and_arrow_has_its_name(key: Any) -> None:
    from tifo.scripting.input_events import KEYS
    from tifo.scripting.window_input import key_name

    for name in (*"ABCXYZ", "LEFT", "UP", "ESCAPE", "TAB", "BACKSPACE", "PAGEUP", "RCTRL", "F12"):
        assert key_name(getattr(key, name)) == name
    unreachable = KEYS - {key_name(symbol) for symbol in key._key_names}
    assert unreachable <= {"UNKNOWN", "HELP"} | {f"F{n}" for n in range(13, 25)}


@pytest.mark.gl
def test_the_mouse(tree: SceneTree, window: FakeWindow, adapter: WindowInput, key: Any) -> None:
    from pyglet.window import mouse

    window.dispatch_event("on_mouse_press", 3, 4, mouse.RIGHT, 0)
    window.dispatch_event("on_mouse_drag", 5, 6, 2, 2, mouse.RIGHT | mouse.MIDDLE, 0)
    window.dispatch_event("on_mouse_release", 5, 6, mouse.RIGHT, 0)
    window.dispatch_event("on_mouse_motion", 7, 8, 1, 1)
    window.dispatch_event("on_mouse_scroll", 7, 8, 0, -2)
    assert taken(tree) == [
        InputEventMouseButton("RIGHT", True, 3, 4),
        InputEventMouseMotion(5, 6, 2, 2, frozenset({"RIGHT", "MIDDLE"})),
        InputEventMouseButton("RIGHT", False, 5, 6),
        InputEventMouseMotion(7, 8, 1, 1),
        InputEventMouseButton("WHEEL_DOWN", True, 7, 8, 2),
        InputEventMouseButton("WHEEL_DOWN", False, 7, 8, 2),
    ]


@pytest.mark.gl
def test_what_is_held_is_released_with_the_focus(
    tree: SceneTree, window: FakeWindow, adapter: WindowInput, key: Any
) -> None:
    from pyglet.window import mouse

    window.dispatch_event("on_key_press", key.W, 0)
    window.dispatch_event("on_mouse_press", 1, 1, mouse.LEFT, 0)
    taken(tree)
    window.dispatch_event("on_deactivate")
    assert taken(tree) == [
        InputEventKey("W", False),
        InputEventMouseButton("LEFT", False, 1, 1),
    ]
    adapter.close()
    window.dispatch_event("on_key_press", key.W, 0)
    assert taken(tree) == []


def test_gamepads(tree: SceneTree, adapter: WindowInput) -> None:
    first, second = FakeController(), FakeController()
    adapter.on_connect(first)
    adapter.on_connect(second)
    assert first.is_open
    second.dispatch_event("on_button_press", second, "a")
    second.dispatch_event("on_stick_motion", second, "leftstick", pyglet.math.Vec2(0.5, -1.00001))
    first.dispatch_event("on_trigger_motion", first, "righttrigger", 0.25)
    first.dispatch_event("on_dpad_motion", first, pyglet.math.Vec2(-1, 0))
    assert taken(tree) == [
        InputEventJoypadButton("A", True, 1),
        InputEventJoypadMotion("LEFT_X", 0.5, 1),
        InputEventJoypadMotion("LEFT_Y", -1.0, 1),
        InputEventJoypadMotion("TRIGGER_RIGHT", 0.25, 0),
        InputEventJoypadButton("DPAD_LEFT", True, 0),
        *(InputEventJoypadButton(f"DPAD_{name}", False, 0) for name in ("RIGHT", "DOWN", "UP")),
    ]
    tree.input_map.add_action("jump", InputEventJoypadButton("A"))
    tree.input_map.add_action("run", InputEventJoypadMotion("LEFT_X"), deadzone=0.1)
    first.dispatch_event("on_button_press", first, "a")
    first.dispatch_event("on_stick_motion", first, "leftstick", pyglet.math.Vec2(0.75, 0.0))
    assert not tree.input.is_action_pressed("jump"), "at the next tick"
    tree.advance(1 / 60)
    assert tree.input.is_action_just_pressed("jump")
    assert tree.input.get_action_strength("run") > 0.5
    adapter.on_disconnect(second)
    assert InputEventJoypadButton("A", False, 1) in taken(tree)
    third = FakeController()
    adapter.on_connect(third)
    third.dispatch_event("on_button_release", third, "x")
    assert taken(tree) == [InputEventJoypadButton("X", False, 1)]
