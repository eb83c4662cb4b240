"""A camera as a node."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...engine.crowd.cameras import camera_presets
from ..camera import FreeCamera, perspective
from ..exports import export
from ..lifecycle import ancestors, below
from ..node3d import Node3D
from .stadium import Stadium

Matrix = NDArray[np.float32]

_PRESETS = ("", "tv", "close", "bowl")


class Camera(Node3D):
    """What is drawn from: it looks along its +Z, as everything in tifo does.

    Attributes
    ----------
    fov
        Vertical field of view, degrees.
    near, far
        Planes between which things are drawn, metres.
    current
        Whether `tifo.run` draws what it sees; without a current one the first camera counts.
    preset
        ``tv``, ``close`` or ``bowl``: where to stand when it gets ready, in the stadium above or
        else the first of the tree.
    distance
        Metres to the point that it orbits.
    follows
        What it turns to in every frame.
    """

    fov: float = export(default=45.0, range=(1, 170))
    near: float = export(default=0.2, range=(0.001, 1000))
    far: float = export(default=1500.0, range=(0.1, 1e6))
    current: bool = export(default=False)
    preset: str = export(default="", choices=_PRESETS, changed="_preset_changed")
    distance: float = export(default=20.0, range=(0.1, 1e5))
    follows: Node3D | None = export(default=None)

    def view(self) -> Matrix:
        """(4, 4) float32 from the world to camera space, which looks down -Z."""
        placed = self.global_transform
        axes = placed[:3, :3] / np.linalg.norm(placed[:3, :3], axis=0)
        matrix = np.eye(4)
        # Half a turn about +Y: the picture's right is the node's -X.
        matrix[0, :3], matrix[1, :3], matrix[2, :3] = -axes[:, 0], axes[:, 1], -axes[:, 2]
        matrix[:3, 3] = -matrix[:3, :3] @ placed[:3, 3]
        return matrix.astype(np.float32)

    def projection(self, size: tuple[int, int]) -> Matrix:
        """(4, 4) float32 from camera to clip space for a picture of `size` pixels."""
        width, height = size
        aspect = max(width, 1) / max(height, 1)
        return perspective(math.radians(self.fov), aspect, self.near, max(self.far, 2 * self.near))

    def look_from(self, eye: Any, target: Any) -> None:
        """Stand at `eye` and look at `target`, metres in the world."""
        self.global_position = eye
        self.look_at(target)
        self.distance = max(self.global_position.distance_to(target), 0.1)

    def as_free_camera(self) -> FreeCamera:
        """The same view as a `FreeCamera`, which keeps its horizon level."""
        ahead = self.forward
        here = self.global_position
        camera = FreeCamera.looking(here, here + ahead * self.distance)
        camera.fov = math.radians(self.fov)
        return camera

    def drag(self, dx: float, dy: float) -> None:
        """Turn about the point that it orbits by a mouse drag in pixels."""
        camera = self.as_free_camera()
        camera.drag(dx, dy)
        self._put(camera)

    def pan(self, dx: float, dy: float) -> None:
        """Shift in the picture plane by a drag in pixels."""
        camera = self.as_free_camera()
        camera.pan(dx, dy)
        self._put(camera)

    def zoom(self, steps: float) -> None:
        """Move towards the point that it orbits, or away."""
        camera = self.as_free_camera()
        camera.zoom(steps)
        self._put(camera)

    def fly(self, right: float, up: float, forward: float) -> None:
        """Move by metres along its own right, the world's up, and its own direction."""
        camera = self.as_free_camera()
        camera.fly(right, up, forward)
        self._put(camera)

    def ray(self, x: float, y: float, size: tuple[int, int]) -> tuple[Any, Any]:
        """Origin and unit direction in the world of the ray through a pixel from the bottom left.

        Parameters are as for `FreeCamera.ray`.
        """
        projection, view = self.projection(size).astype(float), self.view().astype(float)
        clip = 2.0 * (np.array([x, y]) + 0.5) / size - 1.0
        local = np.array([clip[0] / projection[0, 0], clip[1] / projection[1, 1], -1.0])
        direction = view[:3, :3].T @ local
        return np.array(self.global_position), direction / np.linalg.norm(direction)

    def _put(self, camera: FreeCamera) -> None:
        self.look_from(tuple(camera.eye), tuple(camera.target))

    def _stadium(self) -> Stadium | None:
        for one in ancestors(self):
            if isinstance(one, Stadium):
                return one
        around = below(self.tree.root) if self.is_inside_tree() else iter(())
        return next((one for one in around if isinstance(one, Stadium)), None)

    def _preset_changed(self) -> None:
        if self.is_node_ready() and self.is_inside_tree():
            self._made_ready()

    def _made_ready(self) -> None:
        stadium = self._stadium() if self.preset else None
        if stadium is not None:
            eye, target = camera_presets(stadium.simulation.plan)[self.preset]
            self.look_from(stadium.to_global(eye), stadium.to_global(target))

    def _step(self, delta: float, *, physics: bool) -> None:
        target = self.follows
        if physics or target is None or target._freed:
            return
        place = target.global_position
        offset = place - self.global_position
        if abs(offset.x) + abs(offset.z) > 1e-6:
            self.look_at(place)
