"""What every vertex shader of one crowd reads: places, looks, who plays what, and the poses."""

from __future__ import annotations

from dataclasses import dataclass

from ...components import AgentAnimID, Appearance, BakedAnim, Detail, Placement, Transition
from ..gl.program import Program
from ..streams.baked import BakedPoses
from ..streams.pool import StreamPool
from .agent_tables import AgentTables
from .motion_table import MotionTable
from .pose_textures import BakedTextures, PoseTextures, StreamTextures

BODY = 0


@dataclass(frozen=True, slots=True, eq=False)
class CrowdColumns:
    """What drawing reads of a crowd: streams with their blends, or baked poses."""

    placement: Placement
    appearance: Appearance
    detail: Detail
    poses: tuple[StreamPool, AgentAnimID, Transition] | tuple[BakedPoses, BakedAnim]


class CrowdInputs:
    """GPU copies of a crowd's columns and poses, bound together.

    Parameters
    ----------
    columns
        The crowd's columns; read at every update.
    parent
        For a part: the inputs of its crowd. What both have in common is not copied twice, and must
        have been updated before.

    Attributes
    ----------
    defines
        What programs that read the crowd are made with.
    """

    def __init__(self, columns: CrowdColumns, parent: CrowdInputs | None = None) -> None:
        self._columns = columns
        agents = len(columns.placement.yaw)
        self._shares_agents = self._shares_poses = False
        if parent is not None:
            theirs = parent._columns
            self._shares_agents = theirs.appearance is columns.appearance
            self._shares_poses = theirs.poses[0] is columns.poses[0]
        self._agents: AgentTables
        if parent is not None and self._shares_agents:
            self._agents = parent._agents
        else:
            self._agents = AgentTables(agents)
        self._poses: PoseTextures
        if parent is not None and self._shares_poses:
            self._poses = parent._poses
        elif len(columns.poses) == 3:
            self._poses = StreamTextures(columns.poses[0])
        else:
            self._poses = BakedTextures(columns.poses[0])
        self._motion = MotionTable(agents, 3 if len(columns.poses) == 3 else 1)
        self.defines: dict[str, int] = dict(self._poses.defines)

    def update(self, tick: int) -> int:
        """Copy what the simulation changed; bytes copied."""
        columns = self._columns
        copied = 0 if self._shares_poses else self._poses.update(tick)
        if not self._shares_agents:
            copied += self._agents.update_place(columns.placement)
            copied += self._agents.update_looks(columns.appearance)
        if len(columns.poses) == 3:
            _, anim, transition = columns.poses
            return copied + self._motion.update_streams(anim, transition, BODY, tick)
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
        self._poses.bind(program, markers=markers)

    def delete(self) -> None:
        """Delete everything on the GPU, but for what belongs to the parent."""
        if not self._shares_poses:
            self._poses.delete()
        if not self._shares_agents:
            self._agents.delete()
        self._motion.delete()
