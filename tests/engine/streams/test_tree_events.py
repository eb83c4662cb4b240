"""Tags of clips in trees reach agents, weighed by the clip's share and by the agent's blend.

A tree that blends two clips must bring what streams with those clips alone bring, each with its
share; the rules for agents are those of plain streams, which are tested for themselves.
"""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.components import AgentAnimID, Transition
from tifo.engine.animation import ClipBank, ClipEvent
from tifo.engine.animation.controllers import Blend2, ClipNode
from tifo.engine.streams import StreamPool
from tifo.engine.streams.blending import begin_blend, end_finished
from tifo.engine.streams.clip_shares import ClipShares
from tifo.engine.streams.dilation import dilate, finish
from tifo.engine.streams.event_delivery import deliver
from tifo.engine.streams.event_feed import ClipEventFeed

AGENTS = 4
SHARES = (0.25, 0.625)
NAMES = ("a0", "b0", "a1", "b1")
SPEED = 30 / 32  # a pose tick is 1/32 s, so tags lie exactly on ticks or between them


class Hall:
    """Two trees of two clips, those four clips alone, and three groups of agents that do the same.

    Rows 0 and 1 are the trees; rows 2 to 5 are clips a0, a1, b0 and b1. Agents 0 to 3 are on the
    trees, 4 to 7 on the first clips, 8 to 11 on the second.
    """

    def __init__(self, factories: ModuleType) -> None:
        clips = []
        for number, name in enumerate(NAMES):
            skeleton, slide = factories.make_slide(seconds=100.0, base=1000.0 * number)
            step = (5, 3, 4, 7)[number]
            tags = [ClipEvent((k + 0.5 * (number == 1)) / 32, name) for k in range(0, 3100, step)]
            clips.append(replace(slide, name=name, events=tuple(tags)))
        # Two tags in one place, one of a name that both clips have.
        both = tuple(ClipEvent(k / 32, "both") for k in range(0, 3100, 10))
        clips[:2] = [replace(clip, events=clip.events + both) for clip in clips[:2]]
        self.pool = StreamPool(skeleton, ClipBank(skeleton, clips), capacity=6, history=20)
        for k, share in enumerate(SHARES):
            self.pool.add(Blend2(ClipNode(f"a{k}"), ClipNode(f"b{k}"), share), speed=SPEED)
        for name in ("a0", "a1", "b0", "b1"):
            self.pool.add(name, speed=SPEED)
        self.anim = AgentAnimID.allocate(1, 3 * AGENTS, 0)
        self.transition = Transition.allocate(1, 3 * AGENTS)
        self.tick = 0

    def groups(self, agent: int) -> np.ndarray:
        return agent + AGENTS * np.arange(3)

    def place(self, agent: int, tree: int, offset: float) -> None:
        who = self.groups(agent)
        self.anim.row[0, who] = self.rows(tree)
        self.anim.start[0, who] = self.anim.target[0, who] = offset

    def rows(self, tree: int) -> np.ndarray:
        return np.array([tree, 2 + tree, 4 + tree], np.int32)

    def step(self) -> list[list[tuple[str, float]]]:
        """Names and weights that each agent gets in the tick under way."""
        self.pool.evaluate(self.tick)
        self.pool.commit(self.tick)
        found = deliver(self.pool, self.anim, self.transition, 0, self.tick)
        assert (np.diff(found.agents) >= 0).all()
        names = self.pool.clip_events.names
        got: list[list[tuple[str, float]]] = [[] for _ in range(3 * AGENTS)]
        for agent, bits, weight in zip(*(c.tolist() for c in found), strict=True):
            got[agent] += [(n, weight) for k, n in enumerate(names) if bits >> k & 1]
        self.tick += 1
        finish(self.pool, self.anim, self.tick)
        end_finished(self.anim, self.transition, self.tick)
        return got


QUARTER = st.integers(0, 72).map(lambda k: k / 4)
ACTION = st.one_of(
    st.tuples(st.just("dilate"), st.integers(0, AGENTS - 1), QUARTER),
    st.tuples(st.just("enter"), st.integers(0, AGENTS - 1), QUARTER),
    st.tuples(st.just("stop"), st.integers(0, 1), st.just(0.0)),
    st.tuples(st.just("run"), st.integers(0, 1), st.just(0.0)),
    st.tuples(st.just("seek"), st.integers(0, 1), QUARTER),
)


@settings(max_examples=25, deadline=None)
@given(plan=st.lists(st.tuples(st.integers(0, 9), ACTION), max_size=12))
def test_a_tree_brings_what_its_clips_bring_with_their_shares(
    factories: ModuleType, plan: list[tuple[int, tuple[str, int, float]]]
) -> None:
    hall = Hall(factories)
    for agent, (tree, offset) in enumerate(((0, 0.0), (0, 3.25), (1, 9.0), (1, 17.75))):
        hall.place(agent, tree, offset)
    hall.anim.t0[0] = -1
    share_of = {"a0": 1 - SHARES[0], "b0": SHARES[0], "a1": 1 - SHARES[1], "b1": SHARES[1]}
    heard = 0
    for wait, (what, which, value) in [*plan, (30, ("none", 0, 0.0))]:
        for _ in range(wait):
            got = hall.step()
            for agent in range(AGENTS):
                expected = []
                for group, side in ((4, "a"), (8, "b")):
                    for name, weight in got[group + agent]:
                        share = share_of[f"{side}0" if name == "both" else name]
                        expected.append((name, pytest.approx(weight * share, abs=1e-6)))
                heard += len(expected)
                assert sorted(got[agent]) == sorted(expected, key=lambda e: (e[0], e[1].expected))
        act(hall, what, which, value)
    assert heard > 0


def act(hall: Hall, what: str, which: int, value: float) -> None:
    if what == "dilate":
        target = np.full(3, value, np.float32)
        dilate(hall.pool, hall.anim, 0, hall.groups(which), target, 0.0, hall.tick)
    elif what == "enter":
        tree = 1 - int(hall.anim.row[0, which])
        offset = min(value, max(int(hall.pool.valid[tree]) - 2, 0))
        begin_blend(
            hall.anim,
            hall.transition,
            0,
            hall.groups(which),
            hall.rows(tree),
            np.full(3, offset, np.float32),
            hall.tick,
            np.full(3, 4.0, np.float32),
        )
    elif what in ("stop", "run", "seek"):
        for row in hall.rows(which).tolist():
            stream = hall.pool.stream(row)
            if what == "seek":
                hall.pool.seek(stream, value)
            else:
                (hall.pool.stop if what == "stop" else hall.pool.run)(stream)


def test_the_share_at_the_clips_own_tick_counts_however_late_it_is_heard(
    factories: ModuleType,
) -> None:
    hall = Hall(factories)
    hall.place(0, 0, 6.0)
    hall.place(1, 1, 0.0)
    got = []
    for tick in range(14):
        # "a0" comes at 0, 5, 10; its share is 0.75, and from tick 7 on 0.5.
        if tick == 7:
            hall.pool.set(hall.pool.stream(0), "amount", 0.5)
        got.append([weight for name, weight in hall.step()[0] if name == "a0"])
    # Everyone sees a stream's first pose at once.
    assert [(tick, weights) for tick, weights in enumerate(got) if weights] == [
        (0, [0.75]),
        (11, [0.75]),
    ]
    assert [w for _ in range(3) for n, w in hall.step()[0] if n == "a0"] == [0.5]


def test_listeners_hear_each_name_with_its_own_weight(factories: ModuleType) -> None:
    hall = Hall(factories)
    hall.place(0, 0, 0.0)
    hall.place(1, 1, 0.0)
    feed = ClipEventFeed(hall.pool.clip_events, np.ones(3 * AGENTS, np.bool_))
    hall.pool.evaluate(0)
    hall.pool.commit(0)
    feed.post(deliver(hall.pool, hall.anim, hall.transition, 0, 0))
    agents, weights = feed.passed("both")
    assert agents[:6].tolist() == [0, 0, 2, 2, 3, 3]
    assert weights[:2].tolist() == [0.75, 0.25]
    agents, weights = feed.passed("a1")
    assert (agents.tolist(), weights.tolist()) == ([1, 5], [0.375, 1.0])


def test_shares_are_found_by_pose_and_forgotten_with_age() -> None:
    shares = ClipShares(4, 8)
    rows, planes, names = np.array([2, 1]), np.array([0, 1]), np.array([5, 63])
    for tick in range(20):
        shares.begin(tick)
        shares.add(tick, rows, planes, names, np.array([0.5, tick / 32]))
    assert len(shares) == 2 * 8
    pose = shares.pose(np.array([15, 12, 15]), np.array([1, 2, 2]), np.array([1, 0, 1]))
    place, bits, share = shares.find(pose)
    assert (place.tolist(), bits.tolist()) == ([0, 1], [1 << 63, 1 << 5])
    assert share.tolist() == [15 / 32, 0.5]
    assert not len(shares.find(shares.pose(np.array([3]), np.array([2]), 0))[0])
    # A tick that begins again is forgotten.
    shares.begin(19)
    assert len(shares) == 2 * 7
