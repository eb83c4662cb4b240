"""A ball that flies, bounces and rolls."""

from __future__ import annotations

from ..exports import export
from ..node3d import Node3D
from ..signals import Signal
from ..vectors import ZERO, Vector3

GRAVITY = 9.81


class Ball(Node3D):
    """A ball on a flat ground: its place is its middle, in the space of its parent.

    It is a point that others can follow: `Crowd.watches`, `Camera.follows`, `Player.go_to`. tifo
    doesn't draw it.

    Attributes
    ----------
    velocity
        Metres a second.
    radius
        Metres.
    bounce
        Part of the speed that is left after it hits the ground.
    friction
        Metres a second by which it slows down each second while it rolls.
    bounced
        Emitted with the place when it hits the ground.
    stopped
        Emitted when it comes to rest.
    """

    bounced = Signal[Vector3]()
    stopped = Signal[()]()

    velocity: Vector3 = export(default=ZERO)
    radius: float = export(default=0.11, range=(0.01, 10))
    bounce: float = export(default=0.6, range=(0, 1))
    friction: float = export(default=1.5, range=(0, 100))

    def kick(self, velocity: object) -> None:
        """Send it off with a velocity in metres a second."""
        self.velocity = Vector3.of(velocity)

    def kick_to(self, place: object, seconds: float) -> None:
        """Send it off so that it is at `place`, in its parent's space, after `seconds` of flight.

        ValueError if `seconds` isn't above 0.
        """
        if not seconds > 0.0:
            raise ValueError(f"seconds is {seconds}, expected more than 0")
        way = Vector3.of(place) - self.position
        self.velocity = way / seconds + Vector3(0.0, 0.5 * GRAVITY * seconds, 0.0)

    def _step(self, delta: float, *, physics: bool) -> None:
        if not physics or delta <= 0.0:
            return
        x, y, z = self.position
        if self.velocity == ZERO and y <= self.radius:
            return
        vx, vy, vz = self.velocity
        if y > self.radius or vy > 0.0:
            # The mean of the velocities before and after is exact for a parabola.
            falling = vy - GRAVITY * delta
            x, y, z = x + vx * delta, y + 0.5 * (vy + falling) * delta, z + vz * delta
            vy = falling
        else:
            speed = Vector3(vx, 0.0, vz).length()
            slower = max(speed - self.friction * delta, 0.0) / speed if speed > 0.0 else 0.0
            vx, vy, vz = vx * slower, 0.0, vz * slower
            x, y, z = x + vx * delta, self.radius, z + vz * delta
        hit = y <= self.radius and vy < 0.0
        if hit:
            y = self.radius
            vy = -vy * self.bounce
            if vy < 2.0 * GRAVITY * delta:
                vy = 0.0
        self.position = Vector3(x, y, z)
        self.velocity = Vector3(vx, vy, vz)
        if hit:
            self.bounced.emit(self.position)
        if self.velocity == ZERO and y <= self.radius:
            self.stopped.emit()
