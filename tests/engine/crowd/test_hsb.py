"""Hue, saturation and brightness, and the limits of a part's colours."""

from __future__ import annotations

import colorsys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tifo.engine.crowd.hsb import Limits, from_hsb, to_hsb, varied

SHARE = st.floats(0.0, 1.0, width=32)


@given(SHARE, SHARE, SHARE)
def test_as_the_standard_library_has_it(red: float, green: float, blue: float) -> None:
    ours = to_hsb([red, green, blue])
    hue, saturation, brightness = colorsys.rgb_to_hsv(red, green, blue)
    np.testing.assert_allclose(ours[1:], [saturation, brightness], atol=1e-9)
    if saturation * brightness > 1e-6:
        assert abs((ours[0] - hue + 0.5) % 1.0 - 0.5) < 1e-9
    np.testing.assert_allclose(from_hsb(ours), [red, green, blue], atol=1e-9)


@pytest.mark.parametrize(
    ("hue", "held"), [(0.05, 0.05), (0.2, 0.1), (0.9, 0.97), (0.99, 0.99), (0.55, 0.97)]
)
def test_a_range_over_red(hue: float, held: float) -> None:
    limits = Limits((-0.03, 0.1), (0.2, 0.5), (0.0, 1.0))
    np.testing.assert_allclose(limits.held([hue, 0.9, 0.4]), [held, 0.5, 0.4], atol=1e-12)


def test_varied_colours_stay_within_limits_and_vary() -> None:
    limits = Limits((0.03, 0.10), (0.2, 0.6), (0.3, 1.0))
    given = np.tile([224.0, 172.0, 130.0], (2000, 1))
    out = varied(given, (0.02, 0.3, 0.2), limits, np.random.default_rng(3))
    assert out.shape == (2000, 4)
    assert (out[:, 3] == 255).all()
    hsb = to_hsb(out[:, :3] / 255.0)
    # Rounding to 8 bits turns the hue of a dark colour a little.
    assert limits.hold(hsb, slack=0.02).all()
    assert np.ptp(hsb[:, 0]) > 0.04
    assert np.ptp(hsb[:, 2]) > 0.3
    strict = Limits((0.03, 0.10), (0.2, 0.3), (0.3, 1.0))
    assert not strict.hold(hsb, slack=0.02).all()
