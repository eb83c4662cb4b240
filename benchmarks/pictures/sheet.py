"""A contact sheet: shots from the studio on a light ground, with shadows, seats and words."""

from __future__ import annotations

import re

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

from ...engine.assets.spectator import builtin_spectator
from .canvas import Colour
from .studio import Array, Shot, to_linear, to_srgb

WALL: Colour = (222, 228, 236)
FLOOR: Colour = (202, 209, 219)
INK: Colour = (28, 36, 48)
FAINT: Colour = (92, 102, 116)
SEAT: tuple[Colour, Colour] = ((70, 96, 150), (52, 74, 122))
LEG = re.compile("hips|upper_leg|lower_leg|foot|toe")
"""Joints that bodies throw a shadow below."""
_MOST_COLOURS = 256


class Sheet:
    """A picture that shots are put on.

    Parameters
    ----------
    size
        Pixels (width, height).
    scale
        Factor on the size of words.
    colour
        Of the ground.
    """

    def __init__(self, size: tuple[int, int], *, scale: float = 1.0, colour: Colour = WALL) -> None:
        self.size, self.scale = size, scale
        self._image = Image.new("RGB", size, colour)
        self._draw = ImageDraw.Draw(self._image)

    def floor(self, top: float, bottom: float, colour: Colour = FLOOR) -> None:
        """A strip of ground over the whole width, between two heights in pixels."""
        self._draw.rectangle((0, round(top), self.size[0], round(bottom)), colour)

    def card(self, corner: tuple[float, float], size: tuple[float, float]) -> None:
        """A darker card, on which something is shown close up."""
        x, y = corner
        self._draw.rounded_rectangle((x, y, x + size[0], y + size[1]), 8 * self.scale, FLOOR)

    def seat(self, at: tuple[float, float], metre: float, turn: float = 0.5) -> None:
        """A seat behind feet at a place, as wide as a spectator; `turn` in radians."""
        x, y = at[0] - 0.30 * metre * np.sin(turn), at[1] - 0.025 * metre
        half, deep = 0.25 * metre, 0.20 * metre * abs(np.sin(turn))
        front, side = SEAT
        top = y - 0.46 * metre
        self._draw.polygon([(x - half, top), (x + half, top), (x + half, y), (x - half, y)], front)
        self._draw.polygon(
            [
                (x - half, top),
                (x - half - deep * np.sign(turn), top - 0.05 * metre),
                (x + half - deep * np.sign(turn), top - 0.05 * metre),
                (x + half, top),
            ],
            side,
        )

    def put(self, shot: Shot, at: tuple[int, int] = (0, 0), metre: float = 0.0) -> None:
        """Lay a shot over the sheet, with its upper left corner at a place.

        Parameters
        ----------
        metre
            Pixels of a metre for the shadows below bodies; 0 for none.
        """
        if metre:
            self._shade(shot, at, metre)
        height, width = shot.cover.shape
        box = (*at, at[0] + width, at[1] + height)
        ground = to_linear(np.asarray(self._image.crop(box)).astype(np.float64) / 255.0)
        light = shot.light + (1.0 - shot.cover[..., None]) * ground
        self._image.paste(as_image(to_srgb(light)), at)
        self._draw = ImageDraw.Draw(self._image)

    def paste(self, image: Image.Image, at: tuple[int, int]) -> None:
        """Lay an image over the sheet."""
        self._image.paste(image, at)

    def text(
        self,
        place: tuple[float, float],
        words: str,
        size: float = 17.0,
        colour: Colour = INK,
        anchor: str = "mm",
    ) -> None:
        """Words; `anchor` as Pillow has it."""
        font = ImageFont.load_default(max(size * self.scale, 6.0))
        self._draw.text(place, words, colour, font, anchor)

    def line(self, start: tuple[float, float], end: tuple[float, float], colour: Colour) -> None:
        """A thin line."""
        self._draw.line((*start, *end), colour, max(round(self.scale), 1))

    def finish(self) -> Image.Image:
        """The picture, with few colours: it is a tenth as large in a file."""
        return with_few_colours(self._image)

    def _shade(self, shot: Shot, at: tuple[int, int], metre: float) -> None:
        """Soft discs on the ground below joints, fainter below those that are high up."""
        shade = Image.new("L", self.size, 0)
        draw = ImageDraw.Draw(shade)
        legs = [k for k, name in enumerate(builtin_spectator().skeleton.names) if LEG.match(name)]
        places = (shot.ground[:, legs] + np.array(at)).reshape(-1, 2)
        for (x, y), height in zip(places, shot.height[:, legs].ravel(), strict=True):
            if height < 0.7:
                r = metre * (0.13 if height < 0.3 else 0.18)
                draw.ellipse((x - r, y - 0.3 * r, x + r, y + 0.3 * r), 120 if height < 0.3 else 80)
        shade = shade.filter(ImageFilter.GaussianBlur(0.035 * metre))
        self._image.paste(Image.new("RGB", self.size, (70, 78, 96)), (0, 0), shade)


def as_image(srgb: Array) -> Image.Image:
    """A Pillow image of (H, W, 3) sRGB from 0 to 1."""
    return Image.fromarray((np.clip(srgb, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8))


def with_few_colours(image: Image.Image) -> Image.Image:
    """An image of at most 256 colours, dithered."""
    palette = image.quantize(_MOST_COLOURS, Image.Quantize.MAXCOVERAGE, kmeans=1)
    return image.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)
