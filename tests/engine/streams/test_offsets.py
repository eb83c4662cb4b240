"""First offsets of agents."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.engine.streams import initial_offsets


@given(st.sampled_from(["normal", "uniform"]), st.integers(2, 254), st.integers(0, 2**32))
def test_offsets_leave_room_for_the_older_pose_of_the_mix(
    source: Any, history: int, seed: int
) -> None:
    found = initial_offsets(source, 200, history, np.random.default_rng(seed))
    assert found.shape == (200,)
    assert found.dtype == np.float32
    assert found.min() >= 0.0
    assert found.max() <= history - 2


def test_normal_is_centred_on_the_middle_and_a_quarter_wide() -> None:
    found = initial_offsets("normal", 20_000, 60, np.random.default_rng(1))
    inner = found[(found > 0) & (found < 58)]
    assert found.mean() == pytest.approx(29.0, abs=0.5)
    # 53.3 % of the values lie between the quarters 15 and 45 of a normal of width 15, clipped
    # at 1.93 widths, whatever happens at the ends: P(|z| < 0.728).
    share = np.mean(np.abs(found - 29.0) < 0.728 * 15.0)
    assert share == pytest.approx(0.533, abs=0.02)
    assert len(inner) / len(found) == pytest.approx(0.947, abs=0.01)


def test_uniform_fills_the_history_evenly() -> None:
    found = initial_offsets("uniform", 20_000, 60, np.random.default_rng(1))
    counts, _ = np.histogram(found, bins=10, range=(0, 58))
    assert counts.min() > 1800
    assert counts.max() < 2200


def test_equal_seeds_give_equal_offsets() -> None:
    first, second = (initial_offsets("normal", 50, 60, np.random.default_rng(7)) for _ in "ab")
    np.testing.assert_array_equal(first, second)


def test_an_own_function_gets_the_generator_and_the_count() -> None:
    rng = np.random.default_rng(3)

    def own(given_rng: np.random.Generator, count: int) -> NDArray[np.float32]:
        assert given_rng is rng
        return np.arange(count, dtype=np.float32)

    assert initial_offsets(own, 5, 60, rng).tolist() == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("values", [[0.0, 58.1], [-0.1, 3.0], [np.nan, 3.0], [np.inf, 0.0]])
def test_an_own_function_must_stay_inside_the_history(values: list[float]) -> None:
    with pytest.raises(ValueError, match="outside 0 to 58 poses"):
        initial_offsets(lambda _, __: np.array(values, np.float32), 2, 60, np.random.default_rng())


def test_an_own_function_must_answer_for_every_agent() -> None:
    with pytest.raises(ValueError, match=r"shape \(3,\), expected \(2,\)"):
        initial_offsets(lambda _, __: np.zeros(3, np.float32), 2, 60, np.random.default_rng())


@pytest.mark.parametrize("source", ["gaussian", 3, None])
def test_other_sources_are_refused(source: Any) -> None:
    with pytest.raises(
        ValueError, match=r"offsets is .*expected 'normal', 'uniform' or a function"
    ):
        initial_offsets(source, 2, 60, np.random.default_rng())
