"""What a base tick with a pose tick in it costs, system by system, without drawing."""

from __future__ import annotations

from time import perf_counter
from typing import Any

import numpy as np

from ..engine.behaviour.events import Goal
from ..engine.crowd.cameras import camera_presets
from ..engine.crowd.spec import CrowdSpec
from ..scripting.camera import FreeCamera
from ..systems.simulation import Simulation
from .measure import environment, spread
from .synthetic import synthetic_character

SIZE = (1280, 720)


def tick(
    *, agents: int, streams: int, joints: int, history: int, runs: int, seed: int = 1
) -> dict[str, Any]:
    """Time pose ticks of a whole stadium seen from the main stand, and ticks in which goals fall.

    Parameters
    ----------
    agents, streams, joints, history
        Size of the crowd; every seat is taken.
    runs
        Pose ticks that are timed.
    seed
        Of crowd and character.
    """
    spec = CrowdSpec(
        seats=agents, occupancy=1.0, sides=2, streams=streams, history=history, seed=seed
    )
    character = synthetic_character(joints, np.random.default_rng(seed))
    simulation = Simulation(spec, character)
    eye, target = camera_presets(simulation.plan)["tv"]
    camera = FreeCamera.looking(eye, target)
    simulation.look(camera.view(), camera.projection(SIZE), SIZE[1])
    schedule = simulation.schedule
    whole: list[float] = []
    goals: list[float] = []
    with simulation.active():
        for number in range(2 * runs + 120):
            # Goals of both sides, rarely, and the crowd calm again before the next.
            goal = number >= 120 and number % 600 == 120
            if goal:
                simulation.crowd.send(Goal(side=number // 600 % 2))
            schedule.keep_times = number >= 120 and (simulation.clock.tick + 1) % 2 == 0
            begin = perf_counter()
            schedule.tick()
            schedule.frame()
            if schedule.keep_times:
                (goals if goal or number % 600 == 121 else whole).append(perf_counter() - begin)
    result: dict[str, Any] = {
        "benchmark": "tick",
        "agents": agents,
        "streams": streams,
        "joints": joints,
        "history_poses": history,
        **spread(whole),
        "systems": {_name(name): spread(times) for name, times in schedule.times.items()},
        "environment": environment(),
    }
    if goals:
        result["goal_tick_ms"] = spread(goals)["median_ms"]
    simulation.close()
    return result


def _name(system: str) -> str:
    return system.removesuffix("System").lower()
