"""How much of a tree's pose a clip made when it passed a tag.

Streams that play one clip show nothing else, so only passings in trees are kept: in one list,
ordered by the pose at which they happened, from which those older than any history are dropped.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..animation.plan.columns import ranges

MOST_NAMES = 64
"""Event names that one pool can tell apart: a bit each."""
MOST_REPEATS = 8
"""How often one stream can pass one name in a tick; more count as this many."""

Ints = NDArray[np.int64]


class ClipShares:
    """Shares of clips in the poses of trees, by pose and name.

    Parameters
    ----------
    rows, capacity
        Stream rows, and how many pose ticks are remembered.
    """

    __slots__ = ("_capacity", "_key", "_rows", "_share")

    def __init__(self, rows: int, capacity: int) -> None:
        self._rows = rows
        self._capacity = capacity
        # Ascending: tick, row, plane and name of a passing in one number.
        self._key = np.zeros(0, np.int64)
        self._share = np.zeros(0, np.float32)

    def __len__(self) -> int:
        """How many passings are remembered."""
        return len(self._key)

    def pose(self, tick: Ints | int, row: Ints, plane: Ints | int) -> Ints:
        """One number for a pose and a plane of its bits; later poses have greater ones."""
        out: Ints = (tick * self._rows + row) * MOST_REPEATS + plane
        return out

    def begin(self, tick: int) -> None:
        """Forget what is too old for pose tick `tick`, or not older than it."""
        if len(self._key):
            ends = np.array([tick - self._capacity + 1, tick])
            first, last = np.searchsorted(
                self._key, self.pose(ends, np.zeros(2, np.int64), 0) * MOST_NAMES
            )
            if first > 0 or last < len(self._key):
                self._key, self._share = self._key[first:last], self._share[first:last]

    def add(
        self, tick: int, row: Ints, plane: Ints, name: Ints, share: NDArray[np.float64]
    ) -> None:
        """Remember passings (n,) of the pose tick that began."""
        key = self.pose(tick, row, plane) * MOST_NAMES + name
        order = np.argsort(key)
        self._key = np.concatenate([self._key, key[order]])
        self._share = np.concatenate([self._share, share[order].astype(np.float32)])

    def copy(self, tick: int, rows: Ints, twins: Ints) -> None:
        """Let the poses of other rows (S,) in the pose tick that began have what (S,) rows had."""
        first = int(
            np.searchsorted(self._key, self.pose(tick, np.zeros(1, np.int64), 0)[0] * MOST_NAMES)
        )
        cell, rest = np.divmod(self._key[first:], MOST_REPEATS * MOST_NAMES)
        order = np.argsort(rows, kind="stable")
        low, high = (np.searchsorted(cell % self._rows, rows[order], s) for s in ("left", "right"))
        entry, owner = ranges(low, high - low)
        if len(entry):
            more = (cell[entry] + twins[order[owner]] - rows[order[owner]]) * (
                MOST_REPEATS * MOST_NAMES
            ) + rest[entry]
            key = np.concatenate([self._key[first:], more])
            share = np.concatenate([self._share[first:], self._share[first:][entry]])
            order = np.argsort(key)
            self._key = np.concatenate([self._key[:first], key[order]])
            self._share = np.concatenate([self._share[:first], share[order]])

    def find(self, pose: Ints) -> tuple[Ints, NDArray[np.uint64], NDArray[np.float32]]:
        """What was passed at poses, as `pose` numbers them, by clips of trees.

        Parameters
        ----------
        pose
            (K,) in any order.

        Returns
        -------
        (n,) places among the K, in order, (n,) bits of one name each, and (n,) shares; poses of
        streams without a tree have none
        """
        first = np.searchsorted(self._key, pose * MOST_NAMES)
        entry, owner = ranges(first, np.searchsorted(self._key, (pose + 1) * MOST_NAMES) - first)
        names = (self._key[entry] % MOST_NAMES).astype(np.uint64)
        return owner, np.uint64(1) << names, self._share[entry]
