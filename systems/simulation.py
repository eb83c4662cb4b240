"""A stadium that runs by itself, with or without a picture."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from uuid import uuid4

import esper
import numpy as np
from numpy.typing import NDArray

from ..components import View
from ..engine.assets.character import Character
from ..engine.assets.load import add_motions, load_character
from ..engine.assets.simplify import with_lower_levels
from ..engine.assets.spectator import builtin_spectator
from ..engine.behaviour.events import Event
from ..engine.clock import Clock
from ..engine.crowd.seating import SeatPlan
from ..engine.crowd.spec import CrowdSpec
from ..engine.crowd.stadium import build_seats, build_stadium_mesh
from ..engine.crowd.stadium_mesh import StadiumMesh
from ..engine.streams.offsets import OffsetSource
from .crowd import Crowd
from .detail import DetailSystem
from .schedule import Schedule, tick_systems
from .spawn import spawn_crowd


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

    def look(self, view: NDArray[np.float32], projection: NDArray[np.float32], height: int) -> None:
        """Set the camera that culling and drawing use; see `tifo.components.View`."""
        with self.active():
            for entity, _ in esper.get_component(View):
                esper.delete_entity(entity, immediate=True)
            esper.create_entity(View(view, projection, height))

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

    A spec that names BVH motions and no character gets the figure of bones of the first of them.
    A file without coarser meshes gets some.

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
    if not file and motions and motions[0].lower().endswith(".bvh"):
        file, motions = motions[0], motions[1:]
    character = with_lower_levels(load_character(file, scale)) if file else builtin_spectator()
    return add_motions(character, motions, scale) if motions else character
