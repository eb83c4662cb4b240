"""A block of the stands as a node."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from numpy.typing import NDArray

from ...systems.crowd_queries import Question
from ..exports import export
from ..node import Node
from ..vectors import Vector3
from .agent import Agent
from .crowd import Crowd
from .stadium import above


class Section(Node):
    """A section of the crowd above, which is a range of its agents.

    Attributes
    ----------
    section
        Its name in the stadium.
    """

    section: str = export(default="0")

    @property
    def crowd(self) -> Crowd:
        """The crowd above; ValueError if there is none."""
        return above(self, Crowd)

    @property
    def span(self) -> range:
        """Ids of all its seats; ValueError if there is no such section."""
        for name, start, stop in self.crowd.data.plan.sections:
            if name == self.section:
                return range(start, stop)
        names = ", ".join(name for name, _, _ in self.crowd.data.plan.sections[:12])
        raise ValueError(f"there is no section '{self.section}'; there are {names}")

    @property
    def agents(self) -> NDArray[np.int64]:
        """(K,) ids of those who are there."""
        span = self.span
        return span.start + np.flatnonzero(self.crowd.data.seat.occupied[span.start : span.stop])

    @property
    def centre(self) -> Vector3:
        """Middle of its seats, metres in the world."""
        span = self.span
        seats = self.crowd.data.placement.position[:, span.start : span.stop]
        return self.crowd.stadium.to_global(seats.mean(axis=1).astype(float))

    def where(self, **question: Unpack[Question]) -> NDArray[np.int64]:
        """Agents of this section of whom everything holds; see `tifo.Crowd.where`."""
        span = self.span
        found = self.crowd.where(**question)
        return found[(found >= span.start) & (found < span.stop)]

    def agent(self, number: int) -> Agent:
        """Its seat `number` as a node, see `Crowd.agent`."""
        return self.crowd.agent(self.span[number])
