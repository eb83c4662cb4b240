"""Quaternion arithmetic over the frames of a clip, float64, xyzw, shape (..., 4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..rotations import multiply

Array = NDArray[np.float64]


def inverse(rotation: Array) -> Array:
    """The opposite turn of a unit quaternion."""
    result: Array = rotation * np.array([-1.0, -1.0, -1.0, 1.0])
    return result


def rotate(rotation: Array, vector: Array) -> Array:
    """Turn (..., 3) vectors."""
    axis, w = rotation[..., :3], rotation[..., 3:]
    twice = 2 * np.cross(axis, vector)
    result: Array = vector + w * twice + np.cross(axis, twice)
    return result


def about(axis: int, angle: Array) -> Array:
    """Turn by `angle` (...) radians about X (0), Y (1) or Z (2)."""
    result = np.zeros((*np.shape(angle), 4))
    result[..., axis] = np.sin(angle / 2)
    result[..., 3] = np.cos(angle / 2)
    return result


def about_axis(axis: Array, angle: Array) -> Array:
    """Turn by `angle` (...) radians about unit vectors (..., 3)."""
    half = np.asarray(angle)[..., None] / 2
    return np.concatenate([axis * np.sin(half), np.cos(half)], axis=-1)


def from_pitch_yaw_roll(angles: Array) -> Array:
    """Roll about Z, then pitch about X, then yaw about Y, from (..., 3) pitch, yaw, roll."""
    pitch, yaw, roll = np.moveaxis(angles, -1, 0)
    return multiply(about(1, yaw), multiply(about(0, pitch), about(2, roll)))


def unit(vector: Array) -> Array:
    """Vectors (..., 3) at length 1."""
    result: Array = vector / np.maximum(np.linalg.norm(vector, axis=-1, keepdims=True), 1e-12)
    return result


def across(vector: Array, direction: Array) -> Array:
    """The part of `vector` at right angles to the unit `direction`, at length 1."""
    along = np.sum(vector * direction, axis=-1, keepdims=True)
    return unit(vector - along * direction)


def between_frames(first0: Array, second0: Array, first: Array, second: Array) -> Array:
    """The turn that takes unit vector `first0` to `first` and `second0` to `second`.

    Both pairs are at right angles; shapes broadcast, result (..., 4).
    """
    start = np.stack([first0, second0, np.cross(first0, second0)], axis=-1)
    end = np.stack([first, second, np.cross(first, second)], axis=-1)
    return from_matrix(end @ np.swapaxes(start, -1, -2))


def from_matrix(matrix: Array) -> Array:
    """Unit quaternions of rotation matrices (..., 3, 3), after Bar-Itzhack (2000).

    The quaternion is the eigenvector of a symmetric 4 x 4 matrix: no case needs care.
    """
    m = matrix
    k = np.zeros((*m.shape[:-2], 4, 4))
    k[..., 0, 0] = m[..., 0, 0] - m[..., 1, 1] - m[..., 2, 2]
    k[..., 1, 1] = m[..., 1, 1] - m[..., 0, 0] - m[..., 2, 2]
    k[..., 2, 2] = m[..., 2, 2] - m[..., 0, 0] - m[..., 1, 1]
    k[..., 3, 3] = m[..., 0, 0] + m[..., 1, 1] + m[..., 2, 2]
    k[..., 1, 0] = k[..., 0, 1] = m[..., 0, 1] + m[..., 1, 0]
    k[..., 2, 0] = k[..., 0, 2] = m[..., 0, 2] + m[..., 2, 0]
    k[..., 2, 1] = k[..., 1, 2] = m[..., 1, 2] + m[..., 2, 1]
    k[..., 3, 0] = k[..., 0, 3] = m[..., 2, 1] - m[..., 1, 2]
    k[..., 3, 1] = k[..., 1, 3] = m[..., 0, 2] - m[..., 2, 0]
    k[..., 3, 2] = k[..., 2, 3] = m[..., 1, 0] - m[..., 0, 1]
    result: Array = np.linalg.eigh(k)[1][..., 3]
    return np.where(result[..., 3:] < 0, -result, result)


def twist_angle(rotation: Array, axis: Array) -> Array:
    """Angle in (-pi, pi] that a rotation turns about a unit axis (its twist)."""
    along = np.sum(rotation[..., :3] * axis, axis=-1)
    angle = 2 * np.arctan2(along, rotation[..., 3])
    result: Array = (angle + np.pi) % (2 * np.pi) - np.pi
    return result
