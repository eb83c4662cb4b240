"""What an override's Python form gets: the same joint of many agents, and tools to turn it with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class Bodies:
    """Where agents are: the `Body` of the shaders, for K agents.

    Attributes
    ----------
    place
        (K, 3) float32 metres, in the stadium's frame.
    scale
        (K,) float32.
    turn
        (K, 2) float32 sine and cosine of the yaw.
    """

    place: Array
    scale: Array
    turn: Array

    def to_model(self, point: Array) -> Array:
        """(K, 3) model space of points (3,) or (K, 3) of the stadium's frame."""
        x, y, z = ((np.asarray(point, np.float32) - self.place) / self.scale[:, None]).T
        sine, cosine = self.turn.T
        return np.stack([cosine * x - sine * z, y, sine * x + cosine * z], axis=1)

    def to_stadium(self, point: Array) -> Array:
        """(K, 3) stadium's frame of points (3,) or (K, 3) of model space."""
        x, y, z = np.broadcast_to(np.asarray(point, np.float32), self.place.shape).T
        sine, cosine = self.turn.T
        turned = np.stack([cosine * x + sine * z, y, cosine * z - sine * x], axis=1)
        out: Array = self.place + self.scale[:, None] * turned
        return out


@dataclass(frozen=True, slots=True, eq=False)
class OverriddenJoints:
    """One marked joint of K agents: the `OverriddenJoint` of the shaders.

    Attributes
    ----------
    pose
        (K, 4, 4) float32 palettes: bind-pose model space to model space, after blends, overlays and
        the overrides before this one. Characters face +Z in the bind pose, so ``pose[:, :3, 2]`` is
        where a head looks.
    pivot
        (K, 3) float32 the joint's place in model space now.
    bind_pivot
        (3,) float32 its place in the bind pose.
    body
        The agents' places, sizes and turns.
    values
        (K, 4) float32 of the override.
    joint
        Index in the skeleton.
    order
        Which of the override's joints it is, from 0.
    """

    pose: Array
    pivot: Array
    bind_pivot: Array
    body: Bodies
    values: Array
    joint: int
    order: int


def turn_about(pose: Array, pivot: Array, axis: Array, angle: Array) -> Array:
    """Palettes (K, 4, 4), turned about an axis through a point.

    A point one metre above the pivot is one metre to the right of it, at -X, after a quarter turn
    about +Z.

    Parameters
    ----------
    pose
        (K, 4, 4) palettes.
    pivot
        (K, 3) what stays where it is, in model space.
    axis
        (K, 3) or (3,) unit vectors, in model space.
    angle
        (K,) or () radians, right-handed.
    """
    axis = np.broadcast_to(np.asarray(axis, np.float32), pivot.shape)
    angle = np.broadcast_to(np.asarray(angle, np.float32), pivot.shape[:1])
    sine, cosine = np.sin(angle), np.cos(angle)
    x, y, z = axis.T
    turn = (1 - cosine)[:, None, None] * axis[:, :, None] * axis[:, None, :]
    turn += cosine[:, None, None] * np.eye(3, dtype=np.float32)
    for row, column, part in ((2, 1, x), (0, 2, y), (1, 0, z)):
        turn[:, row, column] += sine * part
        turn[:, column, row] -= sine * part
    out = pose.copy()
    out[:, :3] = turn @ pose[:, :3]
    out[:, :3, 3] += pivot - (turn @ pivot[:, :, None])[:, :, 0]
    return out
