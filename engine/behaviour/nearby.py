"""Who is near whom, kept from one pose tick to the next.

People move a few centimetres in a tick. So all pairs up to a margin further apart than matters are
found once (Verlet's neighbour list, Physical Review 159, 98, 1967), and they hold until
somebody has gone half of that margin.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.walk import Errand, Leg, Walk
from .steering import F32, Ints, Pairs, nearer, pairs_within

MARGIN = 0.7
"""Metres by which pairs may be further apart than is asked for."""
_DEEP = 3
"""Whoever has so many vertices to go isn't out of the row before pairs are found anew."""


class Nearby:
    """Pairs of people who may be near each other.

    Parameters
    ----------
    reach
        Metres up to which pairs are wanted.
    """

    def __init__(self, reach: float) -> None:
        self._reach = reach
        self._a: Ints = np.zeros(0, np.int64)
        self._b: Ints = self._a
        self._from: F32 = np.zeros((2, 0), np.float32)

    def pairs(self, walk: Walk, x: F32, z: F32) -> Pairs:
        """Who is at most `reach` from whom, each pair once, but for people in different rows.

        Parameters
        ----------
        walk
            Those on their way; whoever is new since the last time has the last of its W rows.
        x, z
            (W,) where they are.
        """
        known = self._from.shape[1]
        gone = x[:known] - self._from[0]
        gone *= gone
        aside = z[:known] - self._from[1]
        aside *= aside
        gone += aside
        if known and gone.max() > np.float32(0.25 * MARGIN * MARGIN):
            known = 0
        if not known:
            a, b, _ = pairs_within(x, z, self._reach + MARGIN)
            self._from, self._a, self._b = np.stack([x, z]), a[:0], b[:0]
            self._add(walk, a, b)
        elif known < len(x):
            self._meet(walk, x, z, known)
        return nearer(self._a, self._b, x, z, self._reach)

    def keep(self, mask: NDArray[np.bool_]) -> None:
        """Forget those of the rows (n,) that the mask is False for."""
        new = len(mask) - self._from.shape[1]
        kept = mask[: len(mask) - new] if new else mask
        row = np.cumsum(kept) - 1
        both = kept[self._a] & kept[self._b]
        self._a, self._b = row[self._a[both]], row[self._b[both]]
        self._from = self._from[:, kept]

    def _meet(self, walk: Walk, x: F32, z: F32, known: int) -> None:
        """Add the pairs of those who are new, and of them among each other."""
        new = np.arange(known, len(x))
        self._from = np.concatenate([self._from, np.stack([x[new], z[new]])], axis=1)
        apart = self._from[:, new, None] - self._from[:, None]
        near = apart[0] ** 2 + apart[1] ** 2 <= np.float32((self._reach + MARGIN) ** 2)
        near &= np.arange(len(x)) < new[:, None]
        a, b = np.nonzero(near)
        self._add(walk, new[a], b)

    def _add(self, walk: Walk, a: Ints, b: Ints) -> None:
        deep = walk.leg[Leg.IN_ROW] > 0
        deep &= (walk.errand == Errand.ARRIVE) | (walk.mouth - walk.vertex >= _DEEP)
        row = np.where(deep, walk.run, -1)
        first, second = row[a], row[b]
        meet = (first == second) | (first < 0) | (second < 0)
        self._a = np.concatenate([self._a, a[meet]])
        self._b = np.concatenate([self._b, b[meet]])
