"""What the stations of the lab have in common: some agents, and words that say what they show."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

import tifo

TWINS = ("child", "old")
JUMP_TIME = 0.75
"""Seconds into the jump at which it begins, so that a picture after six seconds is in the air."""


class Station(ABC):
    """A few agents that show one thing.

    Parameters
    ----------
    simulation
        Whose crowd it is.
    agents
        (K,) ids, from left to right.

    Attributes
    ----------
    title
        What is shown.
    """

    title = ""

    def __init__(self, simulation: tifo.Simulation, agents: NDArray[np.int64]) -> None:
        self.simulation = simulation
        self.crowd = simulation.crowd
        self.agents = agents
        assert self.crowd.pool is not None
        self.pool: tifo.StreamPool = self.crowd.pool
        self._time = 0.0

    @property
    @abstractmethod
    def text(self) -> str:
        """One line about what is seen, as it is now."""

    @abstractmethod
    def labels(self) -> Sequence[str]:
        """A few words for each agent, as it is now."""

    def advance(self, time: float) -> None:
        """The lab's clock shows `time` seconds now; stations in which things happen override it."""
        self._time = time

    def passed(self, time: float, at: float, period: float) -> bool:
        """Whether one of the moments `at`, `at` + `period`, ... lies since the last `advance`."""
        return bool(np.floor((time - at) / period) > np.floor((self._time - at) / period))

    def play(self, agent: int, stream: tifo.Stream, *, offset: float | None = 0.0) -> None:
        """Put an agent on a stream, without a blend."""
        self.crowd.transition_to_streamed(int(agent), stream, duration=0.0, offset=offset)

    def stand(self, agents: Sequence[int] | NDArray[np.int64], *, seated: bool = False) -> None:
        """Put agents on streams of their own on which nothing happens."""
        for number, agent in enumerate(agents):
            clip = ("sit_idle", "stand_idle")[not seated]
            stream = self.pool.add(clip, time=1.3 * number)
            for kind in TWINS:
                self.pool.add_twin(stream, kind)
            self.play(int(agent), stream)
