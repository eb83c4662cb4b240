"""What a behaviour table says: states with their variants, rules between them, and responses.

A table is what a designer writes (see `table_file` for the file, `compiled` for the arrays that a
crowd runs on). *Thesis* 3.2 and its appendix give the machine of `sport`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum

from ..crowd.motions import Role

PIECE = 10
"""Pose frames of a piece: what an agent does is cut into these (*Thesis* 3.2.1.2)."""
POSTURES = ("seated", "standing")
SEATED, STANDING = 0, 1


class Relation(IntEnum):
    """What an event is to an agent."""

    OWN = 0
    OTHER = 1
    NEUTRAL = 2
    HIT = 3
    NEAR = 4


MACHINES = ("body", "head", "arms")
"""Machines that can run beside each other; those of heads and arms are shown over the body's."""
RELATIONS = tuple(relation.name.lower() for relation in Relation)
NO_LIMIT = 10**8
"""The `limit`, in pieces, of a state in which agents may stay for ever: a hundred days and more."""
GUARDS = ("excitement", "embarrassment", "mood", "fatigue", "fervour", "weight", "time")
"""Numbers that every crowd has for a rule to ask for: emotions, how impressive the event is, and
pieces since the state was entered."""


@dataclass(frozen=True, slots=True)
class Variant:
    """One of the ways in which a state can look.

    Parameters
    ----------
    clips
        A regular expression that whole clip names match, or names of which the first one that
        exists is taken.
    effort
        Chance is proportional to 1 / effort.
    excitement
        From which on the variant is used.
    """

    clips: str | tuple[str, ...]
    effort: float = 1.0
    excitement: float = 0.0


@dataclass(frozen=True, slots=True)
class State:
    """Something to do.

    Parameters
    ----------
    name
        Unique in the table.
    machine
        The machine that it belongs to, one of `MACHINES`.
    role
        Whose motions stand in for clips that a character doesn't have; None shows nothing then.
    posture, arms, head
        What it sets the three channels to; None leaves a channel as it is.
    pieces
        Least and most pieces of a stay; a stay is as long as any between with equal chance.
    limit
        Pieces after which an agent must have left, by `leave_to` if no rule leads away before.
    leave_to
        The state after that.
    variants
        At least one unless `role` is None.
    line
        Where it is in its file; 0 if it is in none.
    """

    name: str
    machine: str = "body"
    role: Role | None = None
    posture: str | None = None
    arms: str | None = None
    head: str | None = None
    pieces: tuple[int, int] = (1, 1)
    limit: int = NO_LIMIT
    leave_to: str = ""
    variants: tuple[Variant, ...] = ()
    line: int = 0


@dataclass(frozen=True, slots=True)
class Rule:
    """A way from one state to another, open when all its conditions hold.

    Parameters
    ----------
    origin, target
        Names of states of one machine.
    effort
        Among the open ways chance is proportional to 1 / effort.
    events
        Kinds of which one must be moving the agent; empty asks for no event.
    relations
        What it must be to the agent; empty allows any.
    calm
        Whether no event may be moving the agent.
    rapid
        Whether the event ends a stay at once, by a blend; else the current piece is finished.
    blend
        Seconds that the change of motion may take.
    pieces
        Of a rule from a state to itself: least and most pieces before the next look.
    limits
        (name, least, below) of numbers: those of `GUARDS` or signals.
    signals
        (name, wanted) of boolean signals.
    line
        Where it is in its file; 0 if it is in none.
    """

    origin: str
    target: str
    effort: float = 1.0
    events: frozenset[str] = frozenset()
    relations: frozenset[str] = frozenset()
    calm: bool = False
    rapid: bool = False
    blend: float = 0.3
    pieces: tuple[int, int] = (1, 1)
    limits: tuple[tuple[str, float, float], ...] = ()
    signals: tuple[tuple[str, bool], ...] = ()
    line: int = 0


@dataclass(frozen=True, slots=True)
class Response:
    """What an event of one kind and relation does to people.

    Parameters
    ----------
    gain
        Of the event's benefit to them: who reacts.
    seconds
        How long they react to the most impressive event if nothing embarrasses them.
    delay
        Shortest and longest reaction time in seconds.
    excitement, embarrassment, mood, fatigue
        By how much the most impressive event raises or lowers these.
    applause
        Benefit of clapping for the most impressive event, 1 that of a good talk; below 0 people
        refuse to.
    """

    gain: float = 0.0
    seconds: float = 0.0
    delay: tuple[float, float] = (0.15, 0.6)
    excitement: float = 0.0
    embarrassment: float = 0.0
    mood: float = 0.0
    fatigue: float = 0.0
    applause: float = 0.0


@dataclass(frozen=True, slots=True)
class BehaviourTable:
    """All that a designer decides about how a crowd behaves.

    Parameters
    ----------
    name
        Of the table.
    states
        The first state of each machine is where its agents begin.
    rules
        In the order in which they are written.
    responses
        By kind and relation.
    """

    name: str
    states: tuple[State, ...]
    rules: tuple[Rule, ...]
    responses: dict[tuple[str, str], Response] = field(default_factory=dict)

    @property
    def machines(self) -> tuple[str, ...]:
        """Names of the machines that have states, in the order of `MACHINES`."""
        used = {state.machine for state in self.states}
        return tuple(machine for machine in MACHINES if machine in used)

    def state(self, name: str) -> State:
        """The state of that name; ValueError if there is none."""
        for state in self.states:
            if state.name == name:
                return state
        names = ", ".join(state.name for state in self.states)
        raise ValueError(f"state is {name!r}, expected one of {names}")

    def problem(self) -> tuple[int, str] | None:
        """The line and the cause of the first thing that makes the table unusable, or None."""
        by_name: dict[str, State] = {}
        for state in self.states:
            if state.name in by_name:
                return state.line, f"state '{state.name}' is there twice"
            by_name[state.name] = state
            if state.machine not in MACHINES:
                known = ", ".join(MACHINES)
                return state.line, f"machine is '{state.machine}', expected one of: {known}"
        if not self.states:
            return 0, "there are no states"
        for rule in self.rules:
            for end in (rule.origin, rule.target):
                if end not in by_name:
                    return rule.line, f"there is no state '{end}'; states: {', '.join(by_name)}"
            if by_name[rule.origin].machine != by_name[rule.target].machine:
                return rule.line, f"'{rule.origin}' and '{rule.target}' are of different machines"
        ways = {(rule.origin, rule.target) for rule in self.rules}
        for state in self.states:
            out = [target for origin, target in ways if origin == state.name]
            if not set(out) - {state.name}:
                return state.line, f"state '{state.name}' has no way out"
            if state.leave_to and (
                state.leave_to == state.name
                or by_name.get(state.leave_to, state).machine != state.machine
                or state.leave_to not in by_name
            ):
                return state.line, f"leave_to of '{state.name}' is no other state of its machine"
        return self._unreachable(by_name)

    def _unreachable(self, by_name: dict[str, State]) -> tuple[int, str] | None:
        starts = {state.machine: state.name for state in reversed(self.states)}
        reached = set(starts.values())
        todo = list(reached)
        while todo:
            name = todo.pop()
            ends = {rule.target for rule in self.rules if rule.origin == name}
            ends |= {by_name[name].leave_to} & set(by_name)
            todo += ends - reached
            reached |= ends
        lost = next((state for state in self.states if state.name not in reached), None)
        return (lost.line, f"no way leads to state '{lost.name}'") if lost else None
