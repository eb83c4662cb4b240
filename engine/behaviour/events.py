"""Things that happen on the pitch or in the stands."""

from __future__ import annotations

import math
from dataclasses import dataclass
from difflib import get_close_matches
from numbers import Integral, Real

from ...components.team import MOST_SIDES

KINDS = (
    *("goal", "near_miss", "foul", "card", "referee_decision", "substitution", "corner"),
    *("kick_off", "half_time", "final_whistle", "ball_in_crowd", "anthem", "player_close", "cue"),
    "mexican_wave",
)
"""What can happen; ``cue`` is whatever asks for applause: the end of a song, a point made.
``mexican_wave``: some fifty people near its place get up for one."""

WEIGHTS = {
    "goal": 1.0,
    "near_miss": 0.5,
    "foul": 0.3,
    "card": 0.4,
    "referee_decision": 0.35,
    "substitution": 0.25,
    "corner": 0.3,
    "kick_off": 0.4,
    "half_time": 0.3,
    "final_whistle": 0.7,
    "ball_in_crowd": 1.0,
    "anthem": 0.6,
    "player_close": 0.5,
    "cue": 0.6,
    "mexican_wave": 0.2,
}
"""How impressive each kind is when nobody says."""

SIDED = frozenset({"goal", "near_miss", "foul", "card", "substitution", "corner"})
"""Kinds that are always of a side: it scored, just missed, fouled, was shown the card, ..."""
PLACED = frozenset({"ball_in_crowd", "player_close", "mexican_wave"})
"""Kinds that only those near their place notice."""


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happens.

    Parameters
    ----------
    kind
        One of `KINDS`.
    side
        Whose event it is: 0 home, 1 away, further sides; None where it is everybody's.
    weight
        How impressive it is, 0 to 1; as usual for its kind (`WEIGHTS`) if None.
    place
        (x, y, z) metres; where it happens, or None.
    time
        Seconds of the simulation at which it happens; at the next tick if None.

    Raises
    ------
    ValueError
        For an unknown kind or side, a kind whose side or place is missing, or numbers that are not
        finite or out of range.
    """

    kind: str
    side: int | None = None
    weight: float | None = None
    place: tuple[float, float, float] | None = None
    time: float | None = None

    def __post_init__(self) -> None:
        """Check every field and fill in the weight."""
        if self.kind not in KINDS:
            near = get_close_matches(str(self.kind), KINDS, n=2, cutoff=0.6)
            hint = f"did you mean {' or '.join(near)}?" if near else f"known: {', '.join(KINDS)}"
            raise ValueError(f"kind is {self.kind!r}; {hint}")
        if self.side is not None and not _is_side(self.side):
            raise ValueError(
                f"side is {self.side!r}, expected 0 (home) or 1 (away), at most {MOST_SIDES - 1}"
            )
        if self.side is None and self.kind in SIDED:
            raise ValueError(f"side is None, expected 0 (home) or 1 (away) for a {self.kind}")
        if self.weight is None:
            object.__setattr__(self, "weight", WEIGHTS[self.kind])
        elif not _is_number(self.weight) or not 0.0 <= self.weight <= 1.0:
            raise ValueError(f"weight is {self.weight!r}, expected a number from 0 to 1")
        if self.place is not None or self.kind in PLACED:
            _check_place(self.place)
        if self.time is not None and (not _is_number(self.time) or self.time < 0.0):
            raise ValueError(f"time is {self.time!r}, expected seconds from 0 on, or None")


class Goal(Event):
    """A goal for `side` (0 home, 1 away); the other fields are those of `Event`."""

    __slots__ = ()

    def __init__(
        self,
        side: int,
        weight: float | None = None,
        place: tuple[float, float, float] | None = None,
        time: float | None = None,
    ) -> None:
        super().__init__("goal", side, weight, place, time)


class BallHit(Event):
    """The ball flies into the stands and lands at `place` (x, y, z metres)."""

    __slots__ = ()

    def __init__(self, place: tuple[float, float, float], time: float | None = None) -> None:
        super().__init__("ball_in_crowd", place=place, time=time)


class EventQueue:
    """Events that wait for their time, in its order, and else in that in which they were sent.


    Attributes
    ----------
    heard
        What was taken last: the events of the last pose tick.
    """

    __slots__ = ("_pending", "heard")

    def __init__(self) -> None:
        self._pending: list[Event] = []
        self.heard: tuple[Event, ...] = ()

    def __len__(self) -> int:
        """How many wait."""
        return len(self._pending)

    def send(self, event: Event) -> None:
        """Queue an event.

        Raises
        ------
        ValueError
            For anything that is no event.
        """
        if not isinstance(event, Event):
            raise ValueError(f"event is {event!r}, expected an Event")
        self._pending.append(event)

    def take(self, now: float = math.inf) -> list[Event]:
        """The events due by `now`, seconds of the simulation; the others go on waiting."""
        if not self._pending:
            self.heard = ()
            return []
        is_due = [event.time is None or event.time <= now for event in self._pending]
        due = [event for event, is_now in zip(self._pending, is_due, strict=True) if is_now]
        self._pending = [e for e, is_now in zip(self._pending, is_due, strict=True) if not is_now]
        due.sort(key=lambda event: now if event.time is None else event.time)
        self.heard = tuple(due)
        return due


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)


def _is_side(value: object) -> bool:
    is_whole = isinstance(value, Integral) and not isinstance(value, bool)
    return is_whole and 0 <= int(value) < MOST_SIDES  # type: ignore[call-overload]


def _check_place(place: object) -> None:
    good = isinstance(place, (tuple, list)) and len(place) == 3 and all(map(_is_number, place))
    if not good:
        raise ValueError(f"place is {place!r}, expected three finite coordinates in metres")
