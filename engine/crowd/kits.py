"""Team shirts: two colours and a pattern, and the rule that says where which colour is.

The rule is made for the pictures' shader (shaders/lib/shirt.glsl) and stands here a second time,
for tests and for whoever paints shirts otherwise.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.appearance import Appearance

PATTERNS = ("plain", "stripes", "hoops", "halves", "sash")
"""Their order is the number in `Appearance.pattern`."""

FAR_SHARE = (0.0, 0.5, 0.5, 0.5, 0.0)
"""How much of the second colour is seen from far away: the mean, but not a narrow sash."""

STRIPE, HOOP = 0.15, 0.19
"""Width of one stripe and height of one hoop, in heights of the trunk."""
SASH = 0.13
"""Half of the sash's width."""
SASH_MIDDLE, SASH_SLOPE = 0.50, 1.10
"""Height of the sash on the middle of the trunk, and how much it rises to the wearer's left."""

RGB = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class Kit:
    """A team's shirt.

    Parameters
    ----------
    colour, second
        sRGB, 0 to 255.
    pattern
        One of `PATTERNS`.

    Raises
    ------
    ValueError
        For another pattern or an impossible colour.
    """

    colour: RGB
    second: RGB = (255, 255, 255)
    pattern: str = "plain"

    def __post_init__(self) -> None:
        """Check the values."""
        if self.pattern not in PATTERNS:
            raise ValueError(f"pattern is {self.pattern!r}, expected one of {', '.join(PATTERNS)}")
        for name in ("colour", "second"):
            value = getattr(self, name)
            if len(value) != 3 or not all(0 <= level <= 255 for level in value):
                raise ValueError(f"{name} is {value!r}, expected three numbers from 0 to 255")

    @property
    def number(self) -> int:
        """Of the pattern."""
        return PATTERNS.index(self.pattern)

    def put_on(self, looks: Appearance, agents: ArrayLike) -> None:
        """Dress agents, ids or a (N,) boolean mask, in this shirt, exactly as it is."""
        who = np.asarray(agents)
        looks.shirt[who] = (*self.colour, 255)
        looks.second[who] = (*self.second, 255)
        looks.pattern[who] = self.number
        looks.version += 1


KITS: tuple[Kit, ...] = (
    Kit((198, 30, 45), (240, 238, 232), "sash"),
    Kit((36, 84, 176), (240, 240, 240), "hoops"),
    Kit((238, 190, 40), (28, 28, 32), "halves"),
    Kit((30, 130, 76), (244, 240, 228), "stripes"),
    Kit((232, 116, 34), (34, 36, 44), "stripes"),
    Kit((112, 52, 148), (236, 232, 240), "sash"),
    Kit((64, 178, 200), (250, 250, 250), "hoops"),
    Kit((236, 96, 166), (36, 34, 44), "halves"),
)
"""Of the home and the away side, and of further ones."""


def second_share(
    pattern: ArrayLike, across: ArrayLike, up: ArrayLike, width: ArrayLike = (1e-6, 1e-6)
) -> NDArray[np.float64]:
    """How much of the second colour a pixel shows; the rule of shaders/lib/shirt.glsl.

    Parameters
    ----------
    pattern
        Numbers of patterns.
    across, up
        Places on the trunk in the bind pose, in heights of the trunk: from its middle to the
        wearer's left, and from the waist.
    width
        What a pixel covers of both; a pattern finer than that is its mean.

    Returns
    -------
    float64 of the shape to which the arguments broadcast, 0 to 1
    """
    kind, u, v = np.asarray(pattern), np.asarray(across, float), np.asarray(up, float)
    wide, high = np.asarray(width, float)
    diagonal = v - SASH_MIDDLE - SASH_SLOPE * u
    return np.select(
        [kind == 1, kind == 2, kind == 3, kind == 4],
        [
            _bands(u / STRIPE + 0.5, wide / STRIPE),
            _bands(v / HOOP, high / HOOP),
            _edge(u, wide),
            _edge(SASH - np.abs(diagonal), high + SASH_SLOPE * wide),
        ],
        0.0,
    )


def _edge(inside: NDArray[np.float64], width: NDArray[np.float64]) -> NDArray[np.float64]:
    """0 outside of an edge, 1 inside, and between them over the width of a pixel."""
    return np.clip(0.5 + inside / np.maximum(width, 1e-6), 0.0, 1.0)


def _bands(place: NDArray[np.float64], width: NDArray[np.float64]) -> NDArray[np.float64]:
    """Every other band of length 1 is inside: those from an odd number on."""
    wave = 0.5 - np.abs(place % 2.0 - 1.5)
    wave = np.where(wave < -0.5, -1.0 - wave, wave)
    resolved = np.clip(2.0 - 2.0 * width, 0.0, 1.0)
    return 0.5 + (_edge(wave, width) - 0.5) * resolved
