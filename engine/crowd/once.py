"""Motions that play once: ducking, reaching, a Mexican wave.

Their clips begin and end in the same pose, so they can run on streams as loops; what counts is that
an agent enters at the beginning, which it finds in a stream's history by phase. A clip longer than
the history takes several streams that are staggered.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..streams.phase import entry_offset
from ..streams.pool import POSE_RATE, StreamPool
from .motions import MotionLibrary, MotionStreams, start_staggered

SPEED = 1.3
"""Reactions are quicker than the clips, which were made to be looked at."""
BLEND = 6.0
"""Longest blend into such a motion, pose ticks."""
MATCHED = ("hug_a", "hug_b")
"""Clips of two who do something together."""
JITTER = 2.0
"""Pose ticks by which agents that begin together differ."""


@dataclass(frozen=True, slots=True, eq=False)
class OnceStreams:
    """Streams of the motions that play once.

    Parameters
    ----------
    rows
        Stream rows by motion of the library.
    exact
        Motions that are entered exactly at the beginning, since two people do them together.
    """

    rows: dict[int, NDArray[np.int32]]
    exact: frozenset[int] = frozenset()

    def enter(
        self,
        pool: StreamPool,
        motion: NDArray[np.int16],
        row: NDArray[np.int32],
        offset: NDArray[np.float32],
        blend: NDArray[np.float32],
        tick: int,
        rng: np.random.Generator,
    ) -> None:
        """Let those of (K,) agents who want such a motion begin at its beginning.

        `row`, `offset` and `blend` are changed in place for them; `tick` is the pose tick about to
        be evaluated.
        """
        for which, rows in self.rows.items():
            k = np.flatnonzero(motion == which)
            if len(k):
                jitter = 0.0 if which in self.exact else JITTER
                place = entry_offset(pool, rows, len(k), tick, rng, jitter=jitter)
                row[k], offset[k] = place.row, place.offset
                blend[k] = np.minimum(blend[k], BLEND)


def streams_for(duration: float, history: int) -> int:
    """How many staggered streams hold every phase of a clip of so many seconds."""
    poses = duration / SPEED * POSE_RATE
    return max(1, int(np.ceil(poses / max(history - 4, 1))))


def add_once(library: MotionLibrary, names: Sequence[str], first_clip: int) -> MotionLibrary:
    """The library with motions that play once as its last; their loops are clips from there on."""
    new = np.arange(first_clip, first_clip + len(names))
    return MotionLibrary(
        names=(*library.names, *names),
        clips=np.append(library.clips, new),
        roles=library.roles,
        innate=np.append(library.innate, np.zeros(len(names))),
    )


def start_once(
    pool: StreamPool,
    library: MotionLibrary,
    motions: Sequence[int],
    streams: MotionStreams,
    history: int,
) -> tuple[OnceStreams, MotionStreams]:
    """Start the staggered streams of motions, and say where all motions are played.

    Parameters
    ----------
    pool
        Gets the streams.
    library
        With the motions.
    motions
        Which of the library play once, ascending, from ``len(streams.first)`` on.
    streams, history
        The streams of the motions before them, and M.
    """
    rows = {}
    for motion in motions:
        clip = int(library.clips[motion])
        number = streams_for(float(pool.bank.duration[clip]), history)
        rows[motion] = start_staggered(pool, clip, number, SPEED)
    exact = frozenset(k for k in motions if library.names[k] in MATCHED)
    return OnceStreams(rows, exact), streams.followed_by([*rows.values()])
