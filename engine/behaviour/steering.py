"""How walkers keep apart: the social force model of Helbing and Molnar (1995).

Each person is driven towards the pace that it likes within `RELAXATION`, and pushed by the others
through a repulsive potential ``V(b) = V0 exp(-b / sigma)`` whose level lines are ellipses directed
along the other's next step. What happens behind one's back counts half. All constants are the
paper's (Physical Review E 51, 4282, table and text).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

F32 = NDArray[np.float32]
Ints = NDArray[np.int64]

STRENGTH = 2.1
"""V0, m^2/s^2."""
RANGE = 0.3
"""sigma, metres."""
STEP = 2.0
"""Seconds by which the other's next step is foreseen."""
RELAXATION = 0.5
"""tau, seconds."""
FASTEST = 1.3
"""Times the pace that somebody likes."""
SIGHT = np.cos(np.deg2rad(100.0))
"""Cosine of half of the 200 degrees that are seen."""
UNSEEN = 0.5
"""Share of a force that comes from behind."""
REACH = 2.0
"""Metres beyond which a force (below 0.01 m/s^2 for people on stairs) is left out."""


class Pairs(NamedTuple):
    """People near each other, each pair once.

    Parameters
    ----------
    a, b
        (p,) rows of the two.
    away
        (2, p) float32 x and z from b to a, metres.
    """

    a: Ints
    b: Ints
    away: F32


def pairs_within(x: F32, z: F32, reach: float) -> Pairs:
    """All pairs of (n,) places at most `reach` apart, each pair once.

    The places are sorted into square cells; a cell's neighbours are two stretches of that order.
    """
    if len(x) < 2:
        nobody = np.zeros(0, np.int64)
        return Pairs(nobody, nobody, np.zeros((2, 0), np.float32))
    wide = np.int64(1 << 20)
    column = np.floor(x / reach).astype(np.int64) + (wide >> 1)
    cell = np.floor(z / reach).astype(np.int64) + (wide >> 1)
    key = column * wide + cell
    order = np.argsort(key, kind="stable")
    key = key[order]
    here = np.arange(len(key))
    lows = np.concatenate([here + 1, np.searchsorted(key, key + wide - 1)])
    highs = np.concatenate(
        [np.searchsorted(key, key + 1, "right"), np.searchsorted(key, key + wide + 1, "right")]
    )
    count = np.maximum(highs - lows, 0)
    owner = np.repeat(np.concatenate([here, here]), count)
    begin = np.cumsum(count) - count
    other = np.arange(int(count.sum())) - np.repeat(begin - lows, count)
    return nearer(order[owner], order[other], x, z, reach)


def nearer(a: Ints, b: Ints, x: F32, z: F32, reach: float) -> Pairs:
    """Those of the pairs a and b (p,) who are at most `reach` apart."""
    dx = x.take(a)
    dx -= x.take(b)
    dz = z.take(a)
    dz -= z.take(b)
    near = np.flatnonzero(dx * dx + dz * dz <= np.float32(reach * reach))
    away = np.empty((2, len(near)), np.float32)
    dx.take(near, out=away[0])
    dz.take(near, out=away[1])
    return Pairs(a.take(near), b.take(near), away)


def repulsion(pairs: Pairs, velocity: F32, heading: F32) -> F32:
    """Accelerations by which people push each other away.

    Parameters
    ----------
    pairs
        As from `pairs_within`.
    velocity, heading
        (2, n) m/s, and unit vectors of where everyone wants to go.

    Returns
    -------
    (2, n) float32 m/s^2
    """
    count = velocity.shape[1]
    total = np.zeros((2, count), np.float32)
    if not len(pairs.a):
        return total
    # Of each pair first what b does to a. What a does to b is the same with away turned round,
    # so rather than that it is a's stride that is turned, and in the end the force.
    stride = np.empty((2, 2, len(pairs.a)), np.float32)
    aim = np.empty_like(stride)
    for axis in (0, 1):
        velocity[axis].take(pairs.b, out=stride[axis, 0])
        velocity[axis].take(pairs.a, out=stride[axis, 1])
        heading[axis].take(pairs.a, out=aim[axis, 0])
        heading[axis].take(pairs.b, out=aim[axis, 1])
    stride *= np.float32(STEP)
    np.negative(stride[:, 1], out=stride[:, 1])
    np.negative(aim[:, 1], out=aim[:, 1])
    away = pairs.away[:, None]
    apart = np.sqrt(away[0] * away[0] + away[1] * away[1])
    apart += np.float32(1e-4)
    ahead = away - stride
    gap = np.sqrt(ahead[0] * ahead[0] + ahead[1] * ahead[1])
    gap += np.float32(1e-4)
    both = apart + gap
    axis_length = both * both
    axis_length -= stride[0] * stride[0]
    axis_length -= stride[1] * stride[1]
    np.maximum(axis_length, np.float32(1e-4), out=axis_length)
    np.sqrt(axis_length, out=axis_length)
    push = np.exp(axis_length * np.float32(-0.5 / RANGE))
    push *= both
    push /= axis_length
    push *= np.float32(0.5 * STRENGTH / RANGE)
    ahead /= gap
    ahead += away / apart
    # The length of a force is that of this sum times the push, so the sum tells what is seen.
    size = np.sqrt(ahead[0] * ahead[0] + ahead[1] * ahead[1])
    size *= np.float32(-SIGHT)
    seen = aim[0] * ahead[0]
    seen += aim[1] * ahead[1]
    push *= np.where(seen <= size, np.float32(1.0), np.float32(UNSEEN))
    ahead *= push
    for axis in (0, 1):
        total[axis] = np.bincount(pairs.a, ahead[axis, 0], count)
        total[axis] -= np.bincount(pairs.b, ahead[axis, 1], count)
    return total
