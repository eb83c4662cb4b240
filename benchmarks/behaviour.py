"""The behaviour models beside what is published of people: figures, plots and what a tick costs."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..engine.behaviour.applause import Applause
from ..engine.behaviour.contagion import EmotionContagion
from ..engine.behaviour.hearing import Hearing
from ..engine.behaviour.parties import FOOTBALL, GENERAL_PUBLIC, seat_parties
from ..engine.behaviour.rhythm import Rhythm
from ..engine.behaviour.wave import MexicanWave
from ..engine.crowd.occupancy import occupancy_mask
from ..engine.crowd.seating import SeatPlan
from ..engine.crowd.spec import CrowdSpec
from ..engine.crowd.stadium import build_seats
from . import experiments as ex
from .measure import environment, spread
from .moods import MATCH, MINUTES, moods
from .plot import Panel, draw_panels
from .walking import walking_costs

TICK = ex.TICK
PEOPLE_AT_MATCH = 600
"""Of the match that is drawn: few, since all of it is run."""


@dataclass(frozen=True, slots=True)
class Figure:
    """What was measured here, and what is published."""

    name: str
    measured: str
    published: str


def behaviour(
    *, agents: int, runs: int = 200, plot: str | None = None, seed: int = 1
) -> dict[str, Any]:
    """Run all experiments.

    Parameters
    ----------
    agents
        Seats of the stadium; groups and reference runs have sizes of their own.
    runs
        Ticks timed.
    plot
        PNG file to draw to.
    seed
        Of everything.
    """
    spec = CrowdSpec(seats=agents, seed=seed)
    plan = build_seats(spec)
    rng = np.random.default_rng(seed)
    present = occupancy_mask(plan, spec, rng)
    figures: list[Figure] = []
    panels: list[Panel] = []
    _applause(plan, present, rng, figures, panels)
    _rhythm(plan, present, rng, figures, panels)
    _wave(plan, present, rng, figures, panels)
    _emotion(plan, present, rng, figures, panels)
    _parties(plan, rng, figures)
    if plot is not None:
        panels.append(_moods(seed))
        draw_panels(panels, plot)
    costs = tick_costs(plan, present, runs, rng)
    walking, people = walking_costs(runs, seed)
    costs["walking"] = spread(walking)
    figures.append(Figure("people on their way, timed as walking", f"{people}", ""))
    return {
        "benchmark": "behaviour",
        "agents": agents,
        **costs["quiet"],
        "situations": costs,
        "figures": [asdict(figure) for figure in figures],
        "environment": environment(),
    }


def _applause(
    plan: SeatPlan,
    present: NDArray[np.bool_],
    rng: np.random.Generator,
    figures: list[Figure],
    panels: list[Panel],
) -> None:
    sizes = rng.integers(13, 21, 1000)
    bouts = ex.applaud(sizes, 1.0, rng)
    low, middle, high = np.percentile(bouts.claps, [25, 50, 75])
    fast, slow = (ex.starting_rate(share, 400_000, rng) for share in (0.5, 0.05))
    hearing = Hearing.of_sections(plan, present)
    curve = ex.clap_from_share(hearing, 0.25, 6.0, rng)
    reached = np.flatnonzero(curve >= 0.9)
    figures += [
        Figure("first clap after a talk, 13-20 people", f"{bouts.first.mean():.2f} s", "2.1 s"),
        Figure("first to last clap", f"{bouts.length.mean():.2f} s", "6.1 s"),
        Figure("first to last start", f"{(bouts.all_started - bouts.first).mean():.2f} s", ""),
        Figure("claps a person, quartiles", f"{low:.0f}, {middle:.0f}, {high:.0f}", ""),
        Figure("starting, half against a twentieth", f"{fast / slow:.1f} times", "10 times"),
        Figure(
            "from 25 % clapping to 90 %, stadium",
            f"{(reached[0] + 1) * TICK:.1f} s" if len(reached) else f"{curve.max():.0%} at most",
            "soon",
        ),
    ]
    benefits = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0])
    answers = [ex.applaud(rng.integers(13, 21, 300), float(b), rng) for b in benefits]
    lengths = [float(a.length.mean()) if len(a.length) else 0.0 for a in answers]
    panels.append(
        Panel(
            "Who claps, by impressiveness (groups of 13-20)",
            "benefit b (1 is a good talk)",
            "share that claps; length / 10 s",
            [
                ("share", benefits, [a.proportion for a in answers]),
                ("length", benefits, np.array(lengths) / 10.0),
            ],
            marks=True,
        )
    )
    panel = Panel("Applause in the stadium", "seconds after the cue", "share that claps")
    for benefit in (0.3, 1.0, 3.0):
        applause = Applause(hearing, rng)
        applause.cue(present, benefit)
        shares = []
        for _ in range(round(12.0 / TICK)):
            applause.step(TICK)
            shares.append(applause.share)
        panel.lines.append((f"b = {benefit:g}", TICK * np.arange(len(shares)), shares))
    panel.lines.append(("25 % made to, b = 0", TICK * np.arange(len(curve)), curve))
    panels.append(panel)


def _rhythm(
    plan: SeatPlan,
    present: NDArray[np.bool_],
    rng: np.random.Generator,
    figures: list[Figure],
    panels: list[Panel],
) -> None:
    reference = ex.synchronise(5000, 180.0, 60.0, rng, ex.REFERENCE_RHYTHM)
    free = float(reference[round(20 / TICK) : round(60 / TICK)].mean())
    figures += [
        Figure("Kuramoto reference run: order at full rate", f"{free:.2f}", "none"),
        Figure("order 60 s after halving", f"{reference[round(120 / TICK)]:.2f}", "grows"),
        Figure("order 120 s after halving", f"{reference[-1]:.2f}", "grows"),
    ]
    seconds = TICK * np.arange(len(reference))
    panels.append(
        Panel(
            "Neda's reference run: every rate halved at 60 s",
            "seconds",
            "order |Z|",
            [("order", seconds, reference)],
        )
    )
    order, slow = ex.ovation(Hearing.of_sections(plan, present), 90.0, rng)
    seconds = TICK * np.arange(len(order))
    panels.append(
        Panel(
            "An ovation that does not end: rhythm comes and goes",
            "seconds",
            "order; share",
            [("order |Z|", seconds, order), ("share at half rate", seconds, slow)],
        )
    )
    rhythmic = TICK * np.count_nonzero(order > 0.5)
    figures.append(
        Figure(
            "ovation of 90 s: in rhythm, order at most", f"{rhythmic:.0f} s, {order.max():.2f}", ""
        )
    )


def _wave(
    plan: SeatPlan,
    present: NDArray[np.bool_],
    rng: np.random.Generator,
    figures: list[Figure],
    panels: list[Panel],
) -> None:
    x, _, z = plan.position
    lower = np.flatnonzero(present & (plan.tier == 0) & (z < 0))
    row = int(np.median(plan.row[lower]))
    seat = int(lower[np.argmin(np.abs(x[lower]) + 5.0 * np.abs(plan.row[lower] - row))])
    run = ex.start_wave(plan, present, seat, 40, 60.0, rng)
    speeds = ex.wave_speeds(plan, run)
    if len(speeds):
        low, middle, high = np.percentile(np.abs(speeds), [10, 50, 90])
        width = 0.7 * middle
        figures += [
            Figure("wave: seats a second", f"{middle:.1f} ({low:.1f} to {high:.1f})", "22 +- 3"),
            Figure("wave: seats from its front to its back", f"{width:.0f}", ""),
        ]
    people = np.array([15, 20, 25, 30, 35, 40, 50])
    ran = np.array([ex.ignitions(plan, present, int(n), 12, rng) for n in people]) / 12
    half = float(np.interp(0.5, np.maximum.accumulate(ran) + 1e-9 * people, people))
    figures.append(Figure("wave: starters for an even chance", f"{half:.0f}", "25 to 35"))
    panels.append(
        Panel(
            "Mexican wave: attempts that run",
            "people who stand up together",
            "share of attempts",
            [("ran", people, ran)],
            marks=True,
        )
    )
    panel = Panel(
        "Mexican wave: when people get up", "degrees clockwise from the far side", "seconds"
    )
    angle = np.degrees(np.arctan2(x, -z)) % 360.0
    for tier in range(int(plan.tier.max()) + 1):
        degrees = np.arange(2, 360, 4)
        some = [(plan.tier == tier) & (np.abs(angle - d) < 2) & (run.rose_at >= 0) for d in degrees]
        at = [float(np.median(run.rose_at[mask])) if mask.any() else np.nan for mask in some]
        panel.lines.append((f"tier {tier}", degrees, at))
    if np.isfinite(run.rose_at).any():
        panels.append(panel)


def _emotion(
    plan: SeatPlan,
    present: NDArray[np.bool_],
    rng: np.random.Generator,
    figures: list[Figure],
    panels: list[Panel],
) -> None:
    for column, published in (("mood", "1.9 min"), ("excitement", "1.7 min")):
        minutes = ex.half_life(column, rng, plan) / 60.0
        figures.append(Figure(f"half-life of {column}", f"{minutes:.2f} min", published))
    share, mean = ex.boil(plan, present, 240.0, 0.5, rng)
    seconds = TICK * np.arange(len(share))
    begin = np.flatnonzero(share > 0.5)
    when = f"at excitement {mean[begin[0]]:.2f}" if len(begin) else "not at all"
    figures.append(Figure("boiling: the crowd joins", when, ""))
    panels.append(
        Panel(
            "Boiling: a crowd gets more and more excited",
            "seconds",
            "share that claps; excitement",
            [("share that claps", seconds, share), ("mean excitement", seconds, mean)],
        )
    )


def _moods(seed: int) -> Panel:
    match = moods(PEOPLE_AT_MATCH, MINUTES, seed)
    goals = [f"{minute:.0f}" for minute, kind, _ in MATCH if kind == "goal"]
    return Panel(
        f"A match of 2:1, goals after {', '.join(goals[:-1])} and {goals[-1]} minutes",
        "minutes",
        "mean of a side",
        [
            (f"{name}, {side}", match.minutes, column[:, number])
            for name, column in (("mood", match.mood), ("excitement", match.excitement))
            for number, side in enumerate(("home", "away"))
        ],
    )


def _parties(plan: SeatPlan, rng: np.random.Generator, figures: list[Figure]) -> None:
    for name, mix, published in (
        ("general public", GENERAL_PUBLIC, "71, 21, 6, 2 %"),
        ("football", FOOTBALL, "a quarter alone, about 4"),
    ):
        taken, party = seat_parties(plan, round(0.96 * plan.count), mix, rng)
        sizes = np.bincount(party.party[taken])
        groups = sizes[sizes > 1]
        shares = [100.0 * np.mean(groups == k) for k in (2, 3, 4)] + [100.0 * np.mean(groups > 4)]
        alone = np.count_nonzero(sizes == 1) / max(int(taken.sum()), 1)
        measured = ", ".join(f"{share:.0f}" for share in shares) + " %"
        if mix is FOOTBALL:
            measured = f"{alone:.0%} alone, {groups.mean():.1f}"
        figures.append(Figure(f"parties, {name}", measured, published))


def tick_costs(
    plan: SeatPlan, present: NDArray[np.bool_], runs: int, rng: np.random.Generator
) -> dict[str, dict[str, float]]:
    """Times of a tick of applause, rhythm, wave and contagion together.

    Returns
    -------
    dict
        ``quiet``: people in good mood clap here and there; ``all_clap``: everybody claps;
        ``wave``: a wave runs, and they clap here and there.
    """
    costs = {}
    for situation in ("quiet", "all_clap", "wave"):
        hearing = Hearing.of_sections(plan, present)
        rhythm = Rhythm(hearing, rng)
        applause = Applause(hearing, rng, rhythm.rate)
        contagion = EmotionContagion(plan, present)
        wave = MexicanWave(plan, rng, present)
        mood = np.zeros(plan.count, np.float32)
        excitement = np.full(plan.count, 0.2, np.float32)
        contagion.excitement_rest[:] = excitement
        if situation == "all_clap":
            applause.cue(present, 30.0)
        if situation == "wave":
            wave.start(ex.crowd_near(plan, int(np.flatnonzero(present)[0]), 60, present))
        seconds = []
        for tick in range(runs + 60):
            begin = perf_counter()
            wave.step()
            contagion.step(mood, excitement, TICK)
            np.multiply(excitement, np.float32(contagion.rates.boil), out=applause.ground)
            change = applause.step(TICK)
            rhythm.begin(change.started)
            rhythm.step(applause.active, TICK)
            if tick >= 60:
                seconds.append(perf_counter() - begin)
        costs[situation] = spread(seconds)
    return costs
