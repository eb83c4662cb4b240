"""Quaternion arithmetic in double precision that readers share.

Readers work in float64 and round once, when they fill a clip. Quaternions are xyzw with the
components on the last axis; every function takes any number of axes before it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def multiply(first: Array, second: Array) -> Array:
    """Hamilton product of (..., 4) quaternions: the rotation `second` followed by `first`."""
    ax, ay, az, aw = np.moveaxis(first, -1, 0)
    bx, by, bz, bw = np.moveaxis(second, -1, 0)
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        axis=-1,
    )


def from_euler(axes: Sequence[int], angles: Array) -> Array:
    """Quaternions of rotations about several axes of the turning body.

    Parameters
    ----------
    axes
        n axes, 0 for X, 1 for Y, 2 for Z. For ``(2, 0, 1)`` the matrix of a column vector is
        ``Rz Rx Ry``.
    angles
        (..., n) radians, in the order of `axes`.

    Returns
    -------
    (..., 4) float64
        The identity where `axes` is empty.
    """
    half = 0.5 * angles
    result = np.zeros((*angles.shape[:-1], 4))
    result[..., 3] = 1.0
    for position, axis in enumerate(axes):
        turn = np.zeros_like(result)
        turn[..., axis] = np.sin(half[..., position])
        turn[..., 3] = np.cos(half[..., position])
        result = turn if position == 0 else multiply(result, turn)
    return result


def angle_between(first: Array, second: Array) -> Array:
    """Radians from 0 to pi that turn unit quaternion `first` into `second`, sign ignored."""
    # The chord is exact for small angles, where an arc cosine of the dot product is not.
    chord = np.minimum(
        np.linalg.norm(first - second, axis=-1), np.linalg.norm(first + second, axis=-1)
    )
    return np.asarray(4.0 * np.arcsin(np.clip(0.5 * chord, 0.0, 1.0)))


def slerp(first: Array, second: Array, fraction: float) -> Array:
    """Point at `fraction` of the shortest arc between unit quaternions; 0 gives `first`."""
    dot = np.sum(first * second, axis=-1, keepdims=True)
    second = np.where(dot < 0, -second, second)
    angle = 0.5 * angle_between(first, second)[..., None]
    sine = np.sin(angle)
    # Below a microradian the arc and the chord agree to double precision.
    near = sine < 1e-6
    safe = np.where(near, 1.0, sine)
    start = np.where(near, 1.0 - fraction, np.sin((1.0 - fraction) * angle) / safe)
    stop = np.where(near, fraction, np.sin(fraction * angle) / safe)
    return np.asarray(start * first + stop * second)
