"""Offsets creep to their targets, and streams keep as many poses and run as much as is needed."""

from __future__ import annotations

from collections import defaultdict

import esper
import numpy as np

from ..components import AgentAnimID, Attachment, Dilation, DilationRequest, Transition
from ..engine.clock import Clock
from ..engine.streams.dilation import Dilated, PoolUser, dilate, finish, shrink_histories
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
        guests = _move_guests(tick)
        for entity, (pool, anim, dilation) in crowds(StreamPool, AgentAnimID, Dilation):
            transition = esper.component_for_entity(entity, Transition)
            others = guests.get(entity, ())
            _move(pool, anim, dilation, tick)
            needs = esper.try_component(entity, StreamNeeds)
            if needs is not None:
                _count(dilation, needs.update(pool, anim, transition, tick, others=others))
            shrunk = shrink_histories(pool, anim, transition, tick, others=others)
            dilation.started += shrunk.moving


def _move_guests(tick: int) -> dict[int, list[PoolUser]]:
    """Move the offsets of parts that play the streams of their crowd; who they are, by crowd."""
    guests: dict[int, list[PoolUser]] = defaultdict(list)
    for entity, (attachment, anim, dilation) in crowds(Attachment, AgentAnimID, Dilation):
        pool = esper.try_component(attachment.parent, StreamPool)
        if pool is not None and not esper.has_component(entity, StreamPool):
            _move(pool, anim, dilation, tick)
            transition = esper.component_for_entity(entity, Transition)
            guests[attachment.parent].append(PoolUser(anim, transition))
    return guests


def _move(pool: StreamPool, anim: AgentAnimID, dilation: Dilation, tick: int) -> None:
    dilation.arrived += finish(pool, anim, tick)
    waiting, dilation.waiting = dilation.waiting, []
    for request in waiting:
        _count(dilation, _apply(request, pool, anim, tick))


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
