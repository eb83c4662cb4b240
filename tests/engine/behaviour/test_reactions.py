"""Who answers an event, with what, how soon and for how long."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tifo.components.motion import NEVER
from tifo.engine.behaviour import BallHit, Goal, settle
from tifo.engine.crowd.motions import Role

TICK = 100
PLACE = (20.0, 8.0, -16.0)


@pytest.mark.parametrize("scorer", [0, 1])
def test_nearly_all_of_the_own_side_cheer(crowd: Any, scorer: int) -> None:
    reacting = crowd.answer(Goal(scorer), TICK)
    own = crowd.supporters(scorer)
    joined = np.intersect1d(own, reacting)
    assert len(joined) / len(own) == pytest.approx(0.97, abs=0.02)
    assert crowd.has_role(crowd.state.reaction[joined], Role.CHEER).all()


@pytest.mark.parametrize("scorer", [0, 1])
def test_about_half_of_the_other_side_are_dismayed_and_nobody_there_cheers(
    crowd: Any, scorer: int
) -> None:
    reacting = crowd.answer(Goal(scorer), TICK)
    other = crowd.supporters(1 - scorer)
    joined = np.intersect1d(other, reacting)
    assert len(joined) / len(other) == pytest.approx(0.55, abs=0.05)
    assert crowd.has_role(crowd.state.reaction[joined], Role.DISMAY).all()


def test_neutrals_applaud(crowd: Any) -> None:
    reacting = crowd.answer(Goal(0), TICK)
    neutral = crowd.supporters(-1)
    joined = np.intersect1d(neutral, reacting)
    assert len(joined) / len(neutral) == pytest.approx(0.6, abs=0.06)
    assert crowd.has_role(crowd.state.reaction[joined], Role.APPLAUD).all()


def test_absent_agents_do_nothing(crowd: Any) -> None:
    for event in (Goal(0), Goal(1), BallHit(PLACE)):
        assert crowd.present[crowd.answer(event, TICK)].all()
    absent = ~crowd.present
    assert (crowd.state.react_at[absent] == NEVER).all()
    assert (crowd.state.calm_at[absent] == NEVER).all()


def test_agents_that_do_not_react_are_left_alone(crowd: Any) -> None:
    reacting = crowd.answer(Goal(0), TICK)
    assert len(np.unique(reacting)) == len(reacting)
    planned = np.zeros(len(crowd.present), bool)
    planned[reacting] = True
    np.testing.assert_array_equal(crowd.state.react_at != NEVER, planned)
    np.testing.assert_array_equal(crowd.state.calm_at != NEVER, planned)
    assert (crowd.state.wanted == crowd.state.innate).all()


@pytest.mark.parametrize(
    ("side", "delay", "length", "blend"),
    [
        (0, (0.15, 0.9), (9.0, 20.0), 12.0),
        (1, (0.3, 1.4), (2.5, 6.0), 12.0),
        (-1, (0.5, 2.0), (4.0, 9.0), 12.0),
    ],
)
def test_delays_and_lengths_fill_their_ranges(
    crowd: Any, side: int, delay: tuple[float, float], length: tuple[float, float], blend: float
) -> None:
    reacting = np.intersect1d(crowd.answer(Goal(0), TICK), crowd.supporters(side))
    waits = (crowd.state.react_at[reacting] - TICK) / 30.0
    lasts = (crowd.state.calm_at[reacting] - crowd.state.react_at[reacting]) / 30.0
    # Ticks are whole: a thirtieth of a second either way.
    assert waits.min() >= delay[0] - 1 / 30
    assert waits.max() <= delay[1]
    assert lasts.min() >= length[0] - 1 / 30
    assert lasts.max() <= length[1] + 1 / 30
    assert np.ptp(waits) > 0.9 * (delay[1] - delay[0])
    assert np.ptp(lasts) > 0.9 * (length[1] - length[0])
    assert waits.mean() == pytest.approx(sum(delay) / 2, abs=0.1)
    assert lasts.mean() == pytest.approx(sum(length) / 2, abs=0.5)
    assert (crowd.state.blend[reacting] == blend).all()


def _distance(crowd: Any) -> Any:
    """Metres from where the ball lands to a point 1 m above everyone's feet."""
    x, y, z = crowd.placement.position.astype(float)
    return np.sqrt((x - PLACE[0]) ** 2 + (y + 1.0 - PLACE[1]) ** 2 + (z - PLACE[2]) ** 2)


def test_a_ball_hits_those_within_reach_and_others_see_it(crowd: Any) -> None:
    reacting = crowd.answer(BallHit(PLACE), TICK)
    distance = _distance(crowd)
    hit = np.flatnonzero(crowd.present & (distance <= 1.2))
    near = np.flatnonzero(crowd.present & (distance > 1.2) & (distance <= 7.0))
    assert len(hit) > 3
    assert np.isin(hit, reacting).all()
    assert distance[reacting].max() <= 7.0
    assert crowd.has_role(crowd.state.reaction[hit], Role.DISMAY).all()
    assert (crowd.state.react_at[hit] <= TICK + 1).all()
    assert (crowd.state.blend[hit] == 6.0).all()
    seen = np.intersect1d(near, reacting)
    assert len(seen) / len(near) == pytest.approx(0.7, abs=0.1)
    assert crowd.has_role(crowd.state.reaction[seen], Role.CHEER).all()


def test_a_ball_that_lands_elsewhere_moves_nobody(crowd: Any) -> None:
    reacting = crowd.answer(BallHit((0.0, 0.0, 500.0)), TICK)
    assert reacting.dtype == np.int64
    assert len(reacting) == 0


def test_reactions_begin_and_end_at_their_ticks(crowd: Any) -> None:
    reacting = crowd.answer(Goal(0), TICK)
    state = crowd.state
    begin, end = state.react_at.copy(), state.calm_at.copy()
    for tick in range(TICK, TICK + 660):
        settle(state, tick)
        busy = (begin <= tick) & (tick < end)
        np.testing.assert_array_equal(state.wanted[busy], state.reaction[busy])
        np.testing.assert_array_equal(state.wanted[~busy], state.innate[~busy])
    assert (state.react_at == NEVER).all()
    assert (state.calm_at == NEVER).all()
    # Calming down takes 0.6 s, for those that reacted.
    assert (state.blend[reacting] == 18.0).all()
    others = np.setdiff1d(np.arange(len(state.blend)), reacting)
    assert (state.blend[others] == 12.0).all()


def test_a_second_goal_before_the_first_is_over_is_answered_too(crowd: Any) -> None:
    crowd.answer(Goal(0), TICK)
    for tick in range(TICK, TICK + 60):
        settle(crowd.state, tick)
    crowd.answer(Goal(1), TICK + 60)
    for tick in range(TICK + 60, TICK + 100):
        settle(crowd.state, tick)
    away = crowd.supporters(1)
    assert crowd.has_role(crowd.state.wanted[away], Role.CHEER).mean() > 0.9
    for tick in range(TICK + 100, TICK + 60 + 640):
        settle(crowd.state, tick)
    np.testing.assert_array_equal(crowd.state.wanted, crowd.state.innate)


def test_equal_seeds_plan_the_same(crowd: Any) -> None:
    plans = []
    for _ in range(2):
        crowd.rng = np.random.default_rng(5)
        crowd.answer(Goal(0), TICK)
        plans.append((crowd.state.react_at.copy(), crowd.state.reaction.copy()))
    for first, second in zip(*plans, strict=True):
        np.testing.assert_array_equal(first, second)
