"""A crowd comes into being: its entity, its columns and its streams."""

from __future__ import annotations

from typing import Any

import esper
import numpy as np

from ..components import (
    AgentAnimID,
    BakedAnim,
    Detail,
    MotionState,
    Placement,
    Seat,
    Section,
    Team,
    Transition,
)
from ..engine.animation.clip import Clip
from ..engine.animation.clip_bank import ClipBank
from ..engine.assets.character import Character
from ..engine.behaviour.events import EventQueue
from ..engine.crowd.colours import draw_appearance
from ..engine.crowd.figure import Figure, make_figure
from ..engine.crowd.motions import sort_motions, start_streams
from ..engine.crowd.occupancy import assign_sides, occupancy_mask
from ..engine.crowd.seating import SeatPlan
from ..engine.crowd.spec import CrowdSpec
from ..engine.crowd.ways import Way, add_ways, find_ways, start_ways, without_ways
from ..engine.streams.baked import BakedPoses
from ..engine.streams.event_feed import ClipEventFeed
from ..engine.streams.ladder import BlendLadder
from ..engine.streams.offsets import OffsetSource, initial_offsets
from ..engine.streams.pool import StreamPool
from ..engine.streams.slots import SlotPool
from ..engine.streams.stream_needs import StreamNeeds
from ..engine.streams.uniques import UniquePool
from .crowd import Crowd

SPECTATOR_HEIGHT = 1.75
"""Metres that a character is scaled to, before agents differ."""


def spawn_crowd(
    spec: CrowdSpec,
    plan: SeatPlan,
    character: Character,
    *,
    offsets: OffsetSource | None = None,
) -> Crowd:
    """Create the entities of a crowd in the current esper world.

    Parameters
    ----------
    spec
        How many, where, how they are animated.
    plan
        The seats.
    character
        Body and clips; a character without clips stands in its rest pose.
    offsets
        First offsets on the streams; as the spec says if None.
    """
    seeds = np.random.SeedSequence(spec.seed).spawn(5)
    rng_seats, rng_sides, rng_looks, rng_motion, rng_place = map(np.random.default_rng, seeds)
    clips = character.clips or (_rest_clip(character),)
    # Every motion should have streams of its own.
    library = sort_motions(clips, most=max(spec.streams // 2, 1))
    plans = None
    if spec.poses == "streams":
        plans = find_ways(clips, library, spec.streams, spec.history)
    if plans is not None:
        library = add_ways(library, plans, len(clips))
    figure = make_figure(character)
    occupied = occupancy_mask(plan, spec, rng_seats)
    side = assign_sides(plan, spec, rng_sides)
    count = plan.count
    crowd = Crowd(
        entity=0,
        spec=spec,
        plan=plan,
        character=character,
        seat=Seat(plan.row, plan.column, plan.section, occupied),
        placement=_place(plan, figure, rng_place),
        team=Team(side),
        appearance=draw_appearance(side, rng_looks),
        motion=MotionState.allocate(library.draw_innate(count, rng_motion)),
        detail=Detail(),
        library=library,
        events=EventQueue(),
    )
    crowd.entity = esper.create_entity(
        crowd.seat,
        crowd.placement,
        crowd.team,
        crowd.appearance,
        crowd.motion,
        crowd.detail,
        crowd.library,
        crowd.events,
        figure,
        character,
    )
    if plans is not None:
        clips = (*clips, *(plan.loop for plan in plans))
    bank = ClipBank(character.skeleton, clips)
    if spec.poses == "baked":
        _add_baked(crowd, bank, figure, rng_motion)
    else:
        _add_streams(crowd, bank, figure, plans, offsets or spec.offsets, rng_motion)
    for name, start, stop in plan.sections:
        esper.create_entity(Section(name, crowd.entity, start, stop))
    return crowd


def _place(plan: SeatPlan, figure: Figure, rng: np.random.Generator) -> Placement:
    count = plan.count
    size = rng.normal(1.0, 0.045, count).clip(0.88, 1.12)
    turn = rng.normal(0.0, 0.12, count).clip(-0.35, 0.35)
    return Placement(
        position=plan.position,
        yaw=(plan.yaw + turn).astype(np.float32),
        scale=(size * SPECTATOR_HEIGHT / figure.height).astype(np.float32),
    )


def _add_streams(
    crowd: Crowd,
    bank: ClipBank,
    figure: Figure,
    plans: tuple[Way, Way] | None,
    offsets: OffsetSource,
    rng: np.random.Generator,
) -> None:
    spec = crowd.spec
    pool = StreamPool(
        crowd.character.skeleton,
        bank,
        capacity=spec.streams,
        history=spec.history,
        markers=figure.joints,
        uniques=spec.uniques,
        slots=spec.slots,
    )
    parts: list[Any] = [pool]
    kept = np.zeros(spec.streams, np.bool_)
    if plans is None:
        streams = start_streams(pool, crowd.library, spec.streams, rng)
    else:
        spare = sum(plan.streams(spec.history) for plan in plans)
        streams = start_streams(pool, without_ways(crowd.library), spec.streams - spare, rng)
        ways, streams = start_ways(pool, crowd.library, plans, streams, spec.history)
        kept[np.concatenate(ways.rows)] = True
        parts.append(ways)
    if spec.rest_idle:
        parts.append(StreamNeeds(spec.streams, always=kept))
    # The crowd is found in the middle of things, so the streams have a past: poses at the ticks
    # before the first one.
    for tick in range(1 - spec.history, 1):
        pool.evaluate(tick)
        pool.commit(tick)
    count = len(crowd)
    anim = AgentAnimID.allocate(1, count, pool.store.bind_row)
    anim.row[0] = streams.draw_rows(crowd.motion.shown, rng)
    anim.start[0] = anim.target[0] = initial_offsets(offsets, count, spec.history, rng)
    crowd.pool, crowd.anim, crowd.transition = pool, anim, Transition.allocate(1, count)
    uniques, slots = UniquePool(pool), SlotPool(pool.store)
    crowd.ladder = BlendLadder(pool, uniques, slots, anim, crowd.transition, crowd.placement)
    crowd.clip_feed = ClipEventFeed(pool.clip_events, crowd.seat.occupied)
    parts += [streams, uniques, slots, anim, crowd.transition, crowd.ladder]
    parts += [crowd.dilation, crowd.clip_feed]
    for component in parts:
        esper.add_component(crowd.entity, component)


def _add_baked(crowd: Crowd, bank: ClipBank, figure: Figure, rng: np.random.Generator) -> None:
    count = len(crowd)
    clips = BakedAnim(
        clip=crowd.library.clips[crowd.motion.shown].astype(np.int32),
        speed=rng.uniform(0.92, 1.08, count).astype(np.float32),
        began=-rng.uniform(0.0, 300.0, count),
    )
    poses = BakedPoses(crowd.character.skeleton, bank, markers=figure.joints)
    crowd.baked = (poses, clips)
    for component in crowd.baked:
        esper.add_component(crowd.entity, component)


def _rest_clip(character: Character) -> Clip:
    skeleton = character.skeleton
    return Clip(
        "rest",
        0.0,
        skeleton.rest_rotation[None],
        skeleton.rest_translation[None],
        skeleton.rest_scale[None],
    )
