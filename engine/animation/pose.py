"""Local poses of many streams in one array.

A pose block is (S, 10, J) float32: one row a stream, and in it ten channels, each over all joints:
x y z w of the rotation, x y z of the translation, x y z of the scale. A whole pose is one
contiguous row, so poses are gathered, mixed and scattered as rows; a channel of all joints is
contiguous in it, so the dot products of blending need no strides.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]

CHANNELS = 10
ROTATION, TRANSLATION, SCALE = slice(0, 4), slice(4, 7), slice(7, 10)


def pack_poses(rotation: Array, translation: Array, scale: Array) -> Array:
    """Pose block (S, 10, J) of (S, J, 4) rotations xyzw, (S, J, 3) translations and scales."""
    joined = np.concatenate([rotation, translation, scale], axis=2, dtype=np.float32)
    return np.ascontiguousarray(joined.transpose(0, 2, 1))


def unpack_poses(block: Array) -> tuple[Array, Array, Array]:
    """Rotations (S, J, 4), translations and scales (S, J, 3) of a pose block, as views."""
    joined = block.transpose(0, 2, 1)
    return joined[..., ROTATION], joined[..., TRANSLATION], joined[..., SCALE]
