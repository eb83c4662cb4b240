"""Who hears whom: what share of the people round a group are making a sound.

Applause spreads by sound, and in a room everybody hears everybody (Mann et al. 2013). In a stadium
sound falls with distance, so a section hears its own people best. Agents are taken together in
groups (sections, or whole audiences of an experiment), so that hearing costs nothing per agent.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..crowd.seating import SeatPlan

REACH = 40.0
"""Metres at which a clap has half the loudness that it has close by."""


class Hearing:
    """Groups of agents and how well they hear each other.

    Parameters
    ----------
    group
        (N,) group of each agent, from 0.
    present
        (N,) bool; absent agents make no sound and don't count. All are present by default.
    loudness
        (G, G) how loud one clapper of the column's group is to the row's group, from 0. By default
        a group hears itself only.

    Attributes
    ----------
    group
        (N,) int32.
    present
        (N,) bool.
    sizes
        (G,) float64 agents present in each group.

    Raises
    ------
    ValueError
        For shapes that don't fit, negative groups, or loudness that is negative or not finite.
    """

    __slots__ = (
        "_all",
        "_is_sorted",
        "_lengths",
        "_loudness",
        "_starts",
        "group",
        "present",
        "sizes",
    )

    def __init__(
        self,
        group: NDArray[np.integer],
        present: NDArray[np.bool_] | None = None,
        loudness: NDArray[np.floating] | None = None,
    ) -> None:
        self.group = np.ascontiguousarray(group, np.int32)
        if self.group.ndim != 1 or len(self.group) == 0 or self.group.min() < 0:
            raise ValueError("group must be a list of one or more group numbers from 0")
        count = int(self.group.max()) + 1
        self.present = (
            np.ones(len(self.group), bool) if present is None else np.array(present, bool)
        )
        if self.present.shape != self.group.shape:
            raise ValueError(f"present has shape {self.present.shape}, expected {self.group.shape}")
        self.sizes = np.bincount(self.group[self.present], minlength=count).astype(np.float64)
        self._loudness: NDArray[np.float64] | None = None
        if loudness is not None:
            self._loudness = np.array(loudness, np.float64)
            if self._loudness.shape != (count, count):
                raise ValueError(
                    f"loudness has shape {self._loudness.shape}, expected ({count}, {count})"
                )
            if not (np.isfinite(self._loudness).all() and (self._loudness >= 0).all()):
                raise ValueError("loudness must be finite and 0 or more")
        self._all = np.maximum(self._mix(self.sizes), 1e-12)
        self._lengths = np.bincount(self.group, minlength=count)
        self._starts = np.cumsum(self._lengths) - self._lengths
        in_order = bool((np.diff(self.group) >= 0).all())
        self._is_sorted = in_order and bool(self._lengths.all())

    @classmethod
    def of_sections(
        cls, plan: SeatPlan, present: NDArray[np.bool_] | None = None, reach: float = REACH
    ) -> Hearing:
        """The sections of a stadium: loudness falls as ``1 / (1 + (d / reach)^2)``.

        Parameters
        ----------
        plan
            Its sections are the groups; d is the distance of their middles in metres.
        present
            As above.
        reach
            Metres, above 0; ``inf`` makes the whole stadium one room.
        """
        if not reach > 0:
            raise ValueError(f"reach is {reach}, expected metres above 0")
        count = len(plan.sections)
        seats = np.maximum(np.bincount(plan.section, minlength=count), 1)
        middle = np.stack(
            [np.bincount(plan.section, axis, count) / seats for axis in plan.position]
        )
        apart = np.linalg.norm(middle[:, :, None] - middle[:, None, :], axis=0)
        return cls(plan.section, present, 1.0 / (1.0 + (apart / reach) ** 2))

    @property
    def count(self) -> int:
        """Number of groups, G."""
        return len(self.sizes)

    def admit(self, agents: NDArray[np.int64], present: bool) -> None:
        """Let agents (K,) ids be there from now on, or no longer."""
        news = np.unique(agents[self.present[agents] != present])
        self.present[news] = present
        self.sizes += self.counts(news) * (1.0 if present else -1.0)
        self._all = np.maximum(self._mix(self.sizes), 1e-12)

    def share(self, sounding: NDArray[np.float64]) -> NDArray[np.float64]:
        """(G,) the share of all loudness possible that each group hears.

        Parameters
        ----------
        sounding
            (G,) how many of each group sound, or the real or imaginary part of their phases.
        """
        result: NDArray[np.float64] = self._mix(sounding) / self._all
        return result

    def heard(self, sounding: NDArray[np.float64]) -> NDArray[np.float64]:
        """(G,) the same not divided: how much each group hears."""
        return self._mix(sounding)

    def sums(self, values: NDArray[np.float32]) -> NDArray[np.float64]:
        """(G,) sums of an (N,) column over each group."""
        if self._is_sorted:
            return np.add.reduceat(values, self._starts).astype(np.float64)
        return np.bincount(self.group, values, self.count).astype(np.float64)

    def spread(self, values: NDArray[np.floating]) -> NDArray[np.float32]:
        """(N,) each agent's own group's value; a shape of (1,) where there is one group only."""
        short = values.astype(np.float32)
        if self.count == 1:
            return short
        if self._is_sorted:
            return np.repeat(short, self._lengths)
        return short[self.group]

    def counts(self, agents: NDArray[np.int64]) -> NDArray[np.int64]:
        """(G,) how many of (K,) agents are in each group."""
        return np.bincount(self.group[agents], minlength=self.count)

    def _mix(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        if self._loudness is None:
            return values
        result: NDArray[np.float64] = self._loudness @ values
        return result
