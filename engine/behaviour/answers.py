"""A small crowd answers an event in its pose tick, and a large crowd in the three that follow.

Nobody reacts within a tenth of a second, which is three pose ticks. So a large crowd is asked a
third at a time, after the tick in which the event is taken in, and what each agent does, and when,
counts from the tick of the event.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

from .events import PLACED, Event

ANSWER_TICKS = 3
SMALL = 30_000
"""Agents that are asked all at once."""


class Asking(NamedTuple):
    """Agents `part` of a crowd have to answer an event of pose tick `tick`."""

    event: Event
    tick: int
    part: slice


class Answers:
    """Who has not been asked yet what an event is to him, in one crowd.

    Parameters
    ----------
    count
        Agents.
    """

    __slots__ = ("_first", "_parts", "_waiting")

    def __init__(self, count: int) -> None:
        parts = 1 if count <= SMALL else ANSWER_TICKS
        self._first = 0 if parts == 1 else 1
        edges = [count * k // parts for k in range(parts + 1)]
        self._parts = [slice(*pair) for pair in pairwise(edges)]
        self._waiting: list[tuple[Event, int]] = []

    def ask(self, events: list[Event], tick: int) -> list[Asking]:
        """Take events of pose tick `tick` in; who has to answer now, in the order of the events.

        What happens at a place concerns few, who are asked at once.
        """
        due: list[Asking] = []
        self._waiting += [(event, tick) for event in events]
        for event, began in self._waiting:
            age = tick - began
            if event.kind in PLACED:
                due.append(Asking(event, began, slice(0, self._parts[-1].stop)))
            elif 0 <= age - self._first < len(self._parts):
                due.append(Asking(event, began, self._parts[age - self._first]))
        self._waiting = [
            (event, began)
            for event, began in self._waiting
            if event.kind not in PLACED and tick - began + 1 - self._first < len(self._parts)
        ]
        return due
