"""Events, feelings, states and orders become the motion that each agent wants."""

from __future__ import annotations

from typing import Any

import esper
import numpy as np

from ..components import Behaviour, Emotion, MotionState, Placement, Seat, Team
from ..engine.behaviour.answers import Answers
from ..engine.behaviour.company import GREETING, Company
from ..engine.behaviour.compiled import CompiledTable
from ..engine.behaviour.display import motions_to_show
from ..engine.behaviour.emotion import relax
from ..engine.behaviour.events import EventQueue
from ..engine.behaviour.facing import Facing
from ..engine.behaviour.guidance import Guidance
from ..engine.behaviour.hugs import Hugs
from ..engine.behaviour.machine import step, union
from ..engine.behaviour.responses import respond
from ..engine.clock import Clock
from ..engine.streams.pool import POSE_RATE
from .gestures import Gestures
from .query import crowds

GUIDED_BLEND = 12.0
"""Pose ticks in which an order takes effect or ends."""


class BehaviourSystem(esper.Processor):
    """Answers the events that are due, and lets agents whose stay in a state ends move on.

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
        for entity, (behaviour, table, motion) in crowds(Behaviour, CompiledTable, MotionState):
            self._step(entity, behaviour, table, motion, clock.pose_tick)

    def _step(
        self,
        entity: int,
        behaviour: Behaviour,
        table: CompiledTable,
        motion: MotionState,
        tick: int,
    ) -> None:
        def component(kind: type[Any]) -> Any:
            return esper.component_for_entity(entity, kind)

        emotion, team = component(Emotion), component(Team)
        company = component(Company)
        hugs: Hugs | None = esper.try_component(entity, Hugs)
        placement, present = component(Placement), component(Seat).occupied
        events = component(EventQueue).take(tick / POSE_RATE)
        for event in events:
            greeted = company.see(event, table, team, placement)
            if len(greeted) and event.place is not None:
                component(Facing).turn_to(greeted, event.place, tick, GREETING)
            if hugs is not None:
                hugs.see(event, tick)
        for event, began, part in component(Answers).ask(events, tick):
            respond(
                *(event, table, behaviour, emotion, team, placement, present, began, self._rng),
                part=part,
            )
        relax(emotion, tick, behaviour.reacting, contagious=True)
        company.step(tick, emotion, behaviour)
        if hugs is not None:
            hugs.step(table, behaviour, motion.busy_until, company.away, tick)
        component(Facing).step(tick)
        changed = step(
            table,
            behaviour,
            columns_of(behaviour, emotion, team),
            tick,
            self._rng,
            held_until=motion.busy_until,
            blend=motion.blend,
        )
        company.listen(table, behaviour, changed, tick)
        gestures = esper.try_component(entity, Gestures)
        if gestures is not None and len(changed):
            gestures.update(entity, table, behaviour, changed, self._rng)
        guidance = component(Guidance)
        told = guidance.step(tick, behaviour)
        if len(told):
            motion.blend[told] = GUIDED_BLEND
            changed = union([changed, told], len(motion.wanted))
        if len(changed):
            motion.wanted[changed] = motions_to_show(
                table, behaviour, guidance, changed, motion.wanted
            )


def columns_of(behaviour: Behaviour, emotion: Emotion, team: Team) -> dict[str, Any]:
    """What the rules of a table may ask for."""
    return {
        **behaviour.signals,
        "excitement": emotion.excitement,
        "embarrassment": emotion.embarrassment,
        "mood": emotion.mood,
        "fatigue": emotion.fatigue,
        "fervour": team.fervour,
    }
