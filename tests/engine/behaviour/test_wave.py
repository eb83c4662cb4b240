"""The Mexican wave: speed, beginning, direction, and the ways in which it ends."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.benchmarks.experiments import (
    TICK,
    crowd_near,
    ignitions,
    start_wave,
    wave_speeds,
)
from tifo.engine.behaviour.wave import ACTIVE, INACTIVE, MexicanWave, WaveRates
from tifo.engine.crowd.bowl import build_bowl
from tifo.engine.crowd.seating import SeatPlan
from tifo.engine.crowd.stand import build_stand


@pytest.fixture(scope="module")
def stand() -> SeatPlan:
    return build_stand(20, 260, step=0.52, rise=0.4, depth=0.8)


@pytest.fixture(scope="module")
def bowl() -> SeatPlan:
    return build_bowl(30_000)


def everybody(plan: SeatPlan) -> np.ndarray:
    return np.ones(plan.count, bool)


def test_it_runs_along_a_stand_at_its_speed_and_one_way(
    stand: SeatPlan, rng: np.random.Generator
) -> None:
    run = start_wave(stand, everybody(stand), stand.find("8|60"), 45, 14.0, rng)
    ahead = (stand.column > 110) & (stand.column < 240)
    assert np.isfinite(run.rose_at[ahead]).mean() > 0.97
    speed = 1.0 / np.polyfit(stand.column[ahead], run.rose_at[ahead], 1)[0]
    assert 19.0 <= speed <= 25.0
    assert np.isfinite(run.rose_at[stand.column < 30]).mean() < 0.05
    # Everybody goes with the front: no row lags far behind.
    at = [np.median(run.rose_at[ahead & (stand.row == row)]) for row in range(20)]
    assert np.ptp(at) < 1.0


def test_a_negative_bias_runs_the_other_way(stand: SeatPlan, rng: np.random.Generator) -> None:
    wave = MexicanWave(stand, rng, rates=WaveRates(bias=-WaveRates().bias))
    wave.start(crowd_near(stand, stand.find("8|200"), 45, everybody(stand)))
    rose = np.concatenate([wave.step().rose for _ in range(200)])
    assert (stand.column[rose] < 100).sum() > 300
    assert (stand.column[rose] > 240).sum() < 30


def test_a_few_do_not_start_it_and_many_do(bowl: SeatPlan, rng: np.random.Generator) -> None:
    present = rng.random(bowl.count) < 0.96
    assert ignitions(bowl, present, 18, 6, rng) == 0
    assert ignitions(bowl, present, 45, 6, rng) >= 5


@pytest.mark.slow
def test_it_takes_25_to_35_people(bowl: SeatPlan, rng: np.random.Generator) -> None:
    present = rng.random(bowl.count) < 0.96
    assert ignitions(bowl, present, 23, 20, rng) <= 4
    assert ignitions(bowl, present, 37, 20, rng) >= 16


@pytest.mark.slow
def test_it_goes_round_a_stadium_over_gangways_and_tiers(rng: np.random.Generator) -> None:
    plan = build_bowl(65_000)
    present = rng.random(plan.count) < 0.96
    x, _, z = plan.position
    seat = int(np.argmin(np.hypot(x, z + 55.0) + 100.0 * ~present))
    run = start_wave(plan, present, seat, 40, 60.0, rng)
    for tier in (0, 1):
        assert np.isfinite(run.rose_at[present & (plan.tier == tier)]).mean() > 0.95
    speeds = wave_speeds(plan, run)
    assert 19.0 <= np.median(speeds) <= 25.0
    assert (speeds > 0).mean() > 0.98  # clockwise
    # About fifteen seats are up at once in a row.
    assert 10 < run.active[400:900].mean() / (int(plan.row.max()) + 1) < 22


def test_excitation_is_the_weighted_share_of_who_is_up(rng: np.random.Generator) -> None:
    plan = build_stand(9, 50, step=0.5, rise=0.4, depth=0.8)
    present = rng.random(plan.count) < 0.8
    rates = WaveRates()
    wave = MexicanWave(plan, rng, present, rates)
    wave.threshold[:] = np.inf
    up = rng.choice(np.flatnonzero(present), 60, replace=False)
    wave.start(up)
    wave.step()
    assert (wave.state[up] == ACTIVE).all()
    # Everybody with everybody, by the formula.
    along = (plan.column[:, None] - plan.column[None, :]) / rates.seats
    across = (plan.row[:, None] - plan.row[None, :]) / rates.rows
    distance = np.hypot(along, across)
    cosine = along / np.maximum(distance, 1e-9)
    weight = np.exp(-distance) * (1 + rates.bias * cosine) * (distance <= 1.9)
    np.fill_diagonal(weight, 0.0)
    weight *= present[None, :]
    is_up = np.isin(np.arange(plan.count), up)
    share = (weight @ is_up) / weight.sum(axis=1)
    inside = present & (plan.column > 15) & (plan.column < 35) & (plan.row > 1) & (plan.row < 7)
    # Weights end at d = 1.9, where distances are rounded to eighths of seats.
    np.testing.assert_allclose(wave.excitation(np.flatnonzero(inside)), share[inside], atol=0.025)


def test_nothing_is_left_over(bowl: SeatPlan, rng: np.random.Generator) -> None:
    wave = MexicanWave(bowl, rng, rng.random(bowl.count) < 0.9)
    for _ in range(3):
        wave.start(rng.choice(bowl.count, 400, replace=False))
        for _ in range(1200):
            wave.step()
            if wave.is_quiet:
                break
            wave.threshold[:] = np.inf
        assert wave.is_quiet
        assert (wave.state == INACTIVE).all()
        assert (wave.excitation(np.arange(bowl.count)) == 0).all()


def test_empty_seats_stop_it_and_stay_empty(stand: SeatPlan, rng: np.random.Generator) -> None:
    present = (stand.column < 120) | (stand.column > 150)
    run = start_wave(stand, present, stand.find("8|60"), 45, 14.0, rng)
    assert np.isfinite(run.rose_at[(stand.column > 90) & (stand.column < 115)]).mean() > 0.9
    assert np.isnan(run.rose_at[~present]).all()
    assert np.isnan(run.rose_at[stand.column > 150]).all()


def test_who_is_in_no_mood_does_not_join(stand: SeatPlan, rng: np.random.Generator) -> None:
    wave = MexicanWave(stand, rng)
    wave.threshold[stand.column > 120] = np.inf
    wave.start(crowd_near(stand, stand.find("8|60"), 45, everybody(stand)))
    rose = np.concatenate([wave.step().rose for _ in range(250)])
    assert 100 < stand.column[rose].max() <= 120


def test_each_rises_once_a_wave_and_the_order_is_sound(
    stand: SeatPlan, rng: np.random.Generator
) -> None:
    wave = MexicanWave(stand, rng)
    wave.start(crowd_near(stand, stand.find("8|60"), 45, everybody(stand)))
    rose, sat = [], []
    for _ in range(150):
        change = wave.step()
        rose.append(change.rose)
        sat.append(change.sat)
    rose, sat = np.concatenate(rose), np.concatenate(sat)
    assert len(np.unique(rose)) == len(rose)
    assert np.isin(sat, rose).all()


def test_quiet_steps_do_nothing(stand: SeatPlan, rng: np.random.Generator) -> None:
    wave = MexicanWave(stand, rng)
    before = rng.bit_generator.state
    for _ in range(10):
        assert len(wave.step().rose) == 0
    assert rng.bit_generator.state == before


def test_the_same_seed_gives_the_same_wave(stand: SeatPlan) -> None:
    runs = [
        start_wave(stand, everybody(stand), 2000, 45, 5.0, np.random.default_rng(3)).rose_at
        for _ in range(2)
    ]
    np.testing.assert_array_equal(*runs)


@pytest.mark.parametrize("size", [(1, 1), (1, 5), (3, 2), (40, 1)])
def test_tiny_stands(size: tuple[int, int], rng: np.random.Generator) -> None:
    plan = build_stand(*size, step=0.5)
    wave = MexicanWave(plan, rng)
    wave.start(np.arange(plan.count))
    rose = sum(len(wave.step().rose) for _ in range(400))
    assert rose >= plan.count
    assert wave.is_quiet


def test_wrong_arguments_are_named(stand: SeatPlan, rng: np.random.Generator) -> None:
    with pytest.raises(ValueError, match="tick_seconds"):
        MexicanWave(stand, rng, tick_seconds=TICK * 5)
    with pytest.raises(ValueError, match="present"):
        MexicanWave(stand, rng, np.ones(3, bool))
    with pytest.raises(ValueError, match="no agent"):
        MexicanWave(stand, rng).start(stand.count)
    assert len(MexicanWave(stand, rng, np.zeros(stand.count, bool)).start([1, 2])) == 0
