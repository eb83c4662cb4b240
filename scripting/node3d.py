"""Nodes with a place in space."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .exports import export
from .lifecycle import below
from .node import Node
from .vectors import IDENTITY, ONE, ZERO, Quaternion, Vector3

Matrix = NDArray[np.float64]


class Node3D(Node):
    """A node with a place, a rotation and a scale, relative to its parent if that has them too.

    A parent without a place interrupts the chain: what is below counts from the world. Vectors
    don't change: write ``node.position += Vector3(1, 0, 0)``.

    Attributes
    ----------
    position
        Metres.
    rotation
        Quaternion x, y, z, w.
    scale
        Factors along its own axes.
    top_level
        Count from the world, whatever the parent is.
    """

    position: Vector3 = export(default=ZERO, group="Transform", changed="_moved")
    rotation: Quaternion = export(default=IDENTITY, group="Transform", changed="_moved")
    scale: Vector3 = export(default=ONE, group="Transform", changed="_moved")
    top_level: bool = export(default=False, group="Transform", changed="_moved")

    def _prepare(self) -> None:
        super()._prepare()
        self._global: Matrix | None = None

    @property
    def transform(self) -> Matrix:
        """(4, 4) float64 column-vector matrix from its own space to its parent's."""
        matrix = np.eye(4)
        matrix[:3, :3] = _rotation_matrix(self.rotation) * self.scale
        matrix[:3, 3] = self.position
        return matrix

    @property
    def global_transform(self) -> Matrix:
        """(4, 4) float64 matrix from its own space to the world; can be set to an affine one.

        Setting takes rotation and scale apart; shear is lost.
        """
        chain: list[Node3D] = [self]
        while chain[-1]._global is None:
            above = chain[-1]._parent
            if chain[-1].top_level or not isinstance(above, Node3D):
                break
            chain.append(above)
        matrix: Matrix | None = None
        for node in reversed(chain):
            if node._global is None:
                matrix = node.transform if matrix is None else matrix @ node.transform
                node._global = matrix
            matrix = node._global
        assert matrix is not None
        return matrix.copy()

    @global_transform.setter
    def global_transform(self, matrix: Any) -> None:
        wanted = np.asarray(matrix, dtype=float)
        if wanted.shape != (4, 4) or not np.isfinite(wanted).all():
            raise ValueError(f"global_transform has shape {wanted.shape}, expected (4, 4) numbers")
        self._take(np.linalg.solve(self._outer(), wanted))

    @property
    def global_position(self) -> Vector3:
        """Place in the world; can be set."""
        return Vector3(*map(float, self.global_transform[:3, 3]))

    @global_position.setter
    def global_position(self, place: Any) -> None:
        point = (*Vector3.of(place), 1.0)
        self.position = Vector3.of(np.linalg.solve(self._outer(), point)[:3])

    @property
    def forward(self) -> Vector3:
        """(x, y, z) in the world that its +Z points at, with length 1."""
        return Vector3(*map(float, self.global_transform[:3, 2])).normalized()

    def to_global(self, point: Any) -> Vector3:
        """A point of its own space in the world."""
        return Vector3.of((self.global_transform @ (*Vector3.of(point), 1.0))[:3])

    def to_local(self, point: Any) -> Vector3:
        """A point of the world in its own space."""
        return Vector3.of(np.linalg.solve(self.global_transform, (*Vector3.of(point), 1.0))[:3])

    def translate(self, offset: Any) -> None:
        """Move along its own axes."""
        self.position = self.position + self.rotation * Vector3.of(offset)

    def rotate(self, axis: Any, angle: float) -> None:
        """Turn by `angle` radians about an axis of the parent's space."""
        self.rotation = Quaternion.of(Quaternion.from_axis_angle(axis, angle) * self.rotation)

    def look_at(self, target: Any, up: Any = (0.0, 1.0, 0.0)) -> None:
        """Turn its +Z to a point of the world, its +Y towards `up`.

        Raises
        ------
        ValueError
            If the point is where the node is, or straight along `up`.
        """
        here = self.global_transform
        forward = (Vector3.of(target) - Vector3(*map(float, here[:3, 3]))).normalized()
        right = Vector3.of(up).cross(forward)
        if right.length() < 1e-9:
            raise ValueError(f"target is {target!r}, which lies here or along up = {up!r}")
        right = right.normalized()
        scales = np.linalg.norm(here[:3, :3], axis=0)
        here[:3, :3] = np.column_stack([right, forward.cross(right), forward]) * scales
        self.global_transform = here

    def reparent(self, parent: Node, *, keep_global_transform: bool = True) -> None:
        """Move to another parent; it stays where it is in the world unless told otherwise."""
        before = self.global_transform
        super().reparent(parent, keep_global_transform=keep_global_transform)
        if keep_global_transform:
            self.global_transform = before

    def _outer(self) -> Matrix:
        above = self._parent
        if self.top_level or not isinstance(above, Node3D):
            return np.eye(4)
        return above.global_transform

    def _take(self, matrix: Matrix) -> None:
        linear = matrix[:3, :3]
        scale = np.linalg.norm(linear, axis=0)
        if np.linalg.det(linear) < 0.0:
            scale[0] = -scale[0]
        if np.abs(scale).min() < 1e-12:
            raise ValueError("a transform that squeezes an axis to nothing can't be taken apart")
        self.scale = Vector3.of(scale)
        self.rotation = _quaternion(linear / scale)
        self.position = Vector3.of(matrix[:3, 3])

    def _moved(self) -> None:
        # Below a node that is out of date all are.
        if self._global is not None:
            self._global = None
            for node in below(self):
                if isinstance(node, Node3D):
                    node._global = None

    def _parent_changed(self) -> None:
        self._moved()


def _rotation_matrix(rotation: Quaternion) -> Matrix:
    x, y, z, w = rotation
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def _quaternion(m: Matrix) -> Quaternion:
    """Rotation of a (3, 3) matrix, by its greatest component (Shepperd 1978)."""
    squares = np.array(
        [
            1.0 + m[0, 0] - m[1, 1] - m[2, 2],
            1.0 - m[0, 0] + m[1, 1] - m[2, 2],
            1.0 - m[0, 0] - m[1, 1] + m[2, 2],
            1.0 + m[0, 0] + m[1, 1] + m[2, 2],
        ]
    )
    x, y, z = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    xy, xz, yz = m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[1, 2] + m[2, 1]
    rows = (
        (squares[0], xy, xz, x),
        (xy, squares[1], yz, y),
        (xz, yz, squares[2], z),
        (x, y, z, squares[3]),
    )
    return Quaternion.of(rows[int(np.argmax(squares))])
