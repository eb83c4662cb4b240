"""One spectator, borrowed as a node."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...components import Placement
from ...systems.crowd import Crowd as CrowdColumns
from ..exports import export
from ..lifecycle import below
from ..node3d import Node3D
from ..vectors import Quaternion, Vector3

if TYPE_CHECKING:
    from .crowd import Crowd


class Agent(Node3D):
    """A spectator: its place, size and seat are those of the crowd's columns, and nothing else.

    What is below it goes with it. Its scale is uniform, and it turns about +Y only; another
    rotation or scale is a ValueError. Freeing the node does nothing to the spectator.

    Attributes
    ----------
    agent
        Its id.
    """

    agent: int = export(range=(0, 2**31 - 1))

    def _prepare(self) -> None:
        super()._prepare()
        self._seen = (-1, -1)

    @property
    def crowd(self) -> Crowd:
        """The crowd above; ValueError if there is none."""
        from .crowd import Crowd
        from .stadium import above

        return above(self, Crowd)

    @property
    def data(self) -> CrowdColumns:
        """The crowd's columns, of which row `agent` is this one."""
        return self.crowd.data

    # The exports of Node3D become the columns themselves; a type checker sees the exports.

    if not TYPE_CHECKING:

        @property
        def position(self) -> Vector3:
            """Place of the feet, metres in the stadium's frame; can be set."""
            return Vector3(*map(float, self._placement.position[:, self.agent]))

        @position.setter
        def position(self, place: Any) -> None:
            placement = self._placement
            placement.position[:, self.agent] = Vector3.of(place)
            placement.version += 1

        @property
        def rotation(self) -> Quaternion:
            """About +Y; can be set."""
            return Quaternion.from_axis_angle((0.0, 1.0, 0.0), self.yaw)

        @rotation.setter
        def rotation(self, rotation: Any) -> None:
            turn = Quaternion.of(rotation)
            up = turn * Vector3(0.0, 1.0, 0.0)
            if up.y < 1.0 - 1e-6:
                raise ValueError(f"rotation is {rotation!r}, expected a turn about +Y")
            self.yaw = turn.to_euler().y

        @property
        def scale(self) -> Vector3:
            """Uniform scale of the character; can be set."""
            size = float(self._placement.scale[self.agent])
            return Vector3(size, size, size)

        @scale.setter
        def scale(self, scale: Any) -> None:
            x, y, z = Vector3.of(scale)
            if not (x > 0.0 and abs(y - x) <= 1e-6 * x and abs(z - x) <= 1e-6 * x):
                raise ValueError(f"scale is {scale!r}, expected three equal numbers above 0")
            placement = self._placement
            placement.scale[self.agent] = x
            placement.version += 1

    @property
    def yaw(self) -> float:
        """Radians; 0 faces +Z, positive turns about +Y; can be set."""
        return float(self._placement.yaw[self.agent])

    @yaw.setter
    def yaw(self, yaw: float) -> None:
        if not np.isfinite(yaw):
            raise ValueError(f"yaw is {yaw}, expected radians")
        placement = self._placement
        placement.yaw[self.agent] = yaw
        placement.version += 1

    @property
    def seat(self) -> str:
        """Label of the seat: ``"12|345"``."""
        return self.data.plan.label(self.agent)

    @property
    def row(self) -> int:
        """Row of the seat, from the front."""
        return int(self.data.seat.row[self.agent])

    @property
    def column(self) -> int:
        """Column of the seat."""
        return int(self.data.seat.column[self.agent])

    @property
    def section(self) -> str:
        """Name of the section."""
        data = self.data
        return data.plan.sections[int(data.seat.section[self.agent])][0]

    @property
    def team(self) -> int:
        """0 home, 1 away, -1 neutral; can be set."""
        return int(self.data.team.side[self.agent])

    @team.setter
    def team(self, side: int) -> None:
        if side not in (-1, 0, 1):
            raise ValueError(f"team is {side!r}, expected 0 (home), 1 (away) or -1 (neutral)")
        self.data.team.side[self.agent] = side

    @property
    def is_present(self) -> bool:
        """Whether somebody is there; can be set."""
        return bool(self.data.seat.occupied[self.agent])

    @is_present.setter
    def is_present(self, present: bool) -> None:
        self.data.seat.occupied[self.agent] = bool(present)

    @property
    def motion(self) -> str:
        """Name of the motion that it shows, or is blending to."""
        data = self.data
        return data.library.names[int(data.motion.shown[self.agent])]

    @property
    def _placement(self) -> Placement:
        data = self.data
        if self.agent >= len(data):
            raise ValueError(f"{self!r} is agent {self.agent}, but there are {len(data)}")
        return data.placement

    # Node3D keeps matrices; an agent's follows from the columns.

    @property
    def _global(self) -> NDArray[np.float64] | None:
        return self._outer() @ self.transform

    @_global.setter
    def _global(self, matrix: Any) -> None:
        pass

    def _outer(self) -> NDArray[np.float64]:
        return self.crowd.stadium.global_transform

    def _moved(self) -> None:
        for node in below(self):
            if isinstance(node, Node3D):
                node._global = None

    def _step(self, delta: float, *, physics: bool) -> None:
        seen = (id(self.data), self._placement.version)
        if seen != self._seen:
            self._seen = seen
            self._moved()
