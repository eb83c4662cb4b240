"""Offsets that change at runtime: rates, spreads and histories, and that nothing ever jumps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.components import AgentAnimID, Transition
from tifo.engine.streams import StreamPool
from tifo.engine.streams.blending import begin_blend
from tifo.engine.streams.dilation import (
    FASTEST,
    change_rate,
    dilate,
    finish,
    shown_offsets,
    shrink_histories,
    spread,
    start_stream,
)
from tifo.engine.streams.displayed import ages, read_palettes, shown_poses
from tifo.engine.streams.stream_needs import StreamNeeds

SlidePool = Callable[..., StreamPool]
ALPHAS = np.arange(4) / 4.0


class Stand:
    """Agents on the first stream of a pool, looked at between all ticks."""

    def __init__(self, pool: StreamPool, agents: int, first_tick: int = 0) -> None:
        self.pool = pool
        self.stream = pool.add(0)
        self.anim = AgentAnimID.allocate(2, agents, self.stream.row)
        self.transition = Transition.allocate(2, agents)
        self.tick = first_tick
        self.shown: list[NDArray[np.float32]] = []
        self.arrived = 0

    def run(self, ticks: int) -> None:
        for _ in range(ticks):
            self.arrived += finish(self.pool, self.anim, self.tick)
            shrink_histories(self.pool, self.anim, self.transition, self.tick)
            self.pool.evaluate(self.tick)
            self.pool.commit(self.tick)
            self._look()
            self.tick += 1

    def _look(self) -> None:
        columns = (self.anim.start[0], self.anim.target[0], self.anim.t0[0], self.anim.rate[0])
        row = self.anim.row[0].astype(np.int64)
        for alpha in ALPHAS:
            places = shown_poses(self.pool, row, *columns, self.tick, float(alpha))
            self.shown.append(read_palettes(self.pool, places)[:, 0, 0, 3])
            # What the limit on the age never needs to hide.
            age = ages(self.pool, row, *columns, self.tick, float(alpha))
            full = self.pool.valid[row] > 2
            assert (age[full] <= self.pool.valid[row][full] - 1 + 1e-4).all()

    def dilate(self, agent: int, target: float, seconds: float) -> None:
        targets = np.array([target], np.float32)
        dilate(self.pool, self.anim, 0, np.array([agent]), targets, seconds, self.tick)

    def offsets(self) -> list[float]:
        agents = np.arange(self.anim.row.shape[1])
        return shown_offsets(self.pool, self.anim, 0, agents, self.tick).tolist()

    def steps(self) -> NDArray[np.float64]:
        """Speed between pictures: 1 where offsets rest."""
        return np.diff(np.array(self.shown, float), axis=0) * len(ALPHAS)


def test_the_rate_of_the_source() -> None:
    assert change_rate(60, 0, 8.0) == 0.25
    assert change_rate(30, 60, 4.0) == -0.25
    assert change_rate(10, 0, 1.0, pose_rate=10.0) == 1.0
    assert change_rate(10, 10, 0.0) == 0.0
    assert change_rate(10, 0, 0.0) == np.inf


@pytest.mark.parametrize(("new", "seconds"), [(10, -1.0), (np.nan, 1.0), (10, np.inf)])
def test_rates_of_nonsense_are_refused(new: float, seconds: float) -> None:
    with pytest.raises(ValueError, match="seconds is"):
        change_rate(new, 0, seconds)


def test_an_offset_arrives_when_it_was_asked_to(slide_pool: SlidePool) -> None:
    stand = Stand(slide_pool(capacity=1), 2)
    stand.run(70)
    stand.dilate(0, 12.0, 2.0)
    assert stand.anim.rate[0].tolist() == pytest.approx([0.2, 0.0])
    stand.run(60)
    assert stand.offsets() == pytest.approx([12.0, 0.0], abs=1e-5)
    stand.run(2)
    assert stand.arrived == 1
    assert (stand.anim.start[0, 0], stand.anim.rate[0, 0]) == (12.0, 0.0)


def test_a_time_that_is_too_short_is_lengthened_and_reported(slide_pool: SlidePool) -> None:
    stand = Stand(slide_pool(capacity=1), 3)
    stand.run(70)
    targets = np.array([30.0, 2.0, 0.0], np.float32)
    done = dilate(stand.pool, stand.anim, 0, np.arange(3), targets, 1.0, stand.tick)
    assert (done.moving, done.lengthened) == (2, 1)
    assert done.ticks == pytest.approx(30 / FASTEST)
    assert stand.anim.rate[0].tolist() == pytest.approx([0.25, 2 / 30, 0.0])


def test_nothing_new_is_to_be_copied_while_offsets_move_and_arrive(slide_pool: SlidePool) -> None:
    stand = Stand(slide_pool(capacity=1), 1)
    stand.run(70)
    stand.dilate(0, 5.0, 1.0)
    version = stand.anim.version
    stand.run(40)
    assert stand.arrived == 1
    assert stand.anim.version == version


def test_agents_of_a_stream_that_starts_begin_together_and_drift_apart(
    slide_pool: SlidePool,
) -> None:
    stand = Stand(slide_pool(capacity=2), 50)
    stand.run(5)
    other = stand.pool.add(1)
    rng = np.random.default_rng(4)
    done = start_stream(
        stand.pool,
        stand.anim,
        other,
        np.arange(50),
        seconds=8.0,
        tick=5,
        rng=rng,
        parts=(0, 1),
    )
    assert done.lengthened == 0
    np.testing.assert_array_equal(stand.anim.target[0], stand.anim.target[1])
    assert np.ptp(stand.anim.target[0]) > 40
    assert 0 <= stand.anim.target.min() <= stand.anim.target.max() <= 58
    # One rate for all: the farthest arrives after 8 s.
    assert stand.anim.rate[0] == pytest.approx(stand.anim.target.max() / 240, rel=1e-5)
    assert (stand.anim.start == 0).all()
    stand.run(241)
    np.testing.assert_allclose(stand.offsets(), stand.anim.target[0], atol=1e-3)
    steps = stand.steps()[6 * len(ALPHAS) :]
    assert steps.min() >= 0.75 - 1e-2
    assert steps.max() <= 1.0 + 1e-2


def test_parts_may_drift_apart_from_each_other(slide_pool: SlidePool) -> None:
    stand = Stand(slide_pool(capacity=2), 20)
    other = stand.pool.add(1)
    start_stream(
        stand.pool,
        stand.anim,
        other,
        np.arange(20),
        seconds=4.0,
        tick=0,
        rng=np.random.default_rng(4),
        parts=(0, 1),
        together=False,
    )
    assert (stand.anim.target[0] != stand.anim.target[1]).any()


def test_a_stream_with_a_past_is_not_started_again(slide_pool: SlidePool) -> None:
    stand = Stand(slide_pool(capacity=1), 1)
    stand.run(5)
    with pytest.raises(ValueError, match="has been running for 5 poses"):
        start_stream(
            stand.pool,
            stand.anim,
            stand.stream,
            np.arange(1),
            seconds=1.0,
            tick=5,
            rng=np.random.default_rng(1),
        )


@pytest.mark.parametrize(
    ("target", "seconds", "fastest", "message"),
    [
        (58.5, 1.0, 0.25, "expected 0 to 58 poses"),
        (-1.0, 1.0, 0.25, "expected 0 to 58 poses"),
        (np.nan, 1.0, 0.25, "expected 0 to 58 poses"),
        (5.0, -1.0, 0.25, "seconds is -1.0"),
        (5.0, np.nan, 0.25, "seconds is nan"),
        (5.0, 1.0, 1.0, "fastest is 1.0"),
        (5.0, 1.0, 0.0, "fastest is 0.0"),
    ],
)
def test_impossible_dilations_are_refused(
    slide_pool: SlidePool, target: float, seconds: float, fastest: float, message: str
) -> None:
    stand = Stand(slide_pool(capacity=1), 1)
    targets = np.array([target], np.float32)
    with pytest.raises(ValueError, match=message):
        dilate(stand.pool, stand.anim, 0, np.arange(1), targets, seconds, 0, fastest=fastest)


def test_who_is_on_no_stream_has_no_offset(slide_pool: SlidePool) -> None:
    stand = Stand(slide_pool(capacity=1), 1)
    stand.anim.row[:] = stand.pool.store.bind_row
    with pytest.raises(ValueError, match="on no stream"):
        stand.dilate(0, 1.0, 1.0)


CHANGE = st.tuples(
    st.integers(0, 30), st.integers(0, 2), st.floats(0, 58, width=32), st.floats(0, 3)
)


@settings(max_examples=15, deadline=None)
@given(plan=st.lists(CHANGE, max_size=8), before=st.integers(1, 70))
def test_displayed_time_never_jumps_and_never_runs_back(
    slide_pool: SlidePool, plan: list[tuple[int, int, float, float]], before: int
) -> None:
    stand = Stand(slide_pool(capacity=1), 3)
    stand.run(before)
    for wait, agent, target, seconds in plan:
        stand.dilate(agent, target, seconds)
        stand.run(wait)
    stand.run(20)
    steps = stand.steps()
    assert steps.max() <= 1.25 + 1e-2
    # While the stream has no past, agents wait at its first pose.
    assert steps.min() >= -1e-3
    assert steps[2 * len(ALPHAS) :].min() >= 0.75 - 1e-2


@settings(max_examples=8, deadline=None)
@given(
    offsets=st.lists(st.floats(0, 58, width=32), min_size=3, max_size=3),
    histories=st.lists(st.tuples(st.integers(2, 62), st.integers(0, 60)), min_size=1, max_size=5),
)
def test_a_history_that_changes_moves_nobody_abruptly(
    slide_pool: SlidePool, offsets: list[float], histories: list[tuple[int, int]]
) -> None:
    stand = Stand(slide_pool(capacity=1), 3)
    stand.anim.start[0] = stand.anim.target[0] = offsets
    stand.run(65)
    settled = len(stand.shown)
    for history, ticks in histories:
        stand.pool.set_history(stand.stream, history)
        stand.run(ticks)
    stand.run(260)
    steps = stand.steps()[settled:]
    assert steps.max() <= 1.25 + 1e-2
    assert steps.min() >= 0.75 - 1e-2
    last = histories[-1][0]
    assert stand.pool.history[0] == last
    assert stand.pool.valid[0] == last
    assert max(stand.offsets()) <= last - 2 + 1e-4


def test_the_limit_falls_as_the_farthest_agent_arrives(slide_pool: SlidePool) -> None:
    stand = Stand(slide_pool(capacity=1), 2)
    stand.anim.start[0] = stand.anim.target[0] = (5.0, 50.0)
    stand.run(70)
    stand.pool.set_history(stand.stream, 12)
    assert stand.pool.room(np.array([0])).tolist() == [10.0]
    stand.run(1)
    assert stand.pool.history[0] == 52
    assert stand.anim.rate[0].tolist() == [0.0, -0.25]
    stand.run(40)
    # 40 ticks at a quarter of a pose.
    assert stand.offsets()[1] == pytest.approx(40.0, abs=0.3)
    assert 41 <= stand.pool.history[0] <= 43
    stand.run(130)
    assert stand.offsets() == pytest.approx([5.0, 10.0])
    assert stand.pool.history[0] == 12


def test_a_blends_source_keeps_its_history(slide_pool: SlidePool) -> None:
    stand = Stand(slide_pool(capacity=2), 1)
    stand.pool.add(1)
    stand.anim.start[0] = stand.anim.target[0] = 50.0
    stand.run(70)
    one = np.array([0])
    begin_blend(
        stand.anim,
        stand.transition,
        0,
        one,
        np.array([1], np.int32),
        np.array([3], np.float32),
        stand.tick,
        np.array([20], np.float32),
    )
    stand.anim.row[1] = 1
    stand.pool.set_history(stand.stream, 12)
    stand.run(10)
    assert stand.pool.history[0] == 52
    stand.transition.duration[:] = 0.0
    stand.run(1)
    assert stand.pool.history[0] == 12


@pytest.mark.parametrize("history", [1, 63])
def test_a_history_must_fit_the_ring(slide_pool: SlidePool, history: int) -> None:
    stand = Stand(slide_pool(capacity=1), 1)
    with pytest.raises(ValueError, match=f"history is {history}, expected 2 to 62"):
        stand.pool.set_history(stand.stream, history)


class Need:
    """Two streams under the policy, and agents that are put on either."""

    def __init__(self, pool: StreamPool) -> None:
        self.pool = pool
        self.streams = [pool.add(0), pool.add(1)]
        self.anim = AgentAnimID.allocate(1, 4, 0)
        self.transition = Transition.allocate(1, 4)
        self.needs = StreamNeeds(2, patience=0.5, seconds=4.0)
        self.tick = 0

    def run(self, ticks: int) -> None:
        for _ in range(ticks):
            self.needs.update(self.pool, self.anim, self.transition, self.tick)
            self.pool.evaluate(self.tick)
            self.pool.commit(self.tick)
            self.tick += 1


def test_a_stream_that_nobody_shows_rests_after_a_while(slide_pool: SlidePool) -> None:
    need = Need(slide_pool(capacity=2))
    need.run(16)
    assert need.pool.running.tolist() == [True, True]
    need.run(1)
    assert need.pool.running.tolist() == [True, False]
    assert need.needs.resting.tolist() == [False, True]


def test_a_blends_source_is_shown(slide_pool: SlidePool) -> None:
    need = Need(slide_pool(capacity=2))
    need.transition.row[0, 2], need.transition.duration[0, 2] = 1, 9.0
    need.run(40)
    assert need.pool.running.all()


def test_agents_put_on_a_resting_stream_begin_at_its_head(slide_pool: SlidePool) -> None:
    need = Need(slide_pool(capacity=2))
    need.run(80)
    need.anim.row[0, 1:] = 1
    need.anim.start[0, 1:] = need.anim.target[0, 1:] = (10.0, 20.0, 58.0)
    need.run(1)
    assert need.pool.running.all()
    assert need.pool.valid[1] == 1
    assert need.anim.start[0].tolist() == [0.0] * 4
    assert need.anim.target[0].tolist() == [0.0, 10.0, 20.0, 58.0]
    # 58 poses in 4 s would be seen; a quarter of a pose a tick is not.
    assert need.anim.rate[0].tolist() == [0.0, 0.25, 0.25, 0.25]
    assert need.needs.resting.tolist() == [False, False]


def test_a_stream_that_the_user_stopped_stays_so(slide_pool: SlidePool) -> None:
    need = Need(slide_pool(capacity=2))
    need.pool.stop(need.streams[1])
    need.run(80)
    need.anim.row[0, 1] = 1
    need.run(5)
    assert need.pool.running.tolist() == [True, False]


def test_some_streams_never_rest(slide_pool: SlidePool) -> None:
    need = Need(slide_pool(capacity=2))
    need.needs = StreamNeeds(2, patience=0.5, always=np.array([False, True]))
    need.run(80)
    assert need.pool.running.all()


def test_spreading_nobody_is_nothing(slide_pool: SlidePool) -> None:
    stand = Stand(slide_pool(capacity=1), 1)
    nobody = np.zeros(0, np.int64)
    done = spread(stand.pool, stand.anim, 0, nobody, np.zeros(0, np.float32), 1.0, 0)
    assert done == (0, 0, 0.0)
