"""Entering a motion at a phase: what the rings hold, by hand and over random clips."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.engine.animation import ClipBank, ClipEvent
from tifo.engine.animation.one_shot import with_pauses
from tifo.engine.streams import StreamPool
from tifo.engine.streams.phase import Entry, entry_offset


def _pool(
    factories: ModuleType, poses: float, times: list[float], *, ticks: int, speed: float = 1.0
) -> StreamPool:
    """Streams of a looping clip of some poses, begun at some poses, after some ticks."""
    skeleton, _ = factories.make_slide()
    clip = with_pauses(factories.make_slide(seconds=poses / 30)[1], 0.0, 0.0)
    pool = StreamPool(skeleton, ClipBank(skeleton, [clip]), capacity=len(times), history=30)
    for time in times:
        pool.add(0, time=time / 30, speed=speed)
    for tick in range(ticks):
        pool.evaluate(tick)
        pool.commit(tick)
    return pool


def _enter(pool: StreamPool, tick: int, count: int = 1, **options: float) -> Entry:
    rows = np.arange(len(pool.alive), dtype=np.int32)
    return entry_offset(pool, rows, count, tick, np.random.default_rng(1), **options)


def test_the_offset_leads_to_the_tick_at_which_the_clip_began(factories: ModuleType) -> None:
    # Times are 0, 1, ... poses, so the clip begins at ticks 0, 20, 40 and 60.
    pool = _pool(factories, 20.0, [0.0], ticks=65)
    entry = _enter(pool, 65, 40)
    assert entry.matched
    assert set(entry.row.tolist()) == {0}
    # 5 or 25 poses behind tick 65; 45 is beyond the history.
    assert set(np.round(entry.offset, 3).tolist()) == {5.0, 25.0}
    assert entry.step == pytest.approx(0.05)
    assert np.minimum(entry.phase, 1 - entry.phase) == pytest.approx(0.0, abs=1e-6)


def test_phases_between_poses_are_found_between_them(factories: ModuleType) -> None:
    pool = _pool(factories, 20.0, [0.4], ticks=65)
    entry = _enter(pool, 65, 40, phase=0.5)
    # Times are k + 0.4: 10 poses at tick 9.6 + 20 k, of which 49.6 is in reach.
    assert entry.offset == pytest.approx(15.4, abs=1e-4)
    assert entry.phase == pytest.approx(0.5, abs=1e-5)


def test_backwards_too(factories: ModuleType) -> None:
    pool = _pool(factories, 20.0, [0.0], ticks=65, speed=-1.0)
    entry = _enter(pool, 65, 40, phase=0.25)
    # 20 - tick = 5: at ticks 15, 35, 55.
    assert 10.0 in np.round(entry.offset, 3).tolist()
    assert entry.step == pytest.approx(-0.05)


def test_jitter_enters_up_to_so_much_earlier(factories: ModuleType) -> None:
    pool = _pool(factories, 40.0, [0.0], ticks=50)
    entry = _enter(pool, 50, 400, jitter=6.0)
    assert 10.0 <= entry.offset.min() < 10.2
    assert 15.8 < entry.offset.max() <= 16.0
    np.testing.assert_allclose(np.mod(entry.phase * 40, 40), (50 - entry.offset) % 40, atol=1e-4)
    # At the end of the history there is less room: 28 poses.
    pool = _pool(factories, 40.0, [0.0], ticks=66)
    assert _enter(pool, 66, 400, jitter=6.0).offset.max() == 28.0


def test_agents_are_spread_over_all_streams_that_hold_the_phase(factories: ModuleType) -> None:
    pool = _pool(factories, 60.0, [0.0, 20.0, 40.0], ticks=65)
    entry = _enter(pool, 65, 300)
    # Stream 0 began at tick 60, stream 1 at 40; stream 2 at 20 and 80.
    found = set(zip(entry.row.tolist(), np.round(entry.offset, 2).tolist(), strict=True))
    assert found == {(0, 5.0), (1, 25.0)}


def test_a_phase_that_no_history_holds_is_reported_and_the_nearest_taken(
    factories: ModuleType,
) -> None:
    pool = _pool(factories, 90.0, [0.0], ticks=65)
    entry = _enter(pool, 65)
    assert not entry.matched
    # The pose of the coming tick is 25 poses before the end.
    assert entry.offset.tolist() == [0.0]
    assert entry.phase[0] * 90 == pytest.approx(65.0, abs=1e-3)


def test_a_history_that_fills_up_offers_what_it_has(factories: ModuleType) -> None:
    pool = _pool(factories, 20.0, [15.0], ticks=9)
    entry = _enter(pool, 9)
    assert entry.offset.tolist() == pytest.approx([4.0])
    with pytest.raises(ValueError, match="runs and has a past"):
        _enter(_pool(factories, 20.0, [0.0], ticks=1), 1)


def test_stopped_streams_are_left_out(factories: ModuleType) -> None:
    pool = _pool(factories, 20.0, [0.0, 0.0], ticks=65)
    pool.stop(pool.stream(0))
    assert set(_enter(pool, 65, 50).row.tolist()) == {1}


@pytest.mark.parametrize("options", [{"phase": -0.1}, {"phase": 1.1}, {"jitter": -1.0}])
def test_impossible_wishes_are_refused(factories: ModuleType, options: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="phase is"):
        _enter(_pool(factories, 20.0, [0.0], ticks=9), 9, **options)


@settings(max_examples=30, deadline=None)
@given(
    poses=st.floats(4.0, 29.0),
    begin=st.floats(0, 28),
    phase=st.floats(0, 1),
    ticks=st.integers(32, 90),
)
def test_every_phase_of_a_clip_no_longer_than_the_history_less_one_is_there(
    factories: ModuleType, poses: float, begin: float, phase: float, ticks: int
) -> None:
    pool = _pool(factories, poses, [begin], ticks=ticks)
    entry = _enter(pool, ticks, phase=phase)
    assert entry.matched
    assert 0 <= entry.offset[0] <= 28
    away = (entry.phase[0] - phase + 0.5) % 1.0 - 0.5
    length = pool.bank.duration[0] * 30
    assert abs(away) * length <= 0.5 + 1e-3
    # What an agent there plays at the coming tick is that phase of the clip.
    played = (begin + ticks - float(entry.offset[0])) / length
    assert (played - entry.phase[0] + 0.5) % 1.0 - 0.5 == pytest.approx(0.0, abs=1e-4)


def test_the_phases_in_the_ring_are_the_clips_times(factories: ModuleType) -> None:
    pool = _pool(factories, 20.0, [3.0], ticks=10)
    for tick in range(10):
        found = pool.store.ring_phase[pool.store.slice_of(tick), 0]
        assert found == pytest.approx((tick + 3) % 20 / 20, abs=1e-6)


def test_pauses_hold_the_ends_and_move_the_events(factories: ModuleType) -> None:
    body = factories.make_body()
    clip = factories.make_clip(body, "stand_up", 1.0, looping=False)
    clip = replace(clip, events=(ClipEvent(0.0, "go"), ClipEvent(1.0, "up")))
    loop = with_pauses(clip, 0.24, 0.5)
    # 0.24 s are 14.4 keys of 1/60 s, so 15.
    assert loop.duration == pytest.approx(1.75)
    assert loop.frame_count == 61 + 15 + 30
    assert loop.looping
    np.testing.assert_array_equal(loop.rotation[:16], np.repeat(clip.rotation[:1], 16, axis=0))
    np.testing.assert_array_equal(loop.rotation[15:76], clip.rotation)
    np.testing.assert_array_equal(loop.rotation[75:], np.repeat(clip.rotation[-1:], 31, axis=0))
    assert [event.time for event in loop.events] == pytest.approx([0.25, 1.25])
    with pytest.raises(ValueError, match="is one pose"):
        with_pauses(factories.make_still(body, "still"), 0.1, 0.1)
    with pytest.raises(ValueError, match="before is -1"):
        with_pauses(clip, -1.0, 0.0)
