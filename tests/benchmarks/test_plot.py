"""Plots: the right ink in the right place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tifo.benchmarks.plot import COLOURS, Panel, draw_panels, ticks


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (0.0, 9.0, [0, 2, 4, 6, 8]),
        (0.0, 1.05, [0, 0.25, 0.5, 0.75, 1.0]),
        (-0.2, 0.2, [-0.2, -0.1, 0, 0.1, 0.2]),
        (12.0, 55.0, [20, 30, 40, 50]),
    ],
)
def test_ticks_are_round(low: float, high: float, expected: list[float]) -> None:
    assert ticks(low, high) == pytest.approx(expected)


def ink(picture: np.ndarray, colour: tuple[int, int, int]) -> np.ndarray:
    return np.argwhere((picture == np.array(colour)).all(axis=2))


def test_a_line_rises_where_its_values_do(tmp_path: Path) -> None:
    path = tmp_path / "plot.png"
    x = np.linspace(0.0, 10.0, 50)
    draw_panels([Panel("rising", "x", "y", [("line", x, x)], [("band", 4.0, 6.0)])], path)
    picture = np.asarray(Image.open(path).convert("RGB"))
    line = ink(picture, COLOURS[0])
    left, right = line[line[:, 1].argmin()], line[line[:, 1].argmax()]
    assert left[0] > right[0] + 200  # rows count downwards
    assert right[1] > left[1] + 400
    band = ink(picture, (250, 236, 200))
    assert 30 < np.ptp(band[:, 0]) < 80


def test_lines_with_gaps_and_single_values(tmp_path: Path) -> None:
    path = tmp_path / "plot.png"
    y = np.array([1.0, np.nan, 3.0, 2.0])
    panels = [
        Panel("gap", "x", "y", [("a", np.arange(4), y), ("b", np.arange(4), y + 1)], marks=True),
        Panel("flat", "x", "y", [("a", [0, 1], [0, 0])]),
        Panel("point", "x", "y", [("a", [3], [5])]),
    ]
    draw_panels(panels, path)
    width, height = Image.open(path).size
    assert (width, height) == (2 * 620, 2 * 380)


def test_no_panels_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="panel"):
        draw_panels([], tmp_path / "plot.png")
