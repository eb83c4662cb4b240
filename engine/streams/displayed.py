"""Which pose an agent shows: the age formula, the same here as in the shaders.

At pose tick n and fraction alpha the picture shows the time ``t = n - 1 + alpha``: one tick late,
so that the two poses that it mixes both exist. A stream whose head is h is shown at
``u = min(t, h)``; while it is stopped, u stays at its head, so its agents hold.
An agent plays ``o(u)`` pose ticks behind, with

    o(u) = clamp(o0 + rate (u - t0)) between o0 and target
    age  = (h - u) + o(u), at most valid - 1

and shows the mix of the poses that are ``floor(age)`` and ``floor(age) + 1`` ticks older than the
head. The limit keeps poses from before a cut out of the mix. A unique is a stream of two poses.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .pool import StreamPool


@dataclass(frozen=True, slots=True, eq=False)
class ShownPoses:
    """Places of the two poses that each agent mixes.

    Parameters
    ----------
    row
        (N,) unified pose index.
    newer, older
        (N,) int64: a slice of the row's ring, or -1 - k for static row k.
    weight
        (N,) float32 share of the older pose.
    """

    row: NDArray[np.int64]
    newer: NDArray[np.int64]
    older: NDArray[np.int64]
    weight: NDArray[np.float32]


def offset_at(
    start: NDArray[np.float32],
    target: NDArray[np.float32],
    rate: NDArray[np.float32],
    since: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Offset of an agent `since` pose ticks after its dilation began.

    From 10 to 14 poses at 0.25 a tick it is 11 after 4 ticks and 14 from tick 16 on.

    Parameters
    ----------
    start, target, rate
        (N,) o0 and target in poses, and poses a tick (its sign leads from start to target).
    since
        (N,) ``u - t0``; before the start the offset is o0.
    """
    moved = start + rate.astype(np.float64) * np.maximum(since, 0.0)
    return np.clip(moved, np.minimum(start, target), np.maximum(start, target))


def ages(
    pool: StreamPool,
    line: NDArray[np.int64],
    start: NDArray[np.float32],
    target: NDArray[np.float32],
    t0: NDArray[np.int32],
    rate: NDArray[np.float32],
    tick: int,
    alpha: float,
) -> NDArray[np.float64]:
    """How many pose ticks older than its stream's head each agent's pose is.

    Parameters
    ----------
    pool
        Whose streams they are.
    line
        (N,) stream rows; behind the streams come the uniques, as ``stream_rows + k``.
    start, target, t0, rate
        (N,) the offset as a linear function of time (`tifo.components.AgentAnimID`).
    tick, alpha
        Current pose tick n and the fraction of it that has passed, 0 to 1.

    Returns
    -------
    (N,) float64
    """
    head, valid = _heads(pool, line)
    shown = np.minimum(tick - 1 + alpha, head)
    age = head - shown + offset_at(start, target, rate, shown - t0)
    return np.clip(age, 0.0, np.maximum(valid - 1, 0))


def shown_poses(
    pool: StreamPool,
    row: NDArray[np.int64],
    start: NDArray[np.float32],
    target: NDArray[np.float32],
    t0: NDArray[np.int32],
    rate: NDArray[np.float32],
    tick: int,
    alpha: float,
) -> ShownPoses:
    """Poses that agents mix; parameters as for `ages`, but rows are unified pose indices.

    A stream or unique without a pose yet shows the bind pose.
    """
    store = pool.store
    unique = (row >= store.first_unique) & (row < store.first_slot)
    number = np.where(unique, (row - store.first_unique) // 2, 0)
    moving = unique | (row < store.stream_rows)
    line = np.where(unique, store.stream_rows + number, np.where(moving, row, 0))
    head, valid = _heads(pool, line)
    age = ages(pool, line, start, target, t0, rate, tick, alpha)
    whole = np.floor(age).astype(np.int64)
    back = np.minimum(whole + 1, np.maximum(valid - 1, 0))
    shown = moving & (valid > 0)
    # Static rows: the one that is asked for, the bind pose, or one of a unique's two.
    still = np.where(moving, 0, row - store.stream_rows)

    def place(age: NDArray[np.int64]) -> NDArray[np.int64]:
        pair = np.ones(len(row), np.int64)
        if store.uniques:
            pair += 2 * number + ((store.unique_newest[number] + age) & 1)
        there = np.where(unique, -1 - pair, (head - age) % store.capacity)
        return np.where(shown, there, -1 - still)

    weight = np.where(shown, age - whole, 0.0).astype(np.float32)
    return ShownPoses(row=row, newer=place(whole), older=place(back), weight=weight)


def read_palettes(pool: StreamPool, shown: ShownPoses) -> NDArray[np.float32]:
    """Mixed palettes (N, J, 3, 4) float32 of the poses in `shown`."""
    mixed = _read(pool, shown.row, shown.newer)
    both = np.flatnonzero(shown.weight)
    if len(both):
        other = _read(pool, shown.row[both], shown.older[both])
        other -= mixed[both]
        other *= shown.weight[both, None, None, None]
        mixed[both] += other
    return mixed


def _read(
    pool: StreamPool, row: NDArray[np.int64], place: NDArray[np.int64]
) -> NDArray[np.float32]:
    store = pool.store
    ring = store.ring.reshape(-1, *store.ring.shape[2:])
    found = np.take(ring, place * store.stream_rows + row, axis=0, mode="clip")
    still = np.flatnonzero(place < 0)
    found[still] = store.static[-1 - place[still]]
    return found


def _heads(
    pool: StreamPool, line: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """Heads and valid counts of stream rows and, behind them, of uniques."""
    head = np.concatenate([pool.head, pool.store.unique_head])
    valid = np.concatenate([pool.valid, pool.store.unique_valid])
    return head[line], valid[line]
