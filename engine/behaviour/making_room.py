"""People in a row who let somebody pass: they get up, step back, and sit down again."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.placement import Placement
from ...components.walk import RATES, Leg, Walk
from ..crowd.seating import SeatPlan
from .walk_now import F32

Ints = NDArray[np.int64]

AHEAD = 4
"""Seats before somebody in a row whose people get up."""
NEAR_ROW = 1.6
"""Metres before a row from which on its people get up."""
ABACK, SPEED = 0.14, 0.3
"""Metres that people step back for somebody, and metres a second."""


class RoomMakers:
    """Who lets somebody pass, and how far they have stepped back.

    Parameters
    ----------
    plan
        The seats.

    Attributes
    ----------
    agents
        (Y,) int64 ids of those who make room, ascending.
    """

    def __init__(self, plan: SeatPlan) -> None:
        self.agents: Ints = np.zeros(0, np.int64)
        self._plan = plan
        self._ids: Ints = self.agents
        self._far: F32 = np.zeros(0, np.float32)
        self._goal: F32 = np.zeros(0, np.float32)
        self._stirs = False

    @property
    def is_idle(self) -> bool:
        """Whether everybody is where they belong."""
        return not len(self.agents) and not len(self._ids)

    def choose(self, walk: Walk, there: NDArray[np.bool_]) -> bool:
        """Who must make room now, of those at their seats (N,); whether anything changed."""
        near = walk.leg[Leg.TO_MOUTH] - walk.along < np.float32(NEAR_ROW)
        near &= walk.granted
        near |= walk.leg[Leg.IN_ROW] > 0
        some = np.flatnonzero(near)
        seat = walk.leg[RATES][Leg.SEAT, some] * walk.along[some] + walk.leg[Leg.SEAT, some]
        begin = np.maximum(np.floor(seat - np.float32(0.1)).astype(np.int64), -1)
        index = begin + np.arange(AHEAD + 1)[:, None]
        good = (index >= 0) & (index < walk.passes[some])
        ids = (walk.first[some] + walk.step[some] * index)[good]
        ids = _unique(ids[there[ids]])
        if np.array_equal(ids, self.agents):
            return False
        self.agents = ids
        self._let_go(there)
        both = _unique(np.concatenate([self._ids, ids]))
        far = np.zeros(len(both), np.float32)
        far[np.searchsorted(both, self._ids)] = self._far
        self._goal = np.zeros(len(both), np.float32)
        self._goal[np.searchsorted(both, ids)] = ABACK
        self._ids, self._far, self._stirs = both, far, True
        return True

    def move(self, placement: Placement, there: NDArray[np.bool_], seconds: float) -> Ints:
        """Let them step back, or forward again; ids of those who did."""
        if not self._stirs:
            return self.agents[:0]
        # Who set out in the meantime is on its own way.
        moving = np.flatnonzero((self._far != self._goal) & there[self._ids])
        ids = self._ids[moving]
        if not len(moving):
            self._stirs = False
            self._let_go(there)
            return ids
        step = np.float32(SPEED * seconds)
        far = self._far[moving]
        far = far + np.clip(self._goal[moving] - far, -step, step)
        self._far[moving] = far
        yaw, home = self._plan.yaw[ids], self._plan.position
        placement.position[0, ids] = home[0, ids] - far * np.sin(yaw)
        placement.position[2, ids] = home[2, ids] - far * np.cos(yaw)
        return ids

    def _let_go(self, there: NDArray[np.bool_]) -> None:
        """Forget those who are back at their places, or on their own way."""
        kept = ((self._far > 0.0) | (self._goal > 0.0)) & there[self._ids]
        self._ids, self._far, self._goal = self._ids[kept], self._far[kept], self._goal[kept]


def _unique(ids: Ints) -> Ints:
    """The same ids (K,), ascending and each once."""
    ids.sort()
    first = np.ones(len(ids), np.bool_)
    np.not_equal(ids[1:], ids[:-1], out=first[1:])
    return ids[first]
