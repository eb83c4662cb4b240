"""Where people on their way are, from the columns of their walk, and how they go on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.walk import RATES, VALUES, Leg, Walk

F32 = NDArray[np.float32]
Ints = NDArray[np.int64]

_NORMAL = slice(Leg.NORMAL_X, Leg.NORMAL_Z + 1)


@dataclass(slots=True)
class Now:
    """What follows from the columns of a walk at one moment.

    Parameters
    ----------
    place
        (3, W) metres.
    ahead, normal
        (2, W) x and z along the route and to the right of it.
    yaw
        (W,) radians, where people want to look.
    """

    place: F32
    ahead: F32
    normal: F32
    yaw: F32


def look(walk: Walk) -> Now:
    """Where everybody is."""
    leg = walk.leg
    values = leg[RATES] * walk.along
    values += leg[VALUES]
    normal = values[_NORMAL]
    values[Leg.X : Leg.Z + 1 : 2] += normal * walk.aside
    return Now(
        values[Leg.X : Leg.Z + 1], leg[Leg.AHEAD_X : Leg.AHEAD_Z + 1], normal, values[Leg.YAW]
    )


def advance(walk: Walk, seconds: float) -> Ints:
    """Let everybody go on at the present speed; rows of those who passed a vertex."""
    time = np.float32(seconds)
    along = walk.along
    along += walk.speed * time
    walk.aside += walk.drift * time
    passed = over = np.flatnonzero(along >= walk.leg[Leg.LENGTH])
    while len(over):
        along[over] -= walk.leg[Leg.LENGTH, over]
        walk.vertex[over] += 1
        walk.enter(over)
        along[over[walk.vertex[over] >= walk.last[over]]] = 0.0
        over = over[along[over] >= walk.leg[Leg.LENGTH, over]]
    return passed
