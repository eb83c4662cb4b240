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
    second
        (N, 4) uint8 the shirt's other colour; the shirt's own if it isn't given.
    pattern
        (N,) uint8 number in `tifo.PATTERNS` of what the two colours make: 0 plain, 1 stripes,
        2 hoops, 3 halves, 4 sash. Plain if it isn't given.
    version
        Grows with every change.
    """

    skin: NDArray[np.uint8]
    hair: NDArray[np.uint8]
    shirt: NDArray[np.uint8]
    trousers: NDArray[np.uint8]
    shoes: NDArray[np.uint8]
    second: NDArray[np.uint8] = None  # type: ignore[assignment]
    pattern: NDArray[np.uint8] = None  # type: ignore[assignment]
    version: int = 0

    def __post_init__(self) -> None:
        """Fill in what plain shirts have."""
        if self.second is None:
            self.second = self.shirt.copy()
        if self.pattern is None:
            self.pattern = np.zeros(len(self.shirt), np.uint8)
