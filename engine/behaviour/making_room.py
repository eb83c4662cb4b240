"""People in a row who let somebody pass: they get up, step back, and sit down again."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.placement import Placement
from ...components.walk import Walk
from ..crowd.seating import SeatPlan
from .walk_now import F32, Now

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

    @property
    def is_idle(self) -> bool:
        """Whether everybody is where they belong."""
        return not len(self.agents) and not len(self._ids)

    def choose(self, walk: Walk, now: Now | None, there: NDArray[np.bool_]) -> bool:
        """Who must make room now, of those at their seats (N,); whether anything changed."""
        ids = self.agents[:0]
        if now is not None:
            some = np.flatnonzero(now.in_row | (walk.granted & (now.to_mouth < NEAR_ROW)))
            begin = np.floor(now.seat[some] - np.float32(0.1)).astype(np.int64)
            index = np.maximum(begin, -1)[:, None] + np.arange(AHEAD + 1)
            good = (index >= 0) & (index < now.passes[some, None])
            ids = (walk.first[some, None] + walk.step[some, None] * index)[good]
            ids = np.sort(ids[there[ids]])
            ids = ids[np.diff(ids, prepend=-1) > 0]
        if np.array_equal(ids, self.agents):
            return False
        self.agents = ids
        both = np.sort(np.concatenate([self._ids, ids]))
        both = both[np.diff(both, prepend=-1) > 0]
        far = np.zeros(len(both), np.float32)
        far[np.searchsorted(both, self._ids)] = self._far
        self._goal = np.zeros(len(both), np.float32)
        self._goal[np.searchsorted(both, ids)] = ABACK
        self._ids, self._far = both, far
        return True

    def move(self, placement: Placement, there: NDArray[np.bool_], seconds: float) -> Ints:
        """Let them step back, or forward again; ids of those who did."""
        if not len(self._ids):
            return self._ids
        # Who set out in the meantime is on its own way.
        moving = np.flatnonzero((self._far != self._goal) & there[self._ids])
        ids = self._ids[moving]
        step = np.float32(SPEED * seconds)
        far = self._far[moving]
        far = far + np.clip(self._goal[moving] - far, -step, step)
        self._far[moving] = far
        yaw, home = self._plan.yaw[ids], self._plan.position
        placement.position[0, ids] = home[0, ids] - far * np.sin(yaw)
        placement.position[2, ids] = home[2, ids] - far * np.cos(yaw)
        done = ((self._far == 0.0) & (self._goal == 0.0)) | ~there[self._ids]
        if done.any():
            kept = ~done
            self._ids, self._far = self._ids[kept], self._far[kept]
            self._goal = self._goal[kept]
        return ids
