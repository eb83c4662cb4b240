"""Draws the stadium, its crowds and their parts: all GL work of a frame happens here."""

from __future__ import annotations

import esper

from ..components import (
    AgentAnimID,
    Appearance,
    Attachment,
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
from ..engine.crowd.regions import Regions
from ..engine.crowd.stadium_mesh import StadiumMesh
from ..engine.gl.state import takes_srgb_bytes, write_srgb
from ..engine.overrides import OverrideSet
from ..engine.render.crowd_inputs import CrowdColumns
from ..engine.render.crowd_renderer import CrowdRenderer, DrawCounts
from ..engine.render.frame import Frame
from ..engine.render.part_renderer import PartRenderer
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
        self._parts: dict[int, PartRenderer] = {}
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
            if esper.has_component(entity, Attachment) or only not in (None, entity):
                continue
            renderer = self._crowds.get(entity)
            if renderer is None:
                renderer = self._crowds[entity] = _renderer(entity, character, detail)
            self._draw(renderer, frame)
        self._draw_parts(frame, only)
        if only is not None:
            return
        for entity, (mesh,) in crowds(StadiumMesh):
            if entity not in self._stadiums:
                self._stadiums[entity] = StadiumPass(mesh)
            self._stadiums[entity].draw(frame)

    def delete(self) -> None:
        """Delete everything on the GPU."""
        for part in self._parts.values():
            part.delete()
        for renderer in self._crowds.values():
            renderer.delete()
        for stadium in self._stadiums.values():
            stadium.delete()
        self._parts.clear()
        self._crowds.clear()
        self._stadiums.clear()

    def _draw_parts(self, frame: Frame, only: int | None) -> None:
        """After the crowds, whose tables they share; all parts, or those of `only` one crowd."""
        found = crowds(Attachment, Character, Detail)
        there = {entity for entity, (part, _, _) in found if part.parent in self._crowds}
        for gone in self._parts.keys() - there:
            self._parts.pop(gone).delete()
        for entity, (attachment, character, detail) in found:
            if entity not in there or only not in (None, attachment.parent):
                continue
            if entity not in self._parts:
                self._parts[entity] = PartRenderer(
                    attachment,
                    character,
                    detail,
                    self._crowds[attachment.parent].inputs,
                    _part_columns(entity, attachment, detail),
                )
            self._draw(self._parts[entity], frame)

    def _draw(self, renderer: CrowdRenderer | PartRenderer, frame: Frame) -> None:
        renderer.update(frame.tick)
        renderer.draw(frame)
        self.counts.triangles += renderer.counts.triangles
        self.counts.uploaded += renderer.counts.uploaded


def _renderer(entity: int, character: Character, detail: Detail) -> CrowdRenderer:
    looks = esper.component_for_entity(entity, Appearance)
    columns = _crowd_columns(entity, looks, detail)
    return CrowdRenderer(character, esper.component_for_entity(entity, Figure).height, columns)


def _crowd_columns(entity: int, looks: Appearance, detail: Detail) -> CrowdColumns:
    return CrowdColumns(
        esper.component_for_entity(entity, Placement),
        looks,
        detail,
        _poses(entity),
        esper.try_component(entity, OverlayStage),
        esper.try_component(entity, OverrideSet),
        esper.try_component(entity, Body),
        esper.try_component(entity, Physique),
        esper.try_component(entity, Regions),
    )


def _poses(
    entity: int,
) -> tuple[StreamPool, AgentAnimID, Transition] | tuple[BakedPoses, BakedAnim]:
    if esper.has_component(entity, StreamPool):
        return (
            esper.component_for_entity(entity, StreamPool),
            esper.component_for_entity(entity, AgentAnimID),
            esper.component_for_entity(entity, Transition),
        )
    if not esper.has_component(entity, BakedPoses):
        raise ValueError("a crowd without poses can't be drawn; use poses='streams' or 'baked'")
    return (
        esper.component_for_entity(entity, BakedPoses),
        esper.component_for_entity(entity, BakedAnim),
    )


def _part_columns(entity: int, attachment: Attachment, detail: Detail) -> CrowdColumns | None:
    """Whatever a part has not of its own is its crowd's; None if it has nothing of its own."""
    parent = attachment.parent
    looks = esper.try_component(entity, Appearance)
    if attachment.follows_body:
        return None if looks is None else _crowd_columns(parent, looks, detail)
    pool = esper.try_component(entity, StreamPool)
    poses = (
        esper.component_for_entity(parent, StreamPool) if pool is None else pool,
        esper.component_for_entity(entity, AgentAnimID),
        esper.component_for_entity(entity, Transition),
    )
    return CrowdColumns(
        esper.component_for_entity(parent, Placement),
        esper.component_for_entity(parent, Appearance) if looks is None else looks,
        detail,
        poses,
    )
