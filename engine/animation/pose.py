"""Where each number of a pose stands in a planar pose block.

A pose block holds the local transforms of S streams as one (10 J, S) float32 array: joints outer,
streams inner. The rows go level by level of the joint tree, and within a level of j joints first
the 4 j rotation components, then 3 j translation and 3 j scale components. So a level is one
contiguous (10, j, S) block that stays in cache while kinematics works on it, and mixing two whole
poses is one operation over the array.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .skeleton import Skeleton

CHANNELS = 10
"""Numbers a joint: 4 of rotation (xyzw), 3 of translation, 3 of scale."""


class PoseLayout:
    """Row numbers of a skeleton's pose blocks.

    Parameters
    ----------
    skeleton
        Whose joints the rows belong to.

    Attributes
    ----------
    rows
        (J, 10) int32: row of each channel of each joint, in the order x y z w of the rotation,
        x y z of the translation, x y z of the scale.
    levels
        One slice of rows per level of the joint tree.

    Examples
    --------
    For a root with two children, the root's rows are 0 to 9, and the x of the second child's
    translation is row 10 + 4 * 2 + 1 = 19.
    """

    __slots__ = ("joint_count", "levels", "rows")

    def __init__(self, skeleton: Skeleton) -> None:
        self.joint_count = skeleton.joint_count
        self.rows = np.empty((skeleton.joint_count, CHANNELS), dtype=np.int32)
        channel = np.arange(CHANNELS)
        slices = []
        for level in skeleton.levels:
            count = level.stop - level.start
            base = CHANNELS * level.start
            self.rows[level] = base + channel * count + np.arange(count)[:, None]
            slices.append(slice(base, base + CHANNELS * count))
        self.levels = tuple(slices)

    def pack(
        self,
        rotation: NDArray[np.float32],
        translation: NDArray[np.float32],
        scale: NDArray[np.float32],
    ) -> NDArray[np.float32]:
        """Pose block rows, streams outer: (S, J, 4), (S, J, 3), (S, J, 3) -> (S, 10 J) float32."""
        joined = np.concatenate([rotation, translation, scale], axis=2)
        block = np.empty((len(joined), CHANNELS * self.joint_count), dtype=np.float32)
        block[:, self.rows.ravel()] = joined.reshape(len(joined), -1)
        return block

    def unpack(
        self, block: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
        """Inverse of `pack`: (S, 10 J) -> (S, J, 4), (S, J, 3) and (S, J, 3)."""
        joined = block[:, self.rows.ravel()].reshape(len(block), self.joint_count, CHANNELS)
        return joined[..., :4], joined[..., 4:7], joined[..., 7:]
