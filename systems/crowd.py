"""A crowd as its users hold it: one entity, with its columns and the few calls that act on it."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..components import (
    AgentAnimID,
    Appearance,
    BakedAnim,
    Behaviour,
    Body,
    Detail,
    Dilation,
    Emotion,
    MotionState,
    Party,
    Placement,
    Seat,
    Team,
    Transition,
)
from ..engine.assets.character import Character
from ..engine.behaviour.company import Company
from ..engine.behaviour.compiled import CompiledTable
from ..engine.behaviour.events import Event, EventQueue
from ..engine.behaviour.facing import Facing
from ..engine.behaviour.guidance import Guidance
from ..engine.behaviour.walkers import Walkers
from ..engine.crowd.agents import agent_ids
from ..engine.crowd.looks import choose
from ..engine.crowd.motions import MotionLibrary
from ..engine.crowd.physique import Physique
from ..engine.crowd.regions import Regions
from ..engine.crowd.seating import SeatPlan
from ..engine.crowd.spec import CrowdSpec
from ..engine.overrides import JointOverride, OverrideSet
from ..engine.streams.baked import BakedPoses
from ..engine.streams.blending import agent_palettes
from ..engine.streams.event_feed import ClipEventFeed
from ..engine.streams.ladder import BlendLadder
from ..engine.streams.overlaying import OverlayStage
from ..engine.streams.pool import POSE_RATE, StreamPool
from .coming import Coming
from .crowd_blends import BlendCalls
from .crowd_drawing import DrawingCalls
from .crowd_overlays import OverlayCalls
from .crowd_queries import QueryCalls
from .crowd_time import TimeCalls
from .guiding import Guiding
from .observing import Observers
from .watching import WatchingCalls

if TYPE_CHECKING:
    from .part import Part
    from .render_embedded import CrowdMirrors


@dataclass(slots=True, eq=False)
class Crowd(
    BlendCalls, TimeCalls, OverlayCalls, QueryCalls, DrawingCalls, Guiding, Coming, WatchingCalls
):
    """One crowd: an entity, and its components at hand.

    Attributes
    ----------
    entity
        The entity that has the components.
    spec, plan, character
        What it was made from.
    seat, placement, body, team, appearance, motion, detail, library, events, overrides
        The components that every crowd has.
    emotion, behaviour, table, guidance
        Feelings, states, the behaviour table as it is used, and orders.
    company
        Parties, applause, waves, and moods that pass from neighbour to neighbour.
    regions
        Parts of the character, and where the patterns of its shirt lie.
    pool, anim, transition, ladder
        Streams, blends and requests for them; None in a baked crowd.
    overlays
        Motions laid over some joints, and the masks; None in a baked crowd.
    dilation
        Changes of offsets that wait or were made.
    clip_feed
        Clip events; None in a baked crowd.
    physique
        Proportions of the character, its body types and the seats.
    walkers
        People on their way; None in a crowd in which nobody walks.
    world
        Name of the esper world that the entity lives in.
    mirrors
        Holds what `draw` keeps on the GPU, once it was called.
    baked
        Baked poses and who shows which; None in a streamed crowd.
    parts
        What hangs on the agents, by name.
    observers
        Recorders that see every pose tick; `watch` and `watch_clips` add some.
    facing
        Who is turned to something; `face` turns people.
    """

    entity: int
    spec: CrowdSpec
    plan: SeatPlan
    character: Character
    seat: Seat
    placement: Placement
    body: Body
    team: Team
    appearance: Appearance
    motion: MotionState
    detail: Detail
    library: MotionLibrary
    events: EventQueue
    overrides: OverrideSet
    company: Company
    emotion: Emotion
    behaviour: Behaviour
    table: CompiledTable
    guidance: Guidance
    regions: Regions
    pool: StreamPool | None = None
    anim: AgentAnimID | None = None
    transition: Transition | None = None
    ladder: BlendLadder | None = None
    overlays: OverlayStage | None = None
    dilation: Dilation = field(default_factory=Dilation)
    clip_feed: ClipEventFeed | None = None
    baked: tuple[BakedPoses, BakedAnim] | None = None
    physique: Physique | None = None
    walkers: Walkers | None = None
    parts: dict[str, Part] = field(default_factory=dict)
    world: str = "default"
    mirrors: list[CrowdMirrors] = field(default_factory=list)
    observers: Observers = field(default_factory=Observers)
    facing: Facing = field(init=False)

    def __post_init__(self) -> None:
        """Nobody is turned yet."""
        self.facing = Facing(self.placement)

    def __len__(self) -> int:
        """Number of agents, absent ones included."""
        return len(self.seat.row)

    def send(self, event: Event) -> None:
        """Let the crowd see an event at the next tick."""
        self.events.send(event)

    def dress(self, agents: int | ArrayLike, **choices: str | None) -> None:
        """Give agents other bodies, hair, or what else the character has variants of.

        Parameters
        ----------
        agents
            Ids.
        **choices
            By group: ``crowd.dress(7, hair="bun", beard=None)``; None is none of it. What there is
            to choose from is in ``tifo.variant_groups(crowd.character)``.

        Raises
        ------
        ValueError
            For ids out of range, or a group or choice that the character has not.
        """
        choose(self.character, self.body, agent_ids(agents, len(self)), choices)

    @property
    def party(self) -> Party:
        """Who came with whom."""
        return self.company.party

    def start_wave(self, agents: int | ArrayLike) -> NDArray[np.int64]:
        """Let agents get up for a Mexican wave, at the next pose tick.

        Whether it runs is up to the others: some thirty people side by side, over a few rows, start
        one as often as not, and twice as many nearly always.

        Parameters
        ----------
        agents
            An id, ids, or a (N,) boolean mask.

        Returns
        -------
        (K,) int64 ids of those who get up: they are there and not up already
        """
        return self.company.start_wave(agents)

    def palettes(
        self, agents: NDArray[np.int64], tick: int, alpha: float = 1.0
    ) -> NDArray[np.float32]:
        """What agents show as meshes, evaluated on the CPU.

        Parameters
        ----------
        agents
            (K,) ids.
        tick, alpha
            Pose tick and the fraction of it that has passed.

        Returns
        -------
        (K, J, 3, 4) float32 palettes in the character's model space

        Raises
        ------
        ValueError
            If an override has no Python form, or the crowd has no poses.
        """
        if self.pool is not None and self.anim is not None and self.transition is not None:
            shown = agent_palettes(self.pool, self.anim, self.transition, 0, agents, tick, alpha)
            assert self.overlays is not None
            shown = self.overlays.lay(shown, agents, tick, alpha)
        else:
            if self.baked is None:
                raise ValueError("this crowd has no poses to show; use poses='streams' or 'baked'")
            poses, clips = self.baked
            seconds = (tick - 1 + alpha - clips.began[agents]) / POSE_RATE
            clip, speed = clips.clip[agents].astype(np.int64), clips.speed[agents]
            shown = poses.palettes[poses.frame_rows(clip, speed, seconds)]
        self.overrides.apply(shown, agents, self.placement)
        return shown

    def add_override(self, override: JointOverride) -> None:
        """Pose joints by code of your own, from the next picture on; see docs/overrides.md.

        Raises
        ------
        ValueError
            For a name that another override has, or a joint that the character doesn't have.
        """
        self.overrides.add(override)

    def remove_override(self, name: str) -> None:
        """Take an override away; ValueError if there is none of that name."""
        self.overrides.remove(name)

    def override_values(self, name: str, agents: int | ArrayLike, values: ArrayLike) -> None:
        """Set the four numbers that agents have for an override.

        Parameters
        ----------
        name
            Of the override.
        agents
            An id, ids, or a (N,) boolean mask.
        values
            (4,) numbers for all of them, or (K, 4).
        """
        self.overrides.set_values(name, agent_ids(agents, len(self)), values)

    def state_hash(self) -> str:
        """Digest of everything that the simulation decided; equal for equal seeds and inputs."""
        digest = hashlib.blake2b(digest_size=16)
        components: list[Any] = [self.motion, self.seat, self.team, self.placement, self.body]
        components += [self.emotion, self.behaviour, self.party]
        clips = self.baked[1] if self.baked else None
        overlays = self.overlays.columns if self.overlays else None
        columns = (self.anim, self.transition, overlays, clips)
        components += [column for column in columns if column is not None]
        for _, part in sorted(self.parts.items()):
            components += part.columns()
        for component in components:
            for column in fields(component):
                value = getattr(component, column.name)
                if isinstance(value, np.ndarray):
                    digest.update(np.ascontiguousarray(value).tobytes())
        for array in self.company.columns():
            digest.update(np.ascontiguousarray(array).tobytes())
        return digest.hexdigest()
