"""Everything that draws one crowd."""

from __future__ import annotations

from dataclasses import dataclass

from ...components import (
    AgentAnimID,
    Appearance,
    BakedAnim,
    Detail,
    Level,
    Placement,
    Transition,
)
from ..assets.character import Character
from ..streams.baked import BakedPoses
from ..streams.pool import StreamPool
from .agent_tables import AgentTables
from .figure_pass import FigurePass
from .frame import Frame
from .pose_textures import BakedTextures, PoseTextures, StreamTextures
from .skinned_pass import SkinnedPass

BODY = 0


@dataclass(frozen=True, slots=True, eq=False)
class CrowdColumns:
    """What drawing reads of a crowd: streams with their blends, or baked poses."""

    placement: Placement
    appearance: Appearance
    detail: Detail
    poses: tuple[StreamPool, AgentAnimID, Transition] | tuple[BakedPoses, BakedAnim]


@dataclass(slots=True)
class DrawCounts:
    """What the last picture cost."""

    triangles: int = 0
    uploaded: int = 0


class CrowdRenderer:
    """GPU copies of one crowd's tables and poses, and the passes that draw it.

    Parameters
    ----------
    character
        Meshes and materials.
    height
        Height of the character in metres.
    columns
        The crowd's columns; read at every draw.
    """

    def __init__(self, character: Character, height: float, columns: CrowdColumns) -> None:
        self._columns = columns
        agents = len(columns.placement.yaw)
        self._poses: PoseTextures
        if len(columns.poses) == 3:
            self._poses = StreamTextures(columns.poses[0])
            self._tables = AgentTables(agents, 3)
        else:
            self._poses = BakedTextures(columns.poses[0])
            self._tables = AgentTables(agents, 1)
        self._skinned = SkinnedPass(character, self._poses.defines, len(Level) - 1)
        self._figures = FigurePass(height, self._poses.defines)
        self.counts = DrawCounts()

    def update(self, tick: int) -> None:
        """Copy what the simulation changed."""
        columns = self._columns
        uploaded = self._poses.update(tick)
        uploaded += self._tables.update_place(columns.placement)
        uploaded += self._tables.update_looks(columns.appearance)
        if len(columns.poses) == 3:
            _, anim, transition = columns.poses
            uploaded += self._tables.update_streams(anim, transition, BODY, tick)
        else:
            baked, clips = columns.poses
            uploaded += self._tables.update_baked(clips, baked, tick)
        lists = (*self._skinned.lists, self._figures.agents)
        for agents, ids in zip(lists, columns.detail.agents, strict=True):
            uploaded += agents.write(ids)
        self.counts.uploaded = uploaded

    def draw(self, frame: Frame) -> None:
        """Draw what `update` copied into the bound framebuffer."""
        self.counts.triangles = self._skinned.draw(frame, self._tables, self._poses)
        self.counts.triangles += self._figures.draw(frame, self._tables, self._poses)

    def delete(self) -> None:
        """Delete everything on the GPU."""
        self._poses.delete()
        self._tables.delete()
        self._skinned.delete()
        self._figures.delete()
