"""What behaviour alone costs for crowds of a thousand to a million: no poses, no streams."""

from __future__ import annotations

import gc
from collections.abc import Sequence
from time import perf_counter
from typing import Any
from uuid import uuid4

import esper
import numpy as np
from numpy.typing import NDArray

from ..components import Behaviour, MotionState, Placement, Seat, Team
from ..engine.behaviour.answers import Answers
from ..engine.behaviour.company import Company
from ..engine.behaviour.compiled import compile_table
from ..engine.behaviour.emotion import draw_emotion
from ..engine.behaviour.events import EventQueue, Goal
from ..engine.behaviour.guidance import Guidance
from ..engine.behaviour.machine import settle
from ..engine.behaviour.parties import GENERAL_PUBLIC, form_parties
from ..engine.behaviour.table_file import load_table
from ..engine.clock import Clock
from ..engine.crowd.motions import Role, sort_motions
from ..engine.crowd.occupancy import assign_sides
from ..engine.crowd.spec import CrowdSpec
from ..engine.crowd.stadium import build_seats
from ..systems.behaviour import BehaviourSystem, columns_of
from .measure import environment, spread
from .synthetic import synthetic_character

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
    before, world = esper.current_world, f"bench-{uuid4().hex}"
    esper.switch_world(world)
    try:
        queue = _spawn(agents, np.random.default_rng(seed))
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
    finally:
        esper.switch_world(before)
        esper.delete_world(world)
        gc.collect()
    return {
        "quiet": spread(quiet),
        "tick of a goal": spread(goals),
        "10 s after it": spread(later),
        "the worst of them": spread(worst),
    }


def _time(system: BehaviourSystem, clock: Clock, ticks: int) -> Sequence[float]:
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


def _spawn(agents: int, rng: np.random.Generator) -> EventQueue:
    """A crowd's behaviour without anything that is shown, as an entity of the current world."""
    spec = CrowdSpec(seats=agents, occupancy=1.0, sides=2)
    plan = build_seats(spec)
    count = plan.count
    present: NDArray[np.bool_] = np.ones(count, np.bool_)
    side = assign_sides(plan, spec, rng)
    team = Team(side, np.where(side < 0, 0.4, 1.0).astype(np.float32))
    emotion = draw_emotion(team.fervour, spec.embarrassment, rng)
    party = form_parties(plan, present, GENERAL_PUBLIC, rng)
    library = sort_motions(synthetic_character(4, rng).clips)
    table = compile_table(load_table("sport"), library)
    behaviour = Behaviour.allocate(len(table.starts), count)
    company = Company(plan, present, team, emotion, party, rng)
    behaviour.signals.update(company.signals)
    settle(table, behaviour, columns_of(behaviour, emotion, team), rng)
    queue = EventQueue()
    esper.create_entity(
        *(behaviour, table, emotion, team, company, queue, Answers(count)),
        Guidance(count, len(table.names), rng),
        Placement(
            plan.position.astype(np.float32),
            np.zeros(count, np.float32),
            np.ones(count, np.float32),
        ),
        Seat(plan.row, plan.column, plan.section, present),
        MotionState.allocate(library.draw(Role.CALM, count, rng)),
    )
    return queue
