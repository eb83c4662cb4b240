"""Draws the stadium and its crowds: all GL work of a frame happens here."""

from __future__ import annotations

import esper

from ..components import (
    AgentAnimID,
    Appearance,
    BakedAnim,
    Body,
    Detail,
    Placement,
    Transition,
    View,
)
from ..engine.assets.character import Character
from ..engine.clock import Clock
from ..engine.crowd.figure import Figure
from ..engine.crowd.physique import Physique
from ..engine.crowd.stadium_mesh import StadiumMesh
from ..engine.gl.state import takes_srgb_bytes, write_srgb
from ..engine.overrides import OverrideSet
from ..engine.render.crowd_inputs import CrowdColumns
from ..engine.render.crowd_renderer import CrowdRenderer, DrawCounts
from ..engine.render.frame import Frame
from ..engine.render.stadium_pass import StadiumPass
from ..engine.streams.baked import BakedPoses
from ..engine.streams.overlaying import OverlayStage
from ..engine.streams.pool import StreamPool
from .query import crowds


class RenderSystem(esper.Processor):
    """Draws every stadium and crowd of the world into the bound framebuffer.

    Needs a current GL context, one entity with a `View`, and a framebuffer with depth whose size
    is `size`.

    Attributes
    ----------
    size
        Pixels (width, height) of the framebuffer.
    counts
        Triangles drawn and bytes copied for the last picture.
    """

    def __init__(self, size: tuple[int, int]) -> None:
        self.size = size
        self.counts = DrawCounts()
        self._crowds: dict[int, CrowdRenderer] = {}
        self._stadiums: dict[int, StadiumPass] = {}

    def process(self, clock: Clock) -> None:
        """One frame."""
        views = crowds(View)
        if not views:
            return
        view = views[0][1][0]
        encode = takes_srgb_bytes()
        self.draw(
            Frame(
                view.view, view.projection, self.size, clock.pose_tick, clock.alpha, encode=encode
            )
        )

    def draw(self, frame: Frame, only: int | None = None) -> None:
        """Draw one picture: everything, or `only` the crowd that is this entity."""
        self.counts = DrawCounts()
        write_srgb(not frame.encode)
        for entity, (character, detail) in crowds(Character, Detail):
            if only not in (None, entity):
                continue
            renderer = self._crowds.get(entity)
            if renderer is None:
                renderer = self._crowds[entity] = _renderer(entity, character, detail)
            renderer.update(frame.tick)
            renderer.draw(frame)
            self.counts.triangles += renderer.counts.triangles
            self.counts.uploaded += renderer.counts.uploaded
        if only is not None:
            return
        for entity, (mesh,) in crowds(StadiumMesh):
            if entity not in self._stadiums:
                self._stadiums[entity] = StadiumPass(mesh)
            self._stadiums[entity].draw(frame)

    def delete(self) -> None:
        """Delete everything on the GPU."""
        for renderer in self._crowds.values():
            renderer.delete()
        for stadium in self._stadiums.values():
            stadium.delete()
        self._crowds.clear()
        self._stadiums.clear()


def _renderer(entity: int, character: Character, detail: Detail) -> CrowdRenderer:
    poses: tuple[StreamPool, AgentAnimID, Transition] | tuple[BakedPoses, BakedAnim]
    if esper.has_component(entity, StreamPool):
        poses = (
            esper.component_for_entity(entity, StreamPool),
            esper.component_for_entity(entity, AgentAnimID),
            esper.component_for_entity(entity, Transition),
        )
    else:
        poses = (
            esper.component_for_entity(entity, BakedPoses),
            esper.component_for_entity(entity, BakedAnim),
        )
    columns = CrowdColumns(
        esper.component_for_entity(entity, Placement),
        esper.component_for_entity(entity, Appearance),
        detail,
        poses,
        esper.try_component(entity, OverlayStage),
        esper.try_component(entity, OverrideSet),
        esper.try_component(entity, Body),
        esper.try_component(entity, Physique),
    )
    return CrowdRenderer(character, esper.component_for_entity(entity, Figure).height, columns)
