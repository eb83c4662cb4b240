"""Plain line plots as PNG files, drawn with Pillow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import ceil, floor, log10
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

INK, GREY, PALE = (40, 40, 44), (120, 120, 126), (228, 228, 232)
COLOURS = ((24, 98, 168), (206, 84, 30), (34, 134, 84), (136, 68, 148))

_WIDTH, _HEIGHT = 620, 380
_LEFT, _RIGHT, _TOP, _BOTTOM = 74, 22, 52, 58


@dataclass(slots=True)
class Panel:
    """One plot.

    Parameters
    ----------
    title, across, up
        Its title, and what its axes show, with units.
    lines
        Name, x and y of each line.
    bands
        Name, lowest and highest y of what has been published.
    marks
        Whether points are marked on the lines.
    """

    title: str
    across: str
    up: str
    lines: list[tuple[str, ArrayLike, ArrayLike]] = field(default_factory=list)
    bands: list[tuple[str, float, float]] = field(default_factory=list)
    marks: bool = False


def draw_panels(panels: Sequence[Panel], path: str | Path, columns: int = 2) -> None:
    """Write panels to a PNG file, row by row.

    Raises
    ------
    ValueError
        Without panels or columns.
    """
    if not panels or columns < 1:
        raise ValueError("there must be at least one panel, and one column")
    from PIL import Image, ImageDraw

    rows = -(-len(panels) // columns)
    picture = Image.new("RGB", (columns * _WIDTH, rows * _HEIGHT), "white")
    draw = ImageDraw.Draw(picture)
    for number, panel in enumerate(panels):
        left, top = number % columns * _WIDTH, number // columns * _HEIGHT
        _draw_panel(picture, draw, panel, left, top)
    picture.save(path, "PNG")


def ticks(low: float, high: float, count: int = 5) -> list[float]:
    """About `count` round numbers from `low` to `high`: 0 to 9 gives 0, 2, 4, 6, 8."""
    span = max(high - low, 1e-12)
    raw = span / count
    power = 10.0 ** floor(log10(raw))
    step = next(power * m for m in (1, 2, 2.5, 5, 10) if power * m >= raw * 0.999)
    first = ceil(low / step - 1e-9)
    return [round(k * step, 10) for k in range(first, floor(high / step + 1e-9) + 1)]


def _draw_panel(picture: Any, draw: Any, panel: Panel, left: int, top: int) -> None:
    from PIL import Image, ImageDraw, ImageFont

    small, large = ImageFont.load_default(13), ImageFont.load_default(17)
    x0, x1 = left + _LEFT, left + _WIDTH - _RIGHT
    y0, y1 = top + _HEIGHT - _BOTTOM, top + _TOP
    lines = [(name, np.asarray(x, float), np.asarray(y, float)) for name, x, y in panel.lines]
    low_x = min(float(x.min()) for _, x, _ in lines)
    high_x = max(float(x.max()) for _, x, _ in lines)
    values = [float(v) for _, _, y in lines for v in (np.nanmin(y), np.nanmax(y))]
    values += [v for _, *span in panel.bands for v in span]
    low_y, high_y = min(0.0, *values), max(values) * 1.05 + 1e-9

    def place(x: Any, y: Any) -> tuple[Any, Any]:
        across = x0 + (x - low_x) / max(high_x - low_x, 1e-12) * (x1 - x0)
        return across, y0 + (y - low_y) / (high_y - low_y) * (y1 - y0)

    draw.text((x0, top + 10), panel.title, fill=INK, font=large)
    for name, low, high in panel.bands:
        box = (x0, place(0, high)[1], x1, place(0, low)[1] + 1)
        draw.rectangle(box, fill=(250, 236, 200))
        draw.text((x1 - 4, box[1] + 2), name, fill=GREY, font=small, anchor="ra")
    for value in ticks(low_y, high_y):
        y = place(0, value)[1]
        draw.line((x0, y, x1, y), fill=PALE)
        draw.text((x0 - 6, y), f"{value:g}", fill=GREY, font=small, anchor="rm")
    for value in ticks(low_x, high_x, 7):
        x = place(value, 0)[0]
        draw.line((x, y0, x, y0 + 4), fill=GREY)
        draw.text((x, y0 + 7), f"{value:g}", fill=GREY, font=small, anchor="ma")
    draw.line((x0, y1, x0, y0, x1, y0), fill=GREY)
    draw.text(((x0 + x1) / 2, y0 + 28), panel.across, fill=INK, font=small, anchor="ma")
    upright = Image.new("RGB", (y0 - y1, 20), "white")
    ImageDraw.Draw(upright).text(((y0 - y1) / 2, 10), panel.up, fill=INK, font=small, anchor="mm")
    picture.paste(upright.rotate(90, expand=True), (left + 4, y1))
    legend = x0
    for (name, x, y), colour in zip(lines, COLOURS * len(lines), strict=False):
        points = [p for p in zip(*place(x, y), strict=True) if np.isfinite(p).all()]
        if len(points) > 1:
            draw.line(points, fill=colour, width=2, joint="curve")
        if panel.marks:
            for px, py in points:
                draw.ellipse((px - 3, py - 3, px + 3, py + 3), fill=colour)
        if len(lines) > 1:
            draw.line((legend, y1 - 9, legend + 18, y1 - 9), fill=colour, width=3)
            draw.text((legend + 23, y1 - 9), name, fill=INK, font=small, anchor="lm")
            legend += 40 + int(draw.textlength(name, font=small))
