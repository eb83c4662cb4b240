"""What an agent wears."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True, eq=False)
class Appearance:
    """Per agent: the colours of the surfaces that vary.

    Attributes
    ----------
    skin, hair, shirt, trousers, shoes
        (N, 4) uint8 sRGB and alpha (unused, 255).
    version
        Grows with every change.
    """

    skin: NDArray[np.uint8]
    hair: NDArray[np.uint8]
    shirt: NDArray[np.uint8]
    trousers: NDArray[np.uint8]
    shoes: NDArray[np.uint8]
    version: int = 0
