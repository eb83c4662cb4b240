"""How alike neighbours are: as drawn, after casting, with what they wear, and after a goal."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..engine.behaviour.events import Goal
from ..engine.crowd.spec import CrowdSpec
from ..systems.casting import clone_report
from ..systems.simulation import Simulation
from .measure import environment

AFTER_GOAL = 3.0
"""Seconds after which the crowd is measured again."""


def variety(*, agents: int, streams: int, history: int, seed: int = 1) -> dict[str, Any]:
    """Measure a crowd of built-in spectators.

    Parameters
    ----------
    agents, streams, history
        Size of the crowd; every seat is taken.
    seed
        Of the crowd.

    Returns
    -------
    For each moment the figures of `tifo.engine.crowd.clones.CloneReport`
    """
    spec = CrowdSpec(
        seats=agents, occupancy=1.0, sides=2, streams=streams, history=history, seed=seed
    )
    moments = {}
    for name, casting in (("as drawn", False), ("cast", True)):
        simulation = Simulation(spec.replace(casting=casting, props=0.0))
        moments[name] = _report(simulation)
        simulation.close()
    simulation = Simulation(spec)
    moments["with caps, scarves and flags"] = _report(simulation)
    simulation.send(Goal(0))
    simulation.run(seconds=AFTER_GOAL)
    moments[f"{AFTER_GOAL:g} s after a goal"] = _report(simulation)
    simulation.close()
    return {
        "benchmark": "variety",
        "agents": agents,
        "streams": streams,
        "history_poses": history,
        "moments": moments,
        "environment": environment(),
    }


def _report(simulation: Simulation) -> dict[str, float]:
    figures = clone_report(simulation.crowd).figures()
    return {name: float(np.round(value, 8)) for name, value in figures.items()}
