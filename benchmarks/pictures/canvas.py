"""Lines, discs and words on a light ground, drawn several times as large and scaled down."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

Colour = tuple[int, int, int]
Place = tuple[float, float]

GROUND: Colour = (250, 251, 253)
INK: Colour = (28, 36, 48)
FAINT: Colour = (128, 138, 152)
PALE: Colour = (214, 220, 228)
BLUE: Colour = (46, 125, 190)
ORANGE: Colour = (214, 92, 56)
GREEN: Colour = (70, 150, 92)
GOLD: Colour = (214, 162, 40)
PURPLE: Colour = (132, 96, 176)

_SCALE = 4


class Canvas:
    """A picture that is drawn on; places and widths are pixels of the finished picture.

    Parameters
    ----------
    width, height
        Pixels.
    """

    def __init__(self, width: int, height: int) -> None:
        self.size = (width, height)
        self._image = Image.new("RGB", (width * _SCALE, height * _SCALE), GROUND)
        self._draw = ImageDraw.Draw(self._image)

    def finish(self) -> Image.Image:
        """The picture in its own size."""
        return self._image.resize(self.size, Image.Resampling.LANCZOS)

    def polygon(self, places: Sequence[Place], colour: Colour) -> None:
        """A filled polygon."""
        self._draw.polygon([_up(place) for place in places], colour)

    def line(
        self, places: Sequence[Place], colour: Colour, width: float = 2.0, *, dashed: bool = False
    ) -> None:
        """A line with round ends through places."""
        pieces = _dashes(places, 7.0, 5.0) if dashed else [list(places)]
        for piece in pieces:
            self._draw.line(
                [_up(place) for place in piece], colour, round(width * _SCALE), joint="curve"
            )
            for end in (piece[0], piece[-1]):
                self.disc(end, 0.5 * width, colour)

    def disc(
        self,
        place: Place,
        radius: float,
        colour: Colour,
        rim: Colour | None = None,
        width: float = 2.0,
    ) -> None:
        """A filled circle, with a rim of another colour if one is given."""
        x, y = _up(place)
        r = radius * _SCALE
        self._draw.ellipse(
            (x - r, y - r, x + r, y + r), colour, rim, round(width * _SCALE) if rim else 0
        )

    def box(
        self, middle: Place, half: Place, colour: Colour, rim: Colour, width: float = 2.0
    ) -> None:
        """A rectangle with round corners."""
        (x, y), (w, h) = _up(middle), _up(half)
        self._draw.rounded_rectangle(
            (x - w, y - h, x + w, y + h), 12 * _SCALE, colour, rim, round(width * _SCALE)
        )

    def arrow(
        self, places: Sequence[Place], colour: Colour, width: float = 2.0, *, dashed: bool = False
    ) -> None:
        """A line whose last piece ends in a head."""
        end, before = np.array(places[-1]), np.array(places[-2])
        along = (end - before) / max(float(np.linalg.norm(end - before)), 1e-6)
        aside = np.array([-along[1], along[0]])
        long, wide = 5.0 * width, 2.2 * width
        neck = end - long * along
        self.line([*places[:-1], _place(end - 0.6 * long * along)], colour, width, dashed=dashed)
        self.polygon(
            [_place(end), _place(neck + wide * aside), _place(neck - wide * aside)], colour
        )

    def text(
        self,
        place: Place,
        words: str,
        size: float = 15.0,
        colour: Colour = INK,
        anchor: str = "mm",
        *,
        halo: bool = False,
    ) -> None:
        """Words at a place; `anchor` as Pillow has it, `halo` sets them off from lines below."""
        font = ImageFont.load_default(size * _SCALE)
        self._draw.multiline_text(
            _up(place),
            words,
            colour,
            font,
            anchor,
            spacing=3 * _SCALE,
            align="center",
            stroke_width=4 * _SCALE if halo else 0,
            stroke_fill=GROUND,
        )


def mixed(one: Colour, other: Colour, share: float) -> Colour:
    """A colour between two."""
    r, g, b = (round(p + (q - p) * share) for p, q in zip(one, other, strict=True))
    return r, g, b


def curve(start: Place, control: Place, end: Place, count: int = 40) -> list[Place]:
    """Points of the quadratic Bezier curve."""
    t = np.linspace(0.0, 1.0, count)[:, None]
    p = (1 - t) ** 2 * np.array(start) + 2 * t * (1 - t) * np.array(control) + t**2 * np.array(end)
    return [_place(point) for point in p]


def _place(point: NDArray[np.float64]) -> Place:
    return float(point[0]), float(point[1])


def _up(place: Place) -> Place:
    return place[0] * _SCALE, place[1] * _SCALE


def _dashes(places: Sequence[Place], on: float, off: float) -> list[list[Place]]:
    """Pieces of a line, `on` pixels long and `off` apart."""
    pieces: list[list[Place]] = []
    travelled = 0.0
    for (x0, y0), (x1, y1) in pairwise(places):
        length = math.hypot(x1 - x0, y1 - y0)
        step = 0.0
        while step < length:
            place_in = (travelled + step) % (on + off)
            left = (on if place_in < on else on + off) - place_in
            stop = min(step + left, length)
            if place_in < on:
                a, b = step / length, stop / length
                pieces.append(
                    [
                        (x0 + a * (x1 - x0), y0 + a * (y1 - y0)),
                        (x0 + b * (x1 - x0), y0 + b * (y1 - y0)),
                    ]
                )
            step = stop + 1e-9
        travelled += length
    return pieces
