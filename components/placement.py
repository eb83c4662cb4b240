"""Where an agent stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

GROUP = 256
"""Neighbouring ids whose places are copied together."""


@dataclass(slots=True, eq=False)
class Placement:
    """Per agent: the place of its feet, its facing and its size.

    Attributes
    ----------
    position
        (3, N) float32 metres, in the stadium's frame.
    yaw
        (N,) float32 radians; 0 faces +Z, positive turns about +Y.
    scale
        (N,) float32 uniform scale of the character.
    version
        Grows with every change, but for those that `touch` tells of.
    touches
        Grows with every `touch`.
    touched
        (G,) int64 number of the last touch of each group of 256 neighbouring ids.
    """

    position: NDArray[np.float32]
    yaw: NDArray[np.float32]
    scale: NDArray[np.float32]
    version: int = 0
    touches: int = 0
    touched: NDArray[np.int64] = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        """Nobody was touched yet."""
        if self.touched is None:
            self.touched = np.zeros(-(-len(self.yaw) // GROUP), np.int64)

    def touch(self, agents: NDArray[np.int64]) -> None:
        """Tell that a few agents (K,) were moved, so that no more than their groups are copied."""
        self.touches += 1
        self.touched[agents // GROUP] = self.touches
