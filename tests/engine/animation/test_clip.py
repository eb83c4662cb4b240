"""Clips, the times of their keys, and the signs of their quaternions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.engine.animation.clip import Clip, continuous_hemisphere, uniform_times

Array = NDArray[Any]


def _parts(keys: int = 3, joints: int = 2) -> dict[str, Any]:
    return {
        "rotation": np.tile(np.array([0, 0, 0, 1], np.float32), (keys, joints, 1)),
        "translation": np.zeros((keys, joints, 3), np.float32),
        "scale": np.ones((keys, joints, 3), np.float32),
    }


def test_counts_follow_from_the_keys() -> None:
    clip = Clip("walk", 1.0, **_parts(keys=5, joints=4))
    assert (clip.frame_count, clip.joint_count) == (5, 4)
    assert clip.looping


@pytest.mark.parametrize("part", ["translation", "scale"])
def test_a_part_of_another_shape_is_named(part: str) -> None:
    parts = _parts()
    parts[part] = parts[part][:2]
    with pytest.raises(ValueError, match=rf"{part} of clip 'walk' has shape \(2, 2, 3\)"):
        Clip("walk", 1.0, **parts)


@pytest.mark.parametrize("shape", [(0, 2, 4), (3, 2, 3), (3, 4)])
def test_rotations_need_keys_of_four_numbers(shape: tuple[int, ...]) -> None:
    parts = _parts() | {"rotation": np.zeros(shape, np.float32)}
    with pytest.raises(ValueError, match="rotation of clip 'walk'"):
        Clip("walk", 1.0, **parts)


@pytest.mark.parametrize("duration", [-0.1, np.nan, np.inf])
def test_durations_are_finite_and_not_negative(duration: float) -> None:
    with pytest.raises(ValueError, match="duration of clip 'walk'"):
        Clip("walk", duration, **_parts())


@pytest.mark.parametrize("part", ["rotation", "translation", "scale"])
def test_values_are_finite(part: str) -> None:
    parts = _parts()
    parts[part][1, 1, 2] = np.nan
    with pytest.raises(ValueError, match=f"{part} of clip 'walk' has values that are not finite"):
        Clip("walk", 1.0, **parts)


def test_the_example_of_uniform_times() -> None:
    times = uniform_times(1.01)
    assert len(times) == 62
    np.testing.assert_allclose(np.diff(times), 1.01 / 61)
    assert times[0] == 0.0
    assert times[-1] == 1.01


@given(st.floats(0, 100), st.floats(1, 240))
def test_keys_are_at_least_as_dense_as_asked(duration: float, rate: float) -> None:
    times = uniform_times(duration, rate)
    assert times[0] == 0.0
    assert times[-1] == pytest.approx(duration, abs=2e-6)
    if len(times) > 1:
        assert np.diff(times).max() <= (1 + 1e-6) / rate


def test_no_duration_is_one_key() -> None:
    assert uniform_times(0.0).tolist() == [0.0]


def test_signs_follow_the_key_before() -> None:
    keys = np.array([[0, 0, 0, 1], [0, 0, -0.1, -1], [0, 0, -0.2, -1], [0, 0, 0.3, 1]], float)
    fixed = continuous_hemisphere(keys[:, None])[:, 0]
    expected = [[0, 0, 0, 1], [0, 0, 0.1, 1], [0, 0, 0.2, 1], [0, 0, 0.3, 1]]
    np.testing.assert_array_equal(fixed, expected)


@given(st.integers(0, 2**32), st.integers(1, 20))
def test_neighbours_lie_in_one_hemisphere_and_rotations_stay(seed: int, keys: int) -> None:
    q = np.random.default_rng(seed).normal(size=(keys, 3, 4))
    fixed = continuous_hemisphere(q)
    assert (np.einsum("fjk,fjk->fj", fixed[1:], fixed[:-1]) >= 0).all()
    np.testing.assert_array_equal(np.abs(fixed), np.abs(q))
    np.testing.assert_array_equal(fixed[0], q[0])
