"""Captions at places of the scene: where they are in a picture, and drawing them into it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import tifo

TITLE, TEXT, LABEL = 0.0245, 0.0182, 0.0178
"""Font sizes as shares of `text_unit`."""
INK, FAINT = (255, 255, 255), (205, 214, 226)
PLATE = (16, 24, 38, 225)


@dataclass(frozen=True, slots=True)
class Caption:
    """Words below a place.

    Parameters
    ----------
    place
        Metres; the words are centred below it.
    title
        The first line, set larger; empty for a plain label.
    text
        The line below it, or the label.
    """

    place: tuple[float, float, float]
    title: str
    text: str


@dataclass(frozen=True, slots=True)
class PlacedCaption:
    """A caption in a picture.

    Parameters
    ----------
    x, y
        Pixels from the left and the top to the middle of the words' upper border.
    title, text
        As in `Caption`.
    """

    x: float
    y: float
    title: str
    text: str


def place_captions(
    captions: Sequence[Caption], camera: tifo.FreeCamera, size: tuple[int, int]
) -> list[PlacedCaption]:
    """Those captions whose places are in a picture of `size` pixels that `camera` sees."""
    if not captions:
        return []
    places = np.ones((len(captions), 4))
    places[:, :3] = [caption.place for caption in captions]
    clip = places @ (camera.projection(size).astype(float) @ camera.view().astype(float)).T
    placed = []
    for caption, (x, y, _, w) in zip(captions, clip, strict=True):
        if w > 0.1 and abs(x) < w and abs(y) < w:
            across = 0.5 * (x / w + 1.0) * size[0]
            down = 0.5 * (1.0 - y / w) * size[1]
            placed.append(PlacedCaption(across, down, caption.title, caption.text))
    return placed


def text_unit(size: tuple[int, int]) -> float:
    """Pixels that words are measured by: the height of the widest 16:9 part of a picture."""
    return min(size[1], size[0] * 9 / 16)


def draw_captions(
    pixels: NDArray[np.uint8], captions: Sequence[PlacedCaption]
) -> NDArray[np.uint8]:
    """A copy of a picture (H, W, 3) with captions on it: titles on plates, labels without."""
    from PIL import Image, ImageDraw, ImageFont

    height, width = pixels.shape[:2]
    unit = text_unit((width, height))
    sizes = [max(round(share * unit), 8) for share in (TITLE, TEXT, LABEL)]
    title, text, label = (ImageFont.load_default(size) for size in sizes)
    layer = Image.new("RGBA", (width, height))
    draw = ImageDraw.Draw(layer)
    pad = sizes[0] * 0.45
    for caption in captions:
        if not caption.title:
            at = (caption.x, caption.y)
            draw.text(
                at,
                caption.text,
                (*INK, 255),
                label,
                "ma",
                stroke_width=2,
                stroke_fill=(16, 24, 38, 200),
            )
            continue
        wide = max(draw.textlength(caption.title, title), draw.textlength(caption.text, text))
        half = 0.5 * wide + pad
        x = min(max(caption.x, half), width - half)
        low = caption.y + 1.2 * sizes[0] + 1.25 * sizes[1] + 0.6 * pad
        draw.rounded_rectangle((x - half, caption.y, x + half, low), 0.5 * pad, PLATE)
        draw.text((x, caption.y + 0.35 * pad), caption.title, (*INK, 255), title, "ma")
        under = caption.y + 0.35 * pad + 1.2 * sizes[0]
        draw.text((x, under), caption.text, (*FAINT, 255), text, "ma")
    picture = Image.alpha_composite(Image.fromarray(pixels).convert("RGBA"), layer)
    return np.ascontiguousarray(np.asarray(picture)[..., :3])
