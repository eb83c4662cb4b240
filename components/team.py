"""Whom an agent supports."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NEUTRAL = -1


@dataclass(slots=True, eq=False)
class Team:
    """Per agent: its side.

    Attributes
    ----------
    side
        (N,) int8: 0 home, 1 away, -1 neutral.
    """

    side: NDArray[np.int8]
