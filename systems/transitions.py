"""Agents whose wanted motion is not the one they show are asked to blend towards it."""

from __future__ import annotations

import esper
import numpy as np

from ..components import BakedAnim, MotionState
from ..engine.clock import Clock
from ..engine.crowd.motions import MotionLibrary, MotionStreams
from ..engine.streams.ladder import BlendLadder
from .query import crowds

BODY = 0
"""The part whose motion behaviour chooses."""


class TransitionSystem(esper.Processor):
    """Turns wanted motions into streams and offsets, and meets what the application asked for.

    What was asked for since the last pose tick goes before what behaviour wants in this one.
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
        for entity, (ladder,) in crowds(BlendLadder):
            state = esper.try_component(entity, MotionState)
            streams = esper.try_component(entity, MotionStreams)
            if state is not None and streams is not None:
                self._want(state, ladder, streams)
            ladder.step(clock.pose_tick, self._rng)
        for _, (state, baked, library) in crowds(MotionState, BakedAnim, MotionLibrary):
            self._bake(state, baked, library, clock.pose_tick)

    def _want(self, state: MotionState, ladder: BlendLadder, streams: MotionStreams) -> None:
        agents = np.flatnonzero(state.wanted != state.shown)
        if not len(agents):
            return
        state.shown[agents] = state.wanted[agents]
        agents = agents[~ladder.transition.asked[BODY, agents]]
        row = streams.draw_rows(state.wanted[agents], self._rng)
        ladder.ask(BODY, agents, row, np.nan, state.blend[agents])

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
