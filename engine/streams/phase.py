"""Entering a motion at its beginning: a stream's history as a choice of phases.

The poses of a stream's ring stand for all the phases that its clip had lately. An agent that wants
to begin a motion now takes the offset at which the wanted phase lies, instead of waiting for the
stream to come round. A history of M poses holds every phase of a clip of at most M - 1 poses; of a
longer clip, several streams that are staggered hold them together.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .pool import StreamPool

TOLERANCE = 0.5
"""Poses between the wanted phase and the one that is entered at which they count as matched."""


class Entry(NamedTuple):
    """Where K agents enter.

    Attributes
    ----------
    row
        (K,) int32 stream rows.
    offset
        (K,) float32 poses behind the head that the coming pose tick makes.
    phase
        (K,) float64 phase there, 0 to 1.
    step
        (K,) float64 phase that passes in a pose tick, negative backwards.
    matched
        Whether the streams' histories hold the wanted phase; if not, `phase` is the nearest.
    """

    row: NDArray[np.int32]
    offset: NDArray[np.float32]
    phase: NDArray[np.float64]
    step: NDArray[np.float64]
    matched: bool


def entry_offset(
    pool: StreamPool,
    rows: NDArray[np.int32],
    count: int,
    tick: int,
    rng: np.random.Generator,
    *,
    phase: float = 0.0,
    jitter: float = 0.0,
) -> Entry:
    """Streams and offsets for agents that enter a motion at a phase in pose tick `tick`.

    Parameters
    ----------
    pool, rows
        (C,) stream rows that play the motion; those that don't run are left out.
    count
        Agents K; each draws one of all the places where the phase lies.
    tick
        The pose tick about to be evaluated.
    rng
        Where choices come from.
    phase
        Wanted, 0 to 1; 0 is the clip's start.
    jitter
        Poses by which an agent may enter before the wanted phase, so that agents who enter
        together differ; drawn from 0 to this, and less at the end of the history.

    Raises
    ------
    ValueError
        If no row runs with a past, for a phase outside 0 to 1 or a negative jitter.
    """
    if not 0 <= phase <= 1 or not 0 <= jitter < np.inf:
        raise ValueError(f"phase is {phase} and jitter is {jitter}, expected 0 to 1 and >= 0")
    running = np.asarray(rows)[pool.running[rows] & (pool.valid[rows] >= 2)]
    if not len(running):
        raise ValueError("rows: none of the streams runs and has a past")
    past = _Past(pool, running, tick)
    stream, offset = past.places(phase)
    matched = len(stream) > 0
    if not matched:
        stream, offset, away = past.nearest(phase)
        matched = away <= TOLERANCE
    pick = (rng.random(count) * len(stream)).astype(np.int64)
    column = stream[pick]
    chosen = offset[pick] + rng.random(count) * jitter
    chosen = np.minimum(chosen, past.longest[column])
    return Entry(
        row=running[column].astype(np.int32),
        offset=chosen.astype(np.float32),
        phase=past.phase_at(column, chosen),
        step=past.step[column],
        matched=matched,
    )


class _Past:
    """Phases of C streams by age at a pose tick that is not evaluated yet.

    `phases` is (A, C), age 0 being the coming tick, whose phase is foreseen; `passed` (A - 1, C) is
    the signed way from each age to the one before it; `longest` (C,) is how old a pose may be that
    an agent enters at, so that the two poses it mixes exist until the next tick.
    """

    def __init__(self, pool: StreamPool, rows: NDArray[np.int32], tick: int) -> None:
        valid = np.minimum(pool.valid[rows] + 1, pool.history[rows])
        kept = np.minimum(valid, pool.history_goal[rows])
        self.longest = np.maximum(kept - 2, 0).astype(np.float64)
        ages = np.arange(1, int(valid.max()))
        ring = pool.store.ring_phase[(tick - ages) % pool.store.capacity][:, rows]
        past = ring.astype(np.float64)
        known = _way(past[1:], past[:-1])
        self.step = known[0] if len(known) else np.zeros(len(rows))
        coming = np.mod(past[0] + self.step, 1.0)
        self.phases = np.concatenate([coming[None], past])
        self.passed = np.concatenate([self.step[None], known])

    def places(self, phase: float) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Columns and offsets at which the phase lies exactly."""
        size = np.abs(self.passed)
        done = np.mod(np.sign(self.passed) * (phase - self.phases[1:]), 1.0)
        older, column = np.nonzero((size > 0) & (done < size))
        offset = older + 1 - done[older, column] / size[older, column]
        good = offset <= self.longest[column]
        return column[good], offset[good]

    def nearest(self, phase: float) -> tuple[NDArray[np.int64], NDArray[np.float64], float]:
        """The one column and offset whose pose is nearest, and how many poses it is away."""
        away = np.abs(_way(self.phases, np.full_like(self.phases, phase)))
        away /= np.maximum(np.abs(self.step), 1e-9)
        away[np.arange(len(away))[:, None] > self.longest] = np.inf
        age, column = np.unravel_index(int(np.argmin(away)), away.shape)
        return np.array([column]), np.array([float(age)]), float(away[age, column])

    def phase_at(
        self, column: NDArray[np.int64], offset: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Phases between two poses of known ages."""
        newer = np.minimum(np.floor(offset).astype(np.int64), len(self.passed) - 1)
        share = offset - newer
        found = self.phases[newer, column] - share * self.passed[newer, column]
        phase: NDArray[np.float64] = np.mod(found, 1.0)
        return phase


def _way(begin: NDArray[np.float64], end: NDArray[np.float64]) -> NDArray[np.float64]:
    """Signed way round the cycle from one phase to another, at most half of it."""
    way: NDArray[np.float64] = np.mod(end - begin + 0.5, 1.0) - 0.5
    return way
