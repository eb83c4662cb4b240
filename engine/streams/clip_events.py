"""Which clip events each stream passes in a pose tick, and the table that remembers them.

*Streams 2017*, 3.3/4: clips carry tags on their timeline, and playing past one tells the
simulation. Streams are few, so their passings are found once a tick and kept beside their poses:
a set of bits for each pose. Agents, who play some poses behind, find theirs there later
(`event_delivery`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import Clip

MOST_NAMES = 64
"""Event names that one pool can tell apart: a bit each."""
MOST_REPEATS = 8
"""How often one stream can pass one name in a tick; more count as this many."""


class ClipRun(NamedTuple):
    """How S streams moved through their clips in one tick; every column is (S,).

    Attributes
    ----------
    clip, duration, looping
        Clip index, its seconds, and whether time wraps at its end.
    before, after, moved
        Seconds since the clip's start before and after, both wrapped where looping, and the signed
        seconds between them, which may be many loops.
    backwards
        Whether the stream plays backwards.
    starts
        Whether `after` is the first time shown since a cut; nothing was moved through then.
    """

    clip: NDArray[np.int64]
    before: NDArray[np.float64]
    after: NDArray[np.float64]
    moved: NDArray[np.float64]
    backwards: NDArray[np.bool_]
    looping: NDArray[np.bool_]
    duration: NDArray[np.float64]
    starts: NDArray[np.bool_]

    def take(self, some: NDArray[np.int64]) -> ClipRun:
        """The movement of some of the streams."""
        return ClipRun(
            self.clip[some],
            self.before[some],
            self.after[some],
            self.moved[some],
            self.backwards[some],
            self.looping[some],
            self.duration[some],
            self.starts[some],
        )


def count_passes(run: ClipRun, time: NDArray[np.float64]) -> NDArray[np.int64]:
    """How often each stream passes each of its tags.

    Playing forwards from a to b passes the tags in (a, b], backwards those in [b, a), so a tag that
    lies exactly where one tick ends and the next begins is passed once. The first pose after a cut
    passes the tags that lie on it, but not those at the end of a loop that begins. On a loop the
    tags at 0 and at the end are passed once at each crossing of the seam. Wraps are counted from
    the times themselves, with no sum of small errors.

    Parameters
    ----------
    run
        The movement of S streams.
    time
        (S, E) seconds of their tags, NaN where a clip has fewer than E.

    Returns
    -------
    (S, E) int64; what stands at NaN means nothing
    """
    before, after, duration = run.before[:, None], run.after[:, None], run.duration[:, None]
    loops = run.looping[:, None] & (duration > 0)
    whole = np.where(duration > 0, duration, 1.0)
    # On a loop the end is the start.
    place = np.where(loops & (time == duration), 0.0, time)
    wraps = np.where(loops, np.rint((before + run.moved[:, None] - after) / whole), 0.0)
    turns = wraps.astype(np.int64)
    forwards = (place <= after).astype(np.int64) - (place <= before) + turns
    backwards = (place >= after).astype(np.int64) - (place >= before) - turns
    counts = np.where(run.backwards[:, None], backwards, forwards)
    return np.where(run.starts[:, None], (time == after).astype(np.int64), counts)


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
        stream plays so fast that it needs more.

    Raises
    ------
    ValueError
        If the clips have more than 64 different names.
    """

    __slots__ = ("_bit", "_tagged", "_time", "names", "planes")

    def __init__(self, clips: Sequence[Clip], rows: int, capacity: int) -> None:
        self.names = tuple(dict.fromkeys(event.name for clip in clips for event in clip.events))
        if len(self.names) > MOST_NAMES:
            raise ValueError(
                f"clips have {len(self.names)} different event names, expected at most {MOST_NAMES}"
            )
        most = max((len(clip.events) for clip in clips), default=0)
        self._time = np.full((len(clips), most), np.nan)
        self._bit = np.zeros((len(clips), most), np.uint64)
        for row, clip in enumerate(clips):
            for column, event in enumerate(clip.events):
                self._time[row, column] = event.time
                self._bit[row, column] = self.bit(event.name)
        self._tagged = np.array([bool(clip.events) for clip in clips], np.bool_)
        self.planes = np.zeros((1, capacity, rows), np.uint64)

    def bit(self, name: str) -> np.uint64:
        """The bit of an event name; ValueError lists the known names if there is none."""
        if name not in self.names:
            known = ", ".join(self.names) or "none"
            raise ValueError(f"no clip event '{name}'; known: {known}")
        return np.uint64(1 << self.names.index(name))

    def record(self, tick: int, rows: NDArray[np.int64], run: ClipRun) -> None:
        """Write what the stream rows (S,) passed in pose tick `tick`."""
        if not self.names:
            return
        slot = tick % self.planes.shape[1]
        self.clear(tick, rows)
        tagged = np.flatnonzero(self._tagged[run.clip])
        if not len(tagged):
            return
        run = run.take(tagged)
        bits = self._bit[run.clip]
        counts = np.where(bits != 0, count_passes(run, self._time[run.clip]), 0)
        passed = np.where(counts > 0, bits, np.uint64(0))
        self.planes[0, slot, rows[tagged]] = np.bitwise_or.reduce(passed, axis=1)
        for busy in np.flatnonzero(counts.sum(axis=1) > 1):
            self._repeat(slot, int(rows[tagged[busy]]), bits[busy], counts[busy])

    def clear(self, tick: int, rows: NDArray[np.int64]) -> None:
        """Stream rows (S,) passed nothing in pose tick `tick`."""
        self.planes[:, tick % self.planes.shape[1], rows] = 0

    def copy(self, tick: int, rows: NDArray[np.int64], twins: NDArray[np.int64]) -> None:
        """Twins (S,) of stream rows (S,) passed in pose tick `tick` what those did."""
        slot = tick % self.planes.shape[1]
        self.planes[:, slot, twins] = self.planes[:, slot, rows]

    def _repeat(
        self, slot: int, row: int, bits: NDArray[np.uint64], counts: NDArray[np.int64]
    ) -> None:
        """Write the further planes of a stream that passed several tags in one tick."""
        total: Counter[int] = Counter()
        for bit, count in zip(bits.tolist(), counts.tolist(), strict=True):
            total[bit] += count
        deepest = min(max(total.values()), MOST_REPEATS)
        if deepest > len(self.planes):
            missing = np.zeros((deepest - len(self.planes), *self.planes.shape[1:]), np.uint64)
            self.planes = np.concatenate([self.planes, missing])
        for plane in range(1, deepest):
            repeated = sum(bit for bit, count in total.items() if count > plane)
            self.planes[plane, slot, row] = repeated
