"""Uniques that play trees of controllers: as streams do, but for one agent."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from trees import machines, make_moves, plain_trees

from tifo.engine.animation import ClipBank
from tifo.engine.animation.controllers import (
    Blend2,
    ClipNode,
    Custom,
    OneShot,
    StateMachine,
    Transition,
)
from tifo.engine.streams import StreamPool, Unique, UniquePool


def _pool(factories: ModuleType, uniques: int = 3) -> UniquePool:
    skeleton, near = factories.make_slide(100.0)
    _, far = factories.make_slide(100.0, base=1000.0)
    bank = ClipBank(skeleton, [near, far])
    return UniquePool(StreamPool(skeleton, bank, capacity=2, uniques=uniques))


def _tick(uniques: UniquePool, *ticks: int) -> None:
    for tick in ticks:
        uniques.pool.evaluate(tick)
        uniques.evaluate(tick)
        uniques.pool.commit(tick)
        uniques.commit(tick)


def _palettes(uniques: UniquePool, unique: Unique, back: int = 0) -> Any:
    store = uniques.pool.store
    newest = int(store.unique_newest[unique.number]) ^ back
    return store.static[1 + 2 * unique.number + newest]


def _x(uniques: UniquePool, unique: Unique, back: int = 0) -> float:
    return float(_palettes(uniques, unique, back)[0, 0, 3])


NEAR, FAR = ClipNode("slide 0"), ClipNode("slide 1000")


def test_parameters_are_set_and_read_and_count_from_the_next_tick(factories: ModuleType) -> None:
    uniques = _pool(factories)
    clip, live = uniques.add(0), uniques.add()
    tree = uniques.add(Blend2(NEAR, FAR, 0.25), time=1.0, speed=2.0)
    _tick(uniques, 1, 2)
    assert _x(uniques, tree) == pytest.approx(250 + 30 + 2)
    uniques.set(tree, "amount", 0.5)
    assert uniques.get(tree, "amount") == 0.5
    assert uniques.parameters(tree) == {"amount": 0.5, "a/speed": 1.0, "b/speed": 1.0}
    assert uniques.controller(tree).children()[0][1] is NEAR
    _tick(uniques, 3)
    assert _x(uniques, tree) == pytest.approx(500 + 30 + 4)
    assert _x(uniques, tree, back=1) == pytest.approx(250 + 30 + 2)
    uniques.set_many([tree.number], "amount", [1.0])
    _tick(uniques, 4)
    assert _x(uniques, tree) == pytest.approx(1000 + 30 + 6)
    assert _x(uniques, clip) == pytest.approx(3.0)
    phases = uniques.phase([clip.number, live.number, tree.number])
    assert phases == pytest.approx([0.001, 0.0, 0.012], abs=1e-6)


def test_stop_holds_and_run_goes_on(factories: ModuleType) -> None:
    uniques = _pool(factories)
    tree = uniques.add(Blend2(NEAR, FAR, 0.0))
    _tick(uniques, 1, 2, 3)
    uniques.stop(tree)
    _tick(uniques, 4, 5)
    assert _x(uniques, tree) == pytest.approx(2.0)
    uniques.run(tree)
    _tick(uniques, 6)
    assert _x(uniques, tree) == pytest.approx(3.0)


def test_seek_and_play_are_cuts(factories: ModuleType) -> None:
    uniques = _pool(factories)
    ways = [Transition("near", "far", trigger="go")]
    tree = uniques.add(StateMachine({"near": NEAR, "far": FAR}, ways))
    told: list[tuple[int, bool]] = []
    uniques.before_cut.append(lambda row, removed: told.append((row, removed)))
    valid = uniques.pool.store.unique_valid
    uniques.set(tree, "go", True)
    _tick(uniques, 1, 2)
    assert (uniques.get(tree, "current"), int(valid[tree.number])) == ("far", 2)
    uniques.travel(tree, "", "near")
    uniques.seek(tree, 2.0)
    assert (uniques.get(tree, "current"), int(valid[tree.number])) == ("near", 0)
    _tick(uniques, 3)
    assert (_x(uniques, tree), int(valid[tree.number])) == (pytest.approx(60.0), 1)
    uniques.play(tree, OneShot(NEAR, FAR), time=1.0)
    assert valid[tree.number] == 0
    uniques.set(tree, "request", "fire")
    _tick(uniques, 4)
    assert _x(uniques, tree) == pytest.approx(1000.0)
    uniques.play(tree, "slide 0", time=3.0)
    _tick(uniques, 5)
    assert _x(uniques, tree) == pytest.approx(90.0)
    uniques.play(tree, None)
    uniques.write(tree, np.eye(3, 4, dtype=np.float32)[None] * 2)
    _tick(uniques, 6)
    assert _palettes(uniques, tree)[0, 0, 0] == 2.0
    assert told == [(uniques.row(tree), False)] * 4


def test_mistakes_are_named_and_change_nothing(factories: ModuleType) -> None:
    uniques = _pool(factories)
    tree, clip, live = uniques.add(Blend2(NEAR, FAR, 0.5)), uniques.add(1), uniques.add()
    with pytest.raises(ValueError, match="no parameter 'amout'; near: amount"):
        uniques.set(tree, "amout", 0.1)
    with pytest.raises(ValueError, match="unique 1 plays a clip, which has no parameters"):
        uniques.get(clip, "amount")
    with pytest.raises(ValueError, match="unique 2 shows poses that are written"):
        uniques.parameters(live)
    with pytest.raises(ValueError, match="unique 0 plays a controller, its poses can't be written"):
        uniques.write(tree, np.eye(3, 4, dtype=np.float32)[None])
    with pytest.raises(ValueError, match=r"'b'.*no clip 'none'"):
        uniques.play(tree, Blend2(NEAR, ClipNode("none")))
    with pytest.raises(ValueError, match="time is nan"):
        uniques.play(tree, 0, time=float("nan"))
    assert uniques.get(tree, "amount") == 0.5
    _tick(uniques, 1)
    assert _x(uniques, tree) == pytest.approx(500.0)
    uniques.remove(tree)
    for call in (uniques.parameters, uniques.controller):
        with pytest.raises(ValueError, match="unique 0 is not alive"):
            call(tree)
    with pytest.raises(ValueError, match="looping is given for a controller"):
        uniques.add(Blend2(NEAR, FAR), looping=True)
    with pytest.raises(ValueError, match="no clip 'none'"):
        uniques.add(ClipNode("none"))
    assert not uniques.alive[0]
    again = uniques.add(Blend2(NEAR, FAR, 0.125))
    with pytest.raises(ValueError, match="unique 0 was removed and its place given to another"):
        uniques.set(tree, "amount", 1.0)
    assert uniques.get(again, "amount") == 0.125


def test_code_that_fails_leaves_nothing_half_shown(factories: ModuleType) -> None:
    class Broken:
        def evaluate(self, context: Any) -> None:
            raise KeyError("pose")

    uniques = _pool(factories)
    clip = uniques.add(0)
    _tick(uniques, 1)
    uniques.add(Custom(Broken(), name="mine"))
    with pytest.raises(ValueError, match="'mine': its code raised KeyError"):
        uniques.evaluate(2)
    uniques.commit(2)
    assert _x(uniques, clip) == 0.0


@settings(
    max_examples=20,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(
    trees=st.lists(plain_trees() | machines(), min_size=1, max_size=4),
    time=st.sampled_from([0.0, 0.7]),
    speed=st.sampled_from([1.0, -1.3]),
    plays=st.lists(st.booleans(), min_size=4, max_size=4),
)
def test_a_unique_shows_what_a_stream_with_the_same_tree_shows(
    factories: ModuleType, trees: list[Any], time: float, speed: float, plays: list[bool]
) -> None:
    skeleton = factories.make_body()
    bank = ClipBank(skeleton, make_moves(skeleton))
    pool = StreamPool(skeleton, bank, capacity=4, history=4, uniques=9)
    uniques = UniquePool(pool)
    uniques.add("move 1")  # something else in the batch
    pairs = []
    for tree, other in zip(trees, plays, strict=False):
        pairs.append((pool.add(tree, time=time, speed=speed), uniques.add(tree, time=time)))
        uniques.speed[pairs[-1][1].number] = speed
        if other:
            uniques.add()
    for tick in range(6):
        _tick(uniques, tick)
        for stream, unique in pairs:
            expected = pool.store.ring[pool.store.slice_of(tick), stream.row]
            np.testing.assert_allclose(_palettes(uniques, unique), expected, atol=1e-6)
            assert uniques.phase([unique.number]) == pool.phase([stream.row])
        if tick == 3:
            stream, unique = pairs[0]
            pool.seek(stream, 0.25)
            uniques.seek(unique, 0.25)
