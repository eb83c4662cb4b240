"""Streams one by one: controllers, cuts, handles and what is marked for drawing."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest

from tifo.engine.animation import ClipBank
from tifo.engine.animation.pose import unpack_poses
from tifo.engine.streams import Stream, StreamPool

SlidePool = Callable[..., StreamPool]


def _tick(pool: StreamPool, tick: int) -> None:
    pool.evaluate(tick)
    pool.commit(tick)


def _x(pool: StreamPool, row: int, tick: int) -> float:
    return float(pool.store.ring[pool.store.slice_of(tick), row, 0, 0, 3])


def test_the_first_pose_is_the_clip_at_the_given_time(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    stream = pool.add(1, time=2.0)
    assert pool.valid[stream.row] == 0
    for tick in (5, 6, 7):
        _tick(pool, tick)
    assert (pool.head[stream.row], pool.valid[stream.row]) == (7, 3)
    shown = [_x(pool, stream.row, tick) for tick in (5, 6, 7)]
    assert shown == pytest.approx([1060, 1061, 1062])


@pytest.mark.parametrize(("speed", "expected"), [(2.0, [60, 62, 64]), (-0.5, [60, 59.5, 59])])
def test_speed_may_be_any_sign(slide_pool: SlidePool, speed: float, expected: list[float]) -> None:
    pool = slide_pool()
    stream = pool.add(0, time=2.0, speed=speed)
    for tick in range(3):
        _tick(pool, tick)
    assert [_x(pool, stream.row, tick) for tick in range(3)] == pytest.approx(expected)


def test_valid_grows_to_the_streams_own_history(slide_pool: SlidePool) -> None:
    pool = slide_pool(history=6)
    short, long = pool.add(0, history=4), pool.add(0)
    for tick in range(20):
        _tick(pool, tick)
    assert pool.valid[[short.row, long.row]].tolist() == [4, 6]


def test_a_row_that_is_given_again_does_not_inherit_a_history(slide_pool: SlidePool) -> None:
    pool = slide_pool(capacity=1, history=6)
    pool.remove(pool.add(0, history=2))
    again = pool.add(0)
    assert pool.history[again.row] == 6


def test_a_stopped_stream_keeps_its_head_while_others_go_on(slide_pool: SlidePool) -> None:
    pool = slide_pool(history=6)
    a, b = pool.add(0), pool.add(0)
    for tick in range(5):
        _tick(pool, tick)
    pool.stop(a)
    for tick in range(5, 40):
        _tick(pool, tick)
    assert (pool.head[a.row], pool.valid[a.row]) == (4, 5)
    assert [_x(pool, a.row, tick) for tick in range(5)] == pytest.approx([0, 1, 2, 3, 4])
    assert pool.head[b.row] == 39


def test_running_again_is_a_cut_that_goes_on_where_it_was(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    stream = pool.add(0)
    for tick in range(5):
        _tick(pool, tick)
    pool.stop(stream)
    pool.run(stream)
    assert pool.valid[stream.row] == 0
    _tick(pool, 5)
    assert (pool.head[stream.row], pool.valid[stream.row]) == (5, 1)
    assert _x(pool, stream.row, 5) == pytest.approx(4.0)


def test_running_a_running_stream_is_no_cut(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    stream = pool.add(0)
    _tick(pool, 0)
    pool.run(stream)
    _tick(pool, 1)
    assert pool.valid[stream.row] == 2


def test_seek_and_play_are_cuts(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    stream = pool.add(0)
    for tick in range(3):
        _tick(pool, tick)
    pool.seek(stream, 10.0)
    _tick(pool, 3)
    assert pool.valid[stream.row] == 1
    assert _x(pool, stream.row, 3) == pytest.approx(300.0)
    pool.play(stream, "slide 1000", time=1.0)
    _tick(pool, 4)
    assert pool.valid[stream.row] == 1
    assert _x(pool, stream.row, 4) == pytest.approx(1030.0)


@pytest.mark.parametrize("cut", ["seek", "play", "stop and run", "remove and add"])
def test_a_cut_between_evaluate_and_commit_shows_nothing_from_before(
    slide_pool: SlidePool, cut: str
) -> None:
    pool = slide_pool(capacity=1)
    stream = pool.add(0)
    _tick(pool, 0)
    pool.evaluate(1)
    if cut == "seek":
        pool.seek(stream, 10.0)
    elif cut == "play":
        pool.play(stream, 1)
    elif cut == "stop and run":
        pool.stop(stream)
        pool.run(stream)
    else:
        pool.remove(stream)
        stream = pool.add(1)
    pool.commit(1)
    assert pool.valid[stream.row] == 0
    _tick(pool, 2)
    assert pool.valid[stream.row] == 1
    expected = {"seek": 300.0, "play": 1000.0, "stop and run": 1.0, "remove and add": 1000.0}
    assert _x(pool, stream.row, 2) == pytest.approx(expected[cut])


def test_a_stop_between_evaluate_and_commit_keeps_the_head(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    a, b = pool.add(0), pool.add(0)
    _tick(pool, 0)
    pool.evaluate(1)
    pool.stop(a)
    pool.commit(1)
    assert pool.head[[a.row, b.row]].tolist() == [0, 1]
    assert pool.valid[[a.row, b.row]].tolist() == [1, 2]


def test_committing_twice_counts_once(slide_pool: SlidePool) -> None:
    pool = slide_pool()
    stream = pool.add(0)
    pool.evaluate(0)
    pool.commit(0)
    pool.commit(0)
    assert pool.valid[stream.row] == 1


def test_handles_of_removed_streams_are_stale(slide_pool: SlidePool) -> None:
    pool = slide_pool(capacity=1)
    old = pool.add(0)
    pool.remove(old)
    for call in (pool.remove, pool.stop, pool.run, pool.row):
        with pytest.raises(ValueError, match="stream 0 is not alive"):
            call(old)
    pool.add(0)
    with pytest.raises(ValueError, match="stream 0 was removed and its row given to another"):
        pool.seek(old, 0.0)
    with pytest.raises(ValueError, match="stream 9 is not alive"):
        pool.row(Stream(9, 1))


def test_a_full_pool_says_so(slide_pool: SlidePool) -> None:
    pool = slide_pool(capacity=2)
    pool.add(0)
    pool.add(0)
    with pytest.raises(ValueError, match="all 2 stream rows are in use"):
        pool.add(0)


def test_wrong_values_are_named_and_change_nothing(slide_pool: SlidePool) -> None:
    pool = slide_pool(capacity=1, history=60)
    with pytest.raises(ValueError, match="clip is 2, expected 0 to 1"):
        pool.add(2)
    with pytest.raises(ValueError, match="no clip 'jump'"):
        pool.add("jump")
    with pytest.raises(ValueError, match="time is nan"):
        pool.add(0, time=float("nan"))
    with pytest.raises(ValueError, match="speed is inf"):
        pool.add(0, speed=float("inf"))
    for history in (1, 63):
        with pytest.raises(ValueError, match=f"history is {history}, expected 2 to 62"):
            pool.add(0, history=history)
    assert not pool.alive.any()
    stream = pool.add(0)
    _tick(pool, 0)
    with pytest.raises(ValueError, match="time is inf"):
        pool.seek(stream, float("inf"))
    with pytest.raises(ValueError, match="clip is -1"):
        pool.play(stream, -1)
    assert pool.valid[stream.row] == 1
    with pytest.raises(ValueError, match="capacity is 0"):
        slide_pool(capacity=0)


def test_committed_slices_and_stream_changes_are_marked(slide_pool: SlidePool) -> None:
    pool = slide_pool(history=6)
    stream = pool.add(0)
    mirror = pool.store.mirror()
    mirror.take()
    pool.evaluate(9)
    dirty = mirror.take()
    assert (dirty.slices, dirty.streams) == (set(), False)
    pool.commit(9)
    dirty = mirror.take()
    assert (dirty.slices, dirty.streams) == ({1}, True)
    pool.stop(stream)
    assert mirror.take().streams
    _tick(pool, 10)
    dirty = mirror.take()
    assert (dirty.slices, dirty.streams) == (set(), False)


def test_looping_controllers_keep_their_precision_for_hours(factories: ModuleType) -> None:
    body = factories.make_body()
    bank = ClipBank(body, [factories.make_clip(body, "sit_idle", 1.0)])
    pool = StreamPool(body, bank, capacity=1)
    stream = pool.add(0, time=30 * 3600.0, speed=-1.0)
    for tick in range(35):
        _tick(pool, tick)
        assert 0.0 <= pool.time[stream.row] < 1.0
    assert pool.time[stream.row] == pytest.approx(1.0 - 4 / 30, abs=1e-9)


def test_markers_are_the_joints_places(factories: ModuleType) -> None:
    character = factories.make_character()
    bank = ClipBank(character.skeleton, character.clips)
    joints = np.array([4, 0], np.int64)
    pool = StreamPool(character.skeleton, bank, capacity=3, markers=joints)
    pool.add(0)
    stream = pool.add("cheer", time=0.3)
    _tick(pool, 0)
    q, t, s = (part[0] for part in unpack_poses(bank.sample_one(bank.index("cheer"), 0.3)))
    places = factories.reference_models(character.skeleton.parents, q, t, s)[joints, :3, 3]
    np.testing.assert_allclose(pool.store.ring_markers[0, stream.row, :, :3], places, atol=1e-5)
    # The bind pose: a head at 0.9 + 0.4 + 0.3 m over hips at 0.9 m.
    np.testing.assert_allclose(
        pool.store.static_markers[0, :, :3], [[0, 1.6, 0], [0, 0.9, 0]], atol=1e-6
    )
