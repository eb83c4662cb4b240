"""Emotions spread and fade."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.benchmarks.experiments import boil, half_life
from tifo.engine.behaviour.contagion import ContagionRates, EmotionContagion
from tifo.engine.crowd.bowl import build_bowl
from tifo.engine.crowd.stand import build_stand

F32 = np.float32


def test_half_lives(rng: np.random.Generator) -> None:
    # Garcia et al. 2016: 1.9 minutes for valence, 1.7 for arousal.
    plan = build_bowl(5000)
    assert half_life("mood", rng, plan) == pytest.approx(1.9 * 60, abs=3)
    assert half_life("excitement", rng, plan) == pytest.approx(1.7 * 60, abs=3)


def test_emotions_fade_to_their_rests() -> None:
    plan = build_stand(3, 5)
    contagion = EmotionContagion(plan)
    contagion.mood_rest[:] = 0.4
    contagion.excitement_rest[:] = -0.2
    mood, excitement = np.zeros(15, F32), np.ones(15, F32)
    for _ in range(4000):
        contagion.step(mood, excitement, 0.5)
    np.testing.assert_allclose(mood, 0.4, atol=1e-3)
    np.testing.assert_allclose(excitement, -0.2, atol=1e-3)


def test_two_neighbours_meet_in_the_middle() -> None:
    rates = ContagionRates(mood_half_life=1e12, excitement_half_life=1e12, rate=0.1)
    contagion = EmotionContagion(build_stand(1, 2, step=0.5), rates=rates, turn_seconds=0.05)
    mood, excitement = np.array([1.0, 0.0], F32), np.zeros(2, F32)
    for _ in range(200):
        contagion.step(mood, excitement, 0.05)
    # dq1/dt = 0.1 (q2 - q1) and back: the difference falls as exp(-0.2 t), here for 10 s.
    assert mood.sum() == pytest.approx(1.0, abs=1e-3)
    assert mood[0] - mood[1] == pytest.approx(np.exp(-2.0), abs=0.01)


def test_excitement_spreads_farther_with_time_and_less_with_distance() -> None:
    plan = build_stand(9, 41, step=0.5, depth=0.8, rise=0.4)
    contagion = EmotionContagion(plan)
    mood, excitement = np.zeros(plan.count, F32), np.zeros(plan.count, F32)
    excitement[plan.find("4|20")] = 1.0
    far = [plan.find(f"4|{20 + k}") for k in (1, 3, 6, 12)]
    early = late = None
    for tick in range(30 * 60):
        contagion.step(mood, excitement, 1 / 30)
        if tick == 150:
            early = excitement[far].copy()
    late = excitement[far]
    assert (np.diff(early) < 0).all()
    assert (np.diff(late) < 0).all()
    assert (late[1:3] > early[1:3]).all()
    assert excitement[plan.find("5|20")] > excitement[plan.find("8|20")] > 0


def test_steps_may_be_short_or_long(rng: np.random.Generator) -> None:
    plan = build_bowl(2000)
    begin = rng.random(2000).astype(F32)
    ends = []
    for dt in (1 / 30, 0.25, 1.0, 2.0):
        contagion = EmotionContagion(plan)
        mood, excitement = begin.copy(), begin.copy()
        for _ in range(round(60 / dt)):
            contagion.step(mood, excitement, dt)
        ends.append((mood, excitement))
    for mood, excitement in ends[1:]:
        np.testing.assert_allclose(mood, ends[0][0], atol=0.02)
        np.testing.assert_allclose(excitement, ends[0][1], atol=0.02)


def test_susceptibility_and_lonely_seats() -> None:
    plan = build_stand(1, 12, step=0.5)
    present = np.ones(12, bool)
    present[[8, 10]] = False
    present[9] = True
    contagion = EmotionContagion(plan, present)
    assert contagion.weights[9].sum() < contagion.weights[5].sum()
    mood, excitement = np.zeros(12, F32), np.zeros(12, F32)
    mood[3] = 1.0
    immune = np.ones(12, F32)
    immune[4] = 0.0
    for _ in range(300):
        contagion.step(mood, excitement, 1 / 30, susceptibility=immune)
    assert mood[4] == 0.0
    assert mood[2] > 0.05


def test_opponents_hardly_infect_each_other() -> None:
    plan = build_stand(1, 8, step=0.5)
    side = np.array([0, 0, 0, 0, 1, 1, -1, -1], np.int8)
    contagion = EmotionContagion(plan, side=side)
    mood, excitement = np.zeros(8, F32), np.zeros(8, F32)
    mood[3] = 1.0
    for _ in range(90):
        contagion.step(mood, excitement, 1 / 30)
    assert 0 < mood[4] < 0.3 * mood[2]
    # Neutrals are nobody's opponents.
    np.testing.assert_allclose(contagion.weights[7].sum(), contagion.weights[0].sum(), rtol=1e-3)


def test_a_crowd_boils(rng: np.random.Generator) -> None:
    """Scattered clapping first, for long; then all at once; nobody told them when."""
    plan = build_bowl(8000)
    share, excitement = boil(plan, np.ones(8000, bool), 150.0, 0.8, rng)
    boils = int(np.flatnonzero(share > 0.5)[0])
    scattered = share[: boils - 150]
    assert 0 < scattered.max() < 0.15
    assert np.count_nonzero(scattered > 0) > 300
    assert share.max() > 0.8
    tenth = np.flatnonzero(share[:boils] < 0.1)[-1]
    assert (boils - tenth) / 30 < 3.0
    assert 0.2 < excitement[boils] < 0.7


def test_nobody_is_there_and_wrong_arguments() -> None:
    plan = build_stand(2, 4)
    contagion = EmotionContagion(plan, np.zeros(8, bool))
    mood = np.ones(8, F32)
    contagion.step(mood, mood.copy(), 1.0)
    assert np.isfinite(mood).all()
    with pytest.raises(ValueError, match="dt is"):
        contagion.step(mood, mood, 0.0)
    with pytest.raises(ValueError, match="turn_seconds"):
        EmotionContagion(plan, turn_seconds=0.0)
