"""How walkers keep apart: the social force model of Helbing and Molnar (1995).

Each person is driven towards the pace that it likes within `RELAXATION`, and pushed by the others
through a repulsive potential ``V(b) = V0 exp(-b / sigma)`` whose level lines are ellipses directed
along the other's next step. What happens behind one's back counts half. All constants are the
paper's (Physical Review E 51, 4282, table and text).
"""

from __future__ import annotations

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


def pairs_within(x: F32, z: F32, reach: float) -> tuple[Ints, Ints]:
    """All pairs of (n,) places at most `reach` apart, each pair once.

    The places are sorted into square cells; a cell's neighbours are two stretches of that order.
    """
    if len(x) < 2:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
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
    a, b = order[owner], order[other]
    near = (x[a] - x[b]) ** 2 + (z[a] - z[b]) ** 2 <= np.float32(reach * reach)
    return a[near], b[near]


def repulsion(
    x: F32,
    z: F32,
    velocity: F32,
    heading: F32,
    pairs: tuple[Ints, Ints],
) -> F32:
    """Accelerations by which people push each other away.

    Parameters
    ----------
    x, z
        (n,) places, metres.
    velocity, heading
        (2, n) m/s, and unit vectors of where everyone wants to go.
    pairs
        (p,) and (p,), each pair once, as from `pairs_within`.

    Returns
    -------
    (2, n) float32 m/s^2
    """
    count = len(x)
    a = np.concatenate(pairs)
    b = np.concatenate(pairs[::-1])
    total = np.zeros((2, count), np.float32)
    if not len(a):
        return total
    away = np.stack([x[a] - x[b], z[a] - z[b]])
    stride = velocity[:, b] * np.float32(STEP)
    apart = np.sqrt((away**2).sum(axis=0)) + np.float32(1e-4)
    ahead = away - stride
    gap = np.sqrt((ahead**2).sum(axis=0)) + np.float32(1e-4)
    both = apart + gap
    axis = 0.5 * np.sqrt(np.maximum(both**2 - (stride**2).sum(axis=0), 1e-4))
    push = np.float32(STRENGTH / RANGE) * np.exp(-axis / np.float32(RANGE))
    push = push * both / (4.0 * axis)
    force = push * (away / apart + ahead / gap)
    size = np.sqrt((force**2).sum(axis=0))
    seen = -(heading[:, a] * force).sum(axis=0) >= size * np.float32(SIGHT)
    force *= np.where(seen, np.float32(1.0), np.float32(UNSEEN))
    for axis_number in (0, 1):
        total[axis_number] = np.bincount(a, force[axis_number], minlength=count)
    return total
