"""Which tags the clips in trees pass, and with which shares: by hand, and against the naive one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import ceil, floor
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from trees import CLIPS, machines, make_moves, plain_trees

from tifo.engine.animation import ClipBank, ClipEvent
from tifo.engine.animation.controllers import (
    Additive,
    Blend2,
    ClipNode,
    Controller,
    Mask,
    Masked,
    OneShot,
    Overlay,
    StateMachine,
    TimeScale,
    Transition,
)
from tifo.engine.streams import Stream, StreamPool
from tifo.engine.streams.clip_shares import MOST_REPEATS

Passed = dict[str, list[float]]


def passed(pool: StreamPool, stream: Stream, tick: int) -> Passed:
    """Shares of what a stream passed in a tick, by name, largest first."""
    events = pool.clip_events
    found: Passed = {}
    for plane in range(len(events.planes)):
        bits = events.planes[plane, pool.store.slice_of(tick), stream.row]
        pose = events.shares.pose(tick, np.array([stream.row]), plane)
        place, single, share = events.shares.find(pose)
        assert not place.any()
        assert np.bitwise_or.reduce(single, initial=0) == bits
        for bit, value in zip(single, share, strict=True):
            found.setdefault(events.names[int(bit).bit_length() - 1], []).append(float(value))
    return found


class Run:
    """One stream with a tree of slides, tick by tick."""

    def __init__(self, pool: StreamPool, controller: Controller, **options: Any) -> None:
        self.pool = pool
        self.stream = pool.add(controller, **options)
        self.next_tick = 0

    def tick(self) -> Passed:
        self.pool.evaluate(self.next_tick)
        self.pool.commit(self.next_tick)
        self.next_tick += 1
        return passed(self.pool, self.stream, self.next_tick - 1)

    def ticks(self, count: int) -> list[Passed]:
        return [self.tick() for _ in range(count)]


@pytest.fixture
def slides(factories: ModuleType) -> Callable[..., StreamPool]:
    """Pools of one joint and clips of 1 s that play once, with tags by clip; a tick is 1/32 s."""

    def make(*tags: dict[str, list[float]], capacity: int = 1) -> StreamPool:
        clips = []
        for number, named in enumerate(tags):
            skeleton, clip = factories.make_slide(1.0, base=1000.0 * number)
            events = [ClipEvent(time, name) for name, times in named.items() for time in times]
            clips.append(replace(clip, name=f"slide {number}", events=tuple(events)))
        return StreamPool(skeleton, ClipBank(skeleton, clips), capacity=capacity, history=6)

    return make


TICK = 30 / 32
A, B = ClipNode("slide 0"), ClipNode("slide 1")


def test_both_sides_of_a_blend_are_heard_with_their_shares(slides: Any) -> None:
    pool = slides({"a": [2 / 32], "both": [3 / 32]}, {"both": [3 / 32]})
    run = Run(pool, Blend2(A, B, 0.25), speed=TICK)
    assert run.ticks(5) == [{}, {}, {"a": [0.75]}, {"both": [0.75, 0.25]}, {}]
    pool.set(run.stream, "amount", 1.0)
    pool.seek(run.stream, 0.0)
    assert run.ticks(4) == [{}, {}, {}, {"both": [1.0]}]


def test_shares_multiply_down_the_tree(slides: Any) -> None:
    pool = slides({"a": [1 / 32]}, {"b": [1 / 32]})
    tree = Blend2(A, Blend2(ClipNode("slide 0"), TimeScale(B, 1.0), 0.5), 0.5)
    assert Run(pool, tree, speed=TICK).ticks(2) == [{}, {"a": [0.5, 0.25], "b": [0.25]}]


def test_what_lies_on_top_takes_nothing_from_its_base(slides: Any) -> None:
    pool = slides({"a": [1 / 32]}, {"b": [1 / 32]})
    masked = Masked(A, Overlay(B, Mask({"joint 0": 1.0}), amount=0.5), name="m")
    run = Run(pool, Additive(masked, ClipNode("slide 1"), 0.125), speed=TICK)
    assert run.ticks(2) == [{}, {"a": [1.0], "b": [0.5, 0.125]}]


def test_a_clip_of_no_weight_is_not_heard_and_goes_on_from_where_it_stood(slides: Any) -> None:
    pool = slides({"a": [2 / 32, 5 / 32]}, {})
    run = Run(pool, Blend2(A, B, 0.0), speed=TICK)
    assert run.ticks(3) == [{}, {}, {"a": [1.0]}]
    pool.set(run.stream, "amount", 1.0)
    assert run.ticks(10) == [{}] * 10
    pool.set(run.stream, "amount", 0.5)
    assert run.ticks(3) == [{}, {}, {"a": [0.5]}]


def test_a_tag_at_the_start_of_a_state_is_heard_when_the_state_is_first_seen(slides: Any) -> None:
    pool = slides({}, {"start": [0.0], "end": [1.0]})
    ways = [Transition("a", "b", trigger="go", duration=4 / 32, curve="linear")]
    run = Run(pool, StateMachine({"a": A, "b": B}, ways), speed=TICK)
    run.ticks(3)
    pool.set(run.stream, "go", True)
    # The transition begins at weight 0.
    assert run.ticks(3) == [{}, {"start": [0.25]}, {}]
    assert [place for place, found in enumerate(run.ticks(40)) if found] == [30]


def test_a_state_begun_in_phase_hears_nothing_of_what_it_left_out(slides: Any) -> None:
    pool = slides({}, {"early": [0.0, 4 / 32], "on": [8 / 32], "late": [9 / 32]})
    run = Run(
        pool,
        StateMachine({"a": A, "b": B}, [Transition("a", "b", trigger="go", sync=True)]),
        speed=TICK,
    )
    run.ticks(9)  # at 8/32
    pool.set(run.stream, "go", True)
    assert run.ticks(2) == [{"on": [1.0]}, {"late": [1.0]}]


def test_a_shot_that_is_fired_again_passes_its_tags_again(slides: Any) -> None:
    pool = slides({"base": [2 / 32]}, {"start": [0.0], "hit": [1 / 32]})
    run = Run(pool, OneShot(A, B), speed=TICK)
    pool.set(run.stream, "request", "fire")
    assert run.ticks(2) == [{"start": [1.0]}, {"hit": [1.0]}]
    pool.set(run.stream, "request", "fire")
    assert run.ticks(2) == [{"start": [1.0]}, {"hit": [1.0]}]
    pool.set(run.stream, "request", "abort")
    # The base, which was covered from the beginning, starts now.
    assert run.ticks(3) == [{}, {}, {"base": [1.0]}]


def test_time_scale_and_speed_make_for_several_wraps_a_tick_and_backwards(slides: Any) -> None:
    pool = slides({"seam": [0.0, 1.0], "mid": [0.5]})
    loop = ClipNode("slide 0", speed=-2.0, loop=True, phase=0.25)
    run = Run(pool, TimeScale(loop, 24.0), speed=TICK)
    # 1.5 loops a tick backwards: 0.25, -1.25 = 0.75, 0.25, ...
    assert [{k: len(v) for k, v in found.items()} for found in run.ticks(3)] == [
        {},
        {"seam": 4, "mid": 1},
        {"seam": 2, "mid": 2},
    ]
    pool.set(run.stream, "scale", -24.0)
    assert {k: len(v) for k, v in run.tick().items()} == {"seam": 2, "mid": 2}


def test_a_clip_put_beyond_its_end_passes_nothing(slides: Any) -> None:
    pool = slides({"end": [1.0]}, {})
    run = Run(pool, Blend2(A, B, 0.5), speed=TICK, time=1.5)
    assert run.ticks(2) == [{}, {}]
    pool.seek(run.stream, 1.0)
    assert run.ticks(2) == [{"end": [0.5]}, {}]


def test_a_stream_that_runs_again_passes_the_tag_that_it_stands_on(slides: Any) -> None:
    """As one that plays a clip does."""
    pool = slides({"a": [2 / 32]}, {"a": [2 / 32]}, capacity=2)
    tree, plain = Run(pool, Blend2(A, B, 0.5), speed=TICK), pool.add(0, speed=TICK)
    tree.ticks(3)
    for stream in (tree.stream, plain):
        pool.stop(stream)
        pool.run(stream)
    assert tree.tick() == {"a": [0.5, 0.5]}
    assert pool.clip_events.planes[0, pool.store.slice_of(3), plain.row] == 1


def test_no_more_repeats_are_kept_than_fit_and_the_largest_shares_are(slides: Any) -> None:
    pool = slides({"a": [0.5]}, {"a": [0.5]})
    a, b = (ClipNode(f"slide {k}", speed=64.0 * 3, loop=True) for k in (0, 1))
    run = Run(pool, Blend2(a, b, 0.75), speed=TICK)
    assert run.ticks(2) == [{}, {"a": [0.75] * 6 + [0.25] * 2}]


def test_shares_are_forgotten_with_their_poses(slides: Any) -> None:
    pool = slides({"a": [0.25, 0.5, 0.75]}, {})
    pool.add(Blend2(ClipNode("slide 0", loop=True), B, 0.5), speed=8.0)
    for tick in range(100):
        pool.evaluate(tick)
        pool.commit(tick)
        assert len(pool.clip_events.shares) <= pool.store.capacity
    # A tick that is evaluated again counts once.
    before = len(pool.clip_events.shares)
    pool.evaluate(99)
    assert len(pool.clip_events.shares) <= before


def test_without_tags_in_a_tree_nothing_is_recorded(slides: Any) -> None:
    pool = slides({}, {})
    run = Run(pool, Blend2(A, B, 0.5), speed=TICK)
    assert run.ticks(3) == [{}] * 3
    assert pool._plan.played is None


CHECK = settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


@CHECK
@given(data=st.data())
def test_random_trees_pass_what_the_definitions_say(
    data: st.DataObject, factories: ModuleType, naive: ModuleType
) -> None:
    skeleton = factories.make_body()
    clips = [
        replace(
            clip,
            events=tuple(
                ClipEvent(share * clip.duration, name)
                for share, name in ((0, "seam"), (0.37, "x"), (0.37, "y"), (0.81, "x"), (1, "seam"))
            ),
        )
        for clip in make_moves(skeleton)
    ]
    assert tuple(clip.name for clip in clips) == CLIPS
    pool = StreamPool(skeleton, ClipBank(skeleton, clips), capacity=3, history=4)
    streams = []
    for _ in range(data.draw(st.integers(1, 3))):
        tree = data.draw(plain_trees() | machines())
        time = data.draw(st.sampled_from([0.0, 0.3, -0.7]))
        speed = data.draw(st.sampled_from([1.0, -1.3, 17.0]))
        stream = pool.add(tree, time=time, speed=speed)
        streams.append((stream, naive.Reference(tree, skeleton, clips, time), speed))
    for tick in range(data.draw(st.integers(3, 10))):
        for stream, reference, _ in streams:
            change(data, pool, stream, reference)
        pool.evaluate(tick)
        pool.commit(tick)
        for stream, reference, speed in streams:
            reference.tick(speed / 30)
            expected = {name: shares for name, shares in expectations(reference).items() if shares}
            found = passed(pool, stream, tick)
            assert found.keys() == expected.keys()
            for name, shares in expected.items():
                kept = sorted(shares, reverse=True)[:MOST_REPEATS]
                assert found[name] == pytest.approx(kept, abs=1e-6)


def change(data: st.DataObject, pool: StreamPool, stream: Stream, reference: Any) -> None:
    """Set one parameter of a stream, or none."""
    path = data.draw(st.sampled_from([None, *sorted(reference.values)]))
    if path is None:
        return
    old = reference.values[path]
    value: Any
    if path.endswith(("position", "speed", "scale")):
        value = [data.draw(st.floats(-3, 3)) for _ in np.atleast_1d(old)]
        value = value if isinstance(old, Sequence) else value[0]
    elif path.endswith("request"):
        value = data.draw(st.integers(0, 3))
    elif path.endswith(("/t", "/u", "/x", "/y")) or path in "tuxy":
        value = data.draw(st.integers(0, 1))
    else:
        value = [data.draw(st.floats(0, 1)) for _ in np.atleast_1d(old)]
        value = value if isinstance(old, Sequence) else value[0]
    pool.set(stream, path, value)
    reference.values[path] = value


def expectations(reference: Any) -> Passed:
    """Shares of the passings of the last tick, from each clip's own way through its times."""
    found: Passed = {}
    for node in reference.root.below():
        if node.played is None:
            continue
        starts, before, step = node.played
        for event in node.clip.events:
            count = images(node, event.time, starts, before, step)
            found.setdefault(event.name, []).extend([node.share] * count)
    return found


def images(node: Any, tag: float, starts: bool, before: float, step: float) -> int:
    """How many images of a tag lie in (before, before + step], or [before + step, before)."""
    duration, after = node.clip.duration, node.time
    if starts:
        return int(tag == after and (node.loops or before == after))
    if not node.loops:
        return int(before < tag <= after) if step > 0 else int(after <= tag < before)
    ends = [(before - tag) / duration, (before + step - tag) / duration]
    # Too near to say, after so much rounding.
    assume(step == 0 or not 0 < abs(ends[1] - round(ends[1])) < 1e-9)
    return floor(ends[1]) - floor(ends[0]) if step > 0 else ceil(ends[0]) - ceil(ends[1])


def test_a_loop_put_before_its_start_lends_its_phase_not_its_time(factories: ModuleType) -> None:
    skeleton = factories.make_body()
    clip = make_moves(skeleton)[0]
    assert clip.looping
    tagged = replace(clip, events=(ClipEvent(0.0, "start"), ClipEvent(0.26 * clip.duration, "on")))
    pool = StreamPool(skeleton, ClipBank(skeleton, [tagged]), capacity=1, history=4)
    states = {"a": ClipNode(clip.name), "b": ClipNode(clip.name)}
    ways = [Transition("a", "b", when="not x", sync=True)]
    machine = StateMachine(states, ways, parameters={"x": 0.0})
    run = Run(pool, machine, time=-1.75 * clip.duration, speed=0.02 * 30 * clip.duration)
    assert run.ticks(2) == [{}, {"on": [1.0]}], "b began at a quarter"
