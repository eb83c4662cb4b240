"""Whom an agent supports, and how much."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NEUTRAL = -1
MOST_SIDES = 8
"""Sides that an event can be for."""


@dataclass(slots=True, eq=False)
class Team:
    """Per agent: its side.

    Attributes
    ----------
    side
        (N,) int8: 0 home, 1 away, further sides up to 7, -1 neutral.
    fervour
        (N,) float32 how much the agent makes of what happens: 1 an ordinary supporter, less a
        neutral, more an ultra. Everyone is ordinary if it isn't given.
    """

    side: NDArray[np.int8]
    fervour: NDArray[np.float32] = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        """Fill in the fervour."""
        if self.fervour is None:
            self.fervour = np.ones(len(self.side), np.float32)
