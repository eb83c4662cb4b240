"""What people must know at each vertex of their way, worked out once when they set out.

Somebody passes a vertex about once a second, and is moved sixty times in between. So all that holds
from one vertex to the next is a row of a table (`Leg`), with what a metre adds to it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.walk import LEG, RATES, VALUES, Errand, Leg
from .gangways import FLOOR_SPEED, ROW_SPEED, STAIR_SPEED, Route

F32 = NDArray[np.float32]

FAR = 1e6
"""Metres to what isn't there."""
_LEAST = 1e-6
_TURN = 2.0 * np.pi


def legs_of(route: Route, errand: Errand, seat_yaw: F32) -> F32:
    """All stretches of a way.

    Parameters
    ----------
    route
        The way, of p vertices.
    errand
        Whether it goes into a row or out of one.
    seat_yaw
        (N,) where those in the seats look: in a row people are passed facing as they do.

    Returns
    -------
    (p, 23) float32 by `Leg`; the last is the place at which the way ends, and goes nowhere.
    """
    last, leaves = len(route.points) - 1, errand is Errand.LEAVE
    table = np.zeros((last + 1, LEG))
    table[:, Leg.X : Leg.Z + 1] = route.points
    table[:, Leg.NORMAL_X : Leg.NORMAL_Z + 1] = route.normal
    table[:, Leg.SEAT] = np.arange(-route.seat0, last + 1 - route.seat0)
    change = table[1:, VALUES] - table[:-1, VALUES]
    length = np.sqrt(change[:, 0] ** 2 + change[:, 1] ** 2 + change[:, 2] ** 2)
    flat = np.maximum(np.sqrt(change[:, 0] ** 2 + change[:, 2] ** 2), _LEAST)
    ahead = change[:, :3:2] / flat[:, None]
    table[:-1, Leg.AHEAD_X : Leg.AHEAD_Z + 1] = ahead
    table[:-1, Leg.YAW] = np.arctan2(ahead[:, 0], ahead[:, 1])
    table[:-1, Leg.LENGTH] = length
    np.minimum(route.room[:-1], route.room[1:], out=table[:-1, Leg.ROOM])
    steep = np.abs(change[:, 1]) > 0.2 * length
    table[:-1, Leg.PACE] = np.where(steep, 1.0, FLOOR_SPEED / STAIR_SPEED)
    table[-1, Leg.AHEAD_X :] = table[-2, Leg.AHEAD_X :]
    table[-1, Leg.YAW] = table[-2, Leg.YAW]
    table[-1, Leg.LENGTH] = FAR
    reach = np.append(0.0, np.cumsum(length))
    table[:, Leg.REST] = reach[-1] - reach
    table[:, Leg.TO_MOUTH : Leg.TO_SEAT + 1] = FAR
    if route.mouth >= 0:
        passes = passed(route, errand)
        inside = slice(0, route.mouth) if leaves else slice(route.mouth, last + 1)
        table[inside, Leg.IN_ROW] = 1.0
        table[inside, Leg.PACE] = ROW_SPEED / STAIR_SPEED
        seat = np.arange(inside.start, inside.stop) - route.seat0
        near = np.minimum(np.maximum(seat, 0), passes - 1 if leaves else passes)
        yaw = seat_yaw[route.first + route.step * near]
        table[inside, Leg.YAW] = yaw
        turn = yaw[1:] - yaw[:-1]
        change[inside.start : inside.stop - 1, Leg.YAW] = turn - _TURN * np.rint(turn / _TURN)
        # The next one in the row who has to get up: not one's own seat, or whoever is behind it.
        follows = seat[: passes - leaves] + route.seat0
        table[follows, Leg.TO_SEAT] = length[follows]
        if not leaves:
            before = slice(0, route.mouth)
            table[before, Leg.TO_MOUTH] = reach[route.mouth] - reach[before]
            if passes:
                table[before, Leg.TO_SEAT] = reach[route.seat0] - reach[before]
    table[:-1, RATES] = change / np.maximum(length, _LEAST)[:, None]
    return table.astype(np.float32)


def passed(route: Route, errand: Errand) -> int:
    """How many seats of the row are passed on a way, one's own not counted."""
    if errand is Errand.LEAVE:
        return route.mouth
    return len(route.points) - 1 - route.seat0 if errand is Errand.ARRIVE else 0
