"""Contact sheets of variants show what they are asked for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.benchmarks.look_sheets import COLOURS, draw_looks
from tifo.engine.assets.spectator import builtin_spectator

Array = NDArray[np.int64]

pytestmark = pytest.mark.gl


def test_figures_differ_where_their_choices_do(gl: Any) -> None:
    """Three figures: two of a kind, and one without hair."""
    picture = draw_looks(
        builtin_spectator(),
        [(0, 0, 255), (0, 0, 255), (0, 255, 255)],
        clip="stand_idle",
        level=2,
        cell=(40, 80),
    )
    assert picture.shape == (80, 120, 3)
    first, second, third = np.split(picture.astype(int), 3, axis=1)
    head = slice(0, 14)

    def off(a: Array, b: Array) -> float:
        return float(np.abs(a[head] - b[head]).sum())

    # The same figure falls on pixels a little differently in another cell.
    assert off(first, third) > 3.0 * off(first, second)
    red = np.array(COLOURS[2])
    assert (np.abs(first - red).sum(axis=2) < 90).any()
