"""Events of a pyglet window and of gamepads as input of a tree; pyglet is loaded late."""

from __future__ import annotations

from typing import Any

from .input_events import (
    KEYS,
    InputEvent,
    InputEventJoypadButton,
    InputEventJoypadMotion,
    InputEventKey,
    InputEventMouseButton,
    InputEventMouseMotion,
)
from .tree import SceneTree

_RENAMED = {
    **{f"_{digit}": str(digit) for digit in range(10)},
    "RETURN": "ENTER",
    "LCOMMAND": "LMETA",
    "RCOMMAND": "RMETA",
    "LWINDOWS": "LMETA",
    "RWINDOWS": "RMETA",
    "LOPTION": "LALT",
    "ROPTION": "RALT",
    "QUOTELEFT": "GRAVE",
    "POUND": "HASH",
}
_MOUSE = ("LEFT", "MIDDLE", "RIGHT", "MOUSE4", "MOUSE5")
"""In the order of pyglet's bits."""
_JOY_BUTTONS = {
    **{name.lower(): name for name in ("A", "B", "X", "Y", "BACK", "START", "GUIDE")},
    "leftstick": "LEFT_STICK",
    "rightstick": "RIGHT_STICK",
    "leftshoulder": "LEFT_SHOULDER",
    "rightshoulder": "RIGHT_SHOULDER",
}
_STICKS = {"leftstick": ("LEFT_X", "LEFT_Y"), "rightstick": ("RIGHT_X", "RIGHT_Y")}
_TRIGGERS = {"lefttrigger": "TRIGGER_LEFT", "righttrigger": "TRIGGER_RIGHT"}


def key_name(symbol: int) -> str:
    """tifo's name of a pyglet key symbol, ``UNKNOWN`` if it has none."""
    from pyglet.window import key

    name = str(key.symbol_string(symbol))
    name = _RENAMED.get(name, name)
    return name if name in KEYS else "UNKNOWN"


class WindowInput:
    """Passes what happens in a window, and on gamepads, to a tree.

    What is held when the window loses the focus is released.

    Parameters
    ----------
    window
        A pyglet window.
    tree
        Gets the events.
    gamepads
        Listen to gamepads too, also those that are plugged in later.
    """

    def __init__(self, window: Any, tree: SceneTree, *, gamepads: bool = True) -> None:
        self._window, self._tree = window, tree
        self._held: dict[tuple[str, str], InputEvent] = {}
        self._devices: list[Any] = []
        self._manager: Any = None
        window.push_handlers(self)
        if gamepads:
            import pyglet

            try:
                self._manager = pyglet.input.ControllerManager()
            except OSError:
                return  # a container without input devices
            for controller in self._manager.get_controllers():
                self.on_connect(controller)
            self._manager.push_handlers(self)

    def close(self) -> None:
        """Release what is held, and listen no longer."""
        self.on_deactivate()
        self._window.remove_handlers(self)
        for controller in [device for device in self._devices if device is not None]:
            controller.remove_handlers(self)
            controller.close()
        if self._manager is not None:
            self._manager.remove_handlers(self)
        self._devices.clear()

    def on_key_press(self, symbol: int, modifiers: int) -> None:
        """A key goes down."""
        name = key_name(symbol)
        event = InputEventKey(name, True, ("key", name) in self._held, **_modifiers(modifiers))
        self._held["key", name] = InputEventKey(name, False)
        self._tree.push_input(event)

    def on_key_release(self, symbol: int, modifiers: int) -> None:
        """A key goes up."""
        name = key_name(symbol)
        self._held.pop(("key", name), None)
        self._tree.push_input(InputEventKey(name, False, **_modifiers(modifiers)))

    def on_mouse_press(self, x: int, y: int, button: int, modifiers: int) -> None:
        """A button goes down."""
        name = _mouse_name(button)
        if name:
            self._held["mouse", name] = InputEventMouseButton(name, False, x, y)
            self._tree.push_input(InputEventMouseButton(name, True, x, y, **_modifiers(modifiers)))

    def on_mouse_release(self, x: int, y: int, button: int, modifiers: int) -> None:
        """A button goes up."""
        name = _mouse_name(button)
        if name:
            self._held.pop(("mouse", name), None)
            self._tree.push_input(InputEventMouseButton(name, False, x, y, **_modifiers(modifiers)))

    def on_mouse_motion(self, x: int, y: int, dx: int, dy: int) -> None:
        """The mouse moves."""
        self._tree.push_input(InputEventMouseMotion(x, y, dx, dy))

    def on_mouse_drag(self, x: int, y: int, dx: int, dy: int, buttons: int, modifiers: int) -> None:
        """The mouse moves with buttons held."""
        held = frozenset(name for bit, name in enumerate(_MOUSE) if buttons & 1 << bit)
        self._tree.push_input(InputEventMouseMotion(x, y, dx, dy, held))

    def on_mouse_scroll(self, x: int, y: int, scroll_x: float, scroll_y: float) -> None:
        """The wheel moves: a press and a release for each direction."""
        for amount, positive, negative in (
            (scroll_y, "WHEEL_UP", "WHEEL_DOWN"),
            (scroll_x, "WHEEL_RIGHT", "WHEEL_LEFT"),
        ):
            if amount:
                name = positive if amount > 0 else negative
                for pressed in (True, False):
                    event = InputEventMouseButton(name, pressed, x, y, abs(amount))
                    self._tree.push_input(event)

    def on_deactivate(self) -> None:
        """The window loses the focus, and will not hear of releases."""
        for event in self._held.values():
            self._tree.push_input(event)
        self._held.clear()

    def on_connect(self, controller: Any) -> None:
        """A gamepad is there; it gets the first free number."""
        controller.open()
        controller.push_handlers(self)
        if None in self._devices:
            self._devices[self._devices.index(None)] = controller
        else:
            self._devices.append(controller)

    def on_disconnect(self, controller: Any) -> None:
        """A gamepad is gone: what is held on it is released, its number is free."""
        if controller not in self._devices:
            return
        device = self._devices.index(controller)
        self._devices[device] = None
        for name in _JOY_BUTTONS.values():
            self._tree.push_input(InputEventJoypadButton(name, False, device))
        for direction in ("UP", "DOWN", "LEFT", "RIGHT"):
            self._tree.push_input(InputEventJoypadButton(f"DPAD_{direction}", False, device))
        for axis in (*_STICKS["leftstick"], *_STICKS["rightstick"], *_TRIGGERS.values()):
            self._tree.push_input(InputEventJoypadMotion(axis, 0.0, device))

    def on_button_press(self, controller: Any, button: str) -> None:
        """A button of a gamepad goes down."""
        self._joy_button(controller, button, True)

    def on_button_release(self, controller: Any, button: str) -> None:
        """A button of a gamepad goes up."""
        self._joy_button(controller, button, False)

    def on_stick_motion(self, controller: Any, stick: str, vector: Any) -> None:
        """A stick moves."""
        for axis, value in zip(_STICKS.get(stick, ()), vector, strict=False):
            self._joy_axis(controller, axis, value)

    def on_trigger_motion(self, controller: Any, trigger: str, value: float) -> None:
        """A trigger moves."""
        if trigger in _TRIGGERS:
            self._joy_axis(controller, _TRIGGERS[trigger], value)

    def on_dpad_motion(self, controller: Any, vector: Any) -> None:
        """The cross moves: its four buttons say so."""
        x, y = vector
        device = self._device(controller)
        for name, pressed in (("LEFT", x < 0), ("RIGHT", x > 0), ("DOWN", y < 0), ("UP", y > 0)):
            self._tree.push_input(InputEventJoypadButton(f"DPAD_{name}", bool(pressed), device))

    def _joy_button(self, controller: Any, button: str, pressed: bool) -> None:
        if button in _JOY_BUTTONS:
            event = InputEventJoypadButton(_JOY_BUTTONS[button], pressed, self._device(controller))
            self._tree.push_input(event)

    def _joy_axis(self, controller: Any, axis: str, value: float) -> None:
        value = min(max(float(value), -1.0), 1.0)
        self._tree.push_input(InputEventJoypadMotion(axis, value, self._device(controller)))

    def _device(self, controller: Any) -> int:
        return self._devices.index(controller) if controller in self._devices else 0


def _mouse_name(button: int) -> str:
    bit = button.bit_length() - 1
    return _MOUSE[bit] if 0 <= bit < len(_MOUSE) else ""


def _modifiers(bits: int) -> dict[str, bool]:
    from pyglet.window import key

    return {
        "shift": bool(bits & key.MOD_SHIFT),
        "ctrl": bool(bits & key.MOD_CTRL),
        "alt": bool(bits & key.MOD_ALT),
        "meta": bool(bits & (key.MOD_COMMAND | key.MOD_WINDOWS)),
    }
