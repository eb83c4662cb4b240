"""Offsets creep to their targets, and streams keep as many poses and run as much as is needed."""

from __future__ import annotations

import esper
import numpy as np

from ..components import AgentAnimID, Dilation, DilationRequest, Transition
from ..engine.clock import Clock
from ..engine.streams.dilation import Dilated, dilate, finish, shrink_histories
from ..engine.streams.pool import StreamPool
from ..engine.streams.stream_needs import StreamNeeds
from .query import crowds


class DilationSystem(esper.Processor):
    """Begins the changes of offsets that were asked for and closes those that have arrived.

    Moving offsets cost nothing in between: the age formula moves them.
    """

    def process(self, clock: Clock) -> None:
        """One base tick; works at pose ticks."""
        if not clock.is_pose_tick:
            return
        tick = clock.pose_tick
        for entity, (pool, anim, dilation) in crowds(StreamPool, AgentAnimID, Dilation):
            transition = esper.component_for_entity(entity, Transition)
            dilation.arrived += finish(pool, anim, tick)
            waiting, dilation.waiting = dilation.waiting, []
            for request in waiting:
                _count(dilation, _apply(request, pool, anim, tick))
            needs = esper.try_component(entity, StreamNeeds)
            if needs is not None:
                _count(dilation, needs.update(pool, anim, transition, tick))
            dilation.started += shrink_histories(pool, anim, transition, tick).moving


def _apply(request: DilationRequest, pool: StreamPool, anim: AgentAnimID, tick: int) -> Dilated:
    """Fit a request to where its agents are by now, and begin it."""
    row = anim.row[request.part, request.agents]
    on_stream = row < pool.store.stream_rows
    agents, row = request.agents[on_stream], row[on_stream]
    longest = (pool.history_goal[row] - 2).astype(np.float32)
    targets = np.minimum(request.targets[on_stream], longest)
    return dilate(pool, anim, request.part, agents, targets, request.seconds, tick)


def _count(dilation: Dilation, done: Dilated) -> None:
    dilation.started += done.moving
    dilation.lengthened += done.lengthened
