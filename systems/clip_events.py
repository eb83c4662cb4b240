"""Tags on the clips' timelines reach the agents that play past them, and whoever listens."""

from __future__ import annotations

import esper

from ..components import AgentAnimID, Transition
from ..engine.clock import Clock
from ..engine.streams.event_delivery import deliver
from ..engine.streams.event_feed import ClipEventFeed
from ..engine.streams.pool import StreamPool
from .query import crowds

BODY = 0
"""The part whose events a crowd hears."""


class ClipEventSystem(esper.Processor):
    """Delivers the clip events of a pose tick once its poses are committed."""

    def process(self, clock: Clock) -> None:
        """One base tick; works at pose ticks."""
        if not clock.is_pose_tick:
            return
        for entity, (pool, anim, transition) in crowds(StreamPool, AgentAnimID, Transition):
            feed = esper.try_component(entity, ClipEventFeed)
            if feed is not None and feed.names:
                feed.post(deliver(pool, anim, transition, BODY, clock.pose_tick))
