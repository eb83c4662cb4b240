"""Uniques: live poses and clips that nobody shares, shown a tick late and smoothly."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.engine.animation import ClipBank
from tifo.engine.streams import StreamPool, Unique, UniquePool
from tifo.engine.streams.displayed import read_palettes, shown_poses

AGENTS = 5


def _slides(factories: ModuleType, uniques: int = 4) -> UniquePool:
    skeleton, clip = factories.make_slide()
    pool = StreamPool(skeleton, ClipBank(skeleton, [clip]), capacity=3, uniques=uniques, slots=2)
    return UniquePool(pool)


def _tick(uniques: UniquePool, tick: int) -> None:
    uniques.pool.evaluate(tick)
    uniques.evaluate(tick)
    uniques.pool.commit(tick)
    uniques.commit(tick)


def _local(x: float) -> NDArray[np.float32]:
    pose = np.zeros((10, 1), np.float32)
    pose[3], pose[4], pose[7:] = 2.0, x, 1.0
    return pose


def _palette(x: float) -> NDArray[np.float32]:
    palette = np.eye(3, 4, dtype=np.float32)[None]
    palette[0, 0, 3] = x
    return palette


def _x(uniques: UniquePool, unique: Unique, tick: int, alpha: float) -> float:
    zero = np.zeros(1, np.float32)
    row = np.array([uniques.row(unique)])
    shown = shown_poses(uniques.pool, row, zero, zero, np.zeros(1, np.int32), zero, tick, alpha)
    return float(read_palettes(uniques.pool, shown)[0, 0, 0, 3])


@pytest.mark.parametrize("make", [_local, _palette])
def test_written_poses_are_shown_a_tick_late_and_mixed(
    factories: ModuleType, make: Callable[[float], NDArray[np.float32]]
) -> None:
    uniques = _slides(factories)
    uniques.add(0)
    live = uniques.add()
    for tick in range(1, 12):
        uniques.write(live, make(float(tick * tick)))
        _tick(uniques, tick)
        if tick > 1:
            for alpha in (0.0, 0.25, 1.0):
                expected = (tick - 1) ** 2 * (1 - alpha) + tick**2 * alpha
                assert _x(uniques, live, tick, alpha) == pytest.approx(expected, abs=1e-4)


def test_before_its_first_pose_a_unique_shows_the_bind_pose(factories: ModuleType) -> None:
    uniques = _slides(factories)
    live = uniques.add()
    _tick(uniques, 1)
    assert _x(uniques, live, 1, 0.5) == 0.0
    uniques.write(live, _local(7.0))
    _tick(uniques, 2)
    for alpha in (0.0, 0.5, 1.0):
        assert _x(uniques, live, 2, alpha) == 7.0


def test_an_unwritten_tick_holds_and_the_next_pose_is_blended_to(factories: ModuleType) -> None:
    uniques = _slides(factories)
    live = uniques.add()
    for tick, x in ((1, 1.0), (2, 2.0)):
        uniques.write(live, _local(x))
        _tick(uniques, tick)
    for tick in range(3, 8):
        _tick(uniques, tick)
        assert [_x(uniques, live, tick, a) for a in (0.0, 0.5, 1.0)] == [2.0, 2.0, 2.0]
    uniques.write(live, _local(4.0))
    _tick(uniques, 8)
    assert [_x(uniques, live, 8, a) for a in (0.0, 0.5, 1.0)] == [2.0, 3.0, 4.0]


def test_the_last_pose_written_in_a_tick_counts(factories: ModuleType) -> None:
    uniques = _slides(factories)
    live = uniques.add()
    uniques.write(live, _palette(3.0))
    uniques.write(live, _local(5.0))
    _tick(uniques, 1)
    assert _x(uniques, live, 1, 1.0) == 5.0


def test_a_clip_plays_like_a_stream_of_its_own(factories: ModuleType) -> None:
    uniques = _slides(factories)
    unique = uniques.add(0, time=2.0, speed=2.0)
    live = uniques.add()
    for tick in range(1, 10):
        uniques.write(live, _local(-1.0))
        _tick(uniques, tick)
    # The first pose is X = 60, and it moves by two a tick.
    assert _x(uniques, unique, 9, 1.0) == pytest.approx(60 + 2 * 8, abs=1e-3)
    assert _x(uniques, unique, 9, 0.25) == pytest.approx(60 + 2 * 7.25, abs=1e-3)
    assert _x(uniques, live, 9, 0.5) == -1.0
    uniques.stop(unique)
    _tick(uniques, 10)
    _tick(uniques, 11)
    assert _x(uniques, unique, 11, 0.3) == pytest.approx(76.0, abs=1e-3)
    uniques.run(unique)
    _tick(uniques, 12)
    assert _x(uniques, unique, 12, 1.0) == pytest.approx(78.0, abs=1e-3)


def test_nothing_is_mixed_across_a_seek(factories: ModuleType) -> None:
    uniques = _slides(factories)
    unique = uniques.add(0)
    for tick in range(1, 5):
        _tick(uniques, tick)
    told: list[tuple[int, bool]] = []
    uniques.before_cut.append(lambda row, removed: told.append((row, removed)))
    uniques.seek(unique, 10.0)
    _tick(uniques, 5)
    assert told == [(uniques.row(unique), False)]
    for alpha in (0.0, 0.5, 1.0):
        assert _x(uniques, unique, 5, alpha) == pytest.approx(300.0, abs=1e-3)


def test_a_seek_between_evaluate_and_commit_shows_nothing_from_before(
    factories: ModuleType,
) -> None:
    uniques = _slides(factories)
    first, second = uniques.add(0), uniques.add(0, time=1.0)
    _tick(uniques, 1)
    uniques.evaluate(2)
    uniques.seek(first, 10.0)
    uniques.commit(2)
    assert uniques.pool.store.unique_valid[first.number] == 0
    assert _x(uniques, second, 2, 1.0) == pytest.approx(31.0, abs=1e-3)
    _tick(uniques, 3)
    assert _x(uniques, first, 3, 0.5) == pytest.approx(300.0, abs=1e-3)


def test_many_uniques_come_and_go(factories: ModuleType) -> None:
    """The batch grows and shrinks, and every unique keeps its own pose."""
    uniques = _slides(factories, uniques=9)
    rng = np.random.default_rng(4)
    live: dict[Unique, float] = {}
    for tick in range(1, 60):
        if live and rng.random() < 0.3:
            gone = list(live)[int(rng.integers(len(live)))]
            uniques.remove(gone)
            del live[gone]
        if len(live) < 9 and rng.random() < 0.6:
            live[uniques.add()] = 0.0
        for unique in live:
            live[unique] = float(rng.integers(0, 1000))
            make = _local if rng.random() < 0.7 else _palette
            uniques.write(unique, make(live[unique]))
        _tick(uniques, tick)
        for unique, x in live.items():
            assert _x(uniques, unique, tick, 1.0) == pytest.approx(x, abs=1e-3)


def test_local_poses_go_through_the_skeleton(factories: ModuleType) -> None:
    character = factories.make_character()
    bank = ClipBank(character.skeleton, character.clips)
    pool = StreamPool(
        character.skeleton, bank, capacity=2, uniques=3, markers=np.array([4, 0], np.int64)
    )
    uniques = UniquePool(pool)
    playing, live = uniques.add("cheer", time=0.3), uniques.add()
    uniques.write(live, bank.sample_one(bank.index("cheer"), 0.3)[0])
    pool.add("cheer", time=0.3)
    _tick(uniques, 1)
    static = pool.store.static[[1 + 2 * u.number + 1 for u in (playing, live)]]
    np.testing.assert_allclose(static, pool.store.ring[[1, 1], 0], atol=1e-6)
    markers = pool.store.static_markers[[1 + 2 * u.number + 1 for u in (playing, live)]]
    np.testing.assert_allclose(markers, pool.store.ring_markers[[1, 1], 0], atol=1e-5)


def test_only_rows_that_changed_are_marked(factories: ModuleType) -> None:
    uniques = _slides(factories)
    uniques.add()
    live = uniques.add()
    store = uniques.pool.store
    mirror = store.mirror()
    mirror.take()
    for tick, row in ((1, 4), (2, 3), (3, 4)):
        uniques.write(live, _local(1.0))
        _tick(uniques, tick)
        dirty = mirror.take()
        assert (dirty.static_rows, dirty.streams) == ({row}, True)
    _tick(uniques, 4)
    dirty = mirror.take()
    assert (dirty.static_rows, dirty.streams) == (set(), False)


def test_wrong_calls_are_named(factories: ModuleType) -> None:
    uniques = _slides(factories, uniques=1)
    live = uniques.add()
    with pytest.raises(ValueError, match="all 1 uniques are in use"):
        uniques.add(0)
    with pytest.raises(ValueError, match=r"shape \(10, 2\), expected a local pose \(10, 1\)"):
        uniques.write(live, np.ones((10, 2), np.float32))
    with pytest.raises(ValueError, match="not finite"):
        uniques.write(live, np.full((10, 1), np.nan, np.float32))
    with pytest.raises(ValueError, match="quaternion of no length"):
        uniques.write(live, np.zeros((10, 1), np.float32))
    uniques.remove(live)
    for call in (uniques.remove, uniques.row, uniques.stop):
        with pytest.raises(ValueError, match="unique 0 is not alive"):
            call(live)
    playing = uniques.add(0)
    with pytest.raises(ValueError, match="removed and its place given to another"):
        uniques.write(live, _local(0.0))
    with pytest.raises(ValueError, match="plays a clip"):
        uniques.write(playing, _local(0.0))
    with pytest.raises(ValueError, match="time is nan"):
        uniques.seek(playing, float("nan"))
    uniques.remove(playing)
    with pytest.raises(ValueError, match="clip is 3, expected 0 to 0"):
        uniques.add(3)
    with pytest.raises(ValueError, match="speed is inf"):
        uniques.add(0, speed=float("inf"))
    assert not uniques.alive.any()
