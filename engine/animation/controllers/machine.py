"""State machines: controllers as states, with transitions between them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from .checks import Label, check_controller, check_part, check_range
from .nodes import Children, Controller

CURVES = ("linear", "smooth")
INTERRUPTIONS = ("any", "priority", "none")
OPERATORS = ("!=", "==", ">", "<", ">=", "<=")
ANY_STATE = "*"

_COMPARISON = re.compile(r"\s*([^\s<>=!]+)\s*(>=|<=|==|!=|>|<)\s*(\S+)\s*")


@dataclass(frozen=True, slots=True)
class Condition:
    """A parameter compared with a number, as `parse_condition` reads it."""

    parameter: str
    operator: str
    threshold: float


def parse_condition(text: str) -> Condition:
    """Condition of ``"moving"`` (not 0), ``"not moving"`` (0) or ``"pace >= 1.5"``.

    Raises
    ------
    ValueError
        For anything else.
    """
    words = text.split()
    if len(words) == 1 and not re.search("[<>=!]", text):
        return Condition(words[0], "!=", 0.0)
    if len(words) == 2 and words[0] == "not":
        return Condition(words[1], "==", 0.0)
    match = _COMPARISON.fullmatch(text)
    try:
        if match:
            threshold = float(match[3])
            check_range(Label("a condition's"), "number", threshold)
            return Condition(match[1], match[2], threshold)
    except ValueError:
        pass
    raise ValueError(
        f"when is {text!r}, expected a condition like 'moving', 'not moving' or 'pace > 1.5'"
    )


@dataclass(frozen=True, slots=True)
class Transition:
    """One way from a state to another.

    It is taken on its own when everything holds that it names of `trigger`, `when` and `at_end`;
    one that names nothing is taken by `StreamPool.travel` only.

    Parameters
    ----------
    source, target
        Names of states; ``"*"`` as source is every state but the target.
    trigger
        Parameter that has to be set; taking the transition clears it.
    when
        Condition on a parameter, see `parse_condition`.
    at_end
        Wait for the end of the source's leading clip (a looping one: for its next wrap).
    duration
        Seconds that the blend takes, 0 for a hard change.
    curve
        ``"linear"`` or ``"smooth"`` (3 x^2 - 2 x^3).
    sync
        Begin all clips of the target at the phase of the source's leading clip.
    priority
        Of several that could be taken, the lowest number is, and the first among equals.
    interrupt
        Whether another may be taken while this blend runs: ``"any"``, only one of a lower
        ``"priority"`` number, or ``"none"``.
    """

    source: str
    target: str
    trigger: str = ""
    when: str = ""
    at_end: bool = False
    duration: float = 0.0
    curve: str = "smooth"
    sync: bool = False
    priority: int = 0
    interrupt: str = "any"

    def __post_init__(self) -> None:
        """Check the values."""
        for name in ("at_end", "sync"):
            if not isinstance(getattr(self, name), bool):
                raise ValueError(
                    f"{self._label} {name} is {getattr(self, name)!r}, expected a bool"
                )
        for name, allowed in (("curve", CURVES), ("interrupt", INTERRUPTIONS)):
            if getattr(self, name) not in allowed:
                value = getattr(self, name)
                raise ValueError(
                    f"{self._label} {name} is {value!r}, expected one of {', '.join(allowed)}"
                )
        if not isinstance(self.priority, int) or isinstance(self.priority, bool):
            raise ValueError(f"{self._label} priority is {self.priority!r}, expected an integer")
        check_range(self._label, "duration", self.duration, 0.0)
        if self.when:
            parse_condition(self.when)

    @property
    def _label(self) -> Label:
        return Label(f"the transition from {self.source!r} to {self.target!r}:")

    @property
    def automatic(self) -> bool:
        """Whether it is ever taken on its own."""
        return bool(self.trigger or self.when or self.at_end)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StateMachine(Controller):
    """Plays one state at a time and blends along transitions.

    Its parameters are the triggers and conditions that its transitions name. To be read:
    ``current``, ``fading_from`` (None without a blend) and ``position`` (seconds in the current
    state). A state starts anew when it is entered, unless it is still fading out. An interrupted
    blend is no jump: everything that is seen at that moment fades out together.

    Parameters
    ----------
    states
        Controllers by the name of their state.
    transitions
        The ways between them.
    start
        Name of the first state; the first of `states` if empty.
    parameters
        What conditions begin with; 0 if not given.
    """

    states: Mapping[str, Controller]
    transitions: Sequence[Transition] = ()
    start: str = ""
    parameters: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check names and values."""
        object.__setattr__(self, "states", dict(self.states))
        object.__setattr__(self, "transitions", tuple(self.transitions))
        object.__setattr__(self, "parameters", dict(self.parameters))
        if not self.states:
            raise ValueError(f"{self!r} states is empty, expected at least one")
        object.__setattr__(self, "start", self.start or next(iter(self.states)))
        for state, node in self.states.items():
            check_part(self, "state", state)
            check_controller(self, f"state {state!r}", node)
        if ANY_STATE in self.states:
            raise ValueError(f"{self!r}: a state can't be called '*', which means every state")
        self._check_state("start", self.start)
        for way in self.transitions:
            if way.source != ANY_STATE:
                self._check_state("transition source", way.source)
            self._check_state("transition target", way.target)
        self._check_parameters()

    def _check_state(self, field: str, name: str) -> None:
        if name not in self.states:
            raise ValueError(
                f"{self!r} {field} is {name!r}, expected a state: {', '.join(self.states)}"
            )

    def _check_parameters(self) -> None:
        triggers = self.triggers()
        conditions = self.conditions()
        for name in (*triggers, *conditions):
            check_part(self, "parameter", name)
            if name in ("current", "fading_from", "position"):
                raise ValueError(f"{self!r}: '{name}' can't be a parameter, it is read from it")
        both = set(triggers) & set(conditions)
        if both:
            raise ValueError(f"{self!r}: '{min(both)}' is both a trigger and a condition")
        for name, value in self.parameters.items():
            check_range(self, f"parameters[{name!r}]", value)

    def triggers(self) -> tuple[str, ...]:
        """Names of the triggers, in order of first use."""
        return tuple(dict.fromkeys(way.trigger for way in self.transitions if way.trigger))

    def conditions(self) -> tuple[str, ...]:
        """Names of the condition parameters: declared ones, then those that are only used."""
        used = (parse_condition(way.when).parameter for way in self.transitions if way.when)
        return tuple(dict.fromkeys((*self.parameters, *used)))

    def children(self) -> Children:
        """The states; a state's name goes before its node's own."""
        return tuple(self.states.items())
