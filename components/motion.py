"""Which motion an agent wants, and which it shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NEVER = np.iinfo(np.int32).max
"""A tick that doesn't come."""


@dataclass(slots=True, eq=False)
class MotionState:
    """Per agent: behaviour's output, motions by their index in the crowd's motion library.

    Attributes
    ----------
    wanted
        (N,) int16 what the agent wants to do now.
    shown
        (N,) int16 what its stream shows, or is blending to.
    busy_until
        (N,) int32 pose tick until which the agent keeps what it shows, whatever it wants: it is
        getting up or sitting down.
    blend
        (N,) float32 pose ticks that the next change of motion may take.
    """

    wanted: NDArray[np.int16]
    shown: NDArray[np.int16]
    busy_until: NDArray[np.int32]
    blend: NDArray[np.float32]

    @classmethod
    def allocate(cls, motion: NDArray[np.int16]) -> MotionState:
        """Everyone shows its motion and wants no other."""
        count = len(motion)
        return cls(
            wanted=motion.copy(),
            shown=motion.copy(),
            busy_until=np.zeros(count, np.int32),
            blend=np.full(count, 12.0, np.float32),
        )
