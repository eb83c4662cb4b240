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
        Pose tick of the start, and (K,) pose ticks that the blend takes, > 0.
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


def end_finished(anim: AgentAnimID, transition: Transition, tick: int) -> int:
    """Clear blends that every picture from pose tick `tick` on shows at their end; how many."""
    done = (transition.duration > 0) & (tick - 1 >= transition.begin + transition.duration)
    count = int(np.count_nonzero(done))
    if count:
        transition.duration[done] = 0.0
        anim.version += 1
    return count


def blend_weight(
    begin: NDArray[np.int32], duration: NDArray[np.float32], shown: float
) -> NDArray[np.float32]:
    """Share of the target: a smooth step from `begin` over `duration` pose ticks; 1 without blend.

    Half way through, it is 0.5, with a slope of 1.5 / duration.
    """
    safe = np.where(duration > 0, duration, 1.0)
    s = np.where(duration > 0, np.clip((shown - begin) / safe, 0.0, 1.0), 1.0)
    return (s * s * (3.0 - 2.0 * s)).astype(np.float32)


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

    def read(columns: AgentAnimID | Transition) -> NDArray[np.float32]:
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

    target = read(anim)
    weight = blend_weight(
        transition.begin[part, agents], transition.duration[part, agents], tick - 1 + alpha
    )
    blending = np.flatnonzero(weight < 1.0)
    if len(blending):
        source = read(transition)[blending]
        share = weight[blending, None, None, None]
        target[blending] = source + (target[blending] - source) * share
    return target
