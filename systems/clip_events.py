"""Tags on the clips' timelines reach the agents that play past them, and whoever listens."""

from __future__ import annotations

import esper

from ..components import AgentAnimID, Transition
from ..engine.clock import Clock
from ..engine.streams.event_feed import ClipEventFeed
from ..engine.streams.overlay_events import deliver_whole
from ..engine.streams.overlaying import OverlayStage
from ..engine.streams.pool import StreamPool
from .query import crowds


class ClipEventSystem(esper.Processor):
    """Delivers the clip events of a pose tick once its poses are committed."""

    def process(self, clock: Clock) -> None:
        """One base tick; works at pose ticks."""
        if not clock.is_pose_tick:
            return
        for entity, (pool, anim, transition) in crowds(StreamPool, AgentAnimID, Transition):
            feed = esper.try_component(entity, ClipEventFeed)
            if feed is not None and feed.names:
                overlays = esper.try_component(entity, OverlayStage)
                feed.post(deliver_whole(pool, anim, transition, overlays, clock.pose_tick))
