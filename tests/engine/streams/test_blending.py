"""Blends: their weight, their ends, and that nothing jumps on the way."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.components import AgentAnimID, Transition
from tifo.engine.animation import ClipBank
from tifo.engine.streams import StreamPool
from tifo.engine.streams.blending import agent_palettes, begin_blend, blend_weight, end_finished

Array = NDArray[Any]
ALPHAS = np.arange(16) / 16.0
BEGIN = 66


def _weight(begin: int, duration: float, shown: float) -> float:
    columns = np.array([begin], np.int32), np.array([duration], np.float32)
    return float(blend_weight(*columns, shown)[0])


@pytest.mark.parametrize(
    ("shown", "expected"),
    [(0.0, 0.0), (10.0, 0.0), (13.0, 0.15625), (16.0, 0.5), (19.0, 0.84375), (22.0, 1.0), (99, 1)],
)
def test_the_weight_is_a_smooth_step(shown: float, expected: float) -> None:
    # s = 1/4: 3/16 - 2/64 = 0.15625.
    assert _weight(10, 12.0, shown) == pytest.approx(expected)


def test_the_slope_half_way_is_one_and_a_half_over_the_duration() -> None:
    slope = (_weight(10, 12.0, 16.01) - _weight(10, 12.0, 15.99)) / 0.02
    assert slope == pytest.approx(1.5 / 12, rel=1e-3)


def test_without_a_blend_the_target_is_shown() -> None:
    assert _weight(0, 0.0, -5.0) == 1.0
    assert _weight(50, 0.0, 3.0) == 1.0


def _columns(agents: int) -> tuple[AgentAnimID, Transition]:
    return AgentAnimID.allocate(2, agents, 0), Transition.allocate(2, agents)


def _begin(
    anim: AgentAnimID, transition: Transition, agents: list[int], tick: int, duration: float
) -> None:
    count = len(agents)
    begin_blend(
        anim,
        transition,
        0,
        np.array(agents),
        np.full(count, 1, np.int32),
        np.full(count, 5.0, np.float32),
        tick,
        np.full(count, duration, np.float32),
    )


def test_begin_blend_moves_the_old_source_and_leaves_everyone_else() -> None:
    anim, transition = _columns(3)
    anim.row[0], anim.start[0], anim.target[0] = (7, 8, 9), (1, 2, 3), (4, 5, 6)
    anim.t0[0], anim.rate[0] = (20, 21, 22), (0.1, 0.2, 0.3)
    before = {name: getattr(anim, name).copy() for name in ("row", "start", "target", "t0", "rate")}
    _begin(anim, transition, [2, 0], 40, 12.0)
    for name, column in before.items():
        np.testing.assert_array_equal(getattr(transition, name)[0, [0, 2]], column[0, [0, 2]])
        assert getattr(transition, name)[0, 1] == 0
        assert getattr(anim, name)[0, 1] == column[0, 1]
        np.testing.assert_array_equal(getattr(anim, name)[1], column[1])
    assert transition.begin[0].tolist() == [40, 0, 40]
    assert transition.duration[0].tolist() == [12, 0, 12]
    assert anim.row[0].tolist() == [1, 8, 1]
    assert (anim.start[0, 0], anim.target[0, 0], anim.rate[0, 0], anim.t0[0, 0]) == (5, 5, 0, 40)
    assert anim.version == 1


def test_end_finished_waits_until_no_picture_needs_the_blend() -> None:
    anim, transition = _columns(2)
    _begin(anim, transition, [0], 40, 12.0)
    _begin(anim, transition, [1], 40, 12.5)
    # The pictures of tick 52 show times from 51 on, those of tick 53 from 52 on.
    assert end_finished(anim, transition, 52) == 0
    assert anim.version == 2
    assert end_finished(anim, transition, 53) == 1
    assert transition.duration[0].tolist() == [0, 12.5]
    assert end_finished(anim, transition, 54) == 1
    assert end_finished(anim, transition, 55) == 0
    assert anim.version == 4


class Stage:
    """Two streams of a person, and three agents: one blends, one is its source, one its target."""

    def __init__(self, factories: ModuleType) -> None:
        body = factories.make_body()
        clips = [
            factories.make_clip(body, "sit_idle", 1.3),
            factories.make_clip(body, "cheer", 0.7),
        ]
        self.pool = StreamPool(body, ClipBank(body, clips), capacity=2)
        self.source = self.pool.add(0)
        self.pool.add(1, time=0.2)
        self.anim, self.transition = _columns(3)
        self.tick = -1
        self.to(BEGIN - 1)

    def to(self, tick: int) -> None:
        while self.tick < tick:
            self.tick += 1
            self.pool.evaluate(self.tick)
            self.pool.commit(self.tick)

    def set(self, agent: int, row: int, start: float, target: float, rate: float) -> None:
        self.anim.row[0, agent] = row
        self.anim.start[0, agent], self.anim.target[0, agent] = start, target
        self.anim.rate[0, agent], self.anim.t0[0, agent] = rate, BEGIN - 4

    def look(self, tick: int, alpha: float) -> Array:
        """(3, J, 3, 4) palettes of the three agents."""
        agents = np.arange(3)
        return agent_palettes(self.pool, self.anim, self.transition, 0, agents, tick, alpha)


@settings(max_examples=20, deadline=None)
@example(offset=0.0, other=58.0, duration=2.0, rate=0.0)
@example(offset=10.0, other=3.0, duration=12.0, rate=0.25)
@given(
    offset=st.floats(0, 50, width=32),
    other=st.floats(0, 58, width=32),
    duration=st.floats(1, 20, width=32),
    rate=st.sampled_from([0.0, 0.25]),
)
def test_a_blend_is_continuous_and_ends_on_its_target(
    factories: ModuleType, offset: float, other: float, duration: float, rate: float
) -> None:
    stage = Stage(factories)
    for agent in (0, 1):
        stage.set(agent, 0, offset, offset + 8, rate)
    stage.set(2, 1, other, other, 0.0)
    pictures = [stage.look(BEGIN - 1, alpha) for alpha in ALPHAS]
    last = BEGIN + int(duration) + 3
    ended = 0
    for tick in range(BEGIN, last + 1):
        if tick == BEGIN:
            row, to = np.array([1], np.int32), np.array([other], np.float32)
            length = np.array([duration], np.float32)
            agents = np.array([0])
            begin_blend(stage.anim, stage.transition, 0, agents, row, to, tick, length)
        ended += end_finished(stage.anim, stage.transition, tick)
        stage.to(tick)
        pictures += [stage.look(tick, alpha) for alpha in ALPHAS]
    assert ended == 1
    shown = np.array(pictures, float)
    time = np.arange(len(shown)) / len(ALPHAS) + BEGIN - 2
    blender, source, target = shown[:, 0], shown[:, 1], shown[:, 2]
    s = np.clip((time - BEGIN) / duration, 0.0, 1.0)
    weight = (3 * s**2 - 2 * s**3)[:, None, None, None]
    np.testing.assert_allclose(blender, source + (target - source) * weight, atol=1e-4)
    np.testing.assert_array_equal(blender[time <= BEGIN], source[time <= BEGIN])
    np.testing.assert_array_equal(
        blender[time >= BEGIN + duration], target[time >= BEGIN + duration]
    )
    own = np.maximum(np.abs(np.diff(source, axis=0)), np.abs(np.diff(target, axis=0)))
    apart = np.abs(target - source)[1:] * 1.5 / duration / len(ALPHAS)
    assert (np.abs(np.diff(blender, axis=0)) <= own + apart + 1e-4).all()


def test_a_blend_goes_on_over_a_source_that_stops(factories: ModuleType) -> None:
    stage = Stage(factories)
    _begin(stage.anim, stage.transition, [0], BEGIN, 10.0)
    stage.to(BEGIN)
    stage.pool.stop(stage.source)
    stage.to(BEGIN + 5)
    held = stage.pool.store.ring[stage.pool.store.slice_of(BEGIN), 0]
    half = stage.look(BEGIN + 5, 1.0)[0]
    stage.set(2, 1, 5.0, 5.0, 0.0)
    target = stage.look(BEGIN + 5, 1.0)[2]
    np.testing.assert_allclose(half, (held + target) / 2, atol=1e-5)


def test_agents_may_blend_from_the_bind_pose(factories: ModuleType) -> None:
    stage = Stage(factories)
    stage.anim.row[0, 0] = stage.pool.store.bind_row
    _begin(stage.anim, stage.transition, [0], BEGIN, 4.0)
    stage.set(2, 1, 5.0, 5.0, 0.0)
    stage.to(BEGIN + 2)
    blender, _, target = stage.look(BEGIN + 2, 1.0)
    np.testing.assert_allclose(blender, (np.eye(3, 4) + target) / 2, atol=1e-5)
