"""What every vertex shader of one crowd reads: places, looks, who plays what, and the poses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components import AgentAnimID, Appearance, BakedAnim, Body, Detail, Placement, Transition
from ..crowd.morphs import MorphWeights
from ..crowd.physique import Physique
from ..crowd.regions import Regions
from ..gl.program import Program
from ..gl.source import Defines
from ..overrides.override_set import OverrideSet
from ..streams.baked import BakedPoses
from ..streams.overlaying import OverlayStage
from ..streams.pool import StreamPool
from .agent_tables import AgentTables
from .motion_table import MotionTable
from .overlay_table import OverlayTable
from .override_tables import OverrideTables
from .pose_textures import BakedTextures, PoseTextures, StreamTextures

BODY = 0


@dataclass(frozen=True, slots=True, eq=False)
class CrowdColumns:
    """What drawing reads of a crowd: streams with their blends or baked poses, and overrides."""

    placement: Placement
    appearance: Appearance
    detail: Detail
    poses: tuple[StreamPool, AgentAnimID, Transition] | tuple[BakedPoses, BakedAnim]
    overlays: OverlayStage | None = None
    overrides: OverrideSet | None = None
    body: Body | None = None
    physique: Physique | None = None
    regions: Regions | None = None


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
        What programs that read the crowd, but not its palettes, are made with.
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
        self._overlays: OverlayTable | None = None
        if columns.overlays is not None:
            stage, markers = columns.overlays, columns.overlays.ladder.pool.markers
            self._overlays = OverlayTable(agents, stage.columns, stage.masks, markers)
            self.defines["OVERLAYS"] = 1
        overrides = columns.overrides
        self._overrides = None if overrides is None else OverrideTables(overrides)

    @property
    def physique(self) -> Physique | None:
        """Proportions of the crowd."""
        return self._columns.physique

    @property
    def morphs(self) -> MorphWeights | None:
        """How meshes take part in the bind-pose morphs."""
        physique = self._columns.physique
        return None if physique is None else physique.morphs

    @property
    def regions(self) -> Regions | None:
        """Parts of the crowd's character; None where shirts have no patterns."""
        return self._columns.regions

    @property
    def revision(self) -> int:
        """Changes when programs that read palettes have to be made anew."""
        return 0 if self._overrides is None else self._overrides.revision

    @property
    def overridden(self) -> NDArray[np.bool_] | None:
        """(J,) joints that overrides reach; None without overrides."""
        return None if self._overrides is None else self._overrides.reached

    def make_program(
        self,
        vertex: str,
        fragment: str | None = None,
        *,
        defines: Defines | None = None,
        feedback: Sequence[str] = (),
    ) -> Program:
        """A program that reads palettes through ``lib/posture.glsl``.

        Parameters are as for `Program`. Where there are overrides, a program for vertices that none
        of them reaches is faster with ``UNTOUCHED`` defined.

        Raises
        ------
        GraphicsError
            When it does not compile; names the override, if one is at fault.
        """
        whole = {**self.defines, **(defines or {})}
        tables = self._overrides
        if tables is None:
            return Program(vertex, fragment, defines=whole, feedback=feedback)
        with tables.blaming(vertex):
            return Program(
                vertex,
                fragment,
                defines={**whole, **tables.defines},
                includes=tables.includes,
                feedback=feedback,
            )

    def update(self, tick: int) -> int:
        """Copy what the simulation changed; bytes copied."""
        columns = self._columns
        copied = 0 if self._shares_poses else self._poses.update(tick)
        if not self._shares_agents:
            copied += self._agents.update_place(columns.placement, columns.body, columns.physique)
            copied += self._agents.update_looks(columns.appearance)
        if self._overrides is not None:
            copied += self._overrides.update()
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
            Made with `defines`, or by `make_program` if it reads palettes.
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
        if self._overrides is not None and not markers:
            self._overrides.bind(program)

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
        """Delete everything on the GPU, but for what belongs to the parent."""
        if not self._shares_poses:
            self._poses.delete()
        if not self._shares_agents:
            self._agents.delete()
        self._motion.delete()
        if self._overlays is not None:
            self._overlays.delete()
        if self._overrides is not None:
            self._overrides.delete()
