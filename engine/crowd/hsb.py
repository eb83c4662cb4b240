"""Hue, saturation and brightness: the space in which colours are varied and held to limits.

*Thesis* 4.1: the limits of a part of the body are ranges in this space. Skin is a narrow range of
hue with little saturation, which no box in RGB is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

F64 = NDArray[np.float64]


def to_hsb(rgb: ArrayLike) -> F64:
    """Hue in turns [0, 1), saturation and brightness in [0, 1] of sRGB.

    Parameters
    ----------
    rgb
        (..., 3) sRGB in [0, 1]. Greys have hue 0.

    Returns
    -------
    (..., 3) float64
    """
    colour = np.asarray(rgb, np.float64)
    high, low = colour.max(axis=-1), colour.min(axis=-1)
    chroma = high - low
    red, green, blue = np.moveaxis(colour, -1, 0)
    step = np.where(chroma > 0, chroma, 1.0)
    sixth = np.where(
        high == red,
        (green - blue) / step,
        np.where(high == green, 2.0 + (blue - red) / step, 4.0 + (red - green) / step),
    )
    hue = np.where(chroma > 0, sixth / 6.0 % 1.0, 0.0)
    saturation = chroma / np.where(high > 0, high, 1.0)
    return np.stack([hue, saturation, high], axis=-1)


def from_hsb(hsb: ArrayLike) -> F64:
    """(..., 3) sRGB in [0, 1] of hue, saturation and brightness; the hue wraps."""
    hue, saturation, brightness = np.moveaxis(np.asarray(hsb, np.float64), -1, 0)
    place = np.stack([hue, hue + 2.0 / 3.0, hue + 1.0 / 3.0], axis=-1) % 1.0
    pure = np.clip(np.abs(6.0 * place - 3.0) - 1.0, 0.0, 1.0)
    rgb: F64 = brightness[..., None] * (1.0 + saturation[..., None] * (pure - 1.0))
    return rgb


@dataclass(frozen=True, slots=True)
class Limits:
    """Ranges that the colours of one part stay in.

    Parameters
    ----------
    hue
        From and to, in turns. A range over red begins below 0.
    saturation, brightness
        From and to, within 0 to 1.
    """

    hue: tuple[float, float]
    saturation: tuple[float, float]
    brightness: tuple[float, float]

    def held(self, hsb: ArrayLike) -> F64:
        """(..., 3) colours moved to the nearest that the limits allow."""
        hue, saturation, brightness = np.moveaxis(np.asarray(hsb, np.float64), -1, 0)
        first, last = self.hue
        middle = 0.5 * (first + last)
        near = (hue - middle + 0.5) % 1.0 - 0.5 + middle
        return np.stack(
            [
                np.clip(near, first, last) % 1.0,
                np.clip(saturation, *self.saturation),
                np.clip(brightness, *self.brightness),
            ],
            axis=-1,
        )

    def hold(self, hsb: ArrayLike, *, slack: float = 0.0) -> NDArray[np.bool_]:
        """(...) whether colours are within the limits, or off by at most `slack`."""
        given = np.asarray(hsb, np.float64)
        off = np.abs(self.held(given) - given)
        off[..., 0] = np.minimum(off[..., 0], 1.0 - off[..., 0])
        # Hues of greys mean nothing.
        off[..., 0] *= given[..., 1] * given[..., 2] > 0.02
        return np.asarray((off <= slack).all(axis=-1))


ANY = Limits((0.0, 1.0), (0.0, 1.0), (0.0, 1.0))


def varied(
    rgb: ArrayLike, spread: tuple[float, float, float], limits: Limits, rng: np.random.Generator
) -> NDArray[np.uint8]:
    """Colours that differ a little from those given, and stay within limits.

    Parameters
    ----------
    rgb
        (N, 3) sRGB, 0 to 255.
    spread
        Standard deviations: of the hue in turns, and of saturation and brightness as factors about
        1. At most twice that is used.
    limits
        Where colours stay, to the rounding of 8 bits.
    rng
        Where choices come from.

    Returns
    -------
    (N, 4) uint8 sRGB and alpha 255
    """
    hsb = to_hsb(np.asarray(rgb, np.float64) / 255.0)
    moved = rng.standard_normal(hsb.shape).clip(-2.0, 2.0) * spread
    hsb[:, 0] += moved[:, 0]
    hsb[:, 1:] *= 1.0 + moved[:, 1:]
    out = np.full((len(hsb), 4), 255, np.uint8)
    out[:, :3] = np.round(255.0 * np.clip(from_hsb(limits.held(hsb)), 0.0, 1.0))
    return out
