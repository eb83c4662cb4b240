"""Which clip events each stream passes in a pose tick, and the table that remembers them.

*Streams 2017*, 3.3/4: clips carry tags on their timeline, and playing past one tells the
simulation. Streams are few, so their passings are found once a tick and kept beside their poses:
a set of bits for each pose. Agents, who play some poses behind, find theirs there later
(`event_delivery`).

A stream with a tree of controllers plays many clips. Each that is seen counts by itself, with its
share in the tree's pose (`clip_shares`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import Clip
from ..animation.clip_run import ClipRun, count_passes
from .clip_shares import MOST_NAMES, MOST_REPEATS, ClipShares

__all__ = ["MOST_NAMES", "MOST_REPEATS", "StreamEvents"]

Ints = NDArray[np.int64]


class StreamEvents:
    """Bits of the clip events that each stream passed at each of its last pose ticks.

    Parameters
    ----------
    clips
        All clips that streams can play; their events give the names.
    rows, capacity
        Stream rows, and slices of the ring.

    Attributes
    ----------
    names
        Event names in the order in which the clips bring them; name k is bit k.
    planes
        (D, capacity, rows) uint64: plane 0 has a stream's bit where it passed the name at least
        once in that tick, plane d where it did more than d times. There is one plane until a
        stream needs more.
    shares
        Shares in their trees' poses of the clips by which names were passed.

    Raises
    ------
    ValueError
        If the clips have more than 64 different names.
    """

    __slots__ = ("_name", "_tagged", "_time", "names", "planes", "shares")

    def __init__(self, clips: Sequence[Clip], rows: int, capacity: int) -> None:
        self.names = tuple(dict.fromkeys(event.name for clip in clips for event in clip.events))
        if len(self.names) > MOST_NAMES:
            raise ValueError(
                f"clips have {len(self.names)} different event names, expected at most {MOST_NAMES}"
            )
        most = max((len(clip.events) for clip in clips), default=0)
        self._time = np.full((len(clips), most), np.nan)
        self._name = np.full((len(clips), most), -1, np.int64)
        for row, clip in enumerate(clips):
            for column, event in enumerate(clip.events):
                self._time[row, column] = event.time
                self._name[row, column] = self.names.index(event.name)
        self._tagged = np.array([bool(clip.events) for clip in clips], np.bool_)
        self.planes = np.zeros((1, capacity, rows), np.uint64)
        self.shares = ClipShares(rows, capacity)

    def bit(self, name: str) -> np.uint64:
        """The bit of an event name; ValueError lists the known names if there is none."""
        if name not in self.names:
            known = ", ".join(self.names) or "none"
            raise ValueError(f"no clip event '{name}'; known: {known}")
        return np.uint64(1 << self.names.index(name))

    def begin(self, tick: int, rows: Ints) -> None:
        """Pose tick `tick` begins, in which stream rows (S,) passed nothing so far."""
        if self.names:
            self.planes[:, tick % self.planes.shape[1], rows] = 0
            self.shares.begin(tick)

    def record(
        self,
        tick: int,
        rows: Ints,
        run: ClipRun,
        share_of: Callable[[Ints], NDArray[np.float64]] | None = None,
    ) -> None:
        """Write what was passed in pose tick `tick`.

        Parameters
        ----------
        tick
            The tick that began.
        rows, run
            (S,) stream rows and how they moved through their clips; of trees, one entry for each
            clip that is seen, so a row may be there several times.
        share_of
            Of trees: shares of some clips in their trees' poses, by places among the S.
        """
        if not self.names:
            return
        tagged = np.flatnonzero(self._tagged[run.clip])
        if not len(tagged):
            return
        run = run.take(tagged)
        names = self._name[run.clip]
        counts = np.where(names >= 0, count_passes(run, self._time[run.clip]), 0)
        place, tag = np.nonzero(counts > 0)
        if not len(place):
            return
        times = np.minimum(counts[place, tag], MOST_REPEATS)
        name, place = np.repeat(names[place, tag], times), np.repeat(tagged[place], times)
        share = np.ones(len(place)) if share_of is None else share_of(place)
        # A name that is passed several times goes to several planes, the largest share first.
        order = np.lexsort((-share, name, rows[place]))
        row, name, share = rows[place[order]], name[order], share[order]
        first = np.flatnonzero(np.diff(row * MOST_NAMES + name, prepend=-1))
        plane = np.arange(len(row)) - np.repeat(first, np.diff(first, append=len(row)))
        if len(first) < len(row):
            kept = plane < MOST_REPEATS
            row, name, share, plane = row[kept], name[kept], share[kept], plane[kept]
            self._deepen(int(plane.max()) + 1)
        _, capacity, width = self.planes.shape
        cell = (plane * capacity + tick % capacity) * width + row
        bit = np.uint64(1) << name.astype(np.uint64)
        np.bitwise_or.at(self.planes.reshape(-1), cell, bit)
        if share_of is not None:
            self.shares.add(tick, row, plane, name, share)

    def copy(self, tick: int, rows: NDArray[np.int64], twins: NDArray[np.int64]) -> None:
        """Twins (S,) of stream rows (S,) passed in pose tick `tick` what those did."""
        slot = tick % self.planes.shape[1]
        self.planes[:, slot, twins] = self.planes[:, slot, rows]
        self.shares.copy(tick, rows, twins)

    def _deepen(self, planes: int) -> None:
        """Have at least so many planes."""
        missing = planes - len(self.planes)
        if missing > 0:
            empty = np.zeros((missing, *self.planes.shape[1:]), np.uint64)
            self.planes = np.concatenate([self.planes, empty])
