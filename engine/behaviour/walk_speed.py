"""How fast people on their way go: social forces, queues, and waiting for others.

A person likes its pace, keeps to the right, and is slowed by the social forces of the others
(`steering`). It stops behind whoever stands before it, before a row that isn't free yet, and before
people in a row who haven't got up.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.walk import Stage, Walk
from ..crowd.gaits import STILL
from ..streams.pool import POSE_RATE
from .gangways import FLOOR_SPEED, ROW_SPEED, STAIR_SPEED
from .steering import FASTEST, REACH, RELAXATION, pairs_within, repulsion
from .walk_now import F32, Now

Ints = NDArray[np.int64]

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


def steer(walk: Walk, now: Now, room: F32) -> None:
    """Set everybody's speed and drift for the next pose tick.

    Parameters
    ----------
    walk, now
        Who is on the way, and where.
    room
        (W,) metres to the next person in the row who sits yet; inf where nobody does.
    """
    count, vertices = walk.reach.shape
    row = np.arange(count) * vertices
    free = walk.stage == Stage.WALK
    pace = np.where(now.steep, np.float32(1.0), np.float32(FLOOR_SPEED / STAIR_SPEED))
    pace[now.in_row] = ROW_SPEED / STAIR_SPEED
    pace *= walk.pace
    stands = free & walk.granted & (walk.speed < STILL)
    walk.waited = np.where(stands, walk.waited + _DT, np.float32(0.0))
    # To the end of the way, to a row that isn't free, and to people in it who sit.
    rest = walk.reach.ravel().take(row + walk.last) - now.covered
    most = np.minimum(pace * np.float32(FASTEST), np.float32(0.12) + rest * np.float32(_BRAKE))
    held = np.where(walk.granted, np.inf, now.to_mouth - np.float32(BEFORE_MOUTH))
    held = np.minimum(held, room - np.float32(BEFORE_SEATED))
    pairs = pairs_within(now.x, now.z, REACH)
    behind = _behind(now, pairs)
    patient = walk.waited < PATIENCE
    held = np.where(patient, np.minimum(held, behind), held)
    most = np.minimum(most, np.maximum(held, np.float32(0.0)) * np.float32(_BRAKE))
    most[~free] = 0.0
    velocity = now.tangent * walk.speed + now.normal * walk.drift
    force = repulsion(now.x, now.z, velocity, now.tangent, pairs)
    along = force[0] * now.tangent[0] + force[1] * now.tangent[1]
    # Nobody is pushed back, or brought to a standstill by those who come towards him.
    along = np.maximum(along, pace * np.float32((_SLOWEST - 1.0) / RELAXATION))
    speed = walk.speed + ((pace - walk.speed) * np.float32(1.0 / RELAXATION) + along) * _DT
    walk.speed = np.clip(speed, np.float32(0.0), most).astype(np.float32)
    across = force[0] * now.normal[0] + force[1] * now.normal[1]
    flat = walk.room.ravel()
    wide = np.minimum(
        flat.take(row + walk.vertex), flat.take(row + np.minimum(walk.vertex + 1, walk.last))
    )
    liked = np.minimum(np.float32(RIGHT), wide)
    back = np.clip((liked - walk.aside) * np.float32(1.0 / RELAXATION), -0.3, 0.3)
    drift = walk.drift + ((back - walk.drift) * np.float32(1.0 / RELAXATION) + across) * _DT
    # The edge of the stairs is a wall, and people keep to their right of the middle.
    left = np.where(wide >= np.float32(_WIDE), liked, -wide)
    drift = np.clip(np.clip(drift, -0.4, 0.4), (left - walk.aside) / _DT, (wide - walk.aside) / _DT)
    walk.drift = np.where(free, np.clip(drift, -0.8, 0.8), np.float32(0.0)).astype(np.float32)


def _behind(now: Now, pairs: tuple[Ints, Ints]) -> F32:
    """(W,) metres to go before one walks into whoever goes the same way ahead; inf for nobody."""
    free = np.full(len(now.x), np.inf, np.float32)
    a, b = pairs
    if not len(a):
        return free
    tx, tz = now.tangent
    dx, dz = now.x[b] - now.x[a], now.z[b] - now.z[a]
    turned = tx[a] * tx[b] + tz[a] * tz[b]
    same = turned > np.float32(0.5)
    # Of two whose ways cross only one waits for the other, as of two who come out of the rows on
    # both sides of a gangway; people on stairs pass each other on the right.
    towards = turned < np.float32(-0.5)
    wide = np.where(towards, np.float32(_OPPOSITE), np.float32(_BESIDE))
    gap = np.where(towards, np.float32(2.4 * GAP), np.float32(GAP))
    for who, other, sign in ((a, b, 1.0), (b, a, -1.0)):
        ux, uz = tx[who], tz[who]
        ahead = np.float32(sign) * (dx * ux + dz * uz)
        near = same | (other < who)
        near &= (np.abs(dx * uz - dz * ux) < wide) & (ahead > np.float32(0.05))
        np.minimum.at(free, who[near], ahead[near] - gap[near])
    return free
