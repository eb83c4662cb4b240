"""Local transforms and matrices in float64, as a file reader needs them.

Readers evaluate a file exactly before anything is rounded to the float32 columns that the systems
use; speed matters less here than in the pose maths of a running crowd.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


class Transforms(NamedTuple):
    """Translation, rotation and scale of many nodes, applied scale first.

    ``rotation (..., 4) xyzw``, ``translation (..., 3)`` and ``scale (..., 3)`` float64.
    """

    rotation: FloatArray
    translation: FloatArray
    scale: FloatArray

    def matrices(self) -> FloatArray:
        """Return the column-vector matrices, (..., 4, 4)."""
        result = np.zeros((*self.rotation.shape[:-1], 4, 4))
        result[..., :3, :3] = rotation_matrices(self.rotation) * self.scale[..., None, :]
        result[..., :3, 3] = self.translation
        result[..., 3, 3] = 1.0
        return result


def rotation_matrices(rotation: FloatArray) -> FloatArray:
    """Turn unit quaternions (..., 4) xyzw into rotation matrices (..., 3, 3)."""
    x, y, z, w = np.moveaxis(rotation, -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def quaternion_of(rotation: FloatArray) -> FloatArray:
    """Turn one rotation matrix (3, 3) into a unit quaternion (4,) xyzw.

    The eigenvector of Bar-Itzhack's symmetric matrix ("New method for extracting the quaternion
    from a rotation matrix", 2000); it has no special cases.
    """
    m = rotation
    k = np.array(
        [
            [m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]],
            [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
            [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], np.trace(m)],
        ]
    )
    quaternion: FloatArray = np.linalg.eigh(k)[1][:, -1]
    return quaternion if quaternion[3] >= 0 else -quaternion


def decompose(matrix: FloatArray) -> tuple[Transforms, float]:
    """Split a matrix (4, 4) into translation, rotation and scale.

    Returns
    -------
    tuple
        The nearest transform and the largest entry by which it misses the matrix, relative to the
        matrix's largest scale: about 1e-16 without shear. A mirroring matrix gets a negative first
        scale, a flattened one a scale of zero.
    """
    linear = matrix[:3, :3].copy()
    mirrored = bool(np.linalg.det(linear) < 0)
    if mirrored:
        linear[:, 0] *= -1
    lengths = np.linalg.norm(linear, axis=0)
    u, _, vt = np.linalg.svd(linear / np.where(lengths > 0, lengths, 1.0))
    u[:, 2] *= np.sign(np.linalg.det(u @ vt))
    rotation = u @ vt
    scale = np.einsum("ij,ij->j", rotation, linear)
    missed = float(np.abs(rotation * scale - linear).max(initial=0.0))
    largest = float(lengths.max())
    if mirrored:
        scale[0] *= -1
    transform = Transforms(quaternion_of(rotation), matrix[:3, 3].copy(), scale)
    return transform, missed / largest if largest > 0 else 0.0


def is_invertible(matrix: FloatArray) -> bool:
    """Whether the affine matrix (4, 4) can be inverted without losing what matters."""
    linear = matrix[:3, :3]
    lengths = np.linalg.norm(linear, axis=0)
    if not np.isfinite(matrix).all() or lengths.min() < 1e-12:
        return False
    return bool(abs(np.linalg.det(linear / lengths)) > 1e-6)


def model_positions(
    local: Transforms, parents: NDArray[np.int32], levels: tuple[slice, ...]
) -> FloatArray:
    """Compute where joints are in model space.

    Parameters
    ----------
    local
        Local transforms of shape (T, J, ...).
    parents, levels
        As in `Skeleton`: sorted by depth, one slice a level.

    Returns
    -------
    (T, J, 3) float64
        Positions in model space.
    """
    linear = rotation_matrices(local.rotation) * local.scale[..., None, :]
    position = local.translation.copy()
    for level in levels[1:]:
        above = parents[level]
        turn = linear[:, above]
        position[:, level] = position[:, above] + np.einsum(
            "tjab,tjb->tja", turn, position[:, level]
        )
        linear[:, level] = turn @ linear[:, level]
    return position
