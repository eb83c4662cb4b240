"""A whole match without pictures: does the crowd drift, does anybody get stuck, does memory grow?

Some quiet minutes, then random events, then quiet again. At the end people must do what they did in
the beginning, in the same shares.
"""

from __future__ import annotations

import os
import sys
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..engine.behaviour.events import KINDS, PLACED, SIDED, Event
from ..engine.behaviour.table import PIECE
from ..engine.crowd.spec import CrowdSpec
from ..systems.crowd import Crowd
from ..systems.observing import CrowdObserver
from ..systems.simulation import Simulation
from .measure import environment

QUIET, CALM = 120.0, 600.0
"""Seconds before the first event, and from the last one to the end."""
EVERY = 1.0
"""Seconds from sample to sample."""
LEAST_MINUTES = 14.0
LIKELY = {"goal": 2.0, "near_miss": 8.0, "foul": 12.0, "corner": 6.0, "cue": 4.0}
"""How often kinds of events come, against 1 for the others."""


def random_events(
    crowd: Crowd, count: int, begin: float, end: float, rng: np.random.Generator
) -> list[Event]:
    """Events of all kinds and weights at random times, `begin` to `end` seconds, in their order."""
    chance = np.array([LIKELY.get(kind, 1.0) for kind in KINDS])
    kinds = rng.choice(len(KINDS), count, p=chance / chance.sum())
    sides = [int(side) for side in np.unique(crowd.team.side) if side >= 0] or [0]
    there = np.flatnonzero(crowd.seat.occupied)
    events = []
    for kind, time in zip(kinds, np.sort(rng.uniform(begin, end, count)), strict=True):
        name = KINDS[kind]
        sided = name in SIDED or rng.random() < 0.3
        x, y, z = crowd.placement.position[:, rng.choice(there)]
        events.append(
            Event(
                name,
                side=int(rng.choice(sides)) if sided else None,
                weight=float(rng.uniform(0.1, 1.0)),
                place=(float(x), float(y), float(z)) if name in PLACED else None,
                time=float(time),
            )
        )
    return events


class LimitWatch(CrowdObserver):
    """By how many pose ticks anybody stayed longer in a state than the table allows.

    Attributes
    ----------
    worst
        (S,) int64 by state; at most 0 where nobody did. Someone who is getting up or sitting down
        finishes that first, and stays end at the ends of pieces.
    """

    def __init__(self, crowd: Crowd) -> None:
        self._crowd = crowd
        self.worst = np.full(len(crowd.table.names), -(2**31), np.int64)

    def see(self, tick: int) -> None:
        """Look once in a piece."""
        if tick % PIECE:
            return
        crowd = self._crowd
        present = crowd.seat.occupied
        for state, entered in zip(crowd.behaviour.state, crowd.behaviour.entered, strict=True):
            over = (tick - entered - crowd.table.limit[state])[present]
            np.maximum.at(self.worst, state[present], over)


def soak(
    *, agents: int = 65_000, minutes: float = 90.0, events: int = 300, runs: int = 1, seed: int = 1
) -> dict[str, Any]:
    """Run a match as fast as it goes, behaviour only, and say how it ended.

    Parameters
    ----------
    agents
        Seats of the stadium.
    minutes
        Length of the match, of which the first 2 and the last 10 are quiet.
    events
        How many, at random times between.
    runs
        How often the match is run; all must end in the same state.
    seed
        Of crowd and events.

    Raises
    ------
    ValueError
        For a match that is too short, or fewer than 0 events.
    """
    if not LEAST_MINUTES <= minutes <= 24 * 60:
        raise ValueError(f"minutes is {minutes}, expected {LEAST_MINUTES:g} to 1440")
    if events < 0 or runs < 1:
        raise ValueError(f"events is {events} and runs {runs}, expected 0 or more and 1 or more")
    first, *others = [_match(agents, minutes, events, seed) for _ in range(runs)]
    hashes = [first["state_hash"], *(other["state_hash"] for other in others)]
    return {
        "benchmark": "soak",
        "agents": agents,
        "minutes": minutes,
        "events": events,
        "runs": runs,
        "same_hash": len(set(hashes)) == 1,
        **first,
        "environment": environment(),
    }


def _match(agents: int, minutes: float, events: int, seed: int) -> dict[str, Any]:
    simulation = Simulation(CrowdSpec(seats=agents, sides=2, poses="none", seed=seed))
    crowd = simulation.crowd
    end = 60.0 * minutes
    rng = np.random.default_rng([seed, 2])
    for event in random_events(crowd, events, QUIET, end - CALM, rng):
        crowd.send(event)
    limits = LimitWatch(crowd)
    crowd.observers.active.append(limits)
    watch = crowd.watch(every=EVERY, by=("team",))
    begin = perf_counter()
    simulation.run(seconds=QUIET + 0.25 * (end - CALM - QUIET))
    warm = resident_bytes()
    simulation.run(seconds=end - QUIET - 0.25 * (end - CALM - QUIET))
    seconds = perf_counter() - begin
    shares = watch.shares("state")[:, 0]
    times = watch.times
    before = _mean(shares[times <= QUIET])
    after = _mean(shares[times > end - QUIET])
    names = crowd.table.names
    moved = np.argsort(-np.abs(after - before))[:5]
    reacting = watch.count("reacting")[:, 0] / watch.people()[:, 0]
    result = {
        "seconds": round(seconds, 1),
        "times_faster": round(end / seconds, 1),
        "largest_change_of_a_share": float(np.abs(after - before).max()),
        "shares": {
            names[k]: [round(float(before[k]), 4), round(float(after[k]), 4)] for k in moved
        },
        "most_reacting": float(reacting.max()),
        "most_clapping": float((watch.count("clapping")[:, 0] / watch.people()[:, 0]).max()),
        "states_entered": int(np.count_nonzero(limits.worst > -(2**31))),
        "states": len(names),
        "overstayed_seconds": max(float(limits.worst.max()) / 30.0, 0.0),
        "longest_in_limit": names[int(limits.worst.argmax())],
        "mean_excitement": [
            round(float(value), 4)
            for value in (
                watch.mean("excitement")[times <= QUIET].mean(),
                watch.mean("excitement")[times > end - QUIET].mean(),
            )
        ],
        "memory_warm_bytes": warm,
        "memory_end_bytes": resident_bytes(),
        "state_hash": crowd.state_hash(),
    }
    simulation.close()
    return result


def resident_bytes() -> int:
    """Memory of this process that is resident; its peak where the system doesn't tell more."""
    try:
        with open("/proc/self/statm", encoding="ascii") as numbers:
            return int(numbers.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        import resource

        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        return peak if sys.platform == "darwin" else peak * 1024


def _mean(shares: NDArray[np.float64]) -> NDArray[np.float64]:
    mean: NDArray[np.float64] = shares.mean(axis=0)
    return mean
