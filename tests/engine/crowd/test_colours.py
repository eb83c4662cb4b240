"""What spectators wear."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import Appearance
from tifo.engine.crowd.body_types import ADULT, CHILD, OLD
from tifo.engine.crowd.colours import LIMITS, TEAM_COLOURS, draw_appearance
from tifo.engine.crowd.hsb import to_hsb
from tifo.engine.crowd.kits import KITS, Kit

NAMES = ("skin", "hair", "shirt", "trousers", "shoes")


def _draw(side: NDArray[np.int8], seed: int = 1, **options: Any) -> Appearance:
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


@pytest.mark.parametrize("part", ["skin", "trousers", "shoes"])
def test_colours_keep_to_the_limits_of_their_part(part: str) -> None:
    colours = getattr(_draw(np.full(3000, -1, np.int8)), part)[:, :3] / 255.0
    # A level of 255 is up to 0.02 of the hue or saturation of a dark colour.
    assert LIMITS[part].hold(to_hsb(colours), slack=0.025).all()


def test_skin_has_a_narrow_hue_and_little_saturation() -> None:
    hsb = to_hsb(_draw(np.zeros(3000, np.int8)).skin[:, :3] / 255.0)
    assert 0.02 < hsb[:, 0].min() < hsb[:, 0].max() < 0.11
    assert hsb[:, 1].max() < 0.65


def test_shirts_of_nobodys_team_are_muted() -> None:
    hsb = to_hsb(_draw(np.full(3000, -1, np.int8)).shirt[:, :3] / 255.0)
    assert hsb[:, 1].max() < 0.65


@pytest.mark.parametrize(("kind", "share"), [(ADULT, 0.06), (CHILD, 0.0), (OLD, 0.85)])
def test_hair_goes_with_the_age(kind: int, share: float) -> None:
    ages = np.full(4000, kind, np.uint8)
    hsb = to_hsb(_draw(np.zeros(4000, np.int8), kind=ages).hair[:, :3] / 255.0)
    grey = LIMITS["grey hair"].hold(hsb, slack=0.04)
    assert grey.mean() == pytest.approx(share, abs=0.025)
    coloured = LIMITS["hair"].hold(hsb, slack=0.06)
    assert (grey | coloured).all()


def test_patterns_are_those_of_the_side() -> None:
    side = np.repeat(np.array([-1, 0, 1, 3], np.int8), 1000)
    look = _draw(side)
    for number in (-1, 0, 1, 3):
        some = look.pattern[side == number]
        if number < 0:
            assert not some.any()
            continue
        assert set(np.unique(some)) == {0, KITS[number].number}
        assert (some > 0).mean() == pytest.approx(0.62 * 0.7, abs=0.05)
        second = look.second[side == number][some > 0]
        assert (_likeness(second, KITS[number].second) > 0.999).all()
    plain = look.pattern == 0
    muted = plain & (side < 0)
    np.testing.assert_array_equal(look.second[muted], look.shirt[muted])


def test_own_kits() -> None:
    kit = Kit((10, 200, 10), (0, 0, 0), "sash")
    look = _draw(np.zeros(500, np.int8), fervour=1.0, kits=(kit,))
    assert (_likeness(look.shirt, (10, 200, 10)) > 0.999).all()
    assert set(np.unique(look.pattern)) == {0, 4}
    with pytest.raises(ValueError, match="kits has 1 shirts, expected 2"):
        _draw(np.ones(3, np.int8), kits=(kit,))
