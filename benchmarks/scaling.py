"""What behaviour alone costs for crowds of a thousand to a million: no poses, no streams."""

from __future__ import annotations

import gc
from time import perf_counter
from typing import Any

import numpy as np

from ..engine.behaviour.events import EventQueue, Goal
from ..engine.clock import Clock
from ..engine.crowd.spec import CrowdSpec
from ..systems.behaviour import BehaviourSystem
from ..systems.simulation import Simulation
from .measure import environment, spread

Seconds = list[float]

SIZES = (1_000, 10_000, 65_000, 250_000, 1_000_000)
GOALS, AFTER = 3, 300
"""Goals that fall, and pose ticks that are watched after each: ten seconds."""
WARM_UP = 20


def scaling(*, agents: int, runs: int = 60, seed: int = 1) -> dict[str, Any]:
    """Time pose ticks of behaviour: quiet ones, those of goals, and the ten seconds after them.

    Parameters
    ----------
    agents
        Of the sizes from 1,000 to 1,000,000 those up to this are measured; it alone if it is less.
    runs
        Quiet pose ticks that are timed of each size.
    seed
        Of the crowds.
    """
    sizes = [size for size in SIZES if size <= agents] or [agents]
    situations = {}
    for size in sizes:
        for situation, figures in _measure(size, runs, seed).items():
            situations[f"{size:,}, {situation}"] = figures
    return {
        "benchmark": "scaling",
        "agents": sizes[-1],
        **situations[f"{sizes[-1]:,}, quiet"],
        "situations": situations,
        "environment": environment(),
    }


def _measure(agents: int, runs: int, seed: int) -> dict[str, dict[str, float]]:
    spec = CrowdSpec(seats=agents, occupancy=1.0, poses="none", walking=False, seed=seed)
    simulation = Simulation(spec)
    try:
        with simulation.active():
            quiet, goals, later, worst = _watch(simulation.crowd.events, runs, seed)
    finally:
        simulation.close()
        gc.collect()
    return {
        "quiet": spread(quiet),
        "tick of a goal": spread(goals),
        "10 s after it": spread(later),
        "the worst of them": spread(worst),
    }


def _watch(queue: EventQueue, runs: int, seed: int) -> tuple[Seconds, Seconds, Seconds, Seconds]:
    """Times of quiet ticks, of those of goals, of the ten seconds after each, and their worst."""
    system, clock = BehaviourSystem(np.random.default_rng(seed)), Clock()
    _time(system, clock, WARM_UP)
    quiet = _time(system, clock, runs)
    goals, later, worst = list[float](), list[float](), list[float]()
    for number in range(GOALS):
        queue.send(Goal(side=number % 2))
        after = _time(system, clock, AFTER)
        goals.append(after[0])
        later += after[1:]
        worst.append(max(after))
        _time(system, clock, AFTER // 2 + number)
    return quiet, goals, later, worst


def _time(system: BehaviourSystem, clock: Clock, ticks: int) -> Seconds:
    """Seconds of each of some pose ticks."""
    seconds = []
    for _ in range(ticks):
        while True:
            clock.advance()
            if clock.is_pose_tick:
                break
        begin = perf_counter()
        system.process(clock)
        seconds.append(perf_counter() - begin)
    return seconds
