"""Agents that turn to something for a while, and back to where they face by themselves.

A motion knows no direction; whoever shall clap *towards* somebody (*Thesis* 6.2) turns there by the
yaw of its placement. Turns ease in and out, may be asked for anew at any moment, and end exactly
where they began.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.placement import Placement
from ..streams.pool import POSE_RATE

TURN = 0.5
"""Seconds of a turn, there or back."""
FARTHEST = 1.2
"""Radians that somebody turns to a place; seats and neighbours are in the way of more."""
FOREVER = np.iinfo(np.int32).max
_TICKS = round(TURN * POSE_RATE)


class Facing:
    """The turns of one crowd.

    Parameters
    ----------
    placement
        Whose yaw is changed.
    """

    def __init__(self, placement: Placement) -> None:
        count = len(placement.yaw)
        self._placement = placement
        self._turning = np.zeros(count, np.bool_)
        self._base, self._from, self._to = np.zeros((3, count), np.float32)
        self._began, self._until = np.zeros((2, count), np.int32)

    @property
    def turning(self) -> NDArray[np.bool_]:
        """(N,) who is turned, or about to be."""
        return self._turning

    def turn(
        self,
        agents: NDArray[np.int64],
        angles: NDArray[np.float32],
        tick: int,
        seconds: float | None = None,
    ) -> None:
        """Let agents (K,) turn by angles (K,) from where they face by themselves, left positive.

        They turn back so that they are there again after `seconds`, or when `turn_back` says so.
        """
        new = agents[~self._turning[agents]]
        self._base[new] = self._placement.yaw[new]
        self._from[agents] = self._placement.yaw[agents] - self._base[agents]
        self._to[agents] = angles
        self._began[agents] = tick
        ticks = FOREVER if seconds is None else tick + round(seconds * POSE_RATE) - _TICKS
        self._until[agents] = ticks
        self._turning[agents] = True

    def turn_to(
        self,
        agents: NDArray[np.int64],
        place: tuple[float, float, float],
        tick: int,
        seconds: float | None = None,
    ) -> None:
        """Let agents (K,) turn to a place, metres in the stadium's frame, as far as they can."""
        x, _, z = self._placement.position[:, agents]
        rest = np.where(self._turning[agents], self._base[agents], self._placement.yaw[agents])
        off = np.arctan2(np.float32(place[0]) - x, np.float32(place[2]) - z) - rest
        off = np.arctan2(np.sin(off), np.cos(off)).clip(-FARTHEST, FARTHEST)
        self.turn(agents, off.astype(np.float32), tick, seconds)

    def turn_back(self, agents: NDArray[np.int64], tick: int) -> None:
        """Let those of (K,) agents who are turned turn back."""
        some = agents[self._turning[agents]]
        self._until[some] = np.minimum(self._until[some], tick)

    def step(self, tick: int) -> None:
        """Move the yaws of those who turn to pose tick `tick`."""
        ids = np.flatnonzero(self._turning)
        if not len(ids):
            return
        back = ids[(self._until[ids] <= tick) & (self._until[ids] >= 0)]
        # From here on they go to where they were.
        self._from[back] = self._placement.yaw[back] - self._base[back]
        self._to[back] = 0.0
        self._began[back] = tick
        self._until[back] = -1
        share = ((tick - self._began[ids]) / np.float32(_TICKS)).clip(0.0, 1.0)
        share = (share * share * (3.0 - 2.0 * share)).astype(np.float32)
        yaw = self._base[ids] + self._from[ids] + share * (self._to[ids] - self._from[ids])
        over = (self._until[ids] < 0) & (share >= 1.0)
        yaw[over] = self._base[ids[over]]
        moved = ids[yaw != self._placement.yaw[ids]]
        self._placement.yaw[ids] = yaw
        if len(moved):
            self._placement.touch(moved)
        self._turning[ids[over]] = False
