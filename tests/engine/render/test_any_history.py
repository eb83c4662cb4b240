"""Skinned vertices from histories of any length, against every pose that streams ever had.

The oracle keeps all poses of a stream for ever, not a ring, and finds each agent's by the
definition in plain Python, in float64. Two pools with skeletons of different sizes are drawn side
by side.
"""

from __future__ import annotations

from math import floor
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from trees import machines, make_moves, plain_trees

from tifo.components import AgentAnimID, Transition
from tifo.engine.animation import ClipBank, Skeleton
from tifo.engine.streams import StreamPool
from tifo.engine.streams.blending import agent_palettes
from tifo.engine.streams.pool import bind_positions

pytestmark = pytest.mark.gl

HISTORIES = (2, 5, 30, 60, 126, 200, 254)
AGENTS = 40

Array = NDArray[Any]


def make_dancer(factories: ModuleType) -> Skeleton:
    """A body of 19 joints: two or three more behind each of the last."""
    body = factories.make_body()
    parents = [*body.parents, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13]
    more = len(parents) - body.joint_count
    places = [*body.rest_translation, *[np.array([0.05, 0.1, 0.02])] * more]
    names = [*body.names, *(f"extra {k}" for k in range(more))]
    skeleton: Skeleton = factories.make_skeleton(parents, np.array(places), names=names)
    return skeleton


def height(skeleton: Skeleton) -> float:
    return float(np.ptp(bind_positions(skeleton)[:, 1]))


class Hall:
    """A pool of streams with clips and trees, agents anywhere on them, and all poses they had."""

    def __init__(self, skeleton: Skeleton, history: int, capacity: int, trees: list[Any]) -> None:
        self.pool = StreamPool(
            skeleton, ClipBank(skeleton, make_moves(skeleton)), capacity=capacity, history=history
        )
        self.motions = [*trees, "move 0", "move 3", "move 4"][:capacity]
        for row, motion in enumerate(self.motions):
            # Some streams keep less than the pool's own history.
            own = history if row % 3 < 2 else 2 + history // 3
            self.pool.add(motion, time=0.1 * row, history=min(own, history))
        self.anim = AgentAnimID.allocate(1, AGENTS, self.pool.store.bind_row)
        self.transition = Transition.allocate(1, AGENTS)
        self.had: list[dict[int, Array]] = [{} for _ in self.motions]

    def tick(self, tick: int) -> None:
        self.pool.evaluate(tick)
        self.pool.commit(tick)
        for row, had in enumerate(self.had):
            valid, newest = int(self.pool.valid[row]), self.pool.head[row] == tick
            # A stopped stream that was cut has nothing to show until it runs again.
            if valid == 0 or (valid == 1 and newest):
                had.clear()
            if valid > 0 and newest:
                had[tick] = self.pool.store.ring[self.pool.store.slice_of(tick), row].astype(float)

    def disturb(self, rng: np.random.Generator) -> None:
        """Cut or stop a stream."""
        row = int(rng.integers(len(self.motions)))
        stream = self.pool.stream(row)
        what = rng.integers(4)
        if what == 0:
            self.pool.seek(stream, rng.uniform(0, 2))
        elif what == 1:
            self.pool.play(stream, self.motions[int(rng.integers(len(self.motions)))])
        elif what == 2:
            self.pool.stop(stream)
        else:
            self.pool.run(stream)

    def spread(self, rng: np.random.Generator, now: int) -> None:
        """Put agents to offsets up to beyond the history, let some dilate and some blend."""
        longest = int(self.pool.history.max())
        for columns in (self.anim, self.transition):
            columns.row[0] = rng.integers(0, len(self.pool.head) + 1, AGENTS)
            columns.start[0] = rng.uniform(0, longest, AGENTS)
            moves = rng.random(AGENTS) < 0.6
            goal = rng.uniform(0, longest + 3, AGENTS)
            columns.target[0] = np.where(moves, goal, columns.start[0])
            speed = rng.uniform(0.01, 0.95, AGENTS)
            columns.rate[0] = speed * np.sign(columns.target[0] - columns.start[0])
            columns.t0[0] = now + rng.integers(-2 * longest, 4, AGENTS)
        blends = rng.random(AGENTS) < 0.5
        self.transition.duration[0] = np.where(blends, rng.uniform(0.5, 12.0, AGENTS), 0.0)
        self.transition.begin[0] = now + rng.integers(-10, 4, AGENTS)
        self.anim.version += 1

    def expected(self, tick: int, alpha: float) -> Array:
        return np.array([self._agent(agent, tick, alpha) for agent in range(AGENTS)])

    def _agent(self, agent: int, tick: int, alpha: float) -> Array:
        target = self._side(self.anim, agent, tick, alpha)
        duration = float(self.transition.duration[0, agent])
        if duration == 0:
            return target
        s = (tick - 1 + alpha - float(self.transition.begin[0, agent])) / duration
        s = min(max(s, 0.0), 1.0)
        share = s * s * (3 - 2 * s)
        return (1 - share) * self._side(self.transition, agent, tick, alpha) + share * target

    def _side(self, columns: Any, agent: int, tick: int, alpha: float) -> Array:
        row = int(columns.row[0, agent])
        if row >= len(self.had) or not self.had[row]:
            return np.tile(np.eye(3, 4), (self.pool.skeleton.joint_count, 1, 1))
        head = max(self.had[row])
        shown = min(tick - 1 + alpha, head)
        start, target, rate = (
            float(getattr(columns, name)[0, agent]) for name in ("start", "target", "rate")
        )
        offset = start + rate * max(shown - int(columns.t0[0, agent]), 0.0)
        offset = min(max(offset, min(start, target)), max(start, target))
        kept = min(len(self.had[row]), int(self.pool.history[row]))
        time = min(max(shown - offset, head - kept + 1), head)
        before = floor(time)
        after = min(before + 1, head)
        poses = self.had[row]
        return poses[before] + (time - before) * (poses[after] - poses[before])


@pytest.mark.parametrize("history", HISTORIES)
@settings(
    max_examples=4,
    deadline=None,
    phases=[Phase.explicit, Phase.reuse, Phase.generate],  # shrinking would draw for minutes
    suppress_health_check=[
        HealthCheck.function_scoped_fixture,
        HealthCheck.too_slow,
        HealthCheck.data_too_large,
    ],
)
@given(
    other=st.sampled_from(HISTORIES),
    capacities=st.tuples(st.integers(1, 9), st.sampled_from([5, 16, 17])),
    trees=st.lists(plain_trees() | machines(), min_size=2, max_size=4),
    filled=st.sampled_from([0.02, 0.6, 1.3]),
    seed=st.integers(0, 2**32 - 1),
    alphas=st.lists(st.sampled_from([0.0, 1.0]) | st.floats(0, 1), min_size=3, max_size=3),
)
def test_two_skeletons_show_the_same_on_both_sides(
    factories: ModuleType,
    shader_crowd: Any,
    history: int,
    other: int,
    capacities: tuple[int, int],
    trees: list[Any],
    filled: float,
    seed: int,
    alphas: list[float],
) -> None:
    rng = np.random.default_rng(seed)
    halls = [
        Hall(factories.make_body(), history, capacities[0], trees),
        Hall(make_dancer(factories), other, capacities[1], trees),
    ]
    crowds = [shader_crowd((hall.pool, hall.anim, hall.transition)) for hall in halls]
    agents = np.arange(AGENTS)
    # Ring and tables begin at any tick.
    tick = int(rng.integers(0, 10**6))
    for alpha in alphas:
        # Up to more than the longest history between two pictures.
        for _ in range(1 + int(filled * max(history, other))):
            tick += 1
            for hall in halls:
                hall.tick(tick)
        for hall, crowd in zip(halls, crowds, strict=True):
            hall.spread(rng, tick)
            crowd.update(tick)
        for hall, crowd in zip(halls, crowds, strict=True):
            limit = 1e-4 * height(hall.pool.skeleton)
            wanted = hall.expected(tick, alpha)
            on_cpu = agent_palettes(hall.pool, hall.anim, hall.transition, 0, agents, tick, alpha)
            on_gpu = crowd.palettes(agents, tick, alpha)
            np.testing.assert_allclose(on_cpu, wanted, rtol=0, atol=limit)
            np.testing.assert_allclose(on_gpu, wanted, rtol=0, atol=limit)
            hall.disturb(rng)
    for crowd in crowds:
        crowd.delete()
