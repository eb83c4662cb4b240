"""sRGB, linear light (IEC 61966-2-1) and PNG."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from PIL import Image


def to_linear(srgb: NDArray[np.uint8]) -> NDArray[np.float64]:
    """Linear light 0 to 1 of 8-bit sRGB."""
    share = srgb / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def to_srgb(light: NDArray[np.float64]) -> NDArray[np.uint8]:
    """8-bit sRGB of linear light 0 to 1."""
    share = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.rint(255.0 * share).astype(np.uint8)


def png(image: NDArray[np.uint8]) -> bytes:
    """A picture (H, W, 4) as a PNG file."""
    from PIL import Image

    return _saved(Image.fromarray(image, "RGBA"))


def png_of_palette(palette: NDArray[np.uint8], texels: NDArray[np.uint8]) -> bytes:
    """A picture of the colours (n, 3) that `texels` (H, W) count, as a PNG file."""
    from PIL import Image

    image = Image.fromarray(texels, "P")
    image.putpalette(palette.tobytes())
    return _saved(image)


def _saved(image: Image.Image) -> bytes:
    content = io.BytesIO()
    image.save(content, "PNG")
    return content.getvalue()
