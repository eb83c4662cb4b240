"""People on their way through the stadium: those who come late, leave, or look after the others."""

from __future__ import annotations

import esper

from ..components import MotionState, Placement
from ..engine.behaviour.company import Company
from ..engine.behaviour.guidance import Guidance
from ..engine.behaviour.walkers import Walkers
from ..engine.clock import BASE_RATE, Clock
from .query import crowds


class WalkingSystem(esper.Processor):
    """Moves those who are on their way, in every tick; who does what is decided at pose ticks.

    What they show, and that others stand up to let them pass, are orders to the behaviour system,
    which runs after this one.
    """

    def process(self, clock: Clock) -> None:
        """One base tick."""
        for entity, (walkers, placement, motion) in crowds(Walkers, Placement, MotionState):
            if walkers.is_idle:
                continue
            arrived = walkers.move(clock.pose_tick, placement, 1.0 / BASE_RATE)
            if len(arrived):
                esper.component_for_entity(entity, Company).excuse(arrived, away=False)
            if clock.is_pose_tick:
                guidance = esper.component_for_entity(entity, Guidance)
                walkers.step(clock.pose_tick, placement, motion, guidance)
