"""How a clip was played in one tick, and which of its tags that passes.

Both streams that play a clip and clips in trees of controllers are played by the same rule.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

_MOST_WRAPS = 1e9
"""A clip that is played more often than this in one tick counts as played so often."""


class ClipRun(NamedTuple):
    """How S streams, or clips in trees, moved in one tick; every column is (S,).

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
        """The movement of some of them."""
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
    passes the tags that lie on it, but not those at the end of a loop that begins, and none at all
    if it was put beyond an end. On a loop the tags at 0 and at the end are passed once at each
    crossing of the seam. Wraps are counted from the times themselves, with no sum of small errors.

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
    np.clip(wraps, -_MOST_WRAPS, _MOST_WRAPS, out=wraps)
    turns = wraps.astype(np.int64)
    forwards = (place <= after).astype(np.int64) - (place <= before) + turns
    backwards = (place >= after).astype(np.int64) - (place >= before) - turns
    counts = np.where(run.backwards[:, None], backwards, forwards)
    shown = (time == after) & (loops | (before == after))
    return np.where(run.starts[:, None], shown.astype(np.int64), counts)
