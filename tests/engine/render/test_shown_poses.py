"""Which poses the shaders show: through the GPU, against what streams had and against the CPU."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import AgentAnimID, Transition
from tifo.engine.animation import ClipBank
from tifo.engine.streams import Stream, StreamPool
from tifo.engine.streams.blending import agent_palettes, begin_blend, end_finished

pytestmark = pytest.mark.gl

HISTORY = 14  # a ring of 16
A, B = 3, 9
ALPHAS = (0.0, 0.5, 1.0)


class Slide:
    """One stream whose joint is at X = the ticks since it began, and two agents behind it."""

    def __init__(self, factories: ModuleType, shader_crowd: Any, offsets: tuple[float, float]):
        skeleton, clip = factories.make_slide()
        self.pool = StreamPool(skeleton, ClipBank(skeleton, [clip]), capacity=2, history=HISTORY)
        self.stream: Stream = self.pool.add(0)
        self.anim = AgentAnimID.allocate(1, 2, self.stream.row)
        self.anim.start[0] = self.anim.target[0] = offsets
        self.crowd = shader_crowd((self.pool, self.anim, Transition.allocate(1, 2)))
        self.had: dict[int, float] = {}

    def tick(self, tick: int) -> None:
        """Evaluate a pose tick and remember what the stream's pose was."""
        self.pool.evaluate(tick)
        self.pool.commit(tick)
        if self.pool.running[self.stream.row]:
            newest = self.pool.store.ring[tick % self.pool.store.capacity, self.stream.row]
            self.had[tick] = float(newest[0, 0, 3])
        self.crowd.update(tick)

    def shown(self, tick: int, alpha: float) -> NDArray[np.float32]:
        """X of both agents, as drawn."""
        x: NDArray[np.float32] = self.crowd.palettes([0, 1], tick, alpha)[:, 0, 0, 3]
        return x

    def at(self, time: float) -> float:
        """X that the stream had at a time between two of its pose ticks."""
        before = int(np.floor(time))
        share = time - before
        if share == 0.0:
            return self.had[before]
        return (1.0 - share) * self.had[before] + share * self.had[before + 1]


@pytest.mark.parametrize("first", [1, 10**6 - 5])
def test_offsets_are_ticks_before_the_shown_time(
    first: int, factories: ModuleType, shader_crowd: Any
) -> None:
    slide = Slide(factories, shader_crowd, (A, B))
    for tick in range(first, first + 40):  # wraps the ring twice
        slide.tick(tick)
        if tick < first + B + 1:
            continue
        for alpha in ALPHAS:
            expected = [slide.at(tick - 1 + alpha - offset) for offset in (A, B)]
            np.testing.assert_allclose(slide.shown(tick, alpha), expected, rtol=0, atol=1e-4)
    assert slide.had[first + 39] == pytest.approx(39.0)


def test_a_stopped_stream_holds_what_its_agents_show(
    factories: ModuleType, shader_crowd: Any
) -> None:
    slide = Slide(factories, shader_crowd, (A, B))
    for tick in range(1, 24):
        slide.tick(tick)
    slide.pool.stop(slide.stream)
    held = [slide.at(23 - A), slide.at(23 - B)]
    for tick in range(24, 60):
        slide.tick(tick)
        for alpha in ALPHAS:
            np.testing.assert_allclose(slide.shown(tick, alpha), held, rtol=0, atol=1e-4)


def test_after_running_again_nothing_from_before_is_shown(
    factories: ModuleType, shader_crowd: Any
) -> None:
    slide = Slide(factories, shader_crowd, (A, B))
    for tick in range(1, 24):
        slide.tick(tick)
    slide.pool.stop(slide.stream)
    for tick in range(24, 30):
        slide.tick(tick)
    # Far from what was before, so that any mix would show.
    slide.pool.seek(slide.stream, 20.0)
    slide.pool.run(slide.stream)
    slide.had.clear()
    for tick in range(30, 64):
        slide.tick(tick)
        for alpha in ALPHAS:
            # The oldest pose since the cut is that of tick 30; before it there is nothing.
            times = [max(tick - 1 + alpha - offset, 30.0) for offset in (A, B)]
            expected = [slide.at(time) for time in times]
            np.testing.assert_allclose(slide.shown(tick, alpha), expected, rtol=0, atol=1e-4)
    assert slide.had[30] == pytest.approx(600.0)


def test_offsets_at_the_end_of_the_history_never_show_a_newer_pose(
    factories: ModuleType, shader_crowd: Any
) -> None:
    slide = Slide(factories, shader_crowd, (HISTORY - 2, HISTORY + 5))
    for tick in range(1, 50):
        slide.tick(tick)
        if tick < HISTORY + 2:
            continue
        for alpha in ALPHAS:
            limit = float(tick - (HISTORY - 1))
            times = [max(tick - 1 + alpha - (HISTORY - 2), limit), limit]
            expected = [slide.at(time) for time in times]
            np.testing.assert_allclose(slide.shown(tick, alpha), expected, rtol=0, atol=1e-4)


AGENTS = 300


class Muddle:
    """A pool with streams in every state and agents with random offsets, dilations and blends."""

    def __init__(self, factories: ModuleType, seed: int, first: int) -> None:
        self.rng = np.random.default_rng(seed)
        character = factories.make_character()
        bank = ClipBank(character.skeleton, character.clips)
        self.pool = StreamPool(character.skeleton, bank, capacity=10, history=HISTORY)
        for row in range(9):
            self.pool.add(row % len(bank.clips), time=float(self.rng.uniform(0, 1)))
        self.stopped = 2
        self.anim = AgentAnimID.allocate(1, AGENTS, self.pool.store.bind_row)
        self.transition = Transition.allocate(1, AGENTS)
        self.now = first
        for _ in range(int(self.rng.integers(3, 40))):
            self.tick()
        self._spread(self.anim)

    def tick(self) -> None:
        """One pose tick, with now and then a cut, a stop or a start."""
        self.now += 1
        pool, event = self.pool, self.rng.random()
        stream = Stream(row := int(self.rng.integers(0, 9)), int(pool.generation[row]))
        if event < 0.08:
            pool.seek(stream, float(self.rng.uniform(0, 1)))
        elif event < 0.16:
            pool.stop(stream)
        elif event < 0.24:
            pool.run(stream)
        pool.evaluate(self.now)
        pool.commit(self.now)

    def change(self) -> None:
        """Half of the agents begin to blend to another row; blends that are over end."""
        end_finished(self.anim, self.transition, self.now)
        free = np.flatnonzero(self.transition.duration[0] == 0)
        agents = free[self.rng.random(len(free)) < 0.5]
        other = AgentAnimID.allocate(1, AGENTS, 0)
        self._spread(other)
        duration = self.rng.uniform(0.5, 12.0, len(agents)).astype(np.float32)
        begin = self.now + int(self.rng.integers(-3, 4))
        begin_blend(
            self.anim,
            self.transition,
            0,
            agents,
            other.row[0, agents],
            other.start[0, agents],
            begin,
            duration,
        )
        for name in ("target", "t0", "rate"):
            getattr(self.anim, name)[0, agents] = getattr(other, name)[0, agents]

    def _spread(self, anim: AgentAnimID) -> None:
        rng = self.rng
        # Row 9 never had a stream, row 10 is the static bind pose.
        anim.row[0] = rng.integers(0, 11, AGENTS)
        anim.start[0] = rng.uniform(0, HISTORY - 2, AGENTS)
        anim.target[0] = np.where(
            rng.random(AGENTS) < 0.3, anim.start[0], rng.uniform(0, HISTORY + 3, AGENTS)
        )
        speed = rng.uniform(0.01, 0.95, AGENTS)
        anim.rate[0] = speed * np.sign(anim.target[0] - anim.start[0])
        anim.t0[0] = self.now + rng.integers(-30, 5, AGENTS)
        anim.version += 1


@pytest.mark.parametrize(
    ("seed", "first"),
    [(1, 0), (2, 0), (3, 2**14 - 20), (4, 2**15 - 15), (5, 10**6), (6, 10**6 + 2**14)],
)
def test_random_crowds_show_the_same_on_both_sides(
    seed: int, first: int, factories: ModuleType, shader_crowd: Any
) -> None:
    muddle = Muddle(factories, seed, first)
    crowd = shader_crowd((muddle.pool, muddle.anim, muddle.transition))
    agents = np.arange(AGENTS)
    blending = 0
    for step in range(24):
        muddle.tick()
        if step % 5 == 0:
            muddle.change()
        crowd.update(muddle.now)
        alpha = float(muddle.rng.choice([0.0, 1.0, muddle.rng.random()]))
        expected = agent_palettes(
            muddle.pool, muddle.anim, muddle.transition, 0, agents, muddle.now, alpha
        )
        shown = crowd.palettes(agents, muddle.now, alpha)
        np.testing.assert_allclose(shown, expected, rtol=0, atol=2e-5)
        blending += int(np.count_nonzero(muddle.transition.duration))
    assert blending > 500


def test_dilation_that_ran_for_an_hour_is_exact(factories: ModuleType, shader_crowd: Any) -> None:
    """Tables count from an origin, so old start ticks and late ones lose nothing."""
    skeleton, clip = factories.make_slide(seconds=8000.0)
    pool = StreamPool(skeleton, ClipBank(skeleton, [clip]), capacity=1, history=60)
    pool.add(0)
    now = 3600 * 30
    for tick in range(now - 62, now + 1):
        pool.evaluate(tick)
        pool.commit(tick)
    anim = AgentAnimID.allocate(1, 3, 0)
    anim.start[0] = 0.0
    anim.target[0] = 40.0
    anim.t0[0] = 0, now - 20, now - 2000
    anim.rate[0] = 40.0 / now, 0.25, 0.015
    crowd = shader_crowd((pool, anim, Transition.allocate(1, 3)))
    crowd.update(now)
    for alpha in ALPHAS:
        shown = now - 1 + alpha
        since = shown - anim.t0[0]
        offsets = anim.rate[0].astype(float) * since
        expected = shown - offsets - (now - 62)
        actual = crowd.palettes([0, 1, 2], now, alpha)[:, 0, 0, 3]
        np.testing.assert_allclose(actual, expected, rtol=0, atol=2e-3)
