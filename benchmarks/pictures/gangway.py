"""A gangway close up: people who come late, those who let them pass, and a steward."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ...engine.crowd.spec import CrowdSpec
from ...engine.streams.pool import POSE_RATE
from ...scripting.camera import FreeCamera
from ...scripting.stage import Stage
from ...systems.simulation import Simulation
from .sheet import with_few_colours

SEATS, STEWARDS, GATE = 1200, 6, 2
"""Size of a bowl, as many stewards as it has gangways, and the one of these that is looked at."""
NEAR, ROWS = 3.6, 8
"""Metres from that gangway, and rows, of the empty seats that people come to."""
WITHIN, CLIMBS, MOMENT = 16.0, 10.0, 20.4
"""Seconds within which they come, and at which the steward goes up and the picture is taken."""


def gangway_crowd() -> tuple[Simulation, NDArray[np.int64], int]:
    """People are on the way to their seats; their ids, and that of the steward."""
    spec = CrowdSpec(
        seats=SEATS,
        occupancy=0.84,
        stewards=STEWARDS,
        sides=2,
        fans="mixed",
        neutrals=0.3,
        props=0.2,
        lod=False,
        seed=11,
    )
    simulation = Simulation(spec)
    crowd, plan = simulation.crowd, simulation.plan
    assert crowd.walkers is not None
    x, _, z = crowd.walkers.ways.stairs(GATE, 0, 0).points[-1]
    beside = (np.abs(plan.position[0] - x) < NEAR) & (plan.position[2] < z + 1.0)
    empty = np.flatnonzero(~crowd.seat.occupied & beside & (plan.row < ROWS))
    late = crowd.arrive(empty, seconds=WITHIN)
    steward = next(a for a, gate in crowd.walkers.posts.items() if gate == GATE)
    simulation.run(seconds=CLIMBS)
    crowd.walk.until[crowd.walk.agent == steward] = round(CLIMBS * POSE_RATE)
    simulation.run(seconds=MOMENT - CLIMBS)
    return simulation, late, steward


def gangway_camera(simulation: Simulation) -> FreeCamera:
    """Before the gangway, a little above the heads of those in front."""
    assert simulation.crowd.walkers is not None
    points = simulation.crowd.walkers.ways.stairs(GATE, 0, 6).points
    x, y, z = points.mean(axis=0).tolist()
    target = (x + 0.15, y + 0.6, z)
    camera = FreeCamera.looking((x + 2.6, y + 3.2, z + 16.0), target)
    camera.fov = math.radians(17.5)
    return camera


def draw_gangway(scale: float = 1.0) -> Image.Image:
    """People come down a gangway and pass others in their rows, and a steward goes up."""
    simulation, _, _ = gangway_crowd()
    size = (round(1140 * scale), round(770 * scale))
    stage = Stage.offscreen(simulation, size)
    stage.draw(gangway_camera(simulation))
    picture = Image.fromarray(stage.pixels())
    stage.close()
    simulation.close()
    return with_few_colours(picture)
