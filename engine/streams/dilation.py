"""Time dilation: agents drift apart on a stream by playing a little slower or faster for a while.

*Techniques 2022*, 4.3: a stream that just started has no past, so everybody on it begins at its
head, together. Their offsets then grow to targets of their own, by

    changeRate = (Mnew - M) / (timeToDilate * poseRate)    poses a pose tick

An agent whose offset grows plays at speed ``1 - rate``, so the rate is limited, and a time that is
too short for it is lengthened. Offsets are linear functions of time (`AgentAnimID`): nothing is
written while they move. A change takes effect at the pose tick about to be evaluated and goes on
from where the last picture before it stood, so what is shown never jumps.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...components.animation import AgentAnimID, Transition
from .displayed import offset_at
from .pool import POSE_RATE, Stream, StreamPool

FASTEST = 0.25
"""Poses a pose tick by which an offset changes at most: agents play at 0.75 to 1.25 times speed."""
_ARRIVED = 1e-6
"""Poses within which an offset is where it should be."""
_LONGEST = 86_400.0


class Dilated(NamedTuple):
    """What a dilation will take.

    Attributes
    ----------
    moving
        Parts of agents whose offset will change.
    lengthened
        Those of them for which the wanted time was too short.
    ticks
        Pose ticks until all have arrived.
    """

    moving: int
    lengthened: int
    ticks: float

    def plus(self, other: Dilated) -> Dilated:
        """Both together."""
        return Dilated(
            self.moving + other.moving,
            self.lengthened + other.lengthened,
            max(self.ticks, other.ticks),
        )


class PoolUser(NamedTuple):
    """Columns that refer to the rows of a pool: a crowd's, or those of a part of it."""

    anim: AgentAnimID
    transition: Transition


def change_rate(new: float, old: float, seconds: float, pose_rate: float = POSE_RATE) -> float:
    """Poses a pose tick that lead an offset from `old` to `new` in `seconds`; infinite for 0 s.

    From 0 to 60 in 8 s at 30 poses a second it is 0.25.

    Raises
    ------
    ValueError
        For negative seconds, or any value that is not finite.
    """
    if not np.isfinite([new, old, seconds]).all() or seconds < 0:
        raise ValueError(f"seconds is {seconds} for {old} to {new} poses, expected finite, >= 0 s")
    if new == old:
        return 0.0
    return (new - old) / (seconds * pose_rate) if seconds > 0 else np.copysign(np.inf, new - old)


def shown_offsets(
    pool: StreamPool,
    columns: AgentAnimID | Transition,
    part: int,
    agents: NDArray[np.int64],
    tick: int,
) -> NDArray[np.float32]:
    """Offsets (K,) that the last picture before pose tick `tick` showed.

    While a history fills up, an agent farther behind than it reaches waits at its first pose; that
    pose's age is its offset.
    """
    at = (part, agents)
    row = columns.row[at].astype(np.int64)
    head = pool.head[row]
    shown = np.minimum(tick - 1, head)
    line = (columns.start[at], columns.target[at], columns.rate[at])
    offset = offset_at(*line, (shown - columns.t0[at]).astype(np.float64))
    most = np.maximum(pool.valid[row] - 1 - (head - shown), 0)
    limited: NDArray[np.float32] = np.clip(offset, 0.0, most).astype(np.float32)
    return limited


def dilate(
    pool: StreamPool,
    anim: AgentAnimID,
    part: int,
    agents: NDArray[np.int64],
    targets: NDArray[np.float32],
    seconds: float,
    tick: int,
    *,
    fastest: float = FASTEST,
) -> Dilated:
    """Let agents' offsets go to their targets, each at a steady rate that takes `seconds`.

    Parameters
    ----------
    pool, anim
        Streams and columns; the columns are changed.
    part, agents
        Part, and (K,) ids.
    targets
        (K,) offsets in poses, 0 to the stream's history less 2.
    seconds
        How long it may take; where that means a rate above `fastest`, it takes longer.
    tick
        The pose tick about to be evaluated.
    fastest
        Poses a pose tick, more than 0 and less than 1.

    Raises
    ------
    ValueError
        For targets outside the history, agents that are on no stream, a negative time, or a rate
        at which time would stand still.
    """
    wanted = np.asarray(targets, np.float32)
    row = anim.row[part, agents].astype(np.int64)
    _check(pool, row, wanted, seconds, fastest)
    current = shown_offsets(pool, anim, part, agents, tick)
    ticks = max(seconds * POSE_RATE, 1e-6)
    rate = np.divide(np.abs(wanted - current), ticks, dtype=np.float32)
    return _creep(anim, part, agents, current, wanted, rate, tick, fastest)


def spread(
    pool: StreamPool,
    anim: AgentAnimID,
    part: int,
    agents: NDArray[np.int64],
    targets: NDArray[np.float32],
    seconds: float,
    tick: int,
    *,
    fastest: float = FASTEST,
) -> Dilated:
    """Put agents of a stream that just started at its head; they drift to their targets from there.

    All drift at one rate, that of the farthest target, as in the source; parameters and errors as
    for `dilate`.
    """
    wanted = np.asarray(targets, np.float32)
    row = anim.row[part, agents].astype(np.int64)
    _check(pool, row, wanted, seconds, fastest)
    anim.t0[part, agents] = tick
    farthest = float(wanted.max(initial=0.0))
    rate = np.full(len(agents), min(change_rate(farthest, 0.0, seconds), 1e6), np.float32)
    current = np.zeros(len(agents), np.float32)
    return _creep(anim, part, agents, current, wanted, rate, tick, fastest)


def start_stream(
    pool: StreamPool,
    anim: AgentAnimID,
    stream: Stream,
    agents: NDArray[np.int64],
    *,
    seconds: float,
    tick: int,
    rng: np.random.Generator,
    parts: tuple[int, ...] = (0,),
    together: bool = True,
    fastest: float = FASTEST,
) -> Dilated:
    """Run a stopped stream with agents on it, who begin at its head and drift apart.

    Parameters
    ----------
    pool, anim, stream
        The stream is cut if it was stopped; one that runs must have been added or cut in this
        tick. The columns are changed.
    agents
        (K,) ids that are put on it; what they showed before is left without a blend (call
        `begin_blend` first and `spread` after it for one).
    seconds, tick, fastest
        As for `dilate`.
    rng
        Targets are drawn from it, uniform over what the history will hold.
    parts, together
        Parts of the agents, and whether all parts of an agent get the same target.

    Raises
    ------
    ValueError
        If the stream is not alive or has a past that agents could be spread over at once.
    """
    row = pool.row(stream)
    pool.run(stream)
    if pool.valid[row] > 0:
        raise ValueError(f"stream {row} has been running for {pool.valid[row]} poses")
    longest = float(pool.history_goal[row] - 2)
    total = Dilated(0, 0, 0.0)
    targets = rng.uniform(0.0, longest, len(agents)).astype(np.float32)
    for number, part in enumerate(parts):
        if number and not together:
            targets = rng.uniform(0.0, longest, len(agents)).astype(np.float32)
        anim.row[part, agents] = row
        done = spread(pool, anim, part, agents, targets, seconds, tick, fastest=fastest)
        total = total.plus(done)
    return total


def finish(pool: StreamPool, anim: AgentAnimID, tick: int) -> int:
    """Set offsets that have arrived by pose tick `tick` to rest; how many.

    What is shown stays the same, so mirrors needn't copy anything and `version` stays.
    """
    done = 0
    for part in range(len(anim.row)):
        agents = np.flatnonzero(anim.rate[part] != 0)
        if not len(agents):
            continue
        at = (part, agents)
        row = np.minimum(anim.row[at].astype(np.int64), len(pool.head) - 1)
        since = np.minimum(tick - 1, pool.head[row]) - anim.t0[at]
        way = np.abs(anim.target[at] - anim.start[at])
        arrived = agents[np.abs(anim.rate[at].astype(np.float64)) * since >= way]
        anim.start[part, arrived] = anim.target[part, arrived]
        anim.rate[part, arrived] = 0.0
        done += len(arrived)
    return done


def shrink_histories(
    pool: StreamPool,
    anim: AgentAnimID,
    transition: Transition,
    tick: int,
    *,
    others: Sequence[PoolUser] = (),
) -> Dilated:
    """Bring agents of streams that shall keep fewer poses nearer, and lower M behind them.

    Agents beyond the new history hurry at `FASTEST` unless they are on their way already. M of a
    stream is as low as the farthest agent allows at any time; sources of running blends hold it
    until they end. Called once a pose tick, before the pool's evaluate; `others` are columns of
    parts that play streams of the same pool.
    """
    total = Dilated(0, 0, 0.0)
    rows = np.flatnonzero(pool.history > pool.history_goal)
    if not len(rows):
        return total
    count = len(pool.head)
    shrinks = np.zeros(count + 1, np.bool_)
    shrinks[rows] = True
    farthest = np.zeros(count)
    for user in (PoolUser(anim, transition), *others):
        total = total.plus(_bring_nearer(pool, user, shrinks, farthest, tick))
    needed = np.ceil(farthest[rows]).astype(np.int32) + 2
    pool.history[rows] = np.clip(needed, pool.history_goal[rows], pool.history[rows])
    return total


def _bring_nearer(
    pool: StreamPool,
    user: PoolUser,
    shrinks: NDArray[np.bool_],
    farthest: NDArray[np.float64],
    tick: int,
) -> Dilated:
    """Let agents beyond new histories hurry; `farthest` (R,) grows to what is still shown."""
    total = Dilated(0, 0, 0.0)
    anim, transition = user
    count = len(farthest)
    for part in range(len(anim.row)):
        on = np.flatnonzero(shrinks[np.minimum(anim.row[part], count)])
        goal = (pool.history_goal[anim.row[part, on]] - 2).astype(np.float32)
        beyond = anim.target[part, on] > goal
        hurry = on[beyond]
        if len(hurry):
            total = total.plus(dilate(pool, anim, part, hurry, goal[beyond], 0.0, tick))
        offset = np.maximum(shown_offsets(pool, anim, part, on, tick), anim.target[part, on])
        np.maximum.at(farthest, anim.row[part, on], offset)
        leaving = np.flatnonzero(transition.duration[part] > 0)
        leaving = leaving[shrinks[np.minimum(transition.row[part, leaving], count)]]
        ends = (transition.start[part, leaving], transition.target[part, leaving])
        np.maximum.at(farthest, transition.row[part, leaving], np.maximum(*ends))
    return total


def _creep(
    anim: AgentAnimID,
    part: int,
    agents: NDArray[np.int64],
    current: NDArray[np.float32],
    targets: NDArray[np.float32],
    rate: NDArray[np.float32],
    tick: int,
    fastest: float,
) -> Dilated:
    """Let offsets go from `current` to `targets` at (K,) rates >= 0, or at `fastest`."""
    at = (part, agents)
    ways = targets - current
    moving = np.abs(ways) > _ARRIVED
    steady = np.where(moving, np.minimum(rate, np.float32(fastest)), np.float32(0.0))
    anim.start[at] = current
    anim.target[at] = np.where(moving, targets, current)
    anim.rate[at] = np.sign(ways) * steady
    # Who entered in this very tick goes on counting from it.
    anim.t0[at] = np.clip(anim.t0[at], tick - 1, tick)
    anim.version += 1
    took = np.abs(ways[moving]) / steady[moving]
    return Dilated(
        moving=int(np.count_nonzero(moving)),
        lengthened=int(np.count_nonzero(moving & (rate > np.float32(fastest * 1.000001)))),
        ticks=float(took.max(initial=0.0)),
    )


def _check(
    pool: StreamPool,
    row: NDArray[np.int64],
    targets: NDArray[np.float32],
    seconds: float,
    fastest: float,
) -> None:
    if targets.shape != row.shape:
        raise ValueError(f"targets has shape {targets.shape}, expected {row.shape}: one an agent")
    if not 0 <= seconds <= _LONGEST:
        raise ValueError(f"seconds is {seconds}, expected 0 to {_LONGEST:g}")
    if not 0 < fastest < 1:
        raise ValueError(f"fastest is {fastest}, expected more than 0 and less than 1 pose a tick")
    if not len(row):
        return
    if int(row.max()) >= len(pool.head):
        raise ValueError("agents: some are on no stream, so they have no offset")
    longest = pool.history_goal[row] - 2
    wrong = ~((targets >= 0) & (targets <= longest))
    if wrong.any():
        k = int(np.argmax(wrong))
        raise ValueError(f"targets has {targets[k]}, expected 0 to {longest[k]} poses there")
