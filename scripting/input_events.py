"""What happened on the keyboard, the mouse or a gamepad: plain data, whatever window it came from.

The same classes describe bindings: `InputEventKey("SPACE")` is the space bar for an action.
"""

from __future__ import annotations

import string
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .input_map import InputMap

KEYS = frozenset(
    {
        *string.ascii_uppercase,
        *string.digits,
        *(f"F{number}" for number in range(1, 25)),
        *(f"NUM_{number}" for number in range(10)),
        *("NUM_ADD", "NUM_SUBTRACT", "NUM_MULTIPLY", "NUM_DIVIDE", "NUM_DECIMAL", "NUM_ENTER"),
        *("SPACE", "ENTER", "ESCAPE", "TAB", "BACKSPACE", "INSERT", "DELETE", "HOME", "END"),
        *("PAGEUP", "PAGEDOWN", "LEFT", "RIGHT", "UP", "DOWN", "PAUSE", "PRINT", "MENU", "HELP"),
        *("LSHIFT", "RSHIFT", "LCTRL", "RCTRL", "LALT", "RALT", "LMETA", "RMETA"),
        *("CAPSLOCK", "NUMLOCK", "SCROLLLOCK"),
        *("MINUS", "EQUAL", "BRACKETLEFT", "BRACKETRIGHT", "SEMICOLON", "APOSTROPHE", "GRAVE"),
        *("BACKSLASH", "COMMA", "PERIOD", "SLASH", "PLUS", "ASTERISK", "HASH", "UNKNOWN"),
    }
)
"""Names of keys."""
MOUSE_BUTTONS = frozenset(
    {"LEFT", "RIGHT", "MIDDLE", "MOUSE4", "MOUSE5"}
    | {"WHEEL_UP", "WHEEL_DOWN", "WHEEL_LEFT", "WHEEL_RIGHT"}
)
JOY_BUTTONS = frozenset(
    {"A", "B", "X", "Y", "BACK", "START", "GUIDE", "LEFT_STICK", "RIGHT_STICK"}
    | {"LEFT_SHOULDER", "RIGHT_SHOULDER", "DPAD_UP", "DPAD_DOWN", "DPAD_LEFT", "DPAD_RIGHT"}
)
"""Buttons of a gamepad, named by their place on an Xbox controller."""
JOY_AXES = frozenset({"LEFT_X", "LEFT_Y", "RIGHT_X", "RIGHT_Y", "TRIGGER_LEFT", "TRIGGER_RIGHT"})
"""Sticks go from -1 (left, down) to 1 (right, up), triggers from 0 to 1."""


def _check(what: str, value: Any, known: frozenset[str]) -> None:
    if value not in known:
        near = get_close_matches(str(value).upper(), sorted(known), n=3)
        hint = (
            f"did you mean {' or '.join(near)}?" if near else f"known: {', '.join(sorted(known))}"
        )
        raise ValueError(f"{what} is {value!r}; {hint}")


@dataclass(frozen=True)
class InputEvent:
    """Anything that happened."""

    _map: Any = field(default=None, init=False, repr=False, compare=False, kw_only=True)

    def under(self, input_map: InputMap) -> InputEvent:
        """This event, asking `input_map` what its actions are."""
        object.__setattr__(self, "_map", input_map)
        return self

    def matches(self, binding: InputEvent) -> bool:
        """Whether this is what `binding` describes, pressed or released."""
        return False

    def strength_for(self, binding: InputEvent) -> float:
        """How far it is pressed, 0 to 1, as `binding` sees it."""
        return 0.0

    def is_action(self, action: str) -> bool:
        """Whether it is bound to an action. ValueError outside `_input` and `_unhandled_input`."""
        return self._find(action) is not None

    def is_action_pressed(self, action: str, *, allow_echo: bool = False) -> bool:
        """Whether an action is pressed by it; a key that repeats itself counts if allowed."""
        strength = self._find(action)
        is_echo = isinstance(self, InputEventKey) and self.echo
        return strength is not None and strength > 0.0 and (allow_echo or not is_echo)

    def is_action_released(self, action: str) -> bool:
        """Whether an action is released by it."""
        return self._find(action) == 0.0

    def _find(self, action: str) -> float | None:
        if self._map is None:
            raise ValueError(f"{self!r} came through no tree, so nothing is known of its actions")
        strength: float | None = self._map.strength(self, action)
        return strength


@dataclass(frozen=True)
class InputEventKey(InputEvent):
    """A key was pressed or released; `echo` if it repeats because it is held.

    As a binding it asks for the modifiers that it has and doesn't mind others.
    """

    key: str
    pressed: bool = True
    echo: bool = False
    shift: bool = False
    ctrl: bool = False
    alt: bool = False
    meta: bool = False

    def __post_init__(self) -> None:
        """Check the values."""
        _check("key", self.key, KEYS)

    def matches(self, binding: InputEvent) -> bool:
        """Whether it is the same key, with at least the binding's modifiers when pressed."""
        if not isinstance(binding, InputEventKey) or binding.key != self.key:
            return False
        if not self.pressed:
            return True  # modifiers may be let go first
        return all(
            getattr(self, name) or not getattr(binding, name)
            for name in ("shift", "ctrl", "alt", "meta")
        )

    def strength_for(self, binding: InputEvent) -> float:
        """1 or 0."""
        return float(self.pressed)


@dataclass(frozen=True)
class InputEventMouseButton(InputEvent):
    """A button was pressed or released, or the wheel moved (pressed and released at once).

    `x`, `y` are pixels from the left and the bottom; `amount` is how far the wheel went.
    """

    button: str
    pressed: bool = True
    x: float = 0.0
    y: float = 0.0
    amount: float = 1.0
    shift: bool = False
    ctrl: bool = False
    alt: bool = False
    meta: bool = False

    def __post_init__(self) -> None:
        """Check the values."""
        _check("button", self.button, MOUSE_BUTTONS)

    def matches(self, binding: InputEvent) -> bool:
        """Whether it is the same button."""
        return isinstance(binding, InputEventMouseButton) and binding.button == self.button

    def strength_for(self, binding: InputEvent) -> float:
        """1 or 0."""
        return float(self.pressed)


@dataclass(frozen=True)
class InputEventMouseMotion(InputEvent):
    """The mouse moved to (x, y) by (dx, dy) pixels, from the left and the bottom."""

    x: float = 0.0
    y: float = 0.0
    dx: float = 0.0
    dy: float = 0.0
    buttons: frozenset[str] = frozenset()


@dataclass(frozen=True)
class InputEventJoypadButton(InputEvent):
    """A button of a gamepad was pressed or released. As a binding, `device` -1 is any gamepad."""

    button: str
    pressed: bool = True
    device: int = -1

    def __post_init__(self) -> None:
        """Check the values."""
        _check("button", self.button, JOY_BUTTONS)

    def matches(self, binding: InputEvent) -> bool:
        """Whether it is the same button of the same gamepad."""
        return (
            isinstance(binding, InputEventJoypadButton)
            and binding.button == self.button
            and binding.device in (-1, self.device)
        )

    def strength_for(self, binding: InputEvent) -> float:
        """1 or 0."""
        return float(self.pressed)


@dataclass(frozen=True)
class InputEventJoypadMotion(InputEvent):
    """A stick or trigger moved. As a binding, the sign of `value` says which direction counts."""

    axis: str
    value: float = 1.0
    device: int = -1

    def __post_init__(self) -> None:
        """Check the values."""
        _check("axis", self.axis, JOY_AXES)
        if not -1.0 <= self.value <= 1.0:
            raise ValueError(f"value is {self.value}, expected -1 to 1")

    def matches(self, binding: InputEvent) -> bool:
        """Whether it is the same axis of the same gamepad, in whatever direction."""
        return (
            isinstance(binding, InputEventJoypadMotion)
            and binding.axis == self.axis
            and binding.device in (-1, self.device)
        )

    def strength_for(self, binding: InputEvent) -> float:
        """How far it is in the binding's direction."""
        assert isinstance(binding, InputEventJoypadMotion)
        return max(self.value if binding.value >= 0.0 else -self.value, 0.0)


@dataclass(frozen=True)
class InputEventAction(InputEvent):
    """An action, pressed or released by code: a replay, a test, a button on the screen."""

    action: str
    pressed: bool = True
    strength: float = 1.0

    def __post_init__(self) -> None:
        """Check the values."""
        if not 0.0 <= self.strength <= 1.0:
            raise ValueError(f"strength is {self.strength}, expected 0 to 1")
