"""Which actions are pressed, and since when."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from .input_events import InputEvent, InputEventAction
from .input_map import InputMap, beyond

if TYPE_CHECKING:
    from .tree import SceneTree


@dataclass
class _State:
    """One action: what each binding of each device says, and when it changed last."""

    raw: dict[Any, float] = field(default_factory=dict)
    pressed: bool = False
    pressed_at: tuple[int, int] = (-1, -1)
    released_at: tuple[int, int] = (-1, -1)
    """Tick and frame."""


class Input:
    """The state of the actions of one tree.

    It changes at the beginning of a tick. *Just* pressed means: within this tick when asked in
    `_physics_process`, within this frame when asked in `_process`; also if it is released already.
    """

    def __init__(self, input_map: InputMap, tree: SceneTree) -> None:
        self._map = input_map
        self._tree = tree
        self._states: dict[str, _State] = {}

    def is_action_pressed(self, action: str) -> bool:
        """Whether it is pressed now."""
        return self._state(action).pressed

    def is_action_just_pressed(self, action: str) -> bool:
        """Whether it began to be pressed in this tick or frame."""
        return self._is_now(self._state(action).pressed_at)

    def is_action_just_released(self, action: str) -> bool:
        """Whether it was let go in this tick or frame."""
        return self._is_now(self._state(action).released_at)

    def get_action_raw_strength(self, action: str) -> float:
        """How far it is pressed, 0 to 1, without the dead zone."""
        return max(self._state(action).raw.values(), default=0.0)

    def get_action_strength(self, action: str) -> float:
        """How far it is pressed beyond its dead zone, 0 to 1."""
        raw = self.get_action_raw_strength(action)
        return beyond(self._map.get(action).deadzone, raw)

    def get_axis(self, negative: str, positive: str) -> float:
        """-1 to 1 from two opposite actions."""
        return self.get_action_strength(positive) - self.get_action_strength(negative)

    def get_vector(
        self,
        negative_x: str,
        positive_x: str,
        negative_y: str,
        positive_y: str,
        deadzone: float = -1.0,
    ) -> tuple[float, float]:
        """Direction from four actions, never longer than 1, with a round dead zone.

        A negative `deadzone` stands for the mean of the actions' own.
        """
        names = (negative_x, positive_x, negative_y, positive_y)
        left, right, down, up = (self.get_action_raw_strength(name) for name in names)
        x, y = right - left, up - down
        if deadzone < 0.0:
            deadzone = sum(self._map.get(name).deadzone for name in names) / 4.0
        length = math.hypot(x, y)
        if length <= deadzone or length == 0.0:
            return 0.0, 0.0
        scale = 1.0 / length
        if length < 1.0:
            scale *= (length - deadzone) / (1.0 - deadzone)
        return x * scale, y * scale

    def action_press(self, action: str, strength: float = 1.0) -> None:
        """Press an action by code, from the next tick on."""
        self._map.get(action)
        self._tree.push_input(InputEventAction(action, True, strength))

    def action_release(self, action: str) -> None:
        """Let go what `action_press` pressed, from the next tick on."""
        self._map.get(action)
        self._tree.push_input(InputEventAction(action, False))

    def take(self, event: InputEvent) -> None:
        """Called by the tree: an event takes effect."""
        event.under(self._map)
        for action in self._map.actions:
            found = self._map.get(action)
            if isinstance(event, InputEventAction):
                if event.action != action:
                    continue
                said: dict[Any, float] = {"code": event.strength if event.pressed else 0.0}
            else:
                device = getattr(event, "device", -1)
                said = {
                    (binding, device): event.strength_for(binding)
                    for binding in found.events
                    if event.matches(binding)
                }
            if said:
                self._say(self._state(action), said, found.deadzone)

    def _say(self, state: _State, said: dict[Any, float], deadzone: float) -> None:
        state.raw.update(said)
        state.raw = {source: strength for source, strength in state.raw.items() if strength > 0.0}
        strongest = max(state.raw.values(), default=0.0)
        pressed = strongest > 0.0 and strongest >= deadzone
        now = (self._tree.tick, self._tree.frame_number)
        if pressed and not state.pressed:
            state.pressed_at = now
        elif state.pressed and not pressed:
            state.released_at = now
        state.pressed = pressed

    def _is_now(self, when: tuple[int, int]) -> bool:
        if self._tree.in_physics:
            return when[0] == self._tree.tick
        return when[1] == self._tree.frame_number

    def _state(self, action: str) -> _State:
        self._map.get(action)
        return self._states.setdefault(action, _State())
