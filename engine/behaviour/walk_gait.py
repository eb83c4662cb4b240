"""Which gait people on their way show: by their speed, and sideways in a row."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.walk import Leg, Stage, Walk
from ..crowd.gaits import STILL, Gaits, nearest
from .walk_now import F32, Ints

HOLD = 9
"""Pose ticks that a gait lasts at least."""
_BETTER = 0.02


class Gaiting:
    """Chooses gaits.

    Parameters
    ----------
    gaits
        The motions of walking.
    calm
        (C,) motions of those who just stand.
    motions
        How many motions the library has.
    size
        (N,) how long each one's legs are, 1 for the character's: short legs have to go quicker.
    """

    def __init__(self, gaits: Gaits, calm: NDArray[np.int16], motions: int, size: F32) -> None:
        self._gaits, self._calm, self._size = gaits, calm, size
        self._speeds = np.zeros(motions, np.float32)
        self._sideways = np.zeros(motions, np.bool_)
        # A gait is kept until another one fits better by far enough.
        self._least = np.full(motions, -np.inf, np.float32)
        self._most = np.full(motions, 0.5 * (gaits.walk[1][0] + _BETTER), np.float32)
        for table in (gaits.left, gaits.right, gaits.walk):
            own, speeds = table
            self._speeds[own] = speeds
            self._sideways[own] = table is not gaits.walk
            middles = 0.5 * (speeds[1:] + speeds[:-1])
            self._least[own[1:]], self._least[own[0]] = middles - 0.5 * _BETTER, -np.inf
            self._most[own[:-1]], self._most[own[-1]] = middles + 0.5 * _BETTER, np.inf
        self._aside = bool(self._sideways.any())

    def choose(self, walk: Walk, tick: int) -> bool:
        """Set the motions of those whose gait doesn't fit any more; whether there are any."""
        still = walk.speed < np.float32(STILL)
        still |= walk.stage != Stage.WALK
        speed = walk.speed / self._size.take(walk.agent)
        fits = speed >= self._least.take(walk.motion)
        fits &= speed <= self._most.take(walk.motion)
        if self._aside:
            fits &= self._sideways.take(walk.motion) == (walk.leg[Leg.IN_ROW] > 0)
        fits[still] = self._speeds.take(walk.motion[still]) == 0.0
        fits |= walk.since > tick - HOLD
        some = np.flatnonzero(~fits)
        if not len(some):
            return False
        chosen = self._best(walk, some, speed[some])
        standing = still[some]
        calm = self._calm[walk.agent[some[standing]] % len(self._calm)]
        chosen[standing] = calm
        others = chosen != walk.motion[some]
        some = some[others]
        walk.motion[some] = chosen[others]
        walk.since[some] = tick
        return len(some) > 0

    def _best(self, walk: Walk, some: Ints, speed: F32) -> NDArray[np.int16]:
        leg = walk.leg[:, some]
        left_x, left_z = np.cos(leg[Leg.YAW]), -np.sin(leg[Leg.YAW])
        to_left = leg[Leg.AHEAD_X] * left_x + leg[Leg.AHEAD_Z] * left_z > 0
        left, right = nearest(self._gaits.left, speed), nearest(self._gaits.right, speed)
        aside = np.where(to_left, left, right)
        return np.where(leg[Leg.IN_ROW] > 0, aside, nearest(self._gaits.walk, speed))
