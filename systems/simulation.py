"""A stadium that runs by itself, with or without a picture."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from uuid import uuid4

import esper
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..components import Appearance, View
from ..engine.animation.clip import Clip
from ..engine.assets.character import Character
from ..engine.assets.load import add_motions, load_character
from ..engine.assets.props import fits
from ..engine.assets.retarget import NotHumanoidError, loop_clip
from ..engine.assets.simplify import with_lower_levels
from ..engine.assets.spectator import builtin_spectator
from ..engine.behaviour.events import Event
from ..engine.clock import Clock
from ..engine.crowd.seating import SeatPlan
from ..engine.crowd.spec import CrowdSpec
from ..engine.crowd.stadium import build_seats, build_stadium_mesh
from ..engine.crowd.stadium_mesh import StadiumMesh
from ..engine.export import Recording
from ..engine.export.targets import Progress
from ..engine.streams.offsets import OffsetSource
from .crowd import Crowd
from .detail import DetailSystem
from .part import Part
from .parts import PartMotion, add_part, remove_part
from .props import give_props
from .recording import Agents, record
from .schedule import Schedule, tick_systems
from .spawn import spawn_crowd

SHORTEST_LOOP = 1.0
"""Seconds of the shortest motion from a file that is closed to a loop."""


class Simulation:
    """One stadium with one crowd, in an esper world of its own.

    Parameters
    ----------
    spec
        What to build; a bowl of 65,000 if None.
    character
        Body and clips; what `spec` names, or the built-in spectator, if None.
    offsets
        First offsets of agents on their streams: a function of your own; as the spec says if None.

    Examples
    --------
    >>> simulation = Simulation(CrowdSpec(seats=500))
    >>> simulation.send(Goal(side=0))
    >>> simulation.run(seconds=2.0)
    >>> int(simulation.crowd.behaviour.reacting.sum())
    473
    """

    def __init__(
        self,
        spec: CrowdSpec | None = None,
        character: Character | None = None,
        *,
        offsets: OffsetSource | None = None,
    ) -> None:
        self.spec = CrowdSpec() if spec is None else spec
        self.world = f"tifo-{uuid4().hex}"
        self.clock = Clock()
        self.plan: SeatPlan = build_seats(self.spec)
        if character is None:
            character = character_of(self.spec)
        self.detail = DetailSystem(levels=self.spec.lod)
        self.schedule = Schedule(self.clock, tick_systems(self.spec.seed), [self.detail])
        with self.active():
            self.crowd: Crowd = spawn_crowd(self.spec, self.plan, character, offsets=offsets)
            if self.spec.props > 0 and self.spec.poses != "none" and fits(character):
                give_props(self.crowd, self.spec.props, tick=self.clock.pose_tick)
            esper.add_processor(self.schedule)

    @contextmanager
    def active(self) -> Iterator[None]:
        """Make this simulation's world esper's current one; the one before comes back after."""
        before = esper.current_world
        esper.switch_world(self.world)
        try:
            yield
        finally:
            esper.switch_world(before)

    def send(self, event: Event) -> None:
        """Let the crowd see an event at the next tick."""
        with self.active():
            self.crowd.send(event)

    def advance(self, delta: float) -> None:
        """Let `delta` seconds pass, as one frame: at most 4 ticks."""
        with self.active():
            esper.process(delta)

    def run(self, *, seconds: float) -> None:
        """Run whole ticks as fast as they go, with no frames between."""
        with self.active():
            for _ in range(round(seconds * 60)):
                self.schedule.tick()

    def record(
        self,
        agents: Agents = None,
        *,
        start: float = 0.0,
        seconds: float = 0.0,
        fps: float = 30.0,
        progress: Progress | None = None,
    ) -> Recording:
        """Let time pass and take down what agents show; see `tifo.systems.recording.record`."""
        with self.active():
            return record(
                self.crowd,
                self.clock,
                self.schedule.tick,
                agents,
                start=start,
                seconds=seconds,
                fps=fps,
                progress=progress,
            )

    def look(self, view: NDArray[np.float32], projection: NDArray[np.float32], height: int) -> None:
        """Set the camera that culling and drawing use; see `tifo.components.View`."""
        with self.active():
            for entity, _ in esper.get_component(View):
                esper.delete_entity(entity, immediate=True)
            esper.create_entity(View(view, projection, height))

    def add_part(
        self,
        name: str,
        character: Character,
        *,
        hook: str | None = None,
        transform: ArrayLike | None = None,
        motion: PartMotion = "own",
        streams: int = 8,
        history: int = 60,
        slots: int = 64,
        uniques: int = 0,
        agents: int | ArrayLike | None = None,
        appearance: Appearance | None = None,
    ) -> Part:
        """Hang something on agents: a hat, a scarf, a flag; see `tifo.add_part`."""
        with self.active():
            return add_part(
                self.crowd,
                name,
                character,
                tick=self.clock.pose_tick,
                hook=hook,
                transform=transform,
                motion=motion,
                streams=streams,
                history=history,
                slots=slots,
                uniques=uniques,
                agents=agents,
                appearance=appearance,
            )

    def remove_part(self, name: str) -> None:
        """Remove a part; ValueError if there is none of that name."""
        with self.active():
            remove_part(self.crowd, name)

    def build_mesh(self) -> None:
        """Add the stadium's own geometry to the world, for drawing, unless it is there."""
        with self.active():
            if not esper.get_component(StadiumMesh):
                esper.create_entity(build_stadium_mesh(self.plan))

    def close(self) -> None:
        """Delete the world; the simulation can't be used any more."""
        if esper.current_world == self.world:
            esper.switch_world("default")
        esper.delete_world(self.world)


def character_of(spec: CrowdSpec, scale: float | None = None) -> Character:
    """The character that a spec names, with its motions; the built-in spectator if it names none.

    Motions that are named are shown instead of the built-in spectator's own; those of a character's
    file are kept beside them. A human motion that does not loop is closed where it matches itself
    best, in place. A file without coarser meshes gets some.

    Parameters
    ----------
    spec
        Names the files.
    scale
        Metres a unit of BVH files; guessed if None.

    Raises
    ------
    AssetError
        If a file can't be used.
    """
    file, motions = spec.character, spec.motions
    if file:
        character = with_lower_levels(load_character(file, scale))
    else:
        character = builtin_spectator()
        character = replace(character, clips=()) if motions else character
    if not motions:
        return character
    own = len(character.clips)
    character = add_motions(character, motions, scale)
    added = tuple(_closed(clip, character) for clip in character.clips[own:])
    return replace(character, clips=character.clips[:own] + added)


def _closed(clip: Clip, character: Character) -> Clip:
    """The clip as a loop, if it is none and long enough, and the character is a human body."""
    if clip.looping or clip.duration < SHORTEST_LOOP:
        return clip
    try:
        return loop_clip(clip, character.skeleton)
    except NotHumanoidError:
        return clip
