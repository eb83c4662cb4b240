"""What people on their way cost: a bowl that fills through its doors."""

from __future__ import annotations

import numpy as np

from ..engine.crowd.spec import CrowdSpec
from ..systems.simulation import Simulation

SEATS, COMING, SECONDS, BEFORE = 20_000, 2_800, 80.0, 45.0
"""Seats of the bowl, people who come, seconds within which, and seconds before times are taken."""


def walking_costs(runs: int, seed: int) -> tuple[list[float], int]:
    """Seconds that walking takes in a pose tick, and how many people are then on their way.

    Both base ticks of a pose tick are counted: people are moved in either.

    Parameters
    ----------
    runs
        Pose ticks that are timed.
    seed
        Of the crowd, and of who comes.
    """
    spec = CrowdSpec(seats=SEATS, occupancy=0.85, poses="none", walking=True, seed=seed)
    simulation = Simulation(spec)
    crowd, schedule = simulation.crowd, simulation.schedule
    empty = np.flatnonzero(~crowd.seat.occupied)
    crowd.arrive(np.random.default_rng(seed).choice(empty, COMING, replace=False), seconds=SECONDS)
    with simulation.active():
        for _ in range(round(BEFORE * 60)):
            schedule.tick()
        schedule.keep_times = True
        for _ in range(2 * runs):
            schedule.tick()
    people = len(crowd.walk)
    simulation.close()
    return np.reshape(schedule.times["WalkingSystem"], (runs, 2)).sum(axis=1).tolist(), people
