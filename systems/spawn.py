"""A crowd comes into being: its entity, its columns and its streams."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import esper
import numpy as np
from numpy.typing import NDArray

from ..components import (
    AgentAnimID,
    BakedAnim,
    Behaviour,
    Detail,
    MotionState,
    Overlays,
    Placement,
    Seat,
    Section,
    Team,
    Transition,
)
from ..engine.animation.clip import rest_clip
from ..engine.animation.clip_bank import ClipBank
from ..engine.assets.character import Character
from ..engine.behaviour.answers import Answers
from ..engine.behaviour.clap_motion import ClapMotion
from ..engine.behaviour.clip_names import wanted_clips
from ..engine.behaviour.company import Company
from ..engine.behaviour.compiled import compile_table
from ..engine.behaviour.display import motions_to_show
from ..engine.behaviour.emotion import draw_emotion
from ..engine.behaviour.events import EventQueue
from ..engine.behaviour.guidance import Guidance
from ..engine.behaviour.hugs import Hugs
from ..engine.behaviour.machine import settle
from ..engine.behaviour.parties import FOOTBALL, GENERAL_PUBLIC, form_parties
from ..engine.behaviour.table_file import load_table
from ..engine.crowd.body_types import make_body_types
from ..engine.crowd.builds import draw_bodies
from ..engine.crowd.cast import Cast, choose_cast, start_cast
from ..engine.crowd.colours import draw_appearance
from ..engine.crowd.figure import Figure, make_figure
from ..engine.crowd.figure_masks import figure_masks
from ..engine.crowd.looks import draw_choices
from ..engine.crowd.motions import Role
from ..engine.crowd.occupancy import assign_sides, draw_fervour, occupancy_mask
from ..engine.crowd.physique import measure
from ..engine.crowd.regions import find_regions
from ..engine.crowd.seating import SeatPlan
from ..engine.crowd.spec import CrowdSpec
from ..engine.overrides import OverrideSet
from ..engine.streams.baked import BakedPoses
from ..engine.streams.event_feed import ClipEventFeed
from ..engine.streams.ladder import BlendLadder
from ..engine.streams.mask_table import MaskTable
from ..engine.streams.offsets import OffsetSource, initial_offsets
from ..engine.streams.overlaying import MAX_LAYERS, OverlayStage
from ..engine.streams.pool import StreamPool
from ..engine.streams.slots import SlotPool
from ..engine.streams.stream_needs import StreamNeeds
from ..engine.streams.uniques import UniquePool
from .behaviour import columns_of
from .casting import cast_crowd
from .crowd import Crowd
from .gestures import Gestures
from .setting_out import Steps, prepare_walking, seats_of_stewards, start_walking

STREAMS_FOR_BODIES = 128
"""With fewer streams, variety of motion is worth more than bones of one's own."""
MOST_CHILDREN = 0.5
"""Share of children up to which each comes with an adult."""
MIXES = {"football": FOOTBALL, "general": GENERAL_PUBLIC}
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
    seeds = np.random.SeedSequence(spec.seed).spawn(10)
    rngs = map(np.random.default_rng, seeds)
    rng_seats, rng_sides, rng_looks, rng_motion, rng_place, *rngs_of_people = rngs
    rng_bodies, rng_deeds, rng_company, rng_casting, rng_walks = rngs_of_people
    clips = character.clips or (rest_clip(character.skeleton),)
    figure = make_figure(character)
    behaviour_table = load_table(spec.behaviour)
    bodies = spec.children + spec.old > 0 and spec.streams >= STREAMS_FOR_BODIES
    cast = choose_cast(
        clips,
        wanted_clips(behaviour_table, [clip.name for clip in clips]),
        streams=spec.streams,
        history=spec.history,
        types=len(make_body_types(character.skeleton, figure)) if bodies else 0,
        baked=spec.poses != "streams",
    )
    steps = prepare_walking(spec, clips, figure, cast)
    library = cast.library if steps is None else steps.library
    occupied, stewards = seats_of_stewards(spec, plan, occupancy_mask(plan, spec, rng_seats))
    side = assign_sides(plan, spec, rng_sides)
    count = plan.count
    in_families = spec.children <= MOST_CHILDREN
    mix = replace(MIXES[spec.parties], children=spec.children if in_families else 0.0)
    party = form_parties(plan, occupied, mix, rng_company)
    body, size = draw_bodies(
        *(count, spec.children, spec.old, figure.height, rng_bodies),
        women=spec.women,
        is_child=party.is_child if in_families else None,
    )
    body.choice = draw_choices(character, body, rng_bodies)
    team = Team(side, draw_fervour(side, spec, rng_deeds))
    emotion = draw_emotion(team.fervour, spec.embarrassment, rng_deeds)
    table = compile_table(behaviour_table, library)
    behaviour = Behaviour.allocate(len(table.starts), count)
    company = Company(plan, occupied.copy(), team, emotion, party, rng_company)
    behaviour.signals.update(company.signals)
    columns = columns_of(behaviour, emotion, team)
    settle(table, behaviour, columns, rng_deeds)
    settle(table, behaviour, columns, rng_deeds, company.following.begin(behaviour))
    guidance = Guidance(count, len(table.names), rng_deeds)
    calm = library.draw(Role.CALM, count, rng_motion)
    shown = motions_to_show(table, behaviour, guidance, np.arange(count), calm)
    crowd = Crowd(
        entity=0,
        spec=spec,
        plan=plan,
        character=character,
        seat=Seat(plan.row, plan.column, plan.section, occupied),
        placement=_place(plan, figure, size, rng_place),
        body=body,
        team=team,
        appearance=draw_appearance(side, rng_looks, kind=body.kind),
        motion=MotionState.allocate(shown),
        emotion=emotion,
        behaviour=behaviour,
        table=table,
        guidance=guidance,
        regions=find_regions(character, figure, tint=spec.tint),
        detail=Detail(),
        library=library,
        events=EventQueue(),
        company=company,
        overrides=OverrideSet(character.skeleton, count),
        world=str(esper.current_world),
    )
    crowd.entity = esper.create_entity(
        crowd.seat,
        crowd.placement,
        crowd.body,
        crowd.team,
        crowd.appearance,
        crowd.motion,
        crowd.detail,
        crowd.library,
        crowd.events,
        crowd.overrides,
        emotion,
        behaviour,
        table,
        guidance,
        company,
        Answers(count),
        party,
        crowd.observers,
        crowd.facing,
        figure,
        crowd.regions,
        character,
    )
    bank = ClipBank(character.skeleton, cast.clips if steps is None else steps.clips)
    if spec.poses == "baked":
        _add_baked(crowd, bank, figure, rng_motion)
    elif spec.poses == "streams":
        _add_streams(crowd, bank, figure, cast, steps, offsets or spec.offsets, rng_motion)
    else:
        beats = ClapMotion(steps.clips if steps else cast.clips, count)
        esper.add_component(crowd.entity, beats)
    if spec.casting and spec.poses != "none":
        # Offsets that the user gave stay with whom they were given to.
        own = callable(offsets or spec.offsets)
        cast_crowd(crowd, rng_casting, motions=not own)
    types = crowd.pool.twins.types if crowd.pool is not None and len(crowd.pool.twins) else ()
    adult = SPECTATOR_HEIGHT / figure.height
    crowd.physique = measure(character.skeleton, figure, types, bank, library, adult)
    esper.add_component(crowd.entity, crowd.physique)
    if steps is not None:
        start_walking(crowd, steps, stewards, rng_walks)
    for name, start, stop in plan.sections:
        esper.create_entity(Section(name, crowd.entity, start, stop))
    return crowd


def _place(
    plan: SeatPlan, figure: Figure, size: NDArray[np.float32], rng: np.random.Generator
) -> Placement:
    count = plan.count
    turn = rng.normal(0.0, 0.12, count).clip(-0.35, 0.35)
    return Placement(
        position=plan.position.copy(),
        yaw=(plan.yaw + turn).astype(np.float32),
        scale=(size * SPECTATOR_HEIGHT / figure.height).astype(np.float32),
    )


def _add_streams(
    crowd: Crowd,
    bank: ClipBank,
    figure: Figure,
    cast: Cast,
    steps: Steps | None,
    offsets: OffsetSource,
    rng: np.random.Generator,
) -> None:
    spec = crowd.spec
    gaits = 0 if steps is None else len(steps.gaits) * (1 + cast.types)
    pool = StreamPool(
        crowd.character.skeleton,
        bank,
        capacity=spec.streams + spec.spare_streams + gaits,
        history=spec.history,
        markers=figure.joints,
        uniques=spec.uniques,
        slots=spec.slots,
        bodies=make_body_types(crowd.character.skeleton, figure),
    )
    started = start_cast(pool, cast, spec.streams, spec.history, rng)
    streams, ways = started.streams, started.ways
    if steps is not None:
        streams, ways = steps.start(pool, streams, ways)
    parts: list[Any] = [pool, started.once]
    if ways is not None:
        parts.append(ways)
    if spec.rest_idle:
        parts.append(StreamNeeds(len(started.kept), always=started.kept))
    # The crowd is found in the middle of things, so the streams have a past: poses at the ticks
    # before the first one.
    for tick in range(1 - spec.history, 1):
        pool.evaluate(tick)
        pool.commit(tick)
    count = len(crowd)
    parts_of_body = 1 + MAX_LAYERS
    anim = AgentAnimID.allocate(parts_of_body, count, pool.store.bind_row)
    anim.row[0] = streams.draw_rows(crowd.motion.shown, crowd.body.kind, rng)
    anim.start[0] = anim.target[0] = initial_offsets(offsets, count, spec.history, rng)
    crowd.pool, crowd.anim, crowd.transition = pool, anim, Transition.allocate(parts_of_body, count)
    uniques, slots = UniquePool(pool), SlotPool(pool.store)
    crowd.ladder = BlendLadder(
        pool, uniques, slots, anim, crowd.transition, crowd.placement, crowd.body.kind
    )
    overlays, masks = Overlays.allocate(MAX_LAYERS, count), MaskTable(pool.skeleton)
    for name, mask in figure_masks(pool.skeleton, figure).items():
        masks.add(name, mask)
    crowd.overlays = OverlayStage(crowd.ladder, overlays, masks)
    crowd.clip_feed = ClipEventFeed(pool.clip_events, crowd.seat.occupied)
    parts += [streams, uniques, slots, anim, crowd.transition, crowd.ladder]
    parts += [overlays, crowd.overlays]
    parts += [
        crowd.dilation,
        crowd.clip_feed,
        ClapMotion(steps.clips if steps else cast.clips, count),
        Gestures(crowd.table, count),
    ]
    assert crowd.company is not None
    hugs = Hugs(crowd.plan, crowd.company.party, crowd.body, crowd.placement, crowd.facing, rng)
    crowd.behaviour.signals.update(hugs.signals)
    parts.append(hugs)
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
