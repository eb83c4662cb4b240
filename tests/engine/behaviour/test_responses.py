"""Who answers an event, how hard and for how long; and how feelings go."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tifo.engine.behaviour import BallHit, Event, Goal, draw_emotion, set_embarrassment
from tifo.engine.behaviour.emotion import relax, shift

PLACE = (20.0, 8.0, -16.0)
LOUD = ("clap", "cheer", "jump")


def _share(crowd: Any, side: int, reacting: Any) -> float:
    mine = crowd.supporters(side)
    return float(np.isin(mine, reacting).mean())


@pytest.mark.parametrize("scorer", [0, 1])
def test_the_own_side_cheers_a_goal_and_others_are_dismayed(crowd: Any, scorer: int) -> None:
    reacting = crowd.answer(Goal(scorer))
    assert (np.diff(reacting) > 0).all()
    assert crowd.present[reacting].all()
    assert _share(crowd, scorer, reacting) > 0.97
    assert 0.4 < _share(crowd, 1 - scorer, reacting) < 0.8
    assert 0.1 < _share(crowd, -1, reacting) < 0.8
    crowd.run(45)
    assert crowd.doing(*LOUD)[crowd.supporters(scorer)].mean() > 0.9
    other = crowd.supporters(1 - scorer)
    assert not crowd.doing(*LOUD)[other].any()
    assert crowd.doing("dismay", "sit_dismay")[other].mean() > 0.3
    neutral = crowd.supporters(-1)
    assert not crowd.doing(*LOUD)[neutral].any()


def test_a_third_side_has_goals_of_its_own(crowd: Any) -> None:
    crowd.team.side[crowd.team.side == -1] = 2
    crowd.team.fervour[:] = 1.0
    crowd.answer(Goal(2))
    crowd.run(45)
    assert crowd.doing(*LOUD)[crowd.supporters(2)].mean() > 0.9
    assert not crowd.doing(*LOUD)[crowd.supporters(0)].any()
    assert not crowd.doing(*LOUD)[crowd.supporters(1)].any()


def test_what_is_nobodys_concerns_everybody(crowd: Any) -> None:
    reacting = crowd.answer(Event("anthem"))
    for side in (0, 1, -1):
        assert _share(crowd, side, reacting) > 0.8
    crowd.run(120)
    assert crowd.doing("stand", "arm_up")[reacting].mean() > 0.9


def test_the_share_that_reacts_is_a_threshold_curve_and_the_duration_goes_on_rising(
    make_crowd: Any,
) -> None:
    shares, lengths = [], []
    for weight in (0.05, 0.15, 0.25, 0.35, 0.5, 0.7, 0.85, 1.0):
        crowd = make_crowd()
        crowd.tick = 1000
        reacting = crowd.answer(Goal(0, weight=weight))
        home = np.intersect1d(reacting, crowd.supporters(0))
        shares.append(_share(crowd, 0, reacting))
        until = crowd.behaviour.stirred_until[home]
        lengths.append(float(until.mean() - 1000) if len(home) else 0.0)
    assert (np.diff(shares) >= 0).all()
    assert shares[0] < 0.05
    assert 0.2 < shares[3] < 0.9
    assert shares[-2] > 0.97
    # The share has saturated; the duration has not.
    assert lengths[-1] > 1.1 * lengths[-2] > 1.1 * 1.1 * lengths[-3]


def test_low_weights_make_few_cheer_and_only_high_ones_make_people_jump(make_crowd: Any) -> None:
    loud, jumping = [], []
    for weight in (0.15, 0.5, 1.0):
        crowd = make_crowd()
        crowd.answer(Goal(0, weight=weight))
        crowd.run(45)
        home = crowd.supporters(0)
        loud.append(crowd.doing(*LOUD)[home].mean())
        jumping.append(crowd.doing("jump")[home].mean())
    assert loud[0] < 0.15 < 0.6 < loud[1] < loud[2]
    assert jumping[0] == jumping[1] == 0.0
    assert jumping[2] == pytest.approx(1 / 3, abs=0.05)


def test_ultras_get_more_excited(make_crowd: Any) -> None:
    crowd = make_crowd()
    ultras = crowd.supporters(0)[::2]
    others = crowd.supporters(0)[1::2]
    crowd.team.fervour[ultras] = 1.5
    reacting = crowd.answer(Goal(0, weight=0.3))
    assert np.isin(ultras, reacting).mean() > np.isin(others, reacting).mean() + 0.2
    assert crowd.emotion.excitement[ultras].mean() > crowd.emotion.excitement[others].mean() + 0.05


def test_absent_agents_neither_react_nor_feel(crowd: Any) -> None:
    before = crowd.emotion.excitement.copy()
    for event in (Goal(0), Goal(1), BallHit(PLACE), Event("anthem")):
        assert crowd.present[crowd.answer(event)].all()
    absent = ~crowd.present
    assert not crowd.behaviour.stirred_until[absent].any()
    np.testing.assert_array_equal(crowd.emotion.excitement[absent], before[absent])


def test_a_ball_hits_those_within_reach_and_others_see_it(crowd: Any) -> None:
    reacting = crowd.answer(BallHit(PLACE))
    x, y, z = crowd.placement.position.astype(float)
    distance = np.sqrt((x - PLACE[0]) ** 2 + (y + 1.0 - PLACE[1]) ** 2 + (z - PLACE[2]) ** 2)
    hit = np.flatnonzero(crowd.present & (distance <= 1.2))
    near = np.flatnonzero(crowd.present & (distance > 1.2) & (distance <= 7.0))
    assert len(hit) > 3
    assert np.isin(hit, reacting).all()
    assert distance[reacting].max() <= 7.0
    assert np.isin(near, reacting).mean() > 0.6
    crowd.run()
    # Being hit is not waited with.
    assert crowd.doing("struck")[hit].all()
    assert crowd.doing("struck").sum() == len(hit)
    crowd.run(30 * 20)
    assert not crowd.doing("struck").any()


def test_events_elsewhere_move_nobody(crowd: Any) -> None:
    for event in (
        BallHit((0.0, 0.0, 500.0)),
        Event("player_close", place=(0.0, 0.0, 500.0)),
        Goal(5, weight=0.0),
    ):
        reacting = crowd.answer(event)
        assert reacting.dtype == np.int64
        assert len(reacting) == 0


def test_something_smaller_does_not_interrupt_but_something_bigger_does(crowd: Any) -> None:
    home = crowd.supporters(0)
    crowd.answer(Goal(0))
    crowd.run(10)
    crowd.answer(Event("foul", 1))
    cheering = crowd.behaviour.event[home] == 0
    assert cheering.mean() > 0.95
    crowd.run(60)
    away = crowd.supporters(1)
    crowd.answer(Goal(1))
    crowd.run(45)
    assert crowd.doing(*LOUD)[away].mean() > 0.9


def test_feelings_stay_in_their_ranges_whatever_happens(crowd: Any) -> None:
    for number in range(200):
        crowd.answer(Goal(number % 2))
        crowd.answer(Event("final_whistle", 0, weight=1.0))
        crowd.run(2, feelings=True)
    e = crowd.emotion
    for column in (e.excitement, e.embarrassment, e.fatigue):
        assert column.min() >= 0.0
        assert column.max() <= 1.0
    assert e.mood.min() >= -1.0
    assert e.mood.max() <= 1.0


def test_shifts_are_shares_of_the_way_left() -> None:
    column = np.array([0.2, 0.2, 0.9, -0.5], np.float32)
    shift(column, slice(0, 4), np.array([0.5, -0.5, 2.0, -1.0], np.float32), -1.0)
    np.testing.assert_allclose(column, [0.6, -0.4, 1.0, -1.0], atol=1e-6)
    up = np.array([0.5, 0.0], np.float32)
    shift(up, np.array([1, 0]), np.array([0.5, 0.25], np.float32))
    np.testing.assert_allclose(up, [0.625, 0.5])


@pytest.mark.parametrize(
    ("name", "minutes", "rest"),
    [("mood", 1.9, 0.0), ("excitement", 1.7, 0.2), ("embarrassment", 1.7, 1.0)],
)
def test_half_of_a_feeling_is_gone_after_its_half_life(
    name: str, minutes: float, rest: float
) -> None:
    emotion = draw_emotion(np.ones(103, np.float32), 1.0, np.random.default_rng(1))
    column = getattr(emotion, name)
    column[:] = rest + 0.4 if rest < 1 else 0.6
    gap = float(column[0]) - rest
    nobody = np.zeros(103, np.bool_)
    for tick in range(1, round(minutes * 60 * 30) + 1):
        relax(emotion, tick, nobody)
    np.testing.assert_allclose(column, rest + gap / 2, atol=2e-3)


def test_being_moved_tires_and_rest_heals() -> None:
    emotion = draw_emotion(np.ones(10, np.float32), 0.2, np.random.default_rng(1))
    everyone = np.ones(10, np.bool_)
    for tick in range(1, 1801):
        relax(emotion, tick, everyone)
    tired = emotion.fatigue.copy()
    assert (tired > 0.3).all()
    assert (tired < 0.5).all()
    for tick in range(1801, 3601):
        relax(emotion, tick, ~everyone)
    np.testing.assert_allclose(emotion.fatigue, tired * 0.5 ** (1 / 3), rtol=0.02)


def test_embarrassment_differs_between_its_ends() -> None:
    emotion = draw_emotion(np.ones(2000, np.float32), 0.4, np.random.default_rng(1))
    assert emotion.embarrassment.std() > 0.05
    assert emotion.embarrassment.mean() == pytest.approx(0.4, abs=0.03)
    for level in (0.0, 1.0):
        set_embarrassment(emotion, level)
        assert (emotion.embarrassment == level).all()
        assert (emotion.rest_embarrassment == level).all()
    for wrong in (-0.1, 1.1, float("nan")):
        with pytest.raises(ValueError, match="expected embarrassment from 0 to 1"):
            set_embarrassment(emotion, wrong)
