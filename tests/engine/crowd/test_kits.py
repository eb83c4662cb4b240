"""Team shirts: their patterns at single places, and dressing agents."""

from __future__ import annotations

import numpy as np
import pytest

from tifo import PATTERNS, Appearance, Kit
from tifo.engine.crowd.kits import FAR_SHARE, second_share


@pytest.mark.parametrize(
    ("pattern", "across", "up", "share"),
    [
        ("plain", 0.1, 0.5, 0.0),
        # Stripes are 0.15 wide, and one of the first colour is in the middle.
        ("stripes", 0.0, 0.5, 0.0),
        ("stripes", 0.07, 0.1, 0.0),
        ("stripes", 0.08, 0.9, 1.0),
        ("stripes", -0.15, 0.2, 1.0),
        ("stripes", 0.30, 0.2, 0.0),
        # Hoops are 0.19 high, the lowest of the first colour.
        ("hoops", 0.0, 0.1, 0.0),
        ("hoops", 0.4, 0.2, 1.0),
        ("hoops", -0.4, 0.40, 0.0),
        ("hoops", 0.0, -0.1, 1.0),
        # The wearer's left half, which the viewer sees on the right.
        ("halves", 0.01, 0.7, 1.0),
        ("halves", -0.01, 0.7, 0.0),
        # From the right hip over 0|0.5 to the left shoulder.
        ("sash", 0.0, 0.5, 1.0),
        ("sash", 0.0, 0.64, 0.0),
        ("sash", 0.2, 0.72, 1.0),
        ("sash", -0.2, 0.28, 1.0),
        ("sash", 0.2, 0.28, 0.0),
    ],
)
def test_single_places(pattern: str, across: float, up: float, share: float) -> None:
    assert second_share(PATTERNS.index(pattern), across, up) == share


@pytest.mark.parametrize("number", [0, 1, 2, 3])
def test_the_mean_that_is_seen_from_far_away(number: int) -> None:
    # Whole periods of stripes and hoops.
    across, up = np.meshgrid(np.linspace(-0.45, 0.45, 901), np.linspace(0.0, 1.14, 1141))
    mean = second_share(number, across, up).mean()
    assert mean == pytest.approx(FAR_SHARE[number], abs=0.01)


def test_an_edge_is_as_wide_as_a_pixel() -> None:
    across = np.array([-0.03, -0.01, 0.0, 0.01, 0.03])
    share = second_share(3, across, 0.5, (0.04, 0.04))
    np.testing.assert_allclose(share, [0.0, 0.25, 0.5, 0.75, 1.0])


def test_stripes_finer_than_a_pixel_are_their_mean() -> None:
    across = np.linspace(-1, 1, 50)
    np.testing.assert_allclose(second_share(1, across, 0.5, (0.2, 0.2)), 0.5)


def test_putting_on_a_kit() -> None:
    looks = Appearance(*np.full((5, 4, 4), 9, np.uint8))
    np.testing.assert_array_equal(looks.second, looks.shirt)
    Kit((1, 2, 3), (4, 5, 6), "hoops").put_on(looks, np.array([True, False, False, True]))
    np.testing.assert_array_equal(looks.pattern, [2, 0, 0, 2])
    np.testing.assert_array_equal(looks.shirt[:, 0], [1, 9, 9, 1])
    np.testing.assert_array_equal(looks.second[3], [4, 5, 6, 255])
    assert looks.version == 1


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (((1, 2, 300),), "colour is"),
        (((1, 2, 3), (1, 2)), "second is"),
        (((1, 2, 3), (4, 5, 6), "dots"), "expected one of plain, stripes"),
    ],
)
def test_impossible_kits(values: tuple[object, ...], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Kit(*values)  # type: ignore[arg-type]
