"""Blends of two sources: what the shader mixes while an agent changes motion.

*Techniques 2022*, 4.4: while a blend runs, the agent is skinned from both motions and the vertices
are mixed. Skinning is linear in the palettes, so mixing palettes is the same.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.animation import AgentAnimID, Transition
from .displayed import read_palettes, shown_poses
from .pool import StreamPool
from .slots import SlotPool


def begin_blend(
    anim: AgentAnimID,
    transition: Transition,
    part: int,
    agents: NDArray[np.int64],
    row: NDArray[np.int32],
    offset: NDArray[np.float32],
    tick: int,
    duration: NDArray[np.float32],
) -> None:
    """Let agents leave what they show for another row and offset.

    Parameters
    ----------
    anim, transition
        Columns that are changed.
    part, agents
        Part, and (K,) ids of agents with no running blend in it.
    row, offset
        (K,) unified pose index and offset in poses to go to.
    tick, duration
        Pose tick of the start, and (K,) pose ticks that the blend takes; 0 is a jump.
    """
    for name in ("row", "start", "target", "t0", "rate"):
        getattr(transition, name)[part, agents] = getattr(anim, name)[part, agents]
    transition.begin[part, agents] = tick
    transition.duration[part, agents] = duration
    anim.row[part, agents] = row
    anim.start[part, agents] = offset
    anim.target[part, agents] = offset
    anim.t0[part, agents] = tick
    anim.rate[part, agents] = 0.0
    anim.version += 1


def come_from_slots(
    transition: Transition,
    part: int,
    agents: NDArray[np.int64],
    rows: NDArray[np.int32],
) -> None:
    """Let running blends of (K,) agents leave slots, by their unified rows, instead of motions."""
    transition.row[part, agents] = rows
    for name in ("start", "target", "t0", "rate"):
        getattr(transition, name)[part, agents] = 0


def hurry(
    anim: AgentAnimID,
    transition: Transition,
    part: int,
    agents: NDArray[np.int64],
    tick: int,
    duration: float,
) -> None:
    """Let running blends go on as if they took at most `duration` pose ticks in all.

    What is shown at `tick`, and so the weight there, stays; only what is left goes faster. A blend
    of 12 ticks that is half done has 3 left instead of 6 if `duration` is 6.
    """
    at = (part, agents)
    begin, length = transition.begin[at], transition.duration[at].astype(np.float64)
    done = np.clip((tick - begin) / length, 0.0, 1.0)
    shorter = np.minimum(length, duration)
    # Down to 1/256, so that begin is exact in float32; the duration makes up for it.
    moved = np.floor((tick - done * shorter) * 256.0) / 256.0
    # One that has hardly begun, with a weight below 3e-4, begins now.
    started = done > 0.01
    transition.begin[at] = np.where(started, moved, np.maximum(begin, tick))
    safe = np.where(started, done, 1.0)
    transition.duration[at] = np.where(
        started, np.minimum((tick - moved) / safe, length), shorter
    ).astype(np.float32)
    anim.version += 1


def end_finished(
    anim: AgentAnimID, transition: Transition, tick: int, slots: SlotPool | None = None
) -> int:
    """Clear blends that every picture from pose tick `tick` on shows at their end; how many.

    The slots that they came from are free again.
    """
    count = 0
    for part, duration in enumerate(transition.duration):
        # Most layers are empty, and a maximum is quicker than a mask.
        if duration.max(initial=0.0) <= 0:
            continue
        agents = np.flatnonzero(duration > 0)
        over = tick - 1 >= transition.begin[part, agents] + duration[agents]
        done = agents[over]
        if len(done):
            if slots is not None:
                slots.release(transition.row[part, done])
            duration[done] = 0.0
            count += len(done)
    anim.version += count > 0
    return count


def blend_progress(
    begin: NDArray[np.float64], duration: NDArray[np.float32], shown: float
) -> NDArray[np.float64]:
    """How much of each blend's time has passed at time `shown`, 0 to 1; 1 without a blend."""
    safe = np.where(duration > 0, duration, 1.0)
    return np.where(duration > 0, np.clip((shown - begin) / safe, 0.0, 1.0), 1.0)


def blend_weight(
    begin: NDArray[np.float64], duration: NDArray[np.float32], shown: float
) -> NDArray[np.float32]:
    """Share of the target: a smooth step from `begin` over `duration` pose ticks; 1 without blend.

    Half way through, it is 0.5, with a slope of 1.5 / duration.
    """
    s = blend_progress(begin, duration, shown)
    return (s * s * (3.0 - 2.0 * s)).astype(np.float32)


def source_palettes(
    pool: StreamPool,
    columns: AgentAnimID | Transition,
    part: int,
    agents: NDArray[np.int64],
    tick: int,
    alpha: float,
) -> NDArray[np.float32]:
    """(K, J, 3, 4) palettes of one side of a blend; parameters as for `agent_palettes`."""
    at = (part, agents)
    shown = shown_poses(
        pool,
        columns.row[at].astype(np.int64),
        columns.start[at],
        columns.target[at],
        columns.t0[at],
        columns.rate[at],
        tick,
        alpha,
    )
    return read_palettes(pool, shown)


def agent_palettes(
    pool: StreamPool,
    anim: AgentAnimID,
    transition: Transition,
    part: int,
    agents: NDArray[np.int64],
    tick: int,
    alpha: float,
) -> NDArray[np.float32]:
    """What agents show, evaluated on the CPU by the shader's rules.

    Parameters
    ----------
    pool, anim, transition
        The crowd's poses and columns.
    part, agents
        Part, and (K,) ids.
    tick, alpha
        Pose tick and the fraction of it that has passed.

    Returns
    -------
    (K, J, 3, 4) float32 palettes
    """

    target = source_palettes(pool, anim, part, agents, tick, alpha)
    weight = blend_weight(
        transition.begin[part, agents], transition.duration[part, agents], tick - 1 + alpha
    )
    blending = np.flatnonzero(weight < 1.0)
    if len(blending):
        source = source_palettes(pool, transition, part, agents[blending], tick, alpha)
        share = weight[blending, None, None, None]
        if len(blending) == len(agents):
            target -= source
            target *= share
            target += source
        else:
            target[blending] = source + (target[blending] - source) * share
    return target
