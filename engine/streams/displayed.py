"""Which pose an agent shows: the age formula, the same here as in the shaders.

At pose tick n and fraction alpha the picture shows the time ``t = n - 1 + alpha``: one tick late,
so that the two poses that it mixes both exist. A stream whose head is h is shown at
``u = min(t, h)``; while it is stopped, u stays at its head, so its agents hold.
An agent plays ``o(u)`` pose ticks behind, with

    o(u) = clamp(o0 + rate (u - t0)) between o0 and target
    age  = (h - u) + o(u), at most valid - 1

and shows the mix of the poses that are ``floor(age)`` and ``floor(age) + 1`` ticks older than the
head. The limit keeps poses from before a cut out of the mix.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .pool import StreamPool


@dataclass(frozen=True, slots=True, eq=False)
class ShownPoses:
    """Ring places of the two poses that each agent mixes.

    Parameters
    ----------
    row
        (N,) unified pose index.
    newer, older
        (N,) int64 ring slices, 0 for static rows.
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
    row: NDArray[np.int64],
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
        Whose streams the rows are.
    row
        (N,) stream rows.
    start, target, t0, rate
        (N,) the offset as a linear function of time (`tifo.components.AgentAnimID`).
    tick, alpha
        Current pose tick n and the fraction of it that has passed, 0 to 1.

    Returns
    -------
    (N,) float64
    """
    head = pool.head[row].astype(np.float64)
    shown = np.minimum(tick - 1 + alpha, head)
    age = head - shown + offset_at(start, target, rate, shown - t0)
    return np.clip(age, 0.0, np.maximum(pool.valid[row] - 1, 0))


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
    """Ring places that the agents mix; parameters as for `ages`, rows may be static as well.

    A stream without a pose yet shows the bind pose.
    """
    store = pool.store
    static = row >= store.stream_rows
    stream = np.where(static, 0, row)
    empty = ~static & (pool.valid[stream] == 0)
    age = ages(pool, stream, start, target, t0, rate, tick, alpha)
    whole = np.floor(age)
    newest = pool.head[stream] - whole.astype(np.int64)
    last = np.maximum(pool.valid[stream] - 1, 0)
    older = pool.head[stream] - np.minimum(whole.astype(np.int64) + 1, last)
    held = static | empty
    return ShownPoses(
        row=np.where(empty, store.bind_row, row),
        newer=np.where(held, 0, newest % store.capacity),
        older=np.where(held, 0, older % store.capacity),
        weight=np.where(held, 0.0, age - whole).astype(np.float32),
    )


def read_palettes(pool: StreamPool, shown: ShownPoses) -> NDArray[np.float32]:
    """Mixed palettes (N, J, 3, 4) float32 of the poses in `shown`."""
    store = pool.store
    static = shown.row >= store.stream_rows
    stream = np.where(static, 0, shown.row)
    weight = shown.weight[:, None, None, None]
    newer, older = store.ring[shown.newer, stream], store.ring[shown.older, stream]
    mixed: NDArray[np.float32] = newer + (older - newer) * weight
    mixed[static] = store.static[shown.row[static] - store.stream_rows]
    return mixed
