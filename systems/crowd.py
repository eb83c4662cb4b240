"""A crowd as its users hold it: one entity, with its columns and the few calls that act on it."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
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
from ..engine.streams.asking import ask_dilation, ask_streamed, ask_unique
from ..engine.streams.baked import BakedPoses
from ..engine.streams.blend_counts import LadderCounts
from ..engine.streams.blending import agent_palettes
from ..engine.streams.event_feed import ClipEventFeed, Listener
from ..engine.streams.ladder import BlendLadder, Focus
from ..engine.streams.overlaying import OverlayStage
from ..engine.streams.pool import POSE_RATE, Stream, StreamPool
from ..engine.streams.uniques import Unique, UniquePool
from .coming import Coming
from .crowd_drawing import DrawingCalls
from .crowd_overlays import BLEND_SECONDS, OverlayCalls, unstreamed
from .crowd_queries import QueryCalls
from .guiding import Guiding
from .observing import Observers
from .watching import WatchingCalls

if TYPE_CHECKING:
    from .part import Part
    from .render_embedded import CrowdMirrors

FOCUS_RADIUS = 60.0
"""Metres around a focus in which agents never jump."""


@dataclass(slots=True, eq=False)
class Crowd(OverlayCalls, QueryCalls, DrawingCalls, Guiding, Coming, WatchingCalls):
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
            0 for the body; ``1 + k`` for the motion of overlay layer k, see `overlay`.
        duration
            Seconds of the blend, for all or for each; 0 jumps.
        offset
            Poses behind the stream's head, for all or for each; None draws one for each agent.

        Raises
        ------
        ValueError
            For a baked crowd, agents that don't exist, a stale stream, or values out of range.
        """
        ask_streamed(self._ladder(), agents, stream, part, duration, offset)

    def transition_to_unique(
        self,
        agents: int | ArrayLike,
        unique: Unique,
        part: int = 0,
        *,
        duration: float | ArrayLike = BLEND_SECONDS,
    ) -> None:
        """Ask agents to blend to a unique; as `transition_to_streamed`, without an offset."""
        ask_unique(self._ladder(), agents, unique, part, duration)

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

    def _ladder(self) -> BlendLadder:
        if self.ladder is None:
            raise ValueError(
                f"this crowd {unstreamed(self.spec)} and can't blend; use poses='streams'"
            )
        return self.ladder

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

    def dilate(
        self, agents: NDArray[np.int64], targets: NDArray[np.float32], seconds: float
    ) -> None:
        """Let agents play closer to their stream's head or farther behind, from the next pose tick.

        They get there a little faster or slower than their motion, so nothing jumps. Where
        `seconds` is too short to be unseen it takes longer, which `dilation.lengthened` counts.

        Parameters
        ----------
        agents, targets
            (K,) ids, and offsets in poses that their streams' histories have room for.
        seconds
            How long it may take.

        Raises
        ------
        ValueError
            For a baked crowd, unknown agents, targets that no stream has room for, or a time
            outside 0 to 86,400 s.
        """
        ask_dilation(self.dilation, self._streams(), len(self), agents, targets, seconds)

    def set_history(self, history: int, seconds: float = 3.0) -> None:
        """Let all streams keep more or fewer poses; agents spread over them as they were spread.

        Parameters
        ----------
        history
            M, 2 to the ring's capacity less 2.
        seconds
            How long agents may take to get where they shall be; it takes longer where that would
            be seen.

        Raises
        ------
        ValueError
            For a baked crowd, a history that the ring has no room for, or a wrong time.
        """
        pool = self._streams()
        assert self.anim is not None
        row = self.anim.row[0]
        agents = np.flatnonzero(row < pool.store.stream_rows)
        before = np.maximum(pool.history_goal[row[agents]] - 2, 1)
        for stream in np.flatnonzero(pool.alive):
            pool.set_history(pool.stream(int(stream)), history)
        share = np.float32(history - 2) / before.astype(np.float32)
        targets = np.minimum(self.anim.target[0, agents] * share, np.float32(history - 2))
        self.dilate(agents, targets, seconds)

    def on_clip_event(self, name: str, listener: Listener) -> Callable[[], None]:
        """Call `listener(agents, weights)` whenever agents play past the event.

        The arrays are as for `clip_events`.

        Returns
        -------
        Callable
            Ends the subscription.

        Raises
        ------
        ValueError
            For a baked crowd, or a name that no clip has.
        """
        self._streams()
        assert self.clip_feed is not None
        return self.clip_feed.on(name, listener)

    def clip_events(self, name: str) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Agents (K,) that played past the event in the current pose tick, and weights (K,).

        Errors as for `on_clip_event`.
        """
        self._streams()
        assert self.clip_feed is not None
        return self.clip_feed.passed(name)

    def _streams(self) -> StreamPool:
        if self.pool is None:
            kept = self.spec.poses
            raise ValueError(f"this crowd's poses are {kept}; streams have offsets and clip events")
        return self.pool

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
