"""Agents whose wanted motion is not the one they show are asked to blend towards it."""

from __future__ import annotations

import esper
import numpy as np
from numpy.typing import NDArray

from ..components import BakedAnim, Body, MotionState
from ..engine.clock import Clock
from ..engine.crowd.motions import MotionLibrary, MotionStreams
from ..engine.crowd.once import OnceStreams
from ..engine.crowd.ways import Ways
from ..engine.streams.ladder import BlendLadder
from ..engine.streams.overlaying import OverlayStage
from .query import crowds

BODY = 0
"""The part whose motion behaviour chooses."""


class TransitionSystem(esper.Processor):
    """Turns wanted motions into streams and offsets, and meets what the application asked for.

    What was asked for since the last pose tick goes before what behaviour wants in this one.
    Where the crowd has ways between sitting and standing, agents at rest take them.
    Baked crowds can't blend: they change clip at once, and so do crowds without poses.

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
        for entity, (ladder,) in crowds(BlendLadder):
            state = esper.try_component(entity, MotionState)
            streams = esper.try_component(entity, MotionStreams)
            if state is not None and streams is not None:
                ways = esper.try_component(entity, Ways)
                once = esper.component_for_entity(entity, OnceStreams)
                kind = esper.component_for_entity(entity, Body).kind
                self._want(state, ladder, streams, kind, ways, once, clock.pose_tick)
            stage = esper.try_component(entity, OverlayStage)
            if stage is not None:
                stage.step(clock.pose_tick, self._rng)
            ladder.step(clock.pose_tick, self._rng)
        for _, (state, baked, library) in crowds(MotionState, BakedAnim, MotionLibrary):
            self._bake(state, baked, library, clock.pose_tick)
        for entity, (state, _) in crowds(MotionState, MotionLibrary):
            posed = (esper.has_component(entity, kind) for kind in (BlendLadder, BakedAnim))
            if not any(posed):
                state.shown[:] = state.wanted

    def _want(
        self,
        state: MotionState,
        ladder: BlendLadder,
        streams: MotionStreams,
        kind: NDArray[np.uint8],
        ways: Ways | None,
        once: OnceStreams,
        tick: int,
    ) -> None:
        ready = state.wanted != state.shown
        if ways is not None:
            ready &= state.busy_until <= tick
        agents = np.flatnonzero(ready)
        if not len(agents):
            return
        asked = ladder.transition.asked[BODY, agents]
        state.shown[agents[asked]] = state.wanted[agents[asked]]
        agents = agents[~asked]
        motion, blend = state.wanted[agents], state.blend[agents]
        row = streams.draw_rows(motion, kind[agents], self._rng)
        offset = np.full(len(agents), np.nan, np.float32)
        resting = np.flatnonzero(ladder.transition.duration[BODY, agents] == 0)
        if ways is not None and len(resting):
            way = (motion[resting], row[resting], offset[resting], blend[resting])
            ways.enter(ladder.pool, state, agents[resting], *way, tick, self._rng)
            for column, changed in zip((motion, row, offset, blend), way, strict=True):
                column[resting] = changed
        once.enter(ladder.pool, motion, row, offset, blend, tick, self._rng)
        row = streams.twins.resolve(row, kind[agents])
        state.shown[agents] = motion
        ladder.ask(BODY, agents, row, offset, blend)

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
