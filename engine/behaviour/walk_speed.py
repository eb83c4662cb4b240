"""How fast people on their way go: social forces, queues, and waiting for others.

A person likes its pace, keeps to the right, and is slowed by the social forces of the others
(`steering`). It stops behind whoever stands before it, before a row that isn't free yet, and before
people in a row who haven't got up.
"""

from __future__ import annotations

import numpy as np

from ...components.walk import Leg, Stage, Walk
from ..crowd.gaits import STILL
from ..streams.pool import POSE_RATE
from .steering import FASTEST, RELAXATION, Pairs, repulsion
from .walk_now import F32, Now

RIGHT = 0.2
"""Metres to the right of the middle at which people walk where there is room."""
GAP = 0.5
"""Metres that people keep behind whoever goes before them."""
BEFORE_MOUTH = 0.9
"""Metres before a row at which somebody waits until it is free."""
BEFORE_SEATED = 0.45
"""Metres along a row before somebody who hasn't got up."""
PATIENCE = 6.0
"""Seconds after which somebody squeezes past those who are in the way."""
_BRAKE = 2.0
_SLOWEST = 0.3
_WIDE = 0.3
_BESIDE, _OPPOSITE = 0.42, 0.3
_DT = np.float32(1.0 / POSE_RATE)


def steer(walk: Walk, now: Now, room: F32, pairs: Pairs) -> None:
    """Set everybody's speed and drift for the next pose tick.

    Parameters
    ----------
    walk, now
        Who is on the way, and where.
    room
        (W,) metres to the next person in the row who sits yet; inf where nobody does.
    pairs
        Who is near whom.
    """
    leg, speed, drift, aside = walk.leg, walk.speed, walk.drift, walk.aside
    bound = walk.stage != Stage.WALK
    pace = leg[Leg.PACE] * walk.pace
    stands = speed < np.float32(STILL)
    stands &= walk.granted
    stands &= ~bound
    walk.waited += _DT
    walk.waited *= stands
    # To a row that isn't free, to whoever goes before, to people in the row who sit, and to the
    # end of the way.
    held = leg[Leg.TO_MOUTH] - walk.along
    held -= np.float32(BEFORE_MOUTH)
    held[walk.granted] = np.inf
    np.minimum(held, _behind(now, pairs), out=held)
    np.minimum(held, room - np.float32(BEFORE_SEATED), out=held)
    held[walk.waited >= np.float32(PATIENCE)] = np.inf
    np.maximum(held, np.float32(0.0), out=held)
    np.minimum(held, (leg[Leg.REST] - walk.along) + np.float32(0.12 / _BRAKE), out=held)
    held *= np.float32(_BRAKE)
    most = np.minimum(pace * np.float32(FASTEST), held, out=held)
    most[bound] = 0.0
    ahead, normal = now.ahead, now.normal
    velocity = ahead * speed
    velocity += normal * drift
    force = repulsion(pairs, velocity, ahead)
    along = force[0] * ahead[0]
    along += force[1] * ahead[1]
    # Nobody is pushed back, or brought to a standstill by those who come towards him.
    np.maximum(along, pace * np.float32((_SLOWEST - 1.0) / RELAXATION), out=along)
    pace -= speed
    pace *= np.float32(1.0 / RELAXATION)
    along += pace
    along *= _DT
    speed += along
    np.maximum(speed, np.float32(0.0), out=speed)
    np.minimum(speed, most, out=speed)
    across = force[0] * normal[0]
    across += force[1] * normal[1]
    wide = leg[Leg.ROOM]
    liked = np.minimum(np.float32(RIGHT), wide)
    back = liked - aside
    back *= np.float32(1.0 / RELAXATION)
    _limit(back, np.float32(-0.3), np.float32(0.3))
    back -= drift
    back *= np.float32(1.0 / RELAXATION)
    across += back
    across *= _DT
    drift += across
    _limit(drift, np.float32(-0.4), np.float32(0.4))
    # The edge of the stairs is a wall, and people keep to their right of the middle.
    left = np.where(wide >= np.float32(_WIDE), liked, -wide)
    left -= aside
    left *= np.float32(POSE_RATE)
    right = wide - aside
    right *= np.float32(POSE_RATE)
    _limit(drift, left, right)
    _limit(drift, np.float32(-0.8), np.float32(0.8))
    drift[bound] = 0.0


def _limit(values: F32, least: F32 | np.float32, most: F32 | np.float32) -> None:
    np.maximum(values, least, out=values)
    np.minimum(values, most, out=values)


def _behind(now: Now, pairs: Pairs) -> F32:
    """(W,) metres to go before one walks into whoever goes the same way ahead; inf for nobody."""
    tx, tz = now.ahead
    free = np.full(len(tx), np.inf, np.float32)
    a, b, (dx, dz) = pairs
    if not len(a):
        return free
    ax, az, bx, bz = tx.take(a), tz.take(a), tx.take(b), tz.take(b)
    turned = ax * bx
    turned += az * bz
    same = turned > np.float32(0.5)
    # Of two whose ways cross only one waits for the other, as of two who come out of the rows on
    # both sides of a gangway; people on stairs pass each other on the right.
    towards = turned < np.float32(-0.5)
    wide = np.where(towards, np.float32(_OPPOSITE), np.float32(_BESIDE))
    first = b < a
    for who, ux, uz, sign, goes_on in ((a, ax, az, -1.0, first), (b, bx, bz, 1.0, ~first)):
        ahead = dx * ux
        ahead += dz * uz
        ahead *= np.float32(sign)
        aside = dx * uz
        aside -= dz * ux
        near = same | goes_on
        near &= np.abs(aside, out=aside) < wide
        near &= ahead > np.float32(0.05)
        some = np.flatnonzero(near)
        gap = np.where(towards[some], np.float32(2.4 * GAP), np.float32(GAP))
        np.minimum.at(free, who[some], ahead[some] - gap)
    return free
