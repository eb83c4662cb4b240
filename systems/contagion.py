"""Beats and offsets of those who clap, after what they show is known."""

from __future__ import annotations

import esper

from ..components import AgentAnimID, MotionState
from ..engine.behaviour.clap_motion import ClapMotion
from ..engine.behaviour.company import Company
from ..engine.clock import Clock
from ..engine.crowd.motions import MotionLibrary
from ..engine.streams.pool import StreamPool
from .query import crowds


class ClapSystem(esper.Processor):
    """Lets clappers' hands meet at their beats."""

    def process(self, clock: Clock) -> None:
        """One base tick; works at pose ticks."""
        if not clock.is_pose_tick:
            return
        for entity, (motion, company, pool) in crowds(ClapMotion, Company, StreamPool):
            anim = esper.component_for_entity(entity, AgentAnimID)
            motion.step(clock.pose_tick, pool, anim, company.rhythm)
        for entity, (motion, company, state) in crowds(ClapMotion, Company, MotionState):
            if not esper.has_component(entity, StreamPool):
                clips = esper.component_for_entity(entity, MotionLibrary).clips
                motion.step_unseen(clock.pose_tick, state.shown, clips, company.rhythm)
