"""Which streams of a crowd are shown on all body types, and how many a crowd can afford."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..streams.pool import StreamPool
from .motions import MotionStreams

TWIN_SHARE = 0.3
"""Streams that show another body type, for each stream of the adults and each type."""


def affordable_streams(rows: int, motions: int, whole: int, types: int) -> int:
    """How many streams the motions get, so that their twins fit in beside them; 0 if they don't.

    Parameters
    ----------
    rows
        Stream rows of the pool.
    motions
        Each needs a stream, and one twin of each type.
    whole
        Further streams that are shown on every type, all of them.
    types
        Body types beside the character's own.
    """
    left = rows - whole * (1 + types)
    own = min(int(left / (1.0 + TWIN_SHARE * types)), left - types * motions)
    return own if own >= motions else 0


def start_twins(
    pool: StreamPool, streams: MotionStreams, whole: NDArray[np.bool_], spare: int = 0
) -> MotionStreams:
    """Show motions on the pool's body types, on the rows that are free.

    Every motion is shown on each type by at least one stream; what is left goes to those that most
    streams play.

    Parameters
    ----------
    pool
        Gets the twins.
    streams
        Who plays the motions.
    whole
        (K,) bool motions all of whose streams are needed.
    spare
        Rows that stay free.
    """
    types = len(pool.twins.types)
    shared = np.where(whole, streams.count, np.minimum(streams.count, 1))
    left = int(np.count_nonzero(~pool.alive)) - spare - types * int(shared.sum())
    if left < 0:
        raise ValueError(f"{len(pool.alive)} streams are too few to show all motions on all bodies")
    while left >= types and (shared < streams.count).any():
        more = np.where(shared < streams.count, streams.count / np.maximum(shared, 1), 0.0)
        shared[np.argmax(more)] += 1
        left -= types
    for first, count in zip(streams.first, shared, strict=True):
        for row in range(first, first + count):
            for kind in pool.twins.types:
                pool.add_twin(pool.stream(row), kind.name)
    return replace(streams, shared=shared.astype(np.int32))
