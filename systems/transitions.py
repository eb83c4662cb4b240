"""Agents whose wanted motion is not the one they show begin to blend towards it."""

from __future__ import annotations

import esper
import numpy as np
from numpy.typing import NDArray

from ..components import AgentAnimID, BakedAnim, MotionState, Transition
from ..engine.clock import Clock
from ..engine.crowd.motions import MotionLibrary, MotionStreams
from ..engine.crowd.ways import Ways
from ..engine.streams.blending import begin_blend, end_finished
from ..engine.streams.pool import StreamPool
from .query import crowds

BODY = 0
"""The part whose motion behaviour chooses."""


class TransitionSystem(esper.Processor):
    """Turns wanted motions into streams and offsets.

    An agent in the middle of a blend finishes it first and then goes on to what it wants by then.
    Where the crowd has ways between sitting and standing, agents take them.
    Baked crowds can't blend: they change clip at once.

    Parameters
    ----------
    rng
        Where streams, offsets and phases come from.
    """

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng

    def process(self, clock: Clock) -> None:
        """One base tick; works at pose ticks."""
        if not clock.is_pose_tick:
            return
        for entity, (state, anim, pool) in crowds(MotionState, AgentAnimID, StreamPool):
            transition = esper.component_for_entity(entity, Transition)
            streams = esper.component_for_entity(entity, MotionStreams)
            ways = esper.try_component(entity, Ways)
            self._stream(state, anim, transition, pool, streams, ways, clock.pose_tick)
        for _, (state, baked, library) in crowds(MotionState, BakedAnim, MotionLibrary):
            self._bake(state, baked, library, clock.pose_tick)

    def _stream(
        self,
        state: MotionState,
        anim: AgentAnimID,
        transition: Transition,
        pool: StreamPool,
        streams: MotionStreams,
        ways: Ways | None,
        tick: int,
    ) -> None:
        end_finished(anim, transition, tick)
        ready = (state.wanted != state.shown) & (transition.duration[BODY] == 0)
        if ways is not None:
            ready &= state.busy_until <= tick
        agents = np.flatnonzero(ready)
        if not len(agents):
            return
        motion = state.wanted[agents]
        row = streams.draw_rows(motion, self._rng)
        offset = self._offsets(pool, row)
        blend = state.blend[agents]
        if ways is not None:
            ways.enter(pool, state, agents, motion, row, offset, blend, tick, self._rng)
        begin_blend(anim, transition, BODY, agents, row, offset, tick, blend)
        state.shown[agents] = motion

    def _offsets(self, pool: StreamPool, row: NDArray[np.int32]) -> NDArray[np.float32]:
        """Uniform over what each stream's history holds."""
        return (self._rng.random(len(row)) * pool.room(row)).astype(np.float32)

    def _bake(
        self, state: MotionState, baked: BakedAnim, library: MotionLibrary, tick: int
    ) -> None:
        agents = np.flatnonzero(state.wanted != state.shown)
        if not len(agents):
            return
        baked.clip[agents] = library.clips[state.wanted[agents]]
        baked.began[agents] = tick - self._rng.uniform(0.0, 60.0, len(agents))
        baked.version += 1
        state.shown[agents] = state.wanted[agents]
