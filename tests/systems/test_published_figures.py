"""What is published of people, measured on whole crowds that run, from event to what they show.

The mechanisms one by one are measured in tests/engine/behaviour.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from tifo.engine.behaviour import Event, Goal
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation

Make = Callable[..., Simulation]
RATE = 30


@pytest.fixture
def people() -> Iterator[Make]:
    """Crowds without poses, closed after the test."""
    made: list[Simulation] = []

    def make(**fields: Any) -> Simulation:
        made.append(Simulation(CrowdSpec(**{"poses": "none", "neutrals": 0.0, **fields})))
        return made[-1]

    yield make
    for simulation in made:
        simulation.close()


def _room(make: Make, seed: int) -> Simulation:
    """13 to 20 people who listen to a speech."""
    size = int(np.random.default_rng(seed).integers(13, 21))
    return make(
        layout="stand", rows=1, columns=size, occupancy=1.0, ultras=0.0, behaviour="speech",
        seed=seed,
    )  # fmt: skip


def _applause(simulation: Simulation, weight: float) -> np.ndarray:
    """Share that claps in each pose tick after somebody made a point, until nobody does again."""
    simulation.send(Event("cue", weight=weight))
    shares: list[float] = []
    while len(shares) < 11 * RATE or (shares[-1] > 0 and len(shares) < 60 * RATE):
        simulation.run(seconds=1 / RATE)
        shares.append(float(simulation.crowd.in_state("sit_clap").mean()))
        if max(shares) > shares[-1] == 0.0:
            break
    return np.array(shares)


@pytest.mark.slow
def test_thirteen_to_twenty_people_clap_like_those_of_the_study(people: Make) -> None:
    """Mann et al. 2013: first clap after 2.1 s, first to last clap 6.1 s, means of the groups."""
    first, length = [], []
    for seed in range(40):
        # 2.5 of the table times 0.4 is a benefit of 1, a good talk.
        clapping = np.flatnonzero(_applause(_room(people, seed), 0.4) > 0) / RATE
        if len(clapping):
            first.append(clapping[0])
            length.append(clapping[-1] - clapping[0])
    assert len(first) >= 36
    # Standard errors of 40 groups are 0.25 s and 0.3 s.
    assert np.mean(first) == pytest.approx(2.1, abs=0.75)
    assert np.mean(length) == pytest.approx(6.1, abs=1.0)


@pytest.mark.slow
def test_more_impressive_is_clapped_by_all_and_then_for_longer(people: Make) -> None:
    """Lupyan and Rifkin 2003: a threshold curve, and lengths that rise beyond it."""
    shares, lengths = [], []
    for weight in (0.04, 0.14, 0.5, 1.0):
        curves = [_applause(_room(people, seed), weight) for seed in range(6)]
        shares.append(np.mean([curve.max() for curve in curves]))
        lengths.append(np.mean([np.count_nonzero(curve) for curve in curves]) / RATE)
    assert shares[0] < 0.05
    assert shares[0] <= shares[1] < shares[2]
    assert min(shares[2:]) > 0.95
    assert lengths[3] > 1.2 * lengths[2] > lengths[1]


@pytest.mark.slow
def test_once_a_quarter_claps_nearly_all_do_within_three_seconds(people: Make) -> None:
    """Some have every reason to clap and the others none, but that a quarter claps."""
    curves = []
    for share in (0.3, 0.12):
        simulation = people(seats=1500, ultras=0.0, behaviour="speech", occupancy=1.0)
        crowd = simulation.crowd
        watch = crowd.watch(every=0, by=())
        eager = np.random.default_rng(3).random(len(crowd)) < share
        crowd.company.applause.cue(np.flatnonzero(eager), 4.0)
        simulation.run(seconds=7.0)
        curves.append(watch.share("clap", channel="arms")[:, 0])
    many, few = curves
    begin = np.flatnonzero(many >= 0.25)[0]
    assert many.max() >= 0.9
    assert np.flatnonzero(many >= 0.9)[0] - begin <= 3 * RATE
    assert few.max() < 0.15


@pytest.mark.slow
def test_cheering_peaks_within_a_second_of_its_start_and_soon_after_the_goal(
    people: Make,
) -> None:
    simulation = people(layout="stand", rows=10, columns=30, ultras=0.0)
    watch = simulation.crowd.watch(every=0, by=())
    simulation.send(Goal(0, time=2.0))
    simulation.run(seconds=90.0)
    shares = watch.shares("arms")[:, 0]
    names = watch.names("arms")
    cheer = shares[:, [names.index(name) for name in ("clap", "cheer", "jump")]].sum(axis=1)
    begins = np.flatnonzero(cheer > 0.05)[0]
    reached = np.flatnonzero(cheer >= 0.9 * cheer.max())[0]
    assert cheer.max() > 0.9
    assert (reached - begins) / RATE < 1.0
    assert 2.0 <= watch.times[cheer.argmax()] <= 2.0 + 20.0
    # Play goes on after 56 to 85 s; by then hardly anybody is still at it.
    assert cheer[round(87 * RATE) :].mean() < 0.2


@pytest.mark.slow
def test_feelings_fade_with_their_half_lives(people: Make) -> None:
    """Garcia et al. 2016: 1.9 minutes for valence, 1.7 for arousal; in a crowd that does things."""
    simulation = people(layout="stand", rows=20, columns=30, behaviour="speech")
    crowd = simulation.crowd
    rest = crowd.emotion.rest_excitement.copy()
    crowd.emotion.excitement[:] = rest + 0.3
    crowd.emotion.mood[:] = 0.8
    watch = crowd.watch(every=1.0, by=())
    simulation.run(seconds=150.0)
    there = crowd.seat.occupied
    for feeling, base, minutes in (("mood", 0.0, 1.9), ("excitement", rest[there].mean(), 1.7)):
        above = watch.mean(feeling)[:, 0] - base
        slope = np.polyfit(watch.times, np.log2(above), 1)[0]
        assert -1.0 / slope / 60.0 == pytest.approx(minutes, rel=0.08), feeling


@pytest.mark.slow
def test_a_wave_takes_some_thirty_people_and_runs_at_its_speed(people: Make) -> None:
    """Farkas et al. 2002: 25 to 35 people, 19 to 25 seats a second."""
    ran = {12: 0, 70: 0}
    for starters in ran:
        for seed in range(5):
            simulation = people(
                layout="stand", rows=30, columns=200, step=0.5, depth=0.8, rise=0.4,
                ultras=0.0, seed=seed, occupancy=0.96,
            )  # fmt: skip
            crowd = simulation.crowd
            start = int(crowd.plan.find("15|40"))
            away = np.hypot(*(crowd.placement.position - crowd.placement.position[:, [start]])[::2])
            away[~crowd.seat.occupied] = np.inf
            simulation.run(seconds=0.2)
            crowd.start_wave(np.argsort(away)[:starters])
            rose = np.full(len(crowd), np.nan)
            for tick in range(8 * RATE):
                simulation.run(seconds=1 / RATE)
                up = crowd.in_state("sit_mexican_wave") | crowd.in_state("mexican_wave")
                rose[up & np.isnan(rose)] = tick / RATE
            ran[starters] += np.isfinite(rose).sum() > 1000
            if starters == 70 and np.isfinite(rose).sum() > 1000:
                columns = np.arange(80, 150)
                at = [np.nanmedian(rose[crowd.seat.column == column]) for column in columns]
                assert 19.0 <= 1.0 / np.polyfit(columns, at, 1)[0] <= 25.0
    assert ran[12] == 0
    assert ran[70] >= 4


@pytest.mark.parametrize("parties", ["general", "football"])
def test_who_comes_with_whom(people: Make, parties: str) -> None:
    crowd = people(seats=12_000, parties=parties).crowd
    sizes = np.bincount(crowd.party.party[crowd.seat.occupied])
    groups = sizes[sizes > 1]
    if parties == "general":
        shares = [np.mean(groups == k) for k in (2, 3, 4)] + [np.mean(groups > 4)]
        np.testing.assert_allclose(shares, [0.71, 0.21, 0.06, 0.02], atol=0.03)
    else:
        assert np.sum(sizes == 1) / sizes.sum() == pytest.approx(0.25, abs=0.03)
        assert groups.mean() == pytest.approx(4.0, abs=0.25)


def test_who_comes_at_all_and_who_stands(people: Make) -> None:
    """0.95 to 0.97 of the seats, about 5 % of them away; about 5 % stand all match."""
    simulation = people(seats=4000, sides=2)
    crowd = simulation.crowd
    there = crowd.seat.occupied
    assert 0.95 <= there.mean() <= 0.97
    away = there & (crowd.team.side == 1)
    assert away.sum() / len(crowd) == pytest.approx(0.05, abs=0.006)
    watch = crowd.watch(every=2.0, by=("team",))
    simulation.run(seconds=20.0)
    standing = watch.share("standing", "team", channel="posture").mean(axis=0)
    home, guests = (standing[watch.groups("team").index(side)] for side in (0, 1))
    assert 0.04 < home < 0.1
    assert guests > 1.5 * home
