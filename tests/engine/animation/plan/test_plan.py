"""Parameters, coming and going of streams, users' own nodes, and what is said about mistakes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tifo.engine.animation import Clip, ClipBank
from tifo.engine.animation.controllers import (
    Additive,
    BatchContext,
    Blend2,
    BlendN,
    BlendSpace1D,
    BlendSpace2D,
    ClipNode,
    Controller,
    Custom,
    Mask,
    Masked,
    Overlay,
    StateMachine,
    StreamContext,
    TimeScale,
    Transition,
    controller_from_toml,
    controller_to_toml,
)
from tifo.engine.streams import Stream, StreamPool

CHECK = settings(
    max_examples=25,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


def tick(pool: StreamPool, *numbers: int) -> None:
    for number in numbers:
        pool.evaluate(number)
        pool.commit(number)


def shown(pool: StreamPool, stream: Stream) -> Any:
    head = int(pool.head[stream.row])
    return pool.store.ring[pool.store.slice_of(head), stream.row].copy()


@pytest.fixture
def slides(factories: Any) -> Callable[[int], StreamPool]:
    """Pools of one joint whose x is 30 a second, from 0 or from 1000, or stands at 500."""

    def make(capacity: int = 2) -> StreamPool:
        skeleton, near = factories.make_slide(100.0)
        _, far = factories.make_slide(100.0, base=1000.0)
        still = factories.make_still(skeleton, "still")
        moved = Clip("moved", 0.0, still.rotation, still.translation + 500, still.scale)
        return StreamPool(skeleton, ClipBank(skeleton, [near, far, moved]), capacity=capacity)

    return make


def x(pool: StreamPool, stream: Stream) -> float:
    return float(shown(pool, stream)[0, 0, 3])


MOVE = ClipNode("move 0")
NEAR, FAR, MOVED = ClipNode("slide 0"), ClipNode("slide 1000"), ClipNode("moved")


@pytest.mark.parametrize(
    ("tree", "expected"),
    [
        (NEAR, 2.0),
        (ClipNode("slide 0", speed=-1.0, phase=0.5), 1498.0),
        (Blend2(NEAR, FAR, 0.25), 252.0),
        (BlendN([NEAR, FAR, MOVED], [1, 2, 1]), 0.5 + 501 + 125),
        (BlendN([NEAR, FAR], [0, 0]), 2.0),
        (TimeScale(TimeScale(NEAR, 3.0), -0.5), 0.0),
        (TimeScale(ClipNode("slide 0", phase=0.5), 2.5), 1505.0),
        (Additive(NEAR, MOVED, 0.5), 252.0),
        (Additive(NEAR, MOVED, 0.5, reference="slide 0", reference_time=1.0), 2 + 235.0),
        (Masked(NEAR, Overlay(MOVED, Mask({"joint 0": 0.5}), 0.5)), 2 + 498 / 4),
        (BlendSpace1D([(4, FAR), (2, NEAR)], 2.5), 252.0),
        (BlendSpace1D([(4, FAR), (2, NEAR)], -9.0), 2.0),
        (BlendSpace2D([((0, 0), NEAR), ((1, 0), FAR), ((0, 1), MOVED)], (0.25, 0.5)), 501.0),
        # Nearest on the hull is (0.5, 0.5), half way between the second and the third.
        (BlendSpace2D([((0, 0), NEAR), ((1, 0), FAR), ((0, 1), MOVED)], (3, 3)), 751.0),
    ],
)
def test_values_by_hand(slides: Any, tree: Controller, expected: float) -> None:
    pool = slides()
    stream = pool.add(tree)
    tick(pool, 0, 1, 2)
    assert x(pool, stream) == pytest.approx(expected, rel=1e-5, abs=1e-4)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 9])
def test_weights_of_a_plane_at_many_places(stage: Any, naive: Any, count: int) -> None:
    rng = np.random.default_rng(count)
    points = rng.normal(size=(count, 2))
    tree = BlendSpace2D([((p[0], p[1]), MOVE) for p in points.tolist()])
    pool = stage.pool(capacity=200)
    rows = [pool.add(tree).row for _ in range(200)]
    positions = rng.normal(size=(200, 2)) * 1.2
    pool.set_many(rows, "position", positions)
    tick(pool, 0)
    weight = pool._plan.tables.nodes["weight"].reshape(-1)[: 200 * (count + 1)]
    expected = [naive.plane_weights(points, position) for position in positions]
    np.testing.assert_allclose(weight.reshape(200, -1)[:, 1:], expected, atol=1e-9)


def test_what_weighs_nothing_stands_still(slides: Any) -> None:
    pool = slides()
    stream = pool.add(Blend2(NEAR, FAR, name="mix"))
    tick(pool, *range(6))
    pool.set(stream, "mix/amount", 1.0)
    tick(pool, 6)
    # The far clip was not seen before and shows its first pose.
    assert x(pool, stream) == pytest.approx(1000.0)
    pool.set(stream, "mix/amount", 0)
    tick(pool, 7)
    assert x(pool, stream) == pytest.approx(6.0)


def test_cuts_of_streams_with_controllers(slides: Any) -> None:
    pool = slides()
    stream = pool.add(NEAR, time=1.0, speed=2.0)
    tick(pool, 0, 1)
    assert x(pool, stream) == pytest.approx(32.0)
    pool.stop(stream)
    tick(pool, 2, 3)
    pool.run(stream)
    tick(pool, 4)
    assert x(pool, stream) == pytest.approx(32.0)
    assert pool.valid[stream.row] == 1
    pool.seek(stream, 2.0)
    tick(pool, 5)
    assert x(pool, stream) == pytest.approx(60.0)
    pool.play(stream, "slide 1000")
    tick(pool, 6)
    assert x(pool, stream) == pytest.approx(1000.0)
    pool.play(stream, Blend2(NEAR, FAR, 0.5), time=1.0)
    tick(pool, 7, 8)
    assert x(pool, stream) == pytest.approx(532.0)
    assert pool.valid[stream.row] == 2


def test_a_controller_is_as_the_clip_that_it_plays(stage: Any) -> None:
    plain, tree = stage.pool(), stage.pool()
    for pool, motions in ((plain, [0, 1, 2]), (tree, [ClipNode(f"move {k}") for k in range(3)])):
        for motion in motions:
            pool.add(motion, time=0.3, speed=1.7)
        tick(pool, *range(40))
    np.testing.assert_allclose(tree.store.ring[7, :3], plain.store.ring[7, :3], atol=2e-6)
    np.testing.assert_allclose(tree.phase([0, 1, 2]), plain.phase([0, 1, 2]), atol=1e-9)
    assert (plain.phase([0, 1, 2]) < 1).all()


def test_the_phase_of_a_tree_is_that_of_its_leading_clip(slides: Any) -> None:
    pool = slides()
    tree = Blend2(ClipNode("slide 0", phase=0.25), ClipNode("slide 1000", phase=0.5), 0.4)
    stream, plain = pool.add(tree), pool.add(0, time=75.0)
    tick(pool, 0)
    assert pool.phase([plain.row, stream.row]) == pytest.approx([0.75, 0.25])
    pool.set(stream, "amount", 0.6)
    tick(pool, 1)
    assert pool.phase([stream.row]) == pytest.approx([0.5 + 1 / 3000])


def test_parameters_of_many_streams(slides: Any) -> None:
    pool = slides(4)
    mix = BlendN([NEAR, FAR], name="mix")
    streams = [pool.add(mix), pool.add(Blend2(mix, NEAR)), pool.add(mix)]
    rows = [stream.row for stream in streams]
    pool.set_many([0, 2], "mix/weights", [[1, 3], [0, 1]])
    assert pool.get(streams[0], "mix/weights") == (1, 3)
    assert pool.get(streams[1], "mix/weights") == (1, 1)
    assert pool.get(streams[2], "mix/weights") == (0, 1)
    pool.set_many(rows, "mix/0/speed", 2.0)
    pool.set_many(rows[::-1], "mix/1/speed", [5, 4, 3])
    assert [pool.get(s, "mix/0/speed") for s in streams] == [2, 2, 2]
    assert [pool.get(s, "mix/1/speed") for s in streams] == [3, 4, 5]
    pool.set(streams[1], "mix/weights/1", 7)
    assert pool.parameters(streams[1]) == {
        **{"amount": 0, "mix/weights": (1, 7), "mix/weights/0": 1, "mix/weights/1": 7},
        **{"mix/0/speed": 2, "mix/1/speed": 4, "b/speed": 1},
    }


def test_wrong_parameters_are_named_and_change_nothing(slides: Any) -> None:
    pool = slides(3)
    machine = StateMachine(
        {"one": NEAR, "two": FAR}, [Transition("one", "two", trigger="go")], name="state"
    )
    stream, plain = pool.add(Blend2(machine, FAR, name="top")), pool.add(0)
    for path, value, message in (
        ("top/amont", 1, "no parameter 'top/amont'; near: top/amount"),
        ("top/amount", 1.5, "'top/amount' is 1.5, expected 0 to 1"),
        ("top/amount", float("nan"), "'top/amount' is nan"),
        ("top/amount", "much", "'top/amount' is much"),
        ("top/amount", [0.1, 0.2], r"got values of shape \(2,\), expected one or 1"),
        ("top/state/go", 2, "expected true or false"),
        ("top/state/current", 1, "'top/state/current' can only be read"),
        ("top/b/speed", float("inf"), "'top/b/speed' is inf"),
    ):
        with pytest.raises(ValueError, match=message):
            pool.set(stream, path, value)
    with pytest.raises(ValueError, match=r"stream 1 plays a clip, which has no parameters"):
        pool.set(plain, "top/amount", 1)
    with pytest.raises(ValueError, match=r"stream 2 is not alive"):
        pool.set_many([0, 2], "top/amount", 1)
    with pytest.raises(ValueError, match="no state machine 'stat'; near: top/state"):
        pool.travel(stream, "stat", "two")
    with pytest.raises(ValueError, match="no state 'tow'; near: two"):
        pool.travel(stream, "top/state", "tow")
    with pytest.raises(ValueError, match="looping is given for a controller"):
        pool.add(NEAR, looping=True)
    assert pool.parameters(stream) == {
        **{"top/amount": 0, "top/state/go": 0, "top/b/speed": 1},
        **{"top/state/one/speed": 1, "top/state/two/speed": 1},
    }


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        (
            Blend2(
                Masked(MOVED, Overlay(MOVED, Mask({"joint O": 1})), name="arms"), MOVED, name="body"
            ),
            "blend tree node 'body/arms': no joint 'joint O'; near: joint 0",
        ),
        (Blend2(NEAR, ClipNode("slid")), "blend tree node 'b': no clip 'slid'; known: slide 0"),
        (Additive(NEAR, NEAR, reference="q"), "blend tree node '': no clip 'q'"),
        (Blend2(ClipNode("moved", name="b"), NEAR), "node '': two of its children are called 'b'"),
        (Blend2(ClipNode("moved", name="b/c"), NEAR), "node 'b/c': a name can't hold '/'"),
    ],
)
def test_trees_that_do_not_fit_are_refused_by_the_path_of_the_node(
    slides: Any, tree: Controller, message: str
) -> None:
    pool = slides()
    with pytest.raises(ValueError, match=message):
        pool.add(tree)
    stream = pool.add(NEAR)
    with pytest.raises(ValueError, match=message):
        pool.play(stream, tree)
    tick(pool, 0, 1)
    assert (x(pool, stream), int(pool.alive.sum())) == (pytest.approx(1.0), 1)


def test_a_node_that_contains_itself_is_refused(slides: Any) -> None:
    nodes: list[Controller] = [NEAR]
    loop = Custom(Doubling(), nodes, name="loop")
    nodes.append(Blend2(NEAR, loop))
    with pytest.raises(ValueError, match="blend tree node 'loop/1/loop': it contains itself"):
        slides().add(loop)


def test_too_many_places_are_refused_before_memory_is_full(slides: Any) -> None:
    tree: Controller = NEAR
    for _ in range(40):
        tree = Blend2(tree, tree)
    with pytest.raises(ValueError, match="a tree has at most 16384 nodes"):
        slides().add(tree)


def test_a_tree_of_depth_500(slides: Any) -> None:
    tree: Controller = NEAR
    for _ in range(500):
        tree = Blend2(tree, MOVED, 0.001)
    pool = slides()
    stream = pool.add(tree)
    tick(pool, 0, 1)
    assert x(pool, stream) == pytest.approx(500 + (1 - 500) * 0.999**500, rel=1e-4)


class Doubling:
    """Doubles the first child's x, and counts what it was called for."""

    def __init__(self) -> None:
        self.calls: list[BatchContext] = []

    def evaluate(self, context: BatchContext) -> None:
        self.calls.append(context)
        context.out[:, 4] = context.inputs[0][:, 4] * 2.0 + context.parameters["more"][:, None]


class Clock:
    """X is the seconds since the node started."""

    def evaluate_stream(self, context: StreamContext) -> None:
        assert context.restarted == (context.time == 0.0)
        context.out[4] = context.time + 1000 * context.stream + context.parameters["add"]
        context.out[0:4] *= 3.0


def test_own_nodes_are_evaluated_in_batches(slides: Any) -> None:
    pool, code = slides(3), Doubling()
    node = Custom(code, [NEAR], {"more": 0.5}, name="own")
    a, b = pool.add(node), pool.add(Blend2(node, FAR, 0.5))
    pool.set(b, "own/more", 1.5)
    tick(pool, 0, 1)
    assert x(pool, a) == pytest.approx(2.5)
    assert x(pool, b) == pytest.approx((3.5 + 1001) / 2)
    # One call a tick.
    assert [context.streams.tolist() for context in code.calls] == [[0, 1], [0, 1]]


def test_own_nodes_one_by_one(slides: Any) -> None:
    pool = slides()
    tree = TimeScale(Custom(Clock(), parameters={"add": 5.0}), 2.0)
    a, b = pool.add(tree), pool.add(tree)
    tick(pool, 0, 1, 2)
    assert (x(pool, a), x(pool, b)) == pytest.approx((5 + 4 / 30, 1005 + 4 / 30))
    pool.seek(a, 0.0)
    tick(pool, 3)
    assert (x(pool, a), x(pool, b)) == pytest.approx((5, 1005 + 6 / 30))
    assert pool.phase([0]).tolist() == [0]


class Failing:
    def __init__(self, what: str) -> None:
        self.what = what

    def evaluate(self, context: BatchContext) -> None:
        if self.what == "raises":
            raise KeyError("lost")
        context.out[:, 4] = np.nan


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ("raises", "its code raised KeyError: 'lost'"),
        ("nan", "its code wrote values that are not finite"),
    ],
)
def test_failing_code_is_named(slides: Any, what: str, message: str) -> None:
    pool = slides()
    stream = pool.add(Blend2(NEAR, Custom(Failing(what), name="own"), 0.5, name="top"))
    with pytest.raises(ValueError, match=f"blend tree node 'top/own': {message}"):
        pool.evaluate(0)
    pool.commit(0)
    assert pool.valid[stream.row] == 0
    with pytest.raises(ValueError, match="expected an object with evaluate"):
        Custom(3)


@CHECK
@given(data=st.data())
def test_streams_that_come_and_go_leave_the_others_as_a_fresh_pool_has_them(
    data: st.DataObject, stage: Any, trees: st.SearchStrategy[Controller]
) -> None:
    pool = stage.pool(capacity=4)
    live: list[Stream] = []
    shapes = data.draw(st.lists(trees, min_size=2, max_size=4))
    for _ in range(data.draw(st.integers(1, 12))):
        if live and data.draw(st.booleans()):
            pool.remove(live.pop(data.draw(st.integers(0, len(live) - 1))))
        elif len(live) < 4:
            live.append(pool.add(data.draw(st.sampled_from(shapes)), time=0.2))
        if live and data.draw(st.booleans()):
            stopped = data.draw(st.sampled_from(live))
            pool.stop(stopped)
            tick(pool, 0)
            pool.run(stopped)
        tick(pool, 1)
    if not live:
        return
    fresh = stage.pool(capacity=4)
    pairs = []
    for stream in reversed(live):
        pool.seek(stream, 0.1)
        pairs.append((stream, fresh.add(pool.controller(stream), time=0.1)))
    for number in range(3):
        tick(pool, number)
        tick(fresh, number)
        for stream, twin in pairs:
            np.testing.assert_array_equal(shown(pool, stream), shown(fresh, twin))
    for stream in live:
        pool.remove(stream)
    tables = pool._plan.tables
    ends = [columns.end for columns in (tables.nodes, tables.children, tables.values)]
    assert ends + [columns.end for columns in tables.constants.values()] == [0] * 11


@CHECK
@given(data=st.data())
def test_a_tree_from_a_file_shows_the_same(
    data: st.DataObject, stage: Any, trees: st.SearchStrategy[Controller]
) -> None:
    tree = data.draw(trees)
    text = controller_to_toml(tree)
    again = controller_from_toml(text)
    assert controller_to_toml(again) == text
    pool = stage.pool(capacity=2)
    a, b = pool.add(tree), pool.add(again)
    tick(pool, 0, 1, 2)
    np.testing.assert_array_equal(shown(pool, a), shown(pool, b))
    assert pool.parameters(a) == pool.parameters(b)
