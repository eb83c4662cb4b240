"""Reactions to events, for a whole crowd at once.

Each agent that reacts gets a motion, a tick to begin and a tick to calm down. People start within
human reaction times of each other and stop over many seconds, so a stand never moves as one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.motion import NEVER, MotionState
from ...components.placement import Placement
from ...components.team import NEUTRAL, Team
from ..crowd.motions import MotionLibrary, Role
from ..streams.pool import POSE_RATE
from .events import BallHit, Event, Goal

HIT_RADIUS = 1.2
"""Metres from where the ball lands within which it hits."""
WITNESS_RADIUS = 7.0
"""Metres within which people turn to what happened."""
INNATE_CHANGE_SECONDS = 25.0
"""Mean time after which a spectator at rest does something else."""


@dataclass(frozen=True, slots=True)
class _Answer:
    """How one group of agents reacts: shares and times in seconds."""

    role: Role
    share: float
    delay: tuple[float, float]
    length: tuple[float, float]
    blend: float = 0.4


_OWN_GOAL_SCORED = _Answer(Role.CHEER, 0.97, (0.15, 0.9), (9.0, 20.0))
_OTHER_GOAL_SCORED = _Answer(Role.DISMAY, 0.55, (0.3, 1.4), (2.5, 6.0))
_NEUTRAL_GOAL = _Answer(Role.APPLAUD, 0.6, (0.5, 2.0), (4.0, 9.0))
_HIT = _Answer(Role.DISMAY, 1.0, (0.0, 0.05), (2.0, 3.5), blend=0.2)
_WITNESS = _Answer(Role.CHEER, 0.7, (0.3, 1.2), (2.0, 4.5))


def answer_event(
    event: Event,
    state: MotionState,
    team: Team,
    placement: Placement,
    present: NDArray[np.bool_],
    library: MotionLibrary,
    tick: int,
    rng: np.random.Generator,
) -> NDArray[np.int64]:
    """Plan the reactions to an event.

    Parameters
    ----------
    event
        What happened.
    state
        Changed in place.
    team, placement, present, library
        Sides, places, who is there, and the motions that exist.
    tick
        Pose tick of the event.
    rng
        Where choices come from.

    Returns
    -------
    (K,) int64 ids of the agents that react
    """
    groups: tuple[tuple[NDArray[np.bool_], _Answer], ...]
    if isinstance(event, Goal):
        groups = (
            (present & (team.side == event.side), _OWN_GOAL_SCORED),
            (present & (team.side == 1 - event.side), _OTHER_GOAL_SCORED),
            (present & (team.side == NEUTRAL), _NEUTRAL_GOAL),
        )
    else:
        distance = _distance(placement, event)
        groups = (
            (present & (distance <= HIT_RADIUS), _HIT),
            (present & (distance > HIT_RADIUS) & (distance <= WITNESS_RADIUS), _WITNESS),
        )
    reacting = [_plan(np.flatnonzero(mask), how, state, library, tick, rng) for mask, how in groups]
    agents: NDArray[np.int64] = np.concatenate(reacting)
    return agents


def settle(state: MotionState, tick: int) -> None:
    """Begin and end the reactions that are due at pose tick `tick`."""
    begins = state.react_at <= tick
    if begins.any():
        state.wanted[begins] = state.reaction[begins]
        state.react_at[begins] = NEVER
    ends = state.calm_at <= tick
    if ends.any():
        state.wanted[ends] = state.innate[ends]
        state.calm_at[ends] = NEVER
        state.blend[ends] = 0.6 * POSE_RATE


def wander(
    state: MotionState, library: MotionLibrary, rng: np.random.Generator
) -> NDArray[np.int64]:
    """Let a few agents at rest choose another innate motion; their ids."""
    count = len(state.wanted)
    changes = rng.poisson(count / (INNATE_CHANGE_SECONDS * POSE_RATE))
    agents = np.unique(rng.integers(0, count, changes))
    state.innate[agents] = library.draw_innate(len(agents), rng)
    resting: NDArray[np.int64] = agents[
        (state.calm_at[agents] == NEVER) & (state.react_at[agents] == NEVER)
    ]
    state.wanted[resting] = state.innate[resting]
    return resting


def _plan(
    agents: NDArray[np.int64],
    how: _Answer,
    state: MotionState,
    library: MotionLibrary,
    tick: int,
    rng: np.random.Generator,
) -> NDArray[np.int64]:
    agents = agents[rng.random(len(agents)) < how.share]
    delay = rng.uniform(*how.delay, len(agents)) * POSE_RATE
    length = rng.uniform(*how.length, len(agents)) * POSE_RATE
    state.reaction[agents] = library.draw(how.role, len(agents), rng)
    state.react_at[agents] = tick + delay.astype(np.int32)
    state.calm_at[agents] = tick + (delay + length).astype(np.int32)
    state.blend[agents] = how.blend * POSE_RATE
    return agents


def _distance(placement: Placement, event: BallHit) -> NDArray[np.float32]:
    """Metres from each agent's chest to where the ball lands."""
    x, y, z = (np.float32(value) for value in event.place)
    px, py, pz = placement.position
    distance: NDArray[np.float32] = np.sqrt((px - x) ** 2 + (py + 1.0 - y) ** 2 + (pz - z) ** 2)
    return distance
