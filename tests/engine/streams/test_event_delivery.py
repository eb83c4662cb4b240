"""Clip events reach agents once, when they play the pose, against a model agent by agent."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.components import AgentAnimID, Transition
from tifo.engine.animation import ClipBank, ClipEvent
from tifo.engine.streams import StreamPool
from tifo.engine.streams.blending import begin_blend, end_finished
from tifo.engine.streams.dilation import dilate, finish
from tifo.engine.streams.event_delivery import Delivered, deliver

AGENTS = 4


class Hall:
    """Two streams with tags every few ticks, and agents whose events are followed."""

    def __init__(self, factories: ModuleType, history: int = 20) -> None:
        skeleton, clip = factories.make_slide(seconds=100.0)
        # A pose tick is 1/32 s at this speed, so tags lie exactly on ticks or between them.
        every = [ClipEvent(k / 32, "even") for k in range(0, 3200, 5)]
        odd = [ClipEvent(k / 32 + 1 / 64, "odd") for k in range(0, 3200, 3)]
        tagged = replace(clip, events=(*every, *odd))
        self.pool = StreamPool(skeleton, ClipBank(skeleton, [tagged]), capacity=2, history=history)
        self.streams = [self.pool.add(0, speed=30 / 32), self.pool.add(0, time=1.0, speed=30 / 32)]
        self.anim = AgentAnimID.allocate(1, AGENTS, 0)
        self.transition = Transition.allocate(1, AGENTS)
        self.tick = 0

    def step(self, *, blends: bool = True) -> Delivered:
        """Evaluate the tick under way and deliver its events, with those of blends' sources."""
        self.pool.evaluate(self.tick)
        self.pool.commit(self.tick)
        if not blends:
            self.transition.duration[:] = 0.0
        found = deliver(self.pool, self.anim, self.transition, 0, self.tick)
        self.tick += 1
        finish(self.pool, self.anim, self.tick)
        end_finished(self.anim, self.transition, self.tick)
        return found

    def rest(self, offset: float, row: int = 0) -> None:
        self.anim.row[0] = row
        self.anim.start[0] = self.anim.target[0] = offset

    def enter(self, agent: int, row: int, offset: float, duration: float) -> None:
        begin_blend(
            self.anim,
            self.transition,
            0,
            np.array([agent]),
            np.array([row], np.int32),
            np.array([offset], np.float32),
            self.tick,
            np.array([duration], np.float32),
        )


def _even(found: Delivered, agent: int = 0) -> list[float]:
    mine = (found.agents == agent) & ((found.bits & np.uint64(1)) != 0)
    return found.weights[mine].tolist()


def _ticks(hall: Hall, count: int, agent: int = 0) -> list[int]:
    """Ticks in which the agent gets "even"."""
    got = []
    for _ in range(count):
        tick = hall.tick
        got += [tick] * len(_even(hall.step(), agent))
    return got


@pytest.mark.parametrize(
    ("offset", "expected"),
    [(0.0, [0, 5, 10, 15, 20]), (7.0, [0, 12, 17, 22]), (7.25, [0, 13, 18, 23])],
)
def test_a_resting_agent_gets_events_when_it_plays_their_pose(
    factories: ModuleType, offset: float, expected: list[int]
) -> None:
    hall = Hall(factories)
    hall.rest(offset)
    # The first pose is shown to everybody from the start, and waited at.
    assert _ticks(hall, 24) == expected


def test_an_entry_at_the_events_pose_gets_it_and_a_later_one_does_not(
    factories: ModuleType,
) -> None:
    for offset, first in ((5.0, 20), (4.75, 25), (5.25, 21)):
        hall = Hall(factories)
        hall.rest(0.0, row=1)
        _ticks(hall, 20)
        # The event of tick 15 lies 5 poses behind at tick 20.
        hall.enter(0, 0, offset, 1e-3)
        hall.transition.duration[0] = 0.0
        got = _ticks(hall, 8)
        assert got[0] == first, offset


def test_a_growing_offset_delays_events_and_a_shrinking_one_hastens_them(
    factories: ModuleType,
) -> None:
    hall = Hall(factories)
    hall.rest(4.0)
    _ticks(hall, 20)
    dilate(hall.pool, hall.anim, 0, np.array([0]), np.array([8.0], np.float32), 0.0, hall.tick)
    # From t0 = 19: o = 4 + (n - 19) / 4, u = 0.75 n + 0.75: 20 at 25.67 -> 26, 25 at 32.3 -> 33.
    assert _ticks(hall, 14) == [26, 33]
    hall = Hall(factories)
    hall.rest(8.0)
    _ticks(hall, 20)
    dilate(hall.pool, hall.anim, 0, np.array([0]), np.array([0.0], np.float32), 0.0, hall.tick)
    # o = 8 - (n - 19) / 4: u reaches 15 at n = 22.2 -> 23, 20 at 26.2 -> 27, 25 at 30.2 -> 31.
    assert _ticks(hall, 13) == [23, 27, 31]


def test_leaving_drops_what_is_pending_and_both_sides_of_a_blend_count(
    factories: ModuleType,
) -> None:
    hall = Hall(factories)
    hall.rest(2.0)
    _ticks(hall, 18)
    hall.enter(0, 1, 0.0, 8.0)
    source, target = [], []
    for tick in range(18, 34):
        s = min(max((tick - 18) / 8, 0.0), 1.0)
        share = s * s * (3 - 2 * s)
        # "even" of stream 0 comes at 5 k + 2; stream 1 is 32 poses ahead: 5 k + 3.
        got = _even(hall.step())
        expected = []
        if tick % 5 == 3:
            expected.append(pytest.approx(share))
            target.append(tick)
        if tick % 5 == 2 and share < 1:
            expected.append(pytest.approx(1 - share))
            source.append(tick)
        assert sorted(got) == sorted(expected), tick
    assert source == [22]
    assert target == [18, 23, 28, 33]


def test_stopping_holds_and_a_cut_drops(factories: ModuleType) -> None:
    hall = Hall(factories)
    hall.rest(4.0)
    _ticks(hall, 17)
    hall.pool.stop(hall.streams[0])
    assert _ticks(hall, 30) == []
    hall.pool.run(hall.streams[0])
    # The event of tick 15 was pending at 16; that of 20 is 4 ticks on, and the agent 4 behind it.
    assert _ticks(hall, 20) == [55, 60, 65]


def test_a_name_that_is_passed_twice_arrives_twice(factories: ModuleType) -> None:
    hall = Hall(factories)
    hall.rest(3.0)
    _ticks(hall, 10)
    hall.pool.speed[0] = 30 / 32 * 10
    counts = [len(_even(hall.step())) for _ in range(6)]
    # Ten clip ticks a pose tick from tick 10 on, three ticks later for the agent.
    assert counts[3:] == [2, 2, 2]


def test_agents_on_no_stream_have_no_events(factories: ModuleType) -> None:
    hall = Hall(factories)
    hall.rest(0.0, row=hall.pool.store.bind_row)
    hall.anim.rate[0, 0] = 0.25
    assert all(len(hall.step().agents) == 0 for _ in range(12))


QUARTER = st.integers(0, 72).map(lambda k: k / 4)
ACTION = st.one_of(
    st.tuples(st.just("dilate"), st.integers(0, AGENTS - 1), QUARTER),
    st.tuples(st.just("enter"), st.integers(0, AGENTS - 1), QUARTER),
    st.tuples(st.just("stop"), st.integers(0, 1), st.just(0.0)),
    st.tuples(st.just("run"), st.integers(0, 1), st.just(0.0)),
    st.tuples(st.just("seek"), st.integers(0, 1), QUARTER),
)


class Follower:
    """The rule of the page, for one side of one agent, with exact numbers and a memory."""

    def __init__(self, hall: Hall) -> None:
        self.hall = hall
        self.history: list[dict[int, list[str]]] = [{}, {}]
        self.cut = [-1, -1]
        self.since: list[Fraction] = []
        self.got: list[set[tuple[int, str]]] = [set() for _ in range(AGENTS)]

    def note(self, tick: int) -> None:
        """Write down what the streams passed in this tick, and their cuts."""
        pool = self.hall.pool
        for row in (0, 1):
            if pool.head[row] == tick and pool.valid[row] == 1:
                self.history[row] = {}
                self.cut[row] = tick
            if pool.head[row] == tick:
                bits = int(pool.clip_events.planes[0, pool.store.slice_of(tick), row])
                names = [n for k, n in enumerate(("even", "odd")) if bits >> k & 1]
                self.history[row][tick] = names

    def expect(self, agent: int, tick: int) -> list[str]:
        anim, pool = self.hall.anim, self.hall.pool
        row = int(anim.row[0, agent])
        shown = min(tick, int(pool.head[row]))
        first = int(pool.head[row]) - int(pool.valid[row]) + 1
        start, target, rate = (
            Fraction(float(column[0, agent])) for column in (anim.start, anim.target, anim.rate)
        )
        low, high = sorted((start, target))
        moved = start + rate * max(shown - int(anim.t0[0, agent]), 0)
        now = max(shown - min(max(moved, low), high), Fraction(first))
        if anim.t0[0, agent] == tick:
            self.got[agent] = {(e, n) for e, names in self.history[row].items() for n in names}
            self.got[agent] = {(e, n) for e, n in self.got[agent] if e < now}
        elif self.cut[row] == tick:
            self.got[agent] = set()
        if pool.head[row] != tick:
            return []
        due = [
            (e, n)
            for e, names in self.history[row].items()
            for n in names
            if first <= e <= now and (e, n) not in self.got[agent]
        ]
        self.got[agent] |= set(due)
        return sorted(n for _, n in due)


@settings(max_examples=60, deadline=None)
@given(plan=st.lists(st.tuples(st.integers(0, 9), ACTION), max_size=12))
def test_every_event_reaches_every_agent_once(
    factories: ModuleType, plan: list[tuple[int, tuple[str, int, float]]]
) -> None:
    hall = Hall(factories)
    hall.anim.start[0] = hall.anim.target[0] = (0.0, 3.25, 9.0, 17.75)
    hall.anim.row[0] = (0, 0, 1, 1)
    hall.anim.t0[0] = -1
    follower = Follower(hall)
    waits = [(wait, action) for wait, action in plan] + [(25, ("none", 0, 0.0))]
    for wait, (what, which, value) in waits:
        for _ in range(wait):
            tick = hall.tick
            found = hall.step(blends=False)
            follower.note(tick)
            for agent in range(AGENTS):
                names = sorted(
                    name
                    for bits in found.bits[found.agents == agent].tolist()
                    for k, name in enumerate(("even", "odd"))
                    if bits >> k & 1
                )
                assert names == follower.expect(agent, tick), (tick, agent)
        _act(hall, what, which, value)


def _act(hall: Hall, what: str, which: int, value: float) -> None:
    if what == "dilate":
        target = np.array([value], np.float32)
        dilate(hall.pool, hall.anim, 0, np.array([which]), target, 0.0, hall.tick)
    elif what == "enter":
        row = 1 - int(hall.anim.row[0, which])
        longest = max(int(hall.pool.valid[row]) - 2, 0)
        hall.enter(which, row, min(value, longest), 4.0)
    elif what == "stop":
        hall.pool.stop(hall.streams[which])
    elif what == "run":
        hall.pool.run(hall.streams[which])
    elif what == "seek":
        hall.pool.seek(hall.streams[which], value)
