"""Who hears which clip events: subscriptions, and what was delivered in the current pose tick."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count

import numpy as np
from numpy.typing import NDArray

from .clip_events import StreamEvents
from .event_delivery import Delivered, nothing_delivered

Listener = Callable[[NDArray[np.int64], NDArray[np.float32]], object]
"""Gets (K,) agent ids, ascending, and (K,) weights of their motions in the picture."""


class ClipEventFeed:
    """Clip events of one crowd.

    Parameters
    ----------
    events
        The pool's event table, whose names may be asked for.
    present
        (N,) bool: agents that are not there have no events; may change.
    """

    __slots__ = ("_delivered", "_events", "_listeners", "_numbers", "_present")

    def __init__(self, events: StreamEvents, present: NDArray[np.bool_]) -> None:
        self._events = events
        self._present = present
        self._listeners: dict[int, tuple[str, Listener]] = {}
        self._numbers = count()
        self._delivered = nothing_delivered()

    @property
    def names(self) -> tuple[str, ...]:
        """Names that the crowd's clips have."""
        return self._events.names

    def on(self, name: str, listener: Listener) -> Callable[[], None]:
        """Call `listener` at each pose tick in which agents pass the event, in order of `on`.

        Returns
        -------
        Callable
            Ends the subscription; calling it again does nothing.

        Raises
        ------
        ValueError
            If no clip has such an event.
        """
        self._events.bit(name)
        number = next(self._numbers)
        self._listeners[number] = (name, listener)

        def end() -> None:
            self._listeners.pop(number, None)

        return end

    def passed(self, name: str) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Agents (K,) that passed the event in the current pose tick, ascending, and weights (K,).

        An agent that passed it twice is there twice.
        """
        some = (self._delivered.bits & self._events.bit(name)) != 0
        return self._delivered.agents[some], self._delivered.weights[some]

    def post(self, delivered: Delivered) -> None:
        """Make these the events of the current pose tick, and call the listeners."""
        there = self._present[delivered.agents]
        if not there.all():
            delivered = Delivered(
                delivered.agents[there], delivered.bits[there], delivered.weights[there]
            )
        self._delivered = delivered
        for name, listener in tuple(self._listeners.values()):
            agents, weights = self.passed(name)
            if len(agents):
                listener(agents, weights)
