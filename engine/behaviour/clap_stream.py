"""A clapper's beat as its offset in a clap stream, so that rhythm is seen and heard.

A stream loops a clip of clapping, `period` poses a clap. An agent that plays o poses behind the
stream's head shows the phase ``stream phase - o / period``. So its phase *is* its offset, and its
rate is the offset's slope,

    o = period frac(stream phase - phase)        rate = 1 - f_agent / f_stream   poses a pose tick

An offset runs on as a linear function of time without being written, and before it leaves the
stream's history it jumps by whole periods, which nobody sees. It is written anew only where the
beat has changed: in free applause about once in two seconds.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..streams.pool import POSE_RATE

F32 = NDArray[np.float32]


def clap_offset(phase: F32, stream_phase: float | F32, period: float | F32) -> F32:
    """Offset in poses, 0 to `period`, at which agents show `phase`.

    A stream at phase 0.25 with 8 poses a clap shows phase 0 at 2 poses behind its head.

    Parameters
    ----------
    phase, stream_phase
        In turns.
    period
        Poses a clap of the stream.
    """
    behind = np.asarray(stream_phase - phase, np.float32)
    behind = behind - np.floor(behind)
    # A tiny negative number wraps to 1 exactly.
    return np.asarray(np.where(behind >= 1.0, np.float32(0.0), behind) * period, np.float32)


def clap_slope(speed: F32, period: float | F32) -> F32:
    """Poses a pose tick by which the offset of agents with `speed` claps a second grows.

    Half a stream's rate gives 0.5, its own rate 0, a tenth more -0.1.
    """
    return np.asarray(1.0 - speed * period / POSE_RATE, np.float32)


class OffsetChange(NamedTuple):
    """Offsets to write at a pose tick, for `AgentAnimID`.

    Attributes
    ----------
    agents
        (K,) int64 ids.
    start, target, slope
        (K,) float32: from `start` now towards `target`, by `slope` poses a pose tick.
    """

    agents: NDArray[np.int64]
    start: F32
    target: F32
    slope: F32


class ClapOffsets:
    """Keeps the offsets of clapping agents true to their beats.

    Parameters
    ----------
    count
        Agents of the crowd, N.
    longest
        Largest offset that a stream's history allows, ``M - 2``; at least two periods of the
        slowest stream.
    tolerance
        How far a shown phase may be from the beat, in turns.
    ahead
        Pose ticks before which an offset that is about to leave the history jumps.
    """

    def __init__(self, count: int, longest: float, tolerance: float = 0.03, ahead: int = 2) -> None:
        if longest <= 0:
            raise ValueError(f"longest is {longest}, expected poses above 0")
        self._longest, self._tolerance = np.float32(longest), np.float32(tolerance)
        self._ahead = np.float32(ahead)
        self._start = np.full(count, np.nan, np.float32)
        self._slope = np.zeros(count, np.float32)
        self._since = np.zeros(count, np.int32)

    def forget(self, agents: NDArray[np.int64]) -> None:
        """Agents left the stream; they are written anew when they come back."""
        self._start[agents] = np.nan

    def offset(self, agents: NDArray[np.int64], tick: float) -> F32:
        """(K,) offsets that agents play at a pose tick; NaN for who was never written."""
        run = self._start[agents] + self._slope[agents] * (tick - self._since[agents])
        return np.asarray(np.clip(run, 0.0, self._longest), np.float32)

    def step(
        self,
        tick: int,
        agents: NDArray[np.int64],
        phase: F32,
        speed: F32,
        stream_phase: float | F32,
        period: float | F32,
    ) -> OffsetChange:
        """Whose offsets to write at pose tick `tick`.

        Parameters
        ----------
        tick
            Pose tick.
        agents
            (K,) ids of those on clap streams.
        phase, speed
            (K,) their beats: turns, and claps a second.
        stream_phase, period
            Turns of the stream's head at `tick`, and its poses a clap; one or (K,).

        Raises
        ------
        ValueError
            For periods that don't fit twice into the history.
        """
        if np.max(period, initial=0.0) * 2.0 > self._longest or np.min(period, initial=1.0) <= 0:
            raise ValueError(
                f"period is {period}, expected poses above 0 and at most {self._longest / 2:g}"
            )
        wanted = clap_offset(phase, stream_phase, period)
        slope = clap_slope(speed, period)
        run = self._start[agents] + self._slope[agents] * (tick - self._since[agents])
        error = (run - wanted) / period
        error -= np.rint(error)
        after = run + self._slope[agents] * self._ahead
        is_true = (np.abs(error) <= self._tolerance) & (after >= 0.0) & (after <= self._longest)
        some = np.flatnonzero(~is_true)  # never written: NaN is not true
        long = np.broadcast_to(np.asarray(period, np.float32), wanted.shape)[some]
        start, slope = wanted[some], slope[some]
        # An offset that shrinks begins as many periods behind as the history holds.
        spare = np.floor((self._longest - start) / long)
        start = start + np.where(slope < 0, np.maximum(spare, 0.0), 0.0).astype(np.float32) * long
        ids = agents[some]
        self._start[ids], self._slope[ids], self._since[ids] = start, slope, tick
        target = np.where(slope < 0, np.float32(0.0), np.where(slope > 0, self._longest, start))
        return OffsetChange(ids, start, target.astype(np.float32), slope)
