"""What a base tick with a pose tick in it costs, system by system, without drawing."""

from __future__ import annotations

from itertools import count
from time import perf_counter
from typing import Any

import numpy as np

from ..engine.behaviour.events import Goal
from ..engine.crowd.cameras import camera_presets
from ..engine.crowd.spec import CrowdSpec
from ..engine.streams.pool import Stream
from ..scripting.camera import FreeCamera
from ..systems.crowd import Crowd
from ..systems.simulation import Simulation
from .measure import environment, spread
from .synthetic import synthetic_character

SIZE = (1280, 720)
GOALS, CALM = 6, 450
"""Goals that are timed, and pose ticks between them: the cheers of the last one are over."""
FILL = 20
"""Ticks of every 40 from which on slots are filled."""


def tick(
    *,
    agents: int,
    streams: int,
    joints: int,
    history: int,
    runs: int,
    slots: int = 800,
    seed: int = 1,
) -> dict[str, Any]:
    """Time pose ticks of a whole stadium seen from the main stand, and ticks in which goals fall.

    Parameters
    ----------
    agents, streams, joints, history
        Size of the crowd; every seat is taken.
    runs
        Pose ticks that are timed.
    slots
        Transition slots, all in use: that many agents are in blends from a snapshot.
    seed
        Of crowd and character.
    """
    spec = CrowdSpec(
        seats=agents,
        occupancy=1.0,
        sides=2,
        streams=streams,
        history=history,
        slots=slots,
        seed=seed,
    )
    character = synthetic_character(joints, np.random.default_rng(seed))
    simulation = Simulation(spec, character)
    eye, target = camera_presets(simulation.plan)["tv"]
    camera = FreeCamera.looking(eye, target)
    simulation.look(camera.view(), camera.projection(SIZE), SIZE[1])
    schedule = simulation.schedule
    whole: list[float] = []
    goals: list[float] = []
    answers: list[float] = []
    in_use: list[int] = []
    with simulation.active():
        for number in count():
            if len(whole) == runs:
                break
            # Behaviour ends blends that hold slots: now and then they are taken again, untimed.
            fills = FILL <= number % 40 < FILL + 6
            if fills and number % 2 == 0:
                _fill_slots(simulation.crowd)
            is_pose_tick = (simulation.clock.tick + 1) % 2 == 0
            schedule.keep_times = number >= 120 and is_pose_tick and not fills
            begin = perf_counter()
            schedule.tick()
            schedule.frame()
            if schedule.keep_times:
                in_use.append(_slots_in_use(simulation.crowd))
                whole.append(perf_counter() - begin)
        quiet = {name: list(times) for name, times in schedule.times.items()}
        # What comes after a goal is no quiet tick, so goals of both sides come last. They fall at
        # different parts of the crowd's own beat, on which it chooses what to do next.
        for number in range(min(GOALS, runs)):
            schedule.keep_times = False
            for _ in range(2 * (CALM + number)):
                schedule.tick()
                schedule.frame()
            simulation.crowd.send(Goal(side=number % 2))
            schedule.keep_times = True
            begin = perf_counter()
            for _ in range(2):
                schedule.tick()
            schedule.frame()
            goals.append(perf_counter() - begin)
            answers.append(max(schedule.times["BehaviourSystem"][-2:]))
    result: dict[str, Any] = {
        "benchmark": "tick",
        "agents": agents,
        "streams": streams,
        "joints": joints,
        "history_poses": history,
        "slots_in_use": int(np.median(in_use)),
        **spread(whole),
        "systems": {_name(name): spread(times) for name, times in quiet.items()},
        "environment": environment(),
    }
    result["goal_tick_ms"] = spread(goals)["median_ms"]
    result["goal_behaviour_ms"] = spread(answers)["median_ms"]
    simulation.close()
    return result


def _fill_slots(crowd: Crowd) -> None:
    """Ask as many agents as there are free slots for something else, for an hour.

    The first time they begin a blend, and the second time they leave its middle. Behaviour leaves
    them alone, so that they keep their slots.
    """
    ladder, pool = crowd.ladder, crowd.pool
    assert ladder is not None
    assert pool is not None
    used = ladder.slots.holds(ladder.transition.row[0]) & (ladder.transition.duration[0] > 0)
    agents = np.flatnonzero(~used)[: ladder.slots.free]
    crowd.motion.busy_until[agents] = np.iinfo(np.int32).max
    crowd.transition_to_streamed(agents, Stream(0, int(pool.generation[0])), duration=3600.0)


def _slots_in_use(crowd: Crowd) -> int:
    assert crowd.ladder is not None
    return len(crowd.ladder.slots.used) - crowd.ladder.slots.free


def _name(system: str) -> str:
    return system.removesuffix("System").lower()
