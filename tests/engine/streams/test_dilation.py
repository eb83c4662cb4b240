"""Agents whose offset changes: displayed time never runs backwards and never jumps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.engine.streams import StreamPool
from tifo.engine.streams.displayed import read_palettes, shown_poses

SlidePool = Callable[..., StreamPool]
FIRST = 70
TICKS = 45
ALPHAS = np.arange(8) / 8.0
LONGEST = 58.0
"""Two less than the history of 60."""


def _displayed(
    pool: StreamPool, start: float, target: float, rate: float, t0: int, tick: int
) -> NDArray[np.float64]:
    """X shown at each fraction of a tick; a stream that runs shows one a pose tick."""
    signed = rate if target >= start else -rate
    values = []
    for alpha in ALPHAS:
        places = shown_poses(
            pool,
            np.zeros(1, np.int64),
            np.array([start], np.float32),
            np.array([target], np.float32),
            np.array([t0], np.int32),
            np.array([signed], np.float32),
            tick,
            float(alpha),
        )
        values.append(float(read_palettes(pool, places)[0, 0, 0, 3]))
    return np.array(values)


def _run(
    pool: StreamPool, start: float, target: float, rate: float, t0: int, stop_at: int | None = None
) -> NDArray[np.float64]:
    """X over `TICKS` ticks, `ALPHAS` a tick."""
    stream = pool.add(0)
    shown = []
    for tick in range(FIRST + TICKS):
        pool.evaluate(tick)
        pool.commit(tick)
        if tick == stop_at:
            pool.stop(stream)
        if tick >= FIRST:
            shown.append(_displayed(pool, start, target, rate, t0, tick))
    return np.concatenate(shown)


OFFSET = st.floats(0, LONGEST, width=32)
RATE = st.floats(0, 0.99)
T0 = st.integers(FIRST - 10, FIRST + TICKS)


@settings(max_examples=40, deadline=None)
@example(start=0.0, target=58.0, rate=0.99, t0=FIRST + 3)
@example(start=58.0, target=0.0, rate=0.99, t0=FIRST + 3)
@given(start=OFFSET, target=OFFSET, rate=RATE, t0=T0)
def test_displayed_time_moves_at_one_minus_the_rate(
    slide_pool: SlidePool, start: float, target: float, rate: float, t0: int
) -> None:
    shown = _run(slide_pool(capacity=1), start, target, rate, t0)
    step = np.diff(shown) * len(ALPHAS)
    slowest, fastest = (1 - rate, 1.0) if target >= start else (1.0, 1 + rate)
    assert step.min() >= slowest - 1e-2
    assert step.max() <= fastest + 1e-2


@settings(max_examples=25, deadline=None)
@given(start=OFFSET, target=OFFSET, rate=RATE, t0=T0)
def test_displayed_time_is_the_shown_time_less_the_offset_then(
    slide_pool: SlidePool, start: float, target: float, rate: float, t0: int
) -> None:
    shown = _run(slide_pool(capacity=1), start, target, rate, t0)
    time = np.arange(len(shown)) / len(ALPHAS) + FIRST - 1
    way = abs(target - start)
    moved = np.minimum(np.maximum(time - t0, 0.0) * rate, way)
    offset = start + np.sign(target - start) * moved
    np.testing.assert_allclose(shown, time - offset, atol=2e-3)


@settings(max_examples=25, deadline=None)
@given(
    start=OFFSET,
    target=OFFSET,
    rate=RATE,
    t0=T0,
    stop_at=st.integers(FIRST, FIRST + TICKS - 3),
)
def test_an_agent_that_is_changing_its_offset_holds_with_its_stream(
    slide_pool: SlidePool, start: float, target: float, rate: float, t0: int, stop_at: int
) -> None:
    shown = _run(slide_pool(capacity=1), start, target, rate, t0, stop_at)
    step = np.diff(shown)
    assert step.min() >= -1e-3
    assert step.max() <= 2.0 / len(ALPHAS) + 1e-3
    # The tick under way at the stop ends at the next one's alpha 0.
    held = shown[(stop_at + 1 - FIRST) * len(ALPHAS) :]
    np.testing.assert_allclose(held, held[0], atol=1e-5)


@settings(max_examples=25, deadline=None)
@given(start=OFFSET, target=OFFSET, rate=RATE, seek_at=st.integers(FIRST, FIRST + TICKS - 3))
def test_after_a_cut_displayed_time_starts_at_the_cut_and_does_not_run_back(
    slide_pool: SlidePool, start: float, target: float, rate: float, seek_at: int
) -> None:
    pool = slide_pool(capacity=1)
    stream = pool.add(0)
    shown = []
    for tick in range(FIRST + 2 * TICKS):
        if tick == seek_at:
            pool.seek(stream, 50.0)
        pool.evaluate(tick)
        pool.commit(tick)
        if tick >= seek_at:
            shown.append(_displayed(pool, start, target, rate, seek_at, tick))
    x = np.concatenate(shown)
    assert x[0] == 1500.0
    assert np.diff(x).min() >= -1e-3
    assert np.diff(x).max() <= 2.0 / len(ALPHAS) + 1e-3
