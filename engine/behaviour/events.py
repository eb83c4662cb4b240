"""Things that happen on the pitch or in the stands."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Real


@dataclass(frozen=True, slots=True)
class Goal:
    """A goal for `side` (0 home, 1 away).

    Raises
    ------
    ValueError
        For another side.
    """

    side: int

    def __post_init__(self) -> None:
        """Check the side."""
        if self.side not in (0, 1):
            raise ValueError(f"side is {self.side!r}, expected 0 (home) or 1 (away)")


@dataclass(frozen=True, slots=True)
class BallHit:
    """The ball flies into the stands and lands at `place` (x, y, z metres).

    Raises
    ------
    ValueError
        For coordinates that are not finite.
    """

    place: tuple[float, float, float]

    def __post_init__(self) -> None:
        """Check the place."""
        numbers = all(isinstance(value, Real) and math.isfinite(value) for value in self.place)
        if len(self.place) != 3 or not numbers:
            raise ValueError(
                f"place is {self.place!r}, expected three finite coordinates in metres"
            )


Event = Goal | BallHit


class EventQueue:
    """Events that wait for the next tick, in the order in which they were sent.

    Attributes
    ----------
    heard
        What was taken last: the events of the last pose tick.
    """

    __slots__ = ("_pending", "heard")

    def __init__(self) -> None:
        self._pending: list[Event] = []
        self.heard: tuple[Event, ...] = ()

    def send(self, event: Event) -> None:
        """Queue an event."""
        self._pending.append(event)

    def take(self) -> list[Event]:
        """All waiting events; the queue is empty afterwards."""
        taken, self._pending = self._pending, []
        self.heard = tuple(taken)
        return taken
