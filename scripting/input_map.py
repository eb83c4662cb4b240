"""Named actions and what they are bound to."""

from __future__ import annotations

from dataclasses import dataclass, field

from .exports import unknown
from .input_events import InputEvent, InputEventAction, InputEventMouseMotion


@dataclass
class Action:
    """What one action is bound to.

    Attributes
    ----------
    deadzone
        How far an axis must be moved to count.
    events
        The bindings.
    """

    deadzone: float
    events: list[InputEvent] = field(default_factory=list)


class InputMap:
    """The actions of a game."""

    def __init__(self) -> None:
        self._actions: dict[str, Action] = {}

    @property
    def actions(self) -> tuple[str, ...]:
        """Names of all actions."""
        return tuple(self._actions)

    def add_action(self, action: str, *events: InputEvent, deadzone: float = 0.5) -> None:
        """Add an action, bound to events: ``add_action("jump", InputEventKey("SPACE"))``.

        Raises
        ------
        ValueError
            If the action is there already, or something can't be bound.
        """
        if not isinstance(action, str) or not action or action in self._actions:
            raise ValueError(f"action is {action!r}, expected a new name")
        if not 0.0 <= deadzone < 1.0:
            raise ValueError(f"deadzone is {deadzone}, expected 0 to below 1")
        self._actions[action] = Action(deadzone)
        for event in events:
            self.action_add_event(action, event)

    def action_add_event(self, action: str, event: InputEvent) -> None:
        """Bind something more to an action."""
        wrong = (InputEventAction, InputEventMouseMotion)
        if not isinstance(event, InputEvent) or isinstance(event, wrong):
            raise ValueError(f"event is {event!r}, which can't be bound to an action")
        self.get(action).events.append(event)

    def action_erase_events(self, action: str) -> None:
        """Unbind everything from an action, to bind it anew."""
        self.get(action).events.clear()

    def erase_action(self, action: str) -> None:
        """Remove an action."""
        self.get(action)
        del self._actions[action]

    def has_action(self, action: str) -> bool:
        """Whether there is an action of that name."""
        return action in self._actions

    def get(self, action: str) -> Action:
        """What an action is bound to; ValueError with near names if there is none."""
        found = self._actions.get(action)
        if found is None:
            raise ValueError(f"there is no action {unknown(str(action), self.actions)}")
        return found

    def strength(self, event: InputEvent, action: str) -> float | None:
        """How far `event` presses an action, 0 to 1; None if it isn't bound to it."""
        found = self.get(action)
        if isinstance(event, InputEventAction):
            return float(event.pressed) * event.strength if event.action == action else None
        strengths = [
            event.strength_for(binding) for binding in found.events if event.matches(binding)
        ]
        return beyond(found.deadzone, max(strengths)) if strengths else None


def beyond(deadzone: float, strength: float) -> float:
    """`strength` counted from the end of the dead zone on: 0.75 beyond 0.5 is 0.5."""
    if strength < deadzone or strength <= 0.0:
        return 0.0
    return min(max((strength - deadzone) / (1.0 - deadzone), 1e-9), 1.0)
