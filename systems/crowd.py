"""A crowd as its users hold it: one entity, with its columns and the few calls that act on it."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, fields
from typing import Any

import esper
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..components import (
    AgentAnimID,
    Appearance,
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
from ..engine.behaviour.events import Event, EventQueue
from ..engine.crowd.agents import agent_ids, agent_values
from ..engine.crowd.colours import draw_appearance
from ..engine.crowd.figure import Figure, make_figure
from ..engine.crowd.motions import MotionLibrary, sort_motions, start_streams
from ..engine.crowd.occupancy import assign_sides, occupancy_mask
from ..engine.crowd.seating import SeatPlan
from ..engine.crowd.spec import CrowdSpec
from ..engine.streams.baked import BakedPoses
from ..engine.streams.blend_counts import LadderCounts
from ..engine.streams.blending import agent_palettes
from ..engine.streams.ladder import BlendLadder, Focus
from ..engine.streams.offsets import OffsetSource, initial_offsets
from ..engine.streams.pool import POSE_RATE, Stream, StreamPool
from ..engine.streams.slots import SlotPool
from ..engine.streams.uniques import Unique, UniquePool

SPECTATOR_HEIGHT = 1.75
"""Metres that a character is scaled to, before agents differ."""
BLEND_SECONDS = 0.4
"""Length of a blend that nobody chose."""
FOCUS_RADIUS = 60.0
"""Metres around a focus in which agents never jump."""


@dataclass(slots=True, eq=False)
class Crowd:
    """One crowd: an entity, and its components at hand.

    Attributes
    ----------
    entity
        The entity that has the components.
    spec, plan, character
        What it was made from.
    seat, placement, team, appearance, motion, detail, library, events
        The components that every crowd has.
    pool, anim, transition, ladder
        Streams, blends and requests for them; None in a baked crowd.
    baked
        Baked poses and who shows which; None in a streamed crowd.
    """

    entity: int
    spec: CrowdSpec
    plan: SeatPlan
    character: Character
    seat: Seat
    placement: Placement
    team: Team
    appearance: Appearance
    motion: MotionState
    detail: Detail
    library: MotionLibrary
    events: EventQueue
    pool: StreamPool | None = None
    anim: AgentAnimID | None = None
    transition: Transition | None = None
    ladder: BlendLadder | None = None
    baked: tuple[BakedPoses, BakedAnim] | None = None

    def __len__(self) -> int:
        """Number of agents, absent ones included."""
        return len(self.seat.row)

    def send(self, event: Event) -> None:
        """Let the crowd see an event at the next tick."""
        self.events.send(event)

    @property
    def uniques(self) -> UniquePool:
        """Motions that are not shared; ValueError in a baked crowd."""
        return self._ladder().uniques

    @property
    def blend_counts(self) -> LadderCounts:
        """How many changes of motion took which rung of the blend ladder."""
        return self._ladder().counts

    def transition_to_streamed(
        self,
        agents: int | ArrayLike,
        stream: Stream,
        part: int = 0,
        *,
        duration: float | ArrayLike = BLEND_SECONDS,
        offset: float | ArrayLike | None = None,
    ) -> None:
        """Ask agents to blend to a stream; it begins at the next pose tick.

        Never fails for want of room, and the last request of an agent is the one it ends on; see
        `tifo.engine.streams.ladder`.

        Parameters
        ----------
        agents
            An id, ids, or a (N,) boolean mask.
        stream
            One of `pool`.
        part
            Which part of the agents.
        duration
            Seconds of the blend, for all or for each; 0 jumps.
        offset
            Poses behind the stream's head, for all or for each; None draws one for each agent.

        Raises
        ------
        ValueError
            For a baked crowd, agents that don't exist, a stale stream, or values out of range.
        """
        ladder = self._ladder()
        row = ladder.pool.row(stream)
        longest = float(ladder.pool.history[row] - 2)
        self._ask(agents, row, part, duration, np.nan if offset is None else offset, longest)

    def transition_to_unique(
        self,
        agents: int | ArrayLike,
        unique: Unique,
        part: int = 0,
        *,
        duration: float | ArrayLike = BLEND_SECONDS,
    ) -> None:
        """Ask agents to blend to a unique; as `transition_to_streamed`, without an offset."""
        self._ask(agents, self._ladder().uniques.row(unique), part, duration, 0.0, 0.0)

    def set_focus(
        self, place: tuple[float, float, float] | None, *, radius: float = FOCUS_RADIUS
    ) -> None:
        """Say where people look, so that only agents farther away may ever jump.

        Parameters
        ----------
        place
            Metres in the stadium's frame; None, as at first, lets nobody jump.
        radius
            Metres around it.
        """
        if place is None:
            self._ladder().focus = None
            return
        if not np.isfinite(place).all() or np.shape(place) != (3,):
            raise ValueError(f"place is {place}, expected three finite numbers")
        if not radius >= 0:
            raise ValueError(f"radius is {radius}, expected metres >= 0")
        self._ladder().focus = Focus(place, radius)

    def _ask(
        self,
        agents: int | ArrayLike,
        row: int,
        part: int,
        duration: float | ArrayLike,
        offset: float | ArrayLike,
        longest: float,
    ) -> None:
        ladder = self._ladder()
        parts = len(ladder.anim.row)
        if not 0 <= part < parts:
            raise ValueError(f"part is {part}, expected 0 to {parts - 1}")
        ids = agent_ids(agents, len(self))
        seconds = agent_values("duration", duration, len(ids), 0.0, np.inf)
        poses = agent_values("offset", offset, len(ids), 0.0, longest, drawn=True)
        ladder.ask(part, ids, row, poses, seconds * np.float32(POSE_RATE))

    def _ladder(self) -> BlendLadder:
        if self.ladder is None:
            raise ValueError("this crowd is baked and can't blend; use poses='streams'")
        return self.ladder

    def palettes(
        self, agents: NDArray[np.int64], tick: int, alpha: float = 1.0
    ) -> NDArray[np.float32]:
        """What agents show, evaluated on the CPU.

        Parameters
        ----------
        agents
            (K,) ids.
        tick, alpha
            Pose tick and the fraction of it that has passed.

        Returns
        -------
        (K, J, 3, 4) float32 palettes in the character's model space
        """
        if self.pool is not None and self.anim is not None and self.transition is not None:
            return agent_palettes(self.pool, self.anim, self.transition, 0, agents, tick, alpha)
        assert self.baked is not None
        poses, clips = self.baked
        seconds = (tick - 1 + alpha - clips.began[agents]) / POSE_RATE
        rows = poses.frame_rows(clips.clip[agents].astype(np.int64), clips.speed[agents], seconds)
        return poses.palettes[rows]

    def state_hash(self) -> str:
        """Digest of everything that the simulation decided; equal for equal seeds and inputs."""
        digest = hashlib.blake2b(digest_size=16)
        components: list[Any] = [self.motion, self.seat, self.team, self.placement]
        clips = self.baked[1] if self.baked else None
        components += [part for part in (self.anim, self.transition, clips) if part is not None]
        for component in components:
            for column in fields(component):
                value = getattr(component, column.name)
                if isinstance(value, np.ndarray):
                    digest.update(np.ascontiguousarray(value).tobytes())
        return digest.hexdigest()


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
    library = sort_motions(clips)
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
    bank = ClipBank(character.skeleton, clips)
    if spec.poses == "baked":
        _add_baked(crowd, bank, figure, rng_motion)
    else:
        _add_streams(crowd, bank, figure, offsets or spec.offsets, rng_motion)
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
    crowd: Crowd, bank: ClipBank, figure: Figure, offsets: OffsetSource, rng: np.random.Generator
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
    streams = start_streams(pool, crowd.library, spec.streams, rng)
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
    for component in (pool, streams, uniques, slots, anim, crowd.transition, crowd.ladder):
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
