"""The captions of a scene in the window."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .captions import FAINT, INK, LABEL, PLATE, TEXT, TITLE, PlacedCaption, text_unit

POINTS = 0.7
"""Points a pixel, a little less than there are, as window fonts are wide."""


class Signs:
    """Draws captions with pyglet; text is laid out anew only where it changed.

    Parameters
    ----------
    window
        The pyglet window; needs the libraries for text.
    """

    def __init__(self, window: Any) -> None:
        import pyglet

        self._pyglet: Any = pyglet
        self._window = window
        self._plate = pyglet.shapes.Rectangle(0, 0, 1, 1, color=PLATE)
        self._labels: list[Any] = []

    def draw(self, captions: Sequence[PlacedCaption]) -> None:
        """Draw captions that were placed in a picture of the window's size."""
        size = self._window.get_size()
        height, unit = size[1], text_unit(size)
        title_size, text_size, label_size = (max(s * unit, 8.0) for s in (TITLE, TEXT, LABEL))
        used = 0

        def write(x: float, y: float, text: str, size: float, color: tuple[int, int, int]) -> Any:
            nonlocal used
            if used == len(self._labels):
                self._labels.append(self._pyglet.text.Label("", anchor_x="center", anchor_y="top"))
            label = self._labels[used]
            used += 1
            points = round(POINTS * size, 1)
            for name, value in (("text", text), ("font_size", points), ("color", (*color, 255))):
                if getattr(label, name) != value:
                    setattr(label, name, value)
            # Text is sharp only where pixels are.
            label.position = (round(x), round(height - y), 0.0)
            return label

        for caption in captions:
            if not caption.title:
                write(caption.x, caption.y, caption.text, label_size, INK).draw()
                continue
            middle = caption.y + 1.35 * title_size
            title = write(caption.x, caption.y + 3.0, caption.title, title_size, INK)
            text = write(caption.x, middle, caption.text, text_size, FAINT)
            wide = max(title.content_width, text.content_width) + title_size
            low = middle + 1.6 * text_size
            self._plate.position = (caption.x - 0.5 * wide, height - low)
            self._plate.width, self._plate.height = wide, low - caption.y
            self._plate.draw()
            title.draw()
            text.draw()
