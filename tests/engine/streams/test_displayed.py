"""Which pose an agent shows: the age formula, across the ring's wrap, stops and cuts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.engine.streams import Stream, StreamPool
from tifo.engine.streams.displayed import offset_at, read_palettes, shown_poses

SlidePool = Callable[..., StreamPool]


def _tick(pool: StreamPool, tick: int) -> None:
    pool.evaluate(tick)
    pool.commit(tick)


def _ticks(pool: StreamPool, first: int, last: int) -> None:
    for tick in range(first, last + 1):
        _tick(pool, tick)


def _shown(
    pool: StreamPool, rows: list[int], offsets: list[float], tick: int, alpha: float
) -> NDArray[np.float32]:
    """X that agents with resting offsets show."""
    count = len(rows)
    offset = np.array(offsets, np.float32)
    places = shown_poses(
        pool,
        np.array(rows, np.int64),
        offset,
        offset,
        np.zeros(count, np.int32),
        np.zeros(count, np.float32),
        tick,
        alpha,
    )
    found: NDArray[np.float32] = read_palettes(pool, places)[:, 0, 0, 3]
    return found


def test_agents_show_the_poses_their_stream_had_before_the_shown_time(
    slide_pool: SlidePool,
) -> None:
    pool = slide_pool(capacity=3)
    other, stream = pool.add(0), pool.add(0, speed=1.37)
    assert other.row != stream.row
    had: dict[int, np.float32] = {}
    for tick in range(200):
        _tick(pool, tick)
        had[tick] = pool.store.ring[pool.store.slice_of(tick), stream.row, 0, 0, 3].copy()
        if tick < 60:
            continue
        # At alpha 0 the shown time is the tick before, at alpha 1 it is this tick.
        a, b = 7, 58
        rows = [stream.row, stream.row]
        at_begin = _shown(pool, rows, [a, b], tick, 0.0)
        assert at_begin.tolist() == [had[tick - 1 - a], had[tick - 1 - b]]
        half = _shown(pool, rows, [a, b], tick, 0.5)
        between = [(had[tick - 1 - o] + had[tick - o]) / 2 for o in (a, b)]
        assert half.tolist() == pytest.approx(between, abs=1e-4)
        at_end = _shown(pool, rows, [a, b], tick, 1.0)
        assert at_end.tolist() == [had[tick - a], had[tick - b]]


def test_fractions_of_offset_and_alpha_add_up(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    stream = pool.add(0)
    _ticks(pool, 0, 80)
    # The shown time is 79.25; X is one a tick.
    found = _shown(pool, [stream.row] * 3, [0.0, 3.5, 10.25], 80, 0.25)
    assert found.tolist() == pytest.approx([79.25, 75.75, 69.0], abs=1e-4)


def test_the_picture_before_a_tick_is_the_picture_after_it(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    stream = pool.add(0)
    rows, offsets = [stream.row] * 4, [0.0, 0.3, 31.7, 58.0]
    _ticks(pool, 0, 100)
    for tick in range(101, 180):
        before = _shown(pool, rows, offsets, tick - 1, 1.0)
        _tick(pool, tick)
        np.testing.assert_allclose(_shown(pool, rows, offsets, tick, 0.0), before, atol=1e-4)


def test_agents_of_a_stopped_stream_hold(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    stream = pool.add(0)
    pool.add(1)
    rows, offsets = [stream.row] * 3, [0.0, 5.5, 58.0]
    _ticks(pool, 0, 90)
    pool.stop(stream)
    # The tick that was under way runs to its end, then nothing moves.
    assert _shown(pool, rows, offsets, 90, 0.5).tolist() == pytest.approx([89.5, 84, 31.5])
    held = [90.0, 84.5, 32.0]
    for tick in range(91, 91 + 140):
        _tick(pool, tick)
        for alpha in (0.0, 0.1, 0.5, 0.999, 1.0):
            found = _shown(pool, rows, offsets, tick, alpha)
            assert found.tolist() == pytest.approx(held, abs=1e-4)


@pytest.mark.parametrize("change", ["run", "seek", "play"])
def test_nothing_from_before_a_cut_is_mixed(slide_pool: SlidePool, change: str) -> None:
    pool = slide_pool()
    stream = pool.add(0)
    _ticks(pool, 0, 90)
    pool.stop(stream)
    _ticks(pool, 91, 120)
    first = {"run": 90.0, "seek": 1500.0, "play": 1000.0}[change]
    if change == "seek":
        pool.seek(stream, 50.0)
    elif change == "play":
        pool.play(stream, 1)
    pool.run(stream)
    last = -np.inf
    for tick in range(121, 200):
        _tick(pool, tick)
        for alpha in np.linspace(0.0, 1.0, 9):
            newest, late = _shown(pool, [stream.row] * 2, [0.0, 20.0], tick, alpha)
            now = tick - 121 - 1 + alpha
            assert newest == pytest.approx(first + max(now, 0.0), abs=1e-3)
            # An agent 20 poses behind waits at the first pose until it has a past.
            assert late == pytest.approx(first + max(now - 20.0, 0.0), abs=1e-3)
            assert late >= last - 1e-3
            last = late


def test_an_offset_beyond_the_history_is_cut_down_to_it(slide_pool: SlidePool) -> None:
    pool = slide_pool(history=10)
    stream = pool.add(0)
    _ticks(pool, 0, 5)
    # Six poses exist: 0 to 5.
    assert _shown(pool, [stream.row], [50.0], 5, 0.5).tolist() == [0.0]
    _ticks(pool, 6, 30)
    for alpha in (0.0, 0.25, 1.0):
        # Of the ten poses 21 to 30 the mix may use all: at most o = 8 behind, where it moves.
        found = _shown(pool, [stream.row] * 2, [8.0, 50.0], 30, alpha)
        assert found.tolist() == pytest.approx([21 + alpha, 21.0], abs=1e-4)


def test_a_stream_with_a_single_pose_shows_it(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    stream = pool.add(0, time=1.0)
    _tick(pool, 0)
    for alpha in (0.0, 0.5, 1.0):
        assert _shown(pool, [stream.row] * 2, [0.0, 9.0], 0, alpha).tolist() == [30.0, 30.0]


def test_static_rows_and_streams_without_a_pose_show_static_poses(slide_pool: SlidePool) -> None:
    pool = slide_pool(capacity=2)
    filled, empty = pool.add(0, time=1.0), 1
    _tick(pool, 0)
    pool.store.write_static(0, np.full((1, 3, 4), 8.0, np.float32))
    bind = pool.store.bind_row
    found = _shown(pool, [bind, filled.row, empty], [3.0, 0.0, 0.0], 0, 0.7)
    assert found.tolist() == [8.0, 30.0, 8.0]
    pool.remove(filled)
    assert _shown(pool, [filled.row], [0.0], 0, 0.7).tolist() == [8.0]


def test_each_agent_follows_its_own_streams_head(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    a = pool.add(0)
    _ticks(pool, 0, 69)
    b = pool.add(1)
    _ticks(pool, 70, 99)
    pool.stop(b)
    _ticks(pool, 100, 110)
    rows = [a.row, b.row, a.row, b.row]
    found = _shown(pool, rows, [0.0, 0.0, 4.0, 4.0], 110, 0.5)
    assert found.tolist() == pytest.approx([109.5, 1029.0, 105.5, 1025.0], abs=1e-3)


def _offset(start: float, target: float, rate: float, since: float) -> float:
    first, last, speed = (np.array([value], np.float32) for value in (start, target, rate))
    return float(offset_at(first, last, speed, np.array([since]))[0])


@pytest.mark.parametrize(
    ("since", "expected"), [(-5, 10), (0, 10), (4, 11), (8, 12), (16, 14), (20, 14), (1e6, 14)]
)
def test_the_example_of_offset_at(since: float, expected: float) -> None:
    assert _offset(10, 14, 0.25, since) == pytest.approx(expected)


@pytest.mark.parametrize(("since", "expected"), [(-5, 14), (0, 14), (4, 13), (16, 10), (99, 10)])
def test_an_offset_may_shrink(since: float, expected: float) -> None:
    assert _offset(14, 10, -0.25, since) == pytest.approx(expected)


def test_an_offset_without_rate_rests() -> None:
    assert _offset(6.5, 6.5, 0.0, 123.0) == 6.5


def test_handles_are_rows_of_the_store(slide_pool: SlidePool) -> None:
    assert slide_pool().add(0) == Stream(row=0, generation=1)
