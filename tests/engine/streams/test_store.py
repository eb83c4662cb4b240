"""The pose store: its ring, its static rows and what it says has changed."""

from __future__ import annotations

import gc

import numpy as np
import pytest

from tifo.engine.streams import PoseStore
from tifo.engine.streams.store import ring_capacity


@pytest.mark.parametrize(
    ("history", "capacity"),
    [(2, 4), (3, 8), (6, 8), (7, 16), (30, 32), (60, 64), (62, 64), (63, 128), (254, 256)],
)
def test_ring_capacity_is_the_next_power_of_two_with_two_to_spare(
    history: int, capacity: int
) -> None:
    assert ring_capacity(history) == capacity


def test_ring_capacity_over_the_whole_range() -> None:
    for history in range(2, 255):
        smallest = next(size for size in (4, 8, 16, 32, 64, 128, 256) if size >= history + 2)
        assert ring_capacity(history) == smallest


@pytest.mark.parametrize("history", [-1, 0, 1, 255])
def test_other_histories_are_refused(history: int) -> None:
    with pytest.raises(ValueError, match=f"history is {history}, expected 2 to 254"):
        ring_capacity(history)


def test_arrays_have_the_documented_shapes_and_start_undeformed() -> None:
    store = PoseStore(5, 3, 60, slots=1, markers=4)
    assert store.ring.shape == (64, 3, 5, 3, 4)
    assert store.static.shape == (2, 5, 3, 4)
    assert store.ring_markers.shape == (64, 3, 4, 4)
    assert store.static_markers.shape == (2, 4, 4)
    assert (store.ring == np.eye(3, 4)).all()
    assert (store.static == np.eye(3, 4)).all()
    assert store.ring[0].flags.c_contiguous
    assert store.bind_row == 3


@pytest.mark.parametrize(("tick", "place"), [(0, 0), (63, 63), (64, 0), (130, 2), (-1, 63)])
def test_ticks_go_round_the_ring(tick: int, place: int) -> None:
    assert PoseStore(1, 1, 60).slice_of(tick) == place


def test_everything_is_dirty_at_first_and_nothing_after_taking() -> None:
    store = PoseStore(1, 1, 6, uniques=1)
    mirror = store.mirror()
    first = mirror.take()
    assert first.slices == set(range(8))
    assert first.static_rows == {0, 1, 2}
    assert first.streams
    second = mirror.take()
    assert (second.slices, second.static_rows, second.streams) == (set(), set(), False)


def test_changes_gather_until_they_are_taken() -> None:
    store = PoseStore(1, 1, 6, uniques=1)
    mirror = store.mirror()
    mirror.take()
    store.mark_slice(9)
    store.mark_slice(10)
    store.mark_slice(17)
    store.write_static(2, np.zeros((1, 3, 4), np.float32))
    dirty = mirror.take()
    assert (dirty.slices, dirty.static_rows, dirty.streams) == ({1, 2}, {2}, False)
    store.mark_streams()
    dirty = mirror.take()
    assert (dirty.slices, dirty.static_rows, dirty.streams) == (set(), set(), True)


def test_each_mirror_takes_its_own_changes() -> None:
    store = PoseStore(1, 1, 6, uniques=1)
    first, second = store.mirror(), store.mirror()
    assert first.take().slices == set(range(8))
    store.mark_slice(3)
    assert first.take().slices == {3}
    store.mark_slice(4)
    assert first.take().slices == {4}
    assert second.take().slices == set(range(8))
    store.mark_slice(5)
    late = store.mirror()
    assert late.take().slices == set(range(8))
    assert (first.take().slices, second.take().slices) == ({5}, {5})
    del second, late
    gc.collect()
    assert len(store._mirrors) == 1, "who is gone is not kept up to date"


def test_a_static_row_takes_a_palette_and_markers() -> None:
    store = PoseStore(2, 1, 6, slots=1, markers=1)
    palette = np.arange(24, dtype=np.float32).reshape(2, 3, 4)
    store.write_static(1, palette, np.array([[1, 2, 3]], np.float32))
    np.testing.assert_array_equal(store.static[1], palette)
    assert store.static_markers[1].tolist() == [[1, 2, 3, 0]]
    assert (store.static[0] == np.eye(3, 4)).all()
