"""Cameras that a person can steer: orbiting a point, or flying.

Pure mathematics: windows feed it with drags, scrolls and seconds, tests with numbers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Self

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float32]
Vector = NDArray[np.float64]

_LIMIT = math.radians(89.0)


class CameraMode(Enum):
    """What dragging and moving do."""

    ORBIT = "orbit"
    FLY = "fly"


def look_at(eye: Vector, target: Vector) -> Matrix:
    """(4, 4) column-vector matrix from the stadium's frame to a camera that looks down its -Z."""
    forward = np.asarray(target, float) - eye
    length = float(np.linalg.norm(forward))
    forward = forward / length if length > 1e-9 else np.array([0.0, 0.0, -1.0])
    up = np.array([0.0, 1.0, 0.0])
    right = np.cross(forward, up)
    if np.linalg.norm(right) < 1e-6:
        right = np.array([1.0, 0.0, 0.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    matrix = np.eye(4)
    matrix[0, :3], matrix[1, :3], matrix[2, :3] = right, up, -forward
    matrix[:3, 3] = -matrix[:3, :3] @ eye
    return matrix.astype(np.float32)


def perspective(fov: float, aspect: float, near: float, far: float) -> Matrix:
    """(4, 4) OpenGL projection; `fov` is the vertical field of view in radians."""
    f = 1.0 / math.tan(fov / 2.0)
    matrix = np.zeros((4, 4), np.float32)
    matrix[0, 0], matrix[1, 1] = f / aspect, f
    matrix[2, 2], matrix[2, 3] = (far + near) / (near - far), 2.0 * far * near / (near - far)
    matrix[3, 2] = -1.0
    return matrix


@dataclass(slots=True)
class FreeCamera:
    """A camera with a place and a direction.

    Attributes
    ----------
    eye
        (3,) float64 metres.
    yaw, pitch
        Direction it looks in, radians: yaw 0 looks along +Z, positive turns about +Y; positive
        pitch looks up.
    distance
        Metres to the point it orbits.
    fov
        Vertical field of view, radians.
    mode
        Orbit or fly.
    """

    eye: Vector
    yaw: float
    pitch: float
    distance: float
    fov: float = math.radians(45.0)
    mode: CameraMode = CameraMode.ORBIT

    @classmethod
    def looking(cls, eye: tuple[float, ...], target: tuple[float, ...]) -> Self:
        """A camera at `eye` that looks at, and orbits, `target`."""
        start, end = np.asarray(eye, float), np.asarray(target, float)
        to = end - start
        distance = max(float(np.linalg.norm(to)), 1e-3)
        pitch = math.asin(float(np.clip(to[1] / distance, -1.0, 1.0)))
        return cls(start, math.atan2(float(to[0]), float(to[2])), pitch, distance)

    @property
    def forward(self) -> Vector:
        """(3,) unit vector that it looks along."""
        flat = math.cos(self.pitch)
        return np.array(
            [math.sin(self.yaw) * flat, math.sin(self.pitch), math.cos(self.yaw) * flat]
        )

    @property
    def target(self) -> Vector:
        """(3,) point that it orbits."""
        return self.eye + self.forward * self.distance

    def view(self) -> Matrix:
        """(4, 4) stadium to camera space."""
        return look_at(self.eye, self.target)

    def projection(self, size: tuple[int, int]) -> Matrix:
        """(4, 4) camera to clip space for a picture of `size` pixels."""
        width, height = size
        near = max(0.1, min(0.5, 0.01 * self.distance))
        return perspective(self.fov, max(width, 1) / max(height, 1), near, 1500.0)

    def drag(self, dx: float, dy: float) -> None:
        """Turn by a mouse drag in pixels: about the target when orbiting, else on the spot."""
        target = self.target
        self.yaw = math.remainder(self.yaw - 0.004 * dx, 2.0 * math.pi)
        self.pitch = float(np.clip(self.pitch + 0.004 * dy, -_LIMIT, _LIMIT))
        if self.mode is CameraMode.ORBIT:
            self.eye = target - self.forward * self.distance

    def pan(self, dx: float, dy: float) -> None:
        """Shift in the picture plane by a drag in pixels."""
        rotation = self.view()[:3, :3].astype(float)
        self.eye = self.eye - self.distance * 0.0015 * (rotation[0] * dx + rotation[1] * dy)

    def zoom(self, steps: float) -> None:
        """Move towards the target (positive steps) or away, by an eighth of the way a step."""
        factor = 0.875**steps
        target = self.target
        self.distance = float(np.clip(self.distance * factor, 0.5, 600.0))
        self.eye = target - self.forward * self.distance

    def fly(self, right: float, up: float, forward: float) -> None:
        """Move by metres along its own right, the world's up, and its own direction."""
        rotation = self.view()[:3, :3].astype(float)
        self.eye = (
            self.eye + rotation[0] * right + np.array([0.0, up, 0.0]) + self.forward * forward
        )

    def keep_above(self, ground: float) -> None:
        """Don't let it sink below a height of `ground` metres."""
        self.eye[1] = max(self.eye[1], ground)

    def rectangle(
        self, first: tuple[float, float], second: tuple[float, float], size: tuple[int, int]
    ) -> tuple[Matrix, tuple[float, float, float, float]]:
        """A rectangle of the picture, for ``crowd.where(framed=...)``.

        Parameters
        ----------
        first, second
            Opposite corners, pixels from the left and the bottom of the picture.
        size
            Width and height of the picture in pixels.
        """
        x, y = (sorted(2.0 * pair[k] / size[k] - 1.0 for pair in (first, second)) for k in (0, 1))
        matrix = (self.projection(size).astype(float) @ self.view()).astype(np.float32)
        return matrix, (x[0], y[0], x[1], y[1])

    def ray(self, x: float, y: float, size: tuple[int, int]) -> tuple[Vector, Vector]:
        """Origin and unit direction of the ray through a pixel.

        Parameters
        ----------
        x, y
            Pixels from the left and the bottom of the picture.
        size
            Width and height of the picture in pixels.
        """
        projection = self.projection(size).astype(float)
        clip_x = 2.0 * (x + 0.5) / size[0] - 1.0
        clip_y = 2.0 * (y + 0.5) / size[1] - 1.0
        local = np.array([clip_x / projection[0, 0], clip_y / projection[1, 1], -1.0])
        direction = self.view()[:3, :3].astype(float).T @ local
        return self.eye.copy(), direction / np.linalg.norm(direction)
