"""What spectators wear."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import Appearance
from tifo.engine.crowd.colours import TEAM_COLOURS, draw_appearance

NAMES = ("skin", "hair", "shirt", "trousers", "shoes")


def _draw(side: NDArray[np.int8], seed: int = 1, **options: float) -> Appearance:
    return draw_appearance(side, np.random.default_rng(seed), **options)


def _likeness(colour: NDArray[np.uint8], other: tuple[int, int, int]) -> NDArray[np.float64]:
    """Cosine between colours: 1 for the same hue at any lightness."""
    a, b = colour[:, :3].astype(float), np.array(other, float)
    return np.asarray(a @ b / (np.linalg.norm(a, axis=1) * np.linalg.norm(b)))


def test_every_surface_is_an_opaque_8_bit_colour() -> None:
    look = _draw(np.zeros(300, np.int8))
    for name in NAMES:
        column = getattr(look, name)
        assert column.shape == (300, 4)
        assert column.dtype == np.uint8
        assert (column[:, 3] == 255).all()
        assert len(np.unique(column, axis=0)) > 20


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("fervour", [0.0, 0.62, 1.0])
def test_the_share_of_supporters_in_their_sides_colour(side: int, fervour: float) -> None:
    look = _draw(np.full(4000, side, np.int8), fervour=fervour)
    in_colours = _likeness(look.shirt, TEAM_COLOURS[side]) > 0.999
    assert in_colours.mean() == pytest.approx(fervour, abs=0.03)
    assert (_likeness(look.shirt, TEAM_COLOURS[1 - side]) > 0.999).mean() < 0.01


def test_neutrals_wear_nobodys_colour() -> None:
    look = _draw(np.full(3000, -1, np.int8))
    for colour in TEAM_COLOURS:
        assert (_likeness(look.shirt, colour) > 0.999).mean() < 0.01
    # Black would be the filler of the table of sides.
    assert look.shirt[:, :3].max(axis=1).min() > 20


def test_skin_lies_on_one_line_of_hue() -> None:
    skin = _draw(np.zeros(2000, np.int8)).skin[:, :3].astype(int)
    assert (skin[:, 0] > skin[:, 1]).all()
    assert (skin[:, 1] > skin[:, 2]).all()
    assert 0.1 < np.mean(skin[:, 0] < 160) < 0.25


def test_equal_seeds_dress_alike_and_others_differ() -> None:
    side = np.array([0, 1, -1] * 50, np.int8)
    first, second, third = _draw(side), _draw(side), _draw(side, seed=2)
    for name in NAMES:
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))
        assert (getattr(first, name) != getattr(third, name)).any()


def test_nobody_needs_no_clothes() -> None:
    assert _draw(np.zeros(0, np.int8)).shirt.shape == (0, 4)
