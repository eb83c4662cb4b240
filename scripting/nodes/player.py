"""A player who runs where he is told."""

from __future__ import annotations

import math

from ..exports import export
from ..node3d import Node3D
from ..signals import Signal
from ..vectors import ZERO, Quaternion, Vector3


class Player(Node3D):
    """A body on the pitch: runs to a place at a constant speed and faces where it runs.

    tifo doesn't draw it.

    Attributes
    ----------
    team, number
        Side, 0 home or 1 away, and shirt number.
    speed
        Metres a second.
    arrived
        Emitted when it gets to where `go_to` sent it.
    """

    arrived = Signal[()]()

    team: int = export(default=0, range=(0, 1))
    number: int = export(default=1, range=(0, 99))
    speed: float = export(default=6.0, range=(0, 20))

    def _prepare(self) -> None:
        super()._prepare()
        self._target: Vector3 | None = None

    @property
    def target(self) -> Vector3 | None:
        """Where it runs to, in its parent's space; None if it stands."""
        return self._target

    @property
    def velocity(self) -> Vector3:
        """Metres a second, in its parent's space."""
        if self._target is None:
            return ZERO
        return (self._target - self.position).normalized() * self.speed

    def go_to(self, place: object) -> None:
        """Run to a place in the parent's space."""
        self._target = Vector3.of(place)

    def stop(self) -> None:
        """Stand still."""
        self._target = None

    def _step(self, delta: float, *, physics: bool) -> None:
        if not physics or self._target is None:
            return
        way = self._target - self.position
        distance, reach = way.length(), self.speed * delta
        if distance > 1e-9:
            yaw = math.atan2(way.x, way.z)
            if abs(way.x) + abs(way.z) > 1e-9:
                self.rotation = Quaternion.from_axis_angle((0.0, 1.0, 0.0), yaw)
        if distance <= reach + 1e-9:
            self.position, self._target = self._target, None
            self.arrived.emit()
        else:
            self.position = self.position + way * (reach / distance)
