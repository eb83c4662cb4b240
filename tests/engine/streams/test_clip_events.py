"""Which clip events streams pass in a tick: by hand, and against exact fractions."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import ceil, floor
from types import ModuleType

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tifo.engine.animation import Clip, ClipBank, ClipEvent
from tifo.engine.streams import StreamPool
from tifo.engine.streams.clip_events import MOST_REPEATS, StreamEvents

GRID = 64
"""Times are whole parts of 1/64 s, so that floats hold them exactly."""


def _clip(factories: ModuleType, seconds: float, tags: dict[str, list[float]]) -> Clip:
    _, clip = factories.make_slide(seconds=seconds)
    events = tuple(ClipEvent(time, name) for name, times in tags.items() for time in times)
    slide: Clip = replace(clip, events=events)
    return slide


def _pool(factories: ModuleType, *clips: Clip, history: int = 20) -> StreamPool:
    skeleton = factories.make_slide()[0]
    return StreamPool(skeleton, ClipBank(skeleton, clips), capacity=2, history=history)


def _counts(pool: StreamPool, row: int, tick: int, name: str) -> int:
    planes = pool.clip_events.planes[:, pool.store.slice_of(tick), row]
    return int(np.count_nonzero(planes & pool.clip_events.bit(name)))


def _run(pool: StreamPool, row: int, ticks: int, name: str) -> list[int]:
    found = []
    for tick in range(ticks):
        pool.evaluate(tick)
        pool.commit(tick)
        found.append(_counts(pool, row, tick, name))
    return found


def test_a_tag_is_passed_in_the_tick_that_reaches_it(factories: ModuleType) -> None:
    pool = _pool(factories, _clip(factories, 1.0, {"step": [0.25, 0.75]}))
    # Eight ticks a second: the times are 0, 0.125, 0.25, ...
    row = pool.add(0, speed=30 / 8, looping=True).row
    assert _run(pool, row, 17, "step") == [0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0]


def test_the_seam_has_the_tags_of_both_ends(factories: ModuleType) -> None:
    pool = _pool(factories, _clip(factories, 1.0, {"start": [0.0], "end": [1.0]}))
    row = pool.add(0, speed=30 / 4, looping=True).row
    # 0, 0.25, 0.5, 0.75, 1.0 = 0, ...; a loop that begins hasn't ended yet.
    assert _run(pool, row, 9, "start") == [1, 0, 0, 0, 1, 0, 0, 0, 1]
    pool.seek(pool.stream(row), 0.0)
    assert _run(pool, row, 9, "end") == [0, 0, 0, 0, 1, 0, 0, 0, 1]


def test_backwards_the_same_tags_are_passed_the_other_way(factories: ModuleType) -> None:
    pool = _pool(factories, _clip(factories, 1.0, {"start": [0.0], "late": [0.75]}))
    row = pool.add(0, speed=-30 / 4, time=0.5, looping=True).row
    # 0.5, 0.25, 0, 0.75, 0.5, 0.25, 0
    assert _run(pool, row, 7, "start") == [0, 0, 1, 0, 0, 0, 1]
    pool.seek(pool.stream(row), 0.5)
    assert _run(pool, row, 7, "late") == [0, 0, 0, 1, 0, 0, 0]


def test_a_clip_that_does_not_loop_passes_its_tags_once(factories: ModuleType) -> None:
    pool = _pool(factories, _clip(factories, 1.0, {"start": [0.0], "end": [1.0]}))
    row = pool.add(0, speed=30 / 4, looping=False).row
    assert _run(pool, row, 9, "end") == [0, 0, 0, 0, 1, 0, 0, 0, 0]
    pool.seek(pool.stream(row), 0.0)
    assert _run(pool, row, 9, "start") == [1, 0, 0, 0, 0, 0, 0, 0, 0]


def test_several_tags_in_one_tick_are_all_passed(factories: ModuleType) -> None:
    pool = _pool(factories, _clip(factories, 1.0, {"a": [0.25], "b": [0.5, 0.75]}))
    # 1.5 clips a tick: 0, 1.5 = 0.5, 3.0 = 0
    row = pool.add(0, speed=45, looping=True).row
    assert _run(pool, row, 3, "a") == [0, 2, 1]
    pool.seek(pool.stream(row), 0.0)
    assert _run(pool, row, 3, "b") == [0, 3, 3]


def test_no_more_repeats_are_kept_than_fit(factories: ModuleType) -> None:
    pool = _pool(factories, _clip(factories, 1.0, {"a": [0.5]}))
    row = pool.add(0, speed=30 * 20, looping=True).row
    assert _run(pool, row, 2, "a") == [0, MOST_REPEATS]


def test_a_slice_forgets_what_it_held(factories: ModuleType) -> None:
    pool = _pool(factories, _clip(factories, 100.0, {"a": [0.0]}), history=6)
    pool.add(0)
    for tick in range(20):
        pool.evaluate(tick)
        pool.commit(tick)
    assert not pool.clip_events.planes.any()


CLIP_TIME = st.integers(0, 3 * GRID)


@settings(max_examples=120, deadline=None)
@example(duration=64, tags=[0, 64], begin=0, moves=[-64, -64, 0, 128], looping=True)
@example(duration=64, tags=[0, 64], begin=64, moves=[-64, 128], looping=False)
@given(
    duration=st.integers(1, 3 * GRID),
    tags=st.lists(CLIP_TIME, min_size=1, max_size=6),
    begin=CLIP_TIME,
    moves=st.lists(st.integers(-2 * GRID, 2 * GRID), min_size=1, max_size=8),
    looping=st.booleans(),
)
def test_streams_pass_what_exact_fractions_pass(
    factories: ModuleType,
    duration: int,
    tags: list[int],
    begin: int,
    moves: list[int],
    looping: bool,
) -> None:
    places = [min(tag, duration) for tag in tags]
    clip = _clip(factories, duration / GRID, {"a": [place / GRID for place in places]})
    pool = _pool(factories, clip)
    at = Fraction(begin % duration if looping else begin)
    row = pool.add(0, time=begin / GRID, looping=looping).row
    expected = [sum(place == at for place in places)]
    found = []
    for tick, move in enumerate([0, *moves]):
        pool.speed[row] = 30.0 * move / GRID
        pool.evaluate(tick)
        pool.commit(tick)
        found.append(_counts(pool, row, tick, "a"))
        if tick:
            expected.append(sum(_images(place, duration, at, move, looping) for place in places))
            at += move
    assert found == [min(count, MOST_REPEATS) for count in expected]


def _images(place: int, duration: int, at: Fraction, move: int, looping: bool) -> int:
    """How many images of a tag lie in (at, at + move], or [at + move, at) backwards."""
    if not looping:
        return int(at < place <= at + move) if move > 0 else int(at + move <= place < at)
    if move > 0:
        return floor((at + move - place) / duration) - floor((at - place) / duration)
    return ceil((at - place) / duration) - ceil((at + move - place) / duration)


@settings(max_examples=30, deadline=None)
@given(speed=st.floats(0.1, 40), time=st.floats(0, 2.3), backwards=st.booleans())
def test_nothing_is_lost_or_doubled_at_any_speed(
    factories: ModuleType, speed: float, time: float, backwards: bool
) -> None:
    """Over a long run each tag is passed as often as the stream came round."""
    tags = [0.0, 0.3, 0.77, 2.3]
    clip = _clip(factories, 2.3, {name: [t] for name, t in zip("abcd", tags, strict=True)})
    pool = _pool(factories, clip)
    signed = -speed if backwards else speed
    row = pool.add(0, time=time, speed=signed, looping=True).row
    total = np.zeros(4)
    for tick in range(300):
        pool.evaluate(tick)
        pool.commit(tick)
        total += [_counts(pool, row, tick, name) for name in "abcd"]
    loops = 299 * speed / 30 / 2.3
    assert (np.abs(total - loops) <= 1.0 + 1e-6).all()
    assert total[0] - total[3] in (0, 1)


def test_names_are_bits_in_the_order_of_the_clips(factories: ModuleType) -> None:
    first = _clip(factories, 1.0, {"b": [0.5], "a": [0.1]})
    second = _clip(factories, 1.0, {"c": [0.5], "b": [0.1]})
    events = StreamEvents((first, second), 1, 8)
    assert events.names == ("b", "a", "c")
    assert [int(events.bit(name)) for name in events.names] == [1, 2, 4]
    with pytest.raises(ValueError, match="no clip event 'd'; known: b, a, c"):
        events.bit("d")
    with pytest.raises(ValueError, match="known: none"):
        StreamEvents((_clip(factories, 1.0, {}),), 1, 8).bit("a")


def test_more_names_than_bits_are_refused(factories: ModuleType) -> None:
    tags = {f"tag {k}": [0.5] for k in range(64)}
    StreamEvents((_clip(factories, 1.0, tags),), 1, 8)
    with pytest.raises(ValueError, match="65 different event names, expected at most 64"):
        StreamEvents((_clip(factories, 1.0, {**tags, "one more": [0.5]}),), 1, 8)


@pytest.mark.parametrize(("time", "name"), [(-0.1, "a"), (np.nan, "a"), (np.inf, "a"), (0.5, "")])
def test_wrong_tags_are_refused(time: float, name: str) -> None:
    with pytest.raises(ValueError, match="clip event"):
        ClipEvent(time, name)


def test_a_tag_after_the_end_is_refused(factories: ModuleType) -> None:
    with pytest.raises(ValueError, match=r"event 'a' of clip .* is at 1.5 s, expected 0 to 1.0 s"):
        _clip(factories, 1.0, {"a": [1.5]})
