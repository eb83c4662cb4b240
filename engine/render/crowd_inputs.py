"""What every vertex shader of one crowd reads: places, looks, who plays what, and the poses."""

from __future__ import annotations

from dataclasses import dataclass

from ...components import AgentAnimID, Appearance, BakedAnim, Body, Detail, Placement, Transition
from ..crowd.physique import Physique
from ..gl.program import Program
from ..streams.baked import BakedPoses
from ..streams.overlaying import OverlayStage
from ..streams.pool import StreamPool
from .agent_tables import AgentTables
from .motion_table import MotionTable
from .overlay_table import OverlayTable
from .pose_textures import BakedTextures, PoseTextures, StreamTextures

BODY = 0


@dataclass(frozen=True, slots=True, eq=False)
class CrowdColumns:
    """What drawing reads of a crowd: streams with their blends, or baked poses."""

    placement: Placement
    appearance: Appearance
    detail: Detail
    poses: tuple[StreamPool, AgentAnimID, Transition] | tuple[BakedPoses, BakedAnim]
    overlays: OverlayStage | None = None
    body: Body | None = None
    physique: Physique | None = None


class CrowdInputs:
    """GPU copies of a crowd's columns and poses, bound together.

    Parameters
    ----------
    columns
        The crowd's columns; read at every update.

    Attributes
    ----------
    defines
        What programs that read the crowd are made with.
    """

    def __init__(self, columns: CrowdColumns) -> None:
        self._columns = columns
        agents = len(columns.placement.yaw)
        self._agents = AgentTables(agents)
        self._poses: PoseTextures
        if len(columns.poses) == 3:
            self._poses = StreamTextures(columns.poses[0])
            self._motion = MotionTable(agents, 3)
        else:
            self._poses = BakedTextures(columns.poses[0])
            self._motion = MotionTable(agents, 1)
        self.defines: dict[str, int] = dict(self._poses.defines)
        self._overlays: OverlayTable | None = None
        if columns.overlays is not None:
            stage, markers = columns.overlays, columns.overlays.ladder.pool.markers
            self._overlays = OverlayTable(agents, stage.columns, stage.masks, markers)
            self.defines["OVERLAYS"] = 1

    def update(self, tick: int) -> int:
        """Copy what the simulation changed; bytes copied."""
        columns = self._columns
        copied = self._poses.update(tick)
        copied += self._agents.update_place(columns.placement, columns.body, columns.physique)
        copied += self._agents.update_looks(columns.appearance)
        if len(columns.poses) == 3:
            _, anim, transition = columns.poses
            copied += self._motion.update_streams(anim, transition, BODY, tick)
            if self._overlays is not None:
                copied += self._overlays.update(anim, transition, self._motion.origin)
            return copied
        baked, clips = columns.poses
        return copied + self._motion.update_baked(clips, baked, tick)

    def bind(self, program: Program, tick: int, alpha: float, *, markers: bool) -> None:
        """Bind everything for a program, and set the time.

        Parameters
        ----------
        program
            Made with `defines`.
        tick, alpha
            Pose tick and the fraction of it that has passed.
        markers
            Whether it reads the joints of the farthest level instead of palettes.
        """
        self._agents.bind(program)
        self._motion.bind(program, tick, alpha)
        self._bind_physique(program, markers=markers)
        self._poses.bind(program, markers=markers)
        if self._overlays is not None:
            self._overlays.bind(program, markers=markers)

    def _bind_physique(self, program: Program, *, markers: bool) -> None:
        physique = self._columns.physique
        seats = None if physique is None else physique.seats
        none = (0.0, 0.0, 0.0)
        program["seat"] = (seats.sitting, seats.standing, seats.seat) if seats else none
        if not markers:
            program["head_centre"] = physique.morphs.head_centre if physique else none
            program["hips_joint"] = physique.hips if physique else 0
            program["hips_bind"] = physique.hips_bind if physique else none

    def delete(self) -> None:
        """Delete everything on the GPU."""
        self._poses.delete()
        self._agents.delete()
        self._motion.delete()
        if self._overlays is not None:
            self._overlays.delete()
