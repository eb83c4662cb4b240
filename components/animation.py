"""Which motion each part of an agent plays, and the blend that leads to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True, eq=False)
class AgentAnimID:
    """Per part and agent: a row of the pose store, and how far behind its head the agent plays.

    *Techniques 2022*, 4.2: ``{part: (ID_SI, ID_O)}``. The offset is a linear function of time, so
    that an agent whose offset changes needs no write a tick: from ``start`` at pose tick ``t0`` to
    ``target``, ``rate`` poses a tick.

    Attributes
    ----------
    row
        (P, N) int32 unified pose index.
    start, target
        (P, N) float32 offsets in poses.
    t0
        (P, N) int32 pose tick from which the offset counts. Whoever puts an agent on a row in pose
        tick n sets n; a change of the offset alone sets an earlier one.
    rate
        (P, N) float32 poses a tick, 0 where the offset rests, ``|rate| < 1``.
    version
        Grows with every change, so that mirrors know when to copy.
    """

    row: NDArray[np.int32]
    start: NDArray[np.float32]
    target: NDArray[np.float32]
    t0: NDArray[np.int32]
    rate: NDArray[np.float32]
    version: int = 0

    @classmethod
    def allocate(cls, parts: int, agents: int, row: int) -> AgentAnimID:
        """All parts of all agents on `row` at offset 0."""
        shape = (parts, agents)
        return cls(
            row=np.full(shape, row, np.int32),
            start=np.zeros(shape, np.float32),
            target=np.zeros(shape, np.float32),
            t0=np.zeros(shape, np.int32),
            rate=np.zeros(shape, np.float32),
        )


@dataclass(slots=True, eq=False)
class Transition:
    """Per part and agent: the source of a running blend into `AgentAnimID`, and what is next.

    Attributes
    ----------
    row, start, target, t0, rate
        As in `AgentAnimID`, of the motion that is left; the row of a slot, if the blend comes from
        a snapshot.
    begin
        (P, N) float64 pose tick at which the blend begins, a multiple of 1/256, so that float32
        holds it exactly beside a nearby tick.
    duration
        (P, N) float32 pose ticks that it takes; 0 where no blend runs.
    next_row
        (P, N) int32 unified pose index of the last request that has not begun; -1 if there is none.
    next_offset
        (P, N) float32 its offset in poses; NaN is drawn when it begins.
    next_duration
        (P, N) float32 pose ticks that it may take; 0 is a jump.
    next_since
        (P, N) int32 pose tick since which the agent waits; -1 before it had to.
    asked
        (P, N) bool: the request is so new that no pose tick has seen it.
    """

    row: NDArray[np.int32]
    start: NDArray[np.float32]
    target: NDArray[np.float32]
    t0: NDArray[np.int32]
    rate: NDArray[np.float32]
    begin: NDArray[np.float64]
    duration: NDArray[np.float32]
    next_row: NDArray[np.int32]
    next_offset: NDArray[np.float32]
    next_duration: NDArray[np.float32]
    next_since: NDArray[np.int32]
    asked: NDArray[np.bool_]

    @classmethod
    def allocate(cls, parts: int, agents: int) -> Transition:
        """No blend runs and none is asked for."""
        shape = (parts, agents)
        return cls(
            row=np.zeros(shape, np.int32),
            start=np.zeros(shape, np.float32),
            target=np.zeros(shape, np.float32),
            t0=np.zeros(shape, np.int32),
            rate=np.zeros(shape, np.float32),
            begin=np.zeros(shape, np.float64),
            duration=np.zeros(shape, np.float32),
            next_row=np.full(shape, -1, np.int32),
            next_offset=np.zeros(shape, np.float32),
            next_duration=np.zeros(shape, np.float32),
            next_since=np.full(shape, -1, np.int32),
            asked=np.zeros(shape, np.bool_),
        )


@dataclass(slots=True, eq=False)
class BakedAnim:
    """Per agent: a baked clip instead of a stream (*Algorithms* 2).

    Attributes
    ----------
    clip
        (N,) int32 index of the clip.
    speed
        (N,) float32 playback speed.
    began
        (N,) float64 pose tick at which the clip's frame 0 was shown; fractions and values before
        the first tick give agents different phases.
    version
        Grows with every change.
    """

    clip: NDArray[np.int32]
    speed: NDArray[np.float32]
    began: NDArray[np.float64]
    version: int = 0
