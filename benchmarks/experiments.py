"""Experiments on the behaviour models: run them, and measure what has been published of people.

Nothing here is part of a model. Each function sets a crowd up, lets it run and returns what an
observer with a stop watch would write down.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..engine.behaviour.applause import CLAPPING, Applause, ApplauseRates
from ..engine.behaviour.contagion import EmotionContagion
from ..engine.behaviour.hearing import Hearing
from ..engine.behaviour.rhythm import Rhythm, RhythmRates
from ..engine.behaviour.wave import MexicanWave
from ..engine.crowd.seating import SeatPlan

F64 = NDArray[np.float64]
TICK = 1.0 / 30.0


@dataclass(frozen=True, slots=True, eq=False)
class Bouts:
    """Rounds of applause of many groups, and of the people in them; seconds after the cue.

    Attributes
    ----------
    first, all_started, first_stop, last
        (G,) first start, last start, first stop and last stop of each group in which anybody
        clapped.
    claps
        (K,) claps of each person that clapped.
    proportion
        Share of the people that clapped.
    """

    first: F64
    all_started: F64
    first_stop: F64
    last: F64
    claps: F64
    proportion: float

    @property
    def length(self) -> F64:
        """(G,) seconds from the first to the last clap."""
        return self.last - self.first


def applaud(
    sizes: NDArray[np.int64],
    benefit: float,
    rng: np.random.Generator,
) -> Bouts:
    """Let groups of `sizes` people, each in a room of its own, answer a talk."""
    group = np.repeat(np.arange(len(sizes)), sizes)
    hearing = Hearing(group)
    rate = Rhythm(hearing, rng).frequency
    applause = Applause(hearing, rng, rate)
    applause.cue(np.arange(len(group)), benefit)
    began, ended = np.full(len(group), np.inf), np.full(len(group), -np.inf)
    tick = 0
    while tick < 300 or (len(applause.active) and tick < 3000):
        tick += 1
        change = applause.step(TICK)
        began[change.started] = np.minimum(began[change.started], tick * TICK)
        ended[change.stopped] = tick * TICK
    clapped = np.isfinite(began)
    start = np.cumsum(sizes) - sizes
    some = np.logical_or.reduceat(clapped, start)
    return Bouts(
        first=np.minimum.reduceat(began, start)[some],
        all_started=np.maximum.reduceat(np.where(clapped, began, 0.0), start)[some],
        first_stop=np.minimum.reduceat(np.where(clapped, ended, np.inf), start)[some],
        last=np.maximum.reduceat(ended, start)[some],
        claps=(ended - began)[clapped] * rate[clapped],
        proportion=float(clapped.mean()),
    )


def starting_rate(share: float, people: int, rng: np.random.Generator) -> float:
    """Starts a second of one person who hears `share` clapping: in the first tick of many rooms."""
    place = np.arange(people) % 100
    applause = Applause(Hearing(np.arange(people) // 100), rng, rates=ApplauseRates(reaction=0.0))
    applause.cue(np.arange(people), 3.0)
    applause.start(place < round(100 * share))
    silent = np.count_nonzero(applause.state != CLAPPING)
    started = len(applause.step(TICK).started)
    return float(-np.log1p(-started / silent) / TICK)


def clap_from_share(
    hearing: Hearing, share: float, seconds: float, rng: np.random.Generator
) -> F64:
    """(T,) share clapping in each tick, where `share` is made to clap for no reason."""
    applause = Applause(hearing, rng)
    applause.start(rng.random(len(hearing.group)) < share)
    curve = []
    for _ in range(round(seconds / TICK)):
        applause.step(TICK)
        curve.append(applause.share)
    return np.array(curve)


def synchronise(
    people: int, seconds: float, halve_at: float, rng: np.random.Generator, rates: RhythmRates
) -> F64:
    """(T,) order of clappers, all of whom halve their rate at `halve_at` seconds."""
    rhythm = Rhythm(Hearing(np.zeros(people, int)), rng, rates)
    active = np.arange(people)
    order = []
    for tick in range(round(seconds / TICK)):
        if tick == round(halve_at / TICK):
            rhythm.rate *= np.float32(0.5)
        rhythm.step(active, TICK)
        order.append(abs(rhythm.order[0]))
    return np.array(order)


REFERENCE_RHYTHM = RhythmRates(rate=1.0, variation=1.0 / 6.9, coupling=0.8, patience=1e9)
"""The run of Neda et al. 2000: mean 2 pi, s.d. 2 pi / 6.9 and K = 0.8 a second, no own changes."""


def ovation(hearing: Hearing, seconds: float, rng: np.random.Generator) -> tuple[F64, F64]:
    """(T,) order and share of slow clappers, where everybody claps on and on."""
    rhythm = Rhythm(hearing, rng)
    active = np.flatnonzero(hearing.present)
    rhythm.begin(active)
    order, slow = [], []
    for _ in range(round(seconds / TICK)):
        rhythm.step(active, TICK)
        order.append(float(np.abs(rhythm.order).mean()))
        slow.append(float(rhythm.is_slow[active].mean()))
    return np.array(order), np.array(slow)


@dataclass(frozen=True, slots=True, eq=False)
class WaveRun:
    """What became of an attempt.

    Attributes
    ----------
    rose_at
        (N,) seconds at which each agent first got up; NaN for who never did.
    active
        (T,) how many were up in each tick.
    """

    rose_at: F64
    active: F64


def crowd_near(
    plan: SeatPlan, seat: int, count: int, present: NDArray[np.bool_]
) -> NDArray[np.int64]:
    """Ids of the `count` people nearest to a seat."""
    x, _, z = plan.position
    away = np.where(present, np.hypot(x - x[seat], z - z[seat]), np.inf)
    return np.argsort(away, kind="stable")[:count]


def start_wave(
    plan: SeatPlan,
    present: NDArray[np.bool_],
    seat: int,
    starters: int,
    seconds: float,
    rng: np.random.Generator,
) -> WaveRun:
    """Let the `starters` people nearest to a seat stand up together."""
    wave = MexicanWave(plan, rng, present)
    wave.start(crowd_near(plan, seat, starters, present))
    rose_at, active, up = np.full(plan.count, np.nan), [], 0
    for tick in range(round(seconds / TICK)):
        change = wave.step()
        new = change.rose[np.isnan(rose_at[change.rose])]
        rose_at[new] = tick * TICK
        up += len(change.rose) - len(change.sat)
        active.append(up)
        if wave.is_quiet:
            break
    return WaveRun(rose_at, np.array(active, np.float64))


def wave_speeds(plan: SeatPlan, run: WaveRun) -> F64:
    """(K,) seats a second along each row of each long side; above 0 towards higher columns.

    Times are fitted by a line over the columns. Sides that the wave reached within 5 s, where it
    began, are left out; so are rows with fewer than 40 people who got up.
    """
    x, _, z = plan.position
    speeds = []
    for side in (-1, 1):
        part = (z * side > 20.0) & (np.abs(x) < 35.0) & np.isfinite(run.rose_at)
        if not part.any() or run.rose_at[part].min() < 5.0:
            continue
        for row in np.unique(plan.row[part]):
            some = part & (plan.row == row)
            if some.sum() >= 40:
                speeds.append(1.0 / np.polyfit(plan.column[some], run.rose_at[some], 1)[0])
    return np.array(speeds)


def ignitions(
    plan: SeatPlan,
    present: NDArray[np.bool_],
    starters: int,
    attempts: int,
    rng: np.random.Generator,
) -> int:
    """How many of the attempts of `starters` people run: reach a thousand more within 6 s."""
    inner = np.flatnonzero(present & (plan.tier == 0) & (plan.row > 4))
    inner = inner[plan.row[inner] < plan.row[plan.tier == 0].max() - 4]
    wave = MexicanWave(plan, rng, present)
    ran = 0
    for seat in rng.choice(inner, attempts):
        wave.reset()
        wave.start(crowd_near(plan, int(seat), starters, present))
        rose = 0
        for _ in range(round(6.0 / TICK)):
            rose += len(wave.step().rose)
            if rose > starters + 1000 or wave.is_quiet:
                break
        ran += rose > starters + 1000
    return ran


def half_life(column: str, rng: np.random.Generator, plan: SeatPlan) -> float:
    """Seconds in which the crowd's mean mood or excitement halves, each agent's being different."""
    contagion = EmotionContagion(plan)
    values = {
        name: rng.uniform(0.2, 1.0, plan.count).astype(np.float32)
        for name in ("mood", "excitement")
    }
    begin = float(values[column].mean())
    seconds = 0.0
    while values[column].mean() > 0.5 * begin:
        contagion.step(values["mood"], values["excitement"], 0.5)
        seconds += 0.5
    return seconds


def boil(
    plan: SeatPlan,
    present: NDArray[np.bool_],
    seconds: float,
    warmest: float,
    rng: np.random.Generator,
) -> tuple[F64, F64]:
    """(T,) share clapping and mean excitement, while what excitement falls back to slowly rises."""
    applause = Applause(Hearing.of_sections(plan, present), rng)
    contagion = EmotionContagion(plan, present)
    mood = np.zeros(plan.count, np.float32)
    excitement = rng.uniform(0.0, 0.4, plan.count).astype(np.float32)
    own = excitement.copy()
    share, mean = [], []
    ticks = round(seconds / TICK)
    for tick in range(ticks):
        if tick % 30 == 0:
            contagion.excitement_rest[:] = own + warmest * tick / ticks
        contagion.step(mood, excitement, TICK)
        applause.ground[:] = contagion.clap_benefit(excitement)
        applause.step(TICK)
        share.append(applause.share)
        mean.append(float(excitement[present].mean()))
    return np.array(share), np.array(mean)
