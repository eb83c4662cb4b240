"""Rotation matrices, arcs and forward kinematics in double precision, over the frames of a clip.

Retargeting compares directions of two bodies, which reads best with matrices; clips hold
quaternions, so both ways between them are here.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...animation.skeleton import Skeleton
from ..gltf_transforms import rotation_matrices

Array = NDArray[np.float64]


def unit(vectors: Array) -> Array:
    """(..., 3) vectors at length 1; a zero vector stays zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(length > 0, length, 1.0))


def across(vectors: Array, along: Array) -> Array:
    """The part of `vectors` at right angles to the unit vectors `along`."""
    return np.asarray(vectors - along * np.sum(vectors * along, axis=-1, keepdims=True))


def matrices_of(quaternions: Array) -> Array:
    """(..., 3, 3) rotations of (..., 4) quaternions xyzw of any length but zero."""
    return rotation_matrices(quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True))


def quaternions_of(rotations: Array) -> Array:
    """(..., 4) unit quaternions xyzw of (..., 3, 3) rotations.

    Shepperd (1978): of four formulas the one with the largest divisor is taken.
    """
    m = rotations
    x, y, z = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    squares = np.stack([1 + x - y - z, 1 - x + y - z, 1 - x - y + z, 1 + x + y + z], axis=-1)
    largest = np.argmax(squares, axis=-1)[..., None]
    d21, d02, d10 = (
        m[..., 2, 1] - m[..., 1, 2],
        m[..., 0, 2] - m[..., 2, 0],
        m[..., 1, 0] - m[..., 0, 1],
    )
    s10, s02, s21 = (
        m[..., 1, 0] + m[..., 0, 1],
        m[..., 0, 2] + m[..., 2, 0],
        m[..., 2, 1] + m[..., 1, 2],
    )
    candidates = np.stack(
        [
            np.stack([squares[..., 0], s10, s02, d21], axis=-1),
            np.stack([s10, squares[..., 1], s21, d02], axis=-1),
            np.stack([s02, s21, squares[..., 2], d10], axis=-1),
            np.stack([d21, d02, d10, squares[..., 3]], axis=-1),
        ],
        axis=-2,
    )
    chosen = np.take_along_axis(candidates, largest[..., None], axis=-2)[..., 0, :]
    return unit_quaternions(chosen)


def unit_quaternions(quaternions: Array) -> Array:
    """(..., 4) quaternions at length 1."""
    return np.asarray(quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True))


def transposed(rotations: Array) -> Array:
    """The opposite turns of (..., 3, 3) rotations."""
    return np.swapaxes(rotations, -1, -2)


def turned(rotations: Array, vectors: Array) -> Array:
    """(..., 3, 3) rotations of (..., 3) vectors; shapes broadcast."""
    return np.asarray(np.matmul(rotations, vectors[..., None])[..., 0])


def arc(start: Array, stop: Array) -> Array:
    """(..., 3, 3) shortest turns from directions `start` to `stop`, (..., 3) each.

    Opposite directions are joined by a half turn about some axis at right angles to them; a zero
    direction gives no turn.
    """
    a, b = np.broadcast_arrays(unit(start), unit(stop))
    axis = np.cross(a, b)
    cosine = np.sum(a * b, axis=-1)
    helper = np.eye(3)[np.argmin(np.abs(a), axis=-1)]
    half_turn = unit(np.cross(a, helper))
    known = (np.abs(a).max(axis=-1) > 0) & (np.abs(b).max(axis=-1) > 0)
    opposite = cosine < -1 + 1e-12
    vector = np.where(opposite[..., None], half_turn, axis)
    w = np.where(opposite, 0.0, 1 + cosine)
    quaternion = np.concatenate([vector, w[..., None]], axis=-1)
    still = np.array([0.0, 0.0, 0.0, 1.0])
    return matrices_of(np.where(known[..., None], quaternion, still))


def about_y(angle: Array) -> Array:
    """(..., 3, 3) turns by `angle` radians about +Y: a quarter takes +Z to +X."""
    c, s = np.cos(angle), np.sin(angle)
    zero, one = np.zeros_like(c), np.ones_like(c)
    rows = ((c, zero, s), (zero, one, zero), (-s, zero, c))
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def between(start: Array, stop: Array, fraction: float) -> Array:
    """Turns at `fraction` of the way between (..., 3, 3) rotations, on the shortest arc."""
    if fraction <= 0:
        return start
    if fraction >= 1:
        return stop
    q = quaternions_of(np.matmul(transposed(start), stop))
    q = np.where(q[..., 3:] < 0, -q, q)
    sine = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    half = np.arctan2(sine, q[..., 3:])
    axis = q[..., :3] / np.where(sine > 0, sine, 1.0)
    part = np.concatenate([axis * np.sin(fraction * half), np.cos(fraction * half)], axis=-1)
    return np.asarray(np.matmul(start, matrices_of(part)))


def nearest_rotation(matrix: Array) -> Array:
    """The rotation nearest to a (3, 3) matrix of turn and scale."""
    length = np.linalg.norm(matrix, axis=0)
    u, _, vt = np.linalg.svd(matrix / np.where(length > 0, length, 1.0))
    u[:, 2] *= np.sign(np.linalg.det(u @ vt))
    return np.asarray(u @ vt)


def forward(
    skeleton: Skeleton, rotation: Array, translation: Array, scale: Array
) -> tuple[Array, Array, Array]:
    """Model space of local transforms.

    Parameters
    ----------
    skeleton
        J joints.
    rotation
        (F, J, 3, 3) float64 local turns.
    translation, scale
        (F, J, 3) float64.

    Returns
    -------
    turns, linear, positions
        (F, J, 3, 3) rotations without the scales, (F, J, 3, 3) with them, and (F, J, 3) places.
    """
    turns = rotation.copy()
    linear = rotation * scale[..., None, :]
    positions = translation.copy()
    for level in skeleton.levels[1:]:
        above = skeleton.parents[level]
        positions[:, level] = positions[:, above] + turned(linear[:, above], translation[:, level])
        linear[:, level] = np.matmul(linear[:, above], linear[:, level])
        turns[:, level] = np.matmul(turns[:, above], rotation[:, level])
    return turns, linear, positions
