"""Where an agent stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


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
        Grows with every change.
    """

    position: NDArray[np.float32]
    yaw: NDArray[np.float32]
    scale: NDArray[np.float32]
    version: int = 0
