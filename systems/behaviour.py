"""Events and innate wishes become the motion that each agent wants."""

from __future__ import annotations

import esper
import numpy as np

from ..components import MotionState, Placement, Seat, Team
from ..engine.behaviour import answer_event, settle, wander
from ..engine.behaviour.events import EventQueue
from ..engine.clock import Clock
from ..engine.crowd.motions import MotionLibrary
from .query import crowds


class BehaviourSystem(esper.Processor):
    """Answers queued events and lets agents at rest change what they do.

    Parameters
    ----------
    rng
        Where choices come from.
    """

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng

    def process(self, clock: Clock) -> None:
        """One base tick; works at pose ticks."""
        if not clock.is_pose_tick:
            return
        tick = clock.pose_tick
        for entity, (state, library, queue) in crowds(MotionState, MotionLibrary, EventQueue):
            team = esper.component_for_entity(entity, Team)
            placement = esper.component_for_entity(entity, Placement)
            present = esper.component_for_entity(entity, Seat).occupied
            for event in queue.take():
                answer_event(event, state, team, placement, present, library, tick, self._rng)
            wander(state, library, self._rng)
            settle(state, tick)
