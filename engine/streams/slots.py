"""Transition slots: static rows of the pose store, each a snapshot of what one agent showed.

*Streams 2017*, 4.3: a fixed number of slots is made at the start. A slot is written once, when a
blend leaves a pose that no stream has (the middle of another blend, or the past of a stream that is
about to be cut), and given back when that blend ends.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .store import PoseStore


class SlotPool:
    """Which slots of a pose store are in use.

    Parameters
    ----------
    store
        Has the rows.

    Attributes
    ----------
    used
        (slots,) bool.
    """

    __slots__ = ("_first", "_free", "used")

    def __init__(self, store: PoseStore) -> None:
        self.used = np.zeros(store.slots, np.bool_)
        self._first = store.first_slot
        self._free = store.slots

    @property
    def free(self) -> int:
        """How many slots are free."""
        return self._free

    def take(self, count: int) -> NDArray[np.int32]:
        """Unified rows of `count` free slots, or of all there are if they are fewer."""
        if not self._free or not count:
            return np.zeros(0, np.int32)
        slots = np.flatnonzero(~self.used)[:count]
        self.used[slots] = True
        self._free -= len(slots)
        return (slots + self._first).astype(np.int32)

    def holds(self, rows: NDArray[np.int32]) -> NDArray[np.bool_]:
        """Which of some unified rows are slots."""
        found: NDArray[np.bool_] = rows >= self._first
        return found

    def release(self, rows: NDArray[np.int32]) -> None:
        """Give back the slots among some unified rows; the others are left alone."""
        slots = rows[self.holds(rows)] - self._first
        self.used[slots] = False
        self._free = int(np.count_nonzero(~self.used)) if len(slots) else self._free
