"""What is published of people, measured on whole crowds that run, from event to what they show.

The mechanisms one by one are measured in tests/engine/behaviour.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from tifo.benchmarks.experiments import REFERENCE_RHYTHM, WaveRun, crowd_near, wave_speeds
from tifo.engine.behaviour import Event, Goal
from tifo.engine.behaviour.rhythm import Rhythm
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation

Make = Callable[..., Simulation]
RATE = 30


@pytest.fixture
def people() -> Iterator[Make]:
    """Crowds without poses, one at a time: each is closed when the next is made."""
    made: list[Simulation] = []

    def make(**fields: Any) -> Simulation:
        if made:
            made.pop().close()
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
    for seed in range(80):
        # 2.5 of the table times 0.4 is a benefit of 1, a good talk.
        clapping = np.flatnonzero(_applause(_room(people, seed), 0.4) > 0) / RATE
        if len(clapping):
            first.append(clapping[0] + 1 / RATE)
            length.append(clapping[-1] - clapping[0] + 1 / RATE)
    assert len(first) >= 78
    # The s.d. are 2.2 s and 1.4 s, so standard errors of 80 groups are 0.25 s and 0.16 s.
    assert np.mean(first) == pytest.approx(2.1, abs=0.6)
    assert np.mean(length) == pytest.approx(6.1, abs=0.4)


def _hall(make: Make, rows: int, seed: int, **fields: Any) -> Simulation:
    """28 seats a row in one room, where everybody hears everybody."""
    return make(
        layout="stand", rows=rows, columns=28, step=0.55, depth=0.8, rise=0.4, occupancy=1.0,
        ultras=0.0, behaviour="speech", seed=seed, **fields,
    )  # fmt: skip


@pytest.mark.slow
def test_half_a_hall_clapping_makes_starting_ten_times_as_likely(people: Make) -> None:
    """Mann et al. 2013: starts, seen and counted, a second of a person who has not begun."""
    edges = np.array([0.02, 0.08, 0.15, 0.25, 0.4, 0.6])
    starts, seconds, heard = np.zeros((3, len(edges) - 1))
    for seed in range(12):
        simulation = _hall(people, 40, seed)
        crowd = simulation.crowd
        simulation.send(Event("cue", weight=1.0))
        before = np.zeros(len(crowd), np.bool_)
        for _ in range(3 * RATE):
            simulation.run(seconds=1 / RATE)
            now = crowd.in_state("sit_clap")
            if (before & ~now).any():
                break  # from here on some who don't clap have stopped
            place = np.searchsorted(edges, before.mean()) - 1
            if 0 <= place < len(starts):
                waited = ((~before).sum() + (~now).sum()) / 2 / RATE
                starts[place] += (now & ~before).sum()
                seconds[place] += waited
                heard[place] += waited * (before.mean() + now.mean()) / 2
            before = now
    hazard, share = starts / seconds, heard / seconds
    assert starts.min() > 500
    slope = hazard / share
    # At a twentieth and at half of the hall; 500 starts have a standard error of 4.5 %.
    assert 0.5 * slope[-1] / (0.05 * slope[0]) == pytest.approx(10.0, abs=2.0)
    # In proportion to who claps: twice as many do twice as much, anywhere between.
    np.testing.assert_allclose(slope, slope.mean(), rtol=0.15)


def test_a_second_reason_does_not_interrupt_applause(people: Make) -> None:
    simulation = _hall(people, 10, 1)
    crowd = simulation.crowd
    for weight in (1.0, 1.0, 0.1):
        simulation.send(Event("cue", weight=weight))
        simulation.run(seconds=1.5)
    share = float(crowd.in_state("sit_clap").mean())
    assert share > 0.97


@pytest.mark.slow
def test_the_reference_run_of_rhythmic_applause(people: Make) -> None:
    """Neda et al. 2000: no order at K = 0.8; every rate halved, it grows over a minute."""
    simulation = _hall(people, 180, 3)
    crowd, company = simulation.crowd, simulation.crowd.company
    assert len(crowd) == 5040
    company.rhythm = Rhythm(company.rhythm.hearing, np.random.default_rng(0), REFERENCE_RHYTHM)
    order = []
    for second in range(140):
        if second % 10 == 0:
            company.applause.cue(np.arange(len(crowd)), 80.0)
        if second == 40:
            company.rhythm.rate *= np.float32(0.5)
        simulation.run(seconds=1.0)
        order.append(float(np.abs(company.rhythm.order[0])))
    assert crowd.in_state("sit_clap").mean() > 0.99
    assert np.mean(order[5:40]) < 0.06
    assert order[45] < 0.2
    steps = np.array([np.mean(order[at : at + 10]) for at in (45, 75, 105, 130)])
    assert (np.diff(steps) > 0.03).all()
    # Kuramoto's theory has 0.46 in the end.
    assert 0.3 < steps[-1] < 0.55


@pytest.mark.slow
def test_in_an_ovation_people_find_a_beat_at_half_their_rate(people: Make) -> None:
    """Neda et al. 2000: rhythm comes, with the double period, and goes again."""
    simulation = _hall(people, 40, 3)
    crowd, rhythm = simulation.crowd, simulation.crowd.company.rhythm
    order, rate = [], []
    phase = rhythm.phase.copy()
    for second in range(40):
        if second % 5 == 0:
            crowd.company.applause.cue(np.arange(len(crowd)), 20.0)
        claps, orders = 0, []
        for _ in range(RATE):
            simulation.run(seconds=1 / RATE)
            claps += int(np.count_nonzero(rhythm.phase < phase - 0.5))  # hands met
            phase = rhythm.phase.copy()
            orders.append(float(np.abs(rhythm.order[0])))
        rate.append(claps / len(crowd))
        order.append(float(np.mean(orders)))
    assert crowd.in_state("sit_clap").mean() > 0.99
    free = np.mean(rate[2:6])
    assert 3.0 < free < 3.6
    assert np.mean(order[2:6]) < 0.2
    best = int(np.argmax(order[:35]))
    assert order[best] > 0.7
    # Four seconds of a common beat are 6 or 7 claps.
    assert np.mean(rate[best - 2 : best + 2]) == pytest.approx(free / 2, rel=0.1)
    assert min(order[best:]) < 0.2


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
def test_a_wave_takes_some_thirty_people(people: Make) -> None:
    """Farkas et al. 2002: 25 to 35 who get up together start it, and fewer don't."""
    simulation = people(seats=20_000, ultras=0.05, seed=5)
    crowd, plan = simulation.crowd, simulation.plan
    there, (x, _, z) = crowd.seat.occupied, plan.position
    rows = plan.row[plan.tier == 0].max()
    inner = there & (plan.tier == 0) & (plan.row > 3) & (plan.row < rows - 3)
    inner &= (np.abs(x) < 40.0) | (np.abs(z) < 22.0)  # not the corners, where it takes fewer
    rng = np.random.default_rng(4)
    wave = crowd.company.wave
    eager = wave.threshold.copy()
    share = {}
    for starters in (15, 20, 25, 30, 35, 50):
        share[starters] = 0.0
        for seat in rng.choice(np.flatnonzero(inner), 8):
            wave.reset()
            wave.threshold[:] = eager  # nobody has seen one before
            crowd.start_wave(crowd_near(plan, int(seat), starters, there))
            rose = np.zeros(len(crowd), np.bool_)
            for _ in range(6 * RATE):
                simulation.run(seconds=1 / RATE)
                rose |= crowd.in_state("sit_mexican_wave") | crowd.in_state("mexican_wave")
                if rose.sum() > starters + 1000 or wave.is_quiet:
                    break
            share[starters] += (rose.sum() > starters + 1000) / 8
    assert share[15] == 0.0
    assert share[20] <= 0.125
    assert min(share[35], share[50]) >= 0.875
    even = np.interp(0.5, np.maximum.accumulate([*share.values()]), np.array([*share]))
    assert 22.5 <= even <= 35.0


@pytest.mark.slow
def test_a_wave_runs_at_its_speed(people: Make) -> None:
    """Farkas et al. 2002: 22 +- 3 seats a second, along every row of the straight sides."""
    simulation = people(seats=20_000, ultras=0.05, seed=5)
    crowd, plan = simulation.crowd, simulation.plan
    seat = int(plan.find(f"6|{plan.column[plan.row == 6].max() // 8}"))
    crowd.start_wave(crowd_near(plan, seat, 40, crowd.seat.occupied))
    rose = np.full(len(crowd), np.nan)
    for tick in range(25 * RATE):
        simulation.run(seconds=1 / RATE)
        up = crowd.in_state("sit_mexican_wave") | crowd.in_state("mexican_wave")
        rose[up & np.isnan(rose)] = tick / RATE
    speeds = np.abs(wave_speeds(plan, WaveRun(rose, np.zeros(0))))
    assert len(speeds) >= 15
    assert 19.0 <= np.median(speeds) <= 25.0
    assert np.mean((speeds > 18.0) & (speeds < 26.0)) > 0.85


@pytest.mark.parametrize("seats", [12_000, pytest.param(65_000, marks=pytest.mark.slow)])
def test_everybody_sees_the_touchline_over_who_sits_in_front(people: Make, seats: int) -> None:
    """C >= 60 mm, 90 mm desirable, rake at most 34 degrees: of people as they sit, by geometry."""
    spatial = pytest.importorskip("scipy.spatial")
    simulation = people(seats=seats)
    simulation.run(seconds=2.0)
    crowd = simulation.crowd
    there = np.flatnonzero(crowd.seat.occupied)
    yaw = simulation.plan.yaw[there].astype(np.float64)
    ahead = np.stack([np.sin(yaw), np.cos(yaw)])
    x, y, z = crowd.placement.position[:, there].astype(np.float64)
    eye = np.stack([x, z]) - 0.35 * ahead  # on the ground; 1.2 m above the feet
    focus = np.stack([np.clip(eye[0], -52.5, 52.5), np.clip(eye[1], -34.0, 34.0)])
    pairs = spatial.cKDTree(eye.T).query_pairs(1.0, output_type="ndarray")
    rear, front = np.concatenate([pairs, pairs[:, ::-1]]).T
    gap = eye[:, front] - eye[:, rear]
    look = focus[:, rear] - eye[:, rear]
    look /= np.linalg.norm(look, axis=0)
    tread = (gap * look).sum(axis=0)
    beside = np.abs(gap[0] * look[1] - gap[1] * look[0])
    hides = (tread > 0.5) & (beside < 0.3)
    rear, front, tread = rear[hides], front[hides], tread[hides]
    assert len(np.unique(rear)) > 0.7 * len(there)
    distance = np.linalg.norm(focus[:, rear] - eye[:, rear], axis=0) - tread
    riser, height = y[rear] - y[front], y[front] + 1.2
    c = distance * (riser + height) / (distance + tread) - height
    assert c.min() >= 0.085  # whoever sits there, also across the curve of a corner
    assert np.mean(c >= 0.09) > 0.99
    same_tier = crowd.plan.tier[there[rear]] == crowd.plan.tier[there[front]]
    assert np.degrees(np.arctan2(riser, 0.8)[same_tier]).max() <= 34.01


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
