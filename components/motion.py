"""Which motion an agent wants, and what it will want next."""

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
    innate
        (N,) int16 what it does when nothing happens.
    reaction
        (N,) int16 what it will do at `react_at`.
    react_at, calm_at
        (N,) int32 pose ticks at which the reaction begins and ends; NEVER if none is due.
    busy_until
        (N,) int32 pose tick until which the agent keeps what it shows, whatever it wants: it is
        getting up or sitting down.
    blend
        (N,) float32 pose ticks that the next change of motion may take.
    """

    wanted: NDArray[np.int16]
    shown: NDArray[np.int16]
    innate: NDArray[np.int16]
    reaction: NDArray[np.int16]
    react_at: NDArray[np.int32]
    calm_at: NDArray[np.int32]
    busy_until: NDArray[np.int32]
    blend: NDArray[np.float32]

    @classmethod
    def allocate(cls, innate: NDArray[np.int16]) -> MotionState:
        """Everyone shows its innate motion and nothing is due."""
        count = len(innate)
        return cls(
            wanted=innate.copy(),
            shown=innate.copy(),
            innate=innate.copy(),
            reaction=innate.copy(),
            react_at=np.full(count, NEVER, np.int32),
            calm_at=np.full(count, NEVER, np.int32),
            busy_until=np.zeros(count, np.int32),
            blend=np.full(count, 12.0, np.float32),
        )
