"""All clips of one skeleton in one array, sampled for many streams at once.

The bank keeps each key as one contiguous row, so sampling S streams copies 2 S rows and mixes them:
the cost does not depend on how many clips there are or how long they are.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .clip import Clip
from .pose import CHANNELS, pack_poses
from .skeleton import Skeleton


class ClipBank:
    """Clips of one skeleton, ready for batched sampling.

    Parameters
    ----------
    skeleton
        All clips must have its number of joints.
    clips
        At least one; a clip's index is its place in this sequence.

    Raises
    ------
    ValueError
        If there is no clip or a clip is made for another number of joints.
    """

    __slots__ = ("clips", "duration", "frames", "intervals", "joint_count", "looping", "start")

    def __init__(self, skeleton: Skeleton, clips: Sequence[Clip]) -> None:
        if not clips:
            raise ValueError("clips: a clip bank needs at least one clip")
        for clip in clips:
            if clip.joint_count != skeleton.joint_count:
                raise ValueError(
                    f"clip '{clip.name}' has {clip.joint_count} joints, "
                    f"the skeleton has {skeleton.joint_count}"
                )
        self.joint_count = skeleton.joint_count
        self.clips = tuple(clips)
        counts = np.array([clip.frame_count for clip in clips], dtype=np.int64)
        self.start = np.concatenate([[0], np.cumsum(counts)[:-1]])
        self.intervals = counts - 1
        self.duration = np.array([clip.duration for clip in clips], dtype=np.float64)
        self.looping = np.array([clip.looping for clip in clips], dtype=np.bool_)
        self.frames = np.concatenate(
            [pack_poses(clip.rotation, clip.translation, clip.scale) for clip in clips]
        )

    def index(self, name: str) -> int:
        """Index of the clip called `name`; ValueError lists the known names if there is none."""
        for index, clip in enumerate(self.clips):
            if clip.name == name:
                return index
        known = ", ".join(clip.name for clip in self.clips)
        raise ValueError(f"no clip '{name}'; known: {known}")

    def locate(
        self, clip: NDArray[np.int64], time: NDArray[np.float64], looping: NDArray[np.bool_]
    ) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Key before each time, as a row of `frames`, and the weight of the key after it.

        Parameters
        ----------
        clip, time, looping
            (S,) clip indices, seconds since each clip's start (any sign), and whether time wraps
            at the clip's end or stays there. A 2 s looping clip at -0.5 s shows 1.5 s.

        Returns
        -------
        (S,) int64 rows and (S,) float32 weights in [0, 1]
        """
        duration = self.duration[clip]
        safe = np.where(duration > 0, duration, 1.0)
        local = np.where(looping, np.mod(time, safe), np.clip(time, 0.0, duration))
        intervals = self.intervals[clip]
        position = np.clip(local / safe, 0.0, 1.0) * intervals
        before = np.minimum(position.astype(np.int64), np.maximum(intervals - 1, 0))
        return self.start[clip] + before, (position - before).astype(np.float32)

    def sample(
        self,
        clip: NDArray[np.int64],
        time: NDArray[np.float64],
        looping: NDArray[np.bool_],
        out: NDArray[np.float32],
        scratch: NDArray[np.float32],
    ) -> NDArray[np.float32]:
        """Local poses of S streams at their times.

        Rotations are mixed component by component and not normalised (kinematics divides by the
        squared length), which at 60 keys a second stays within 1e-4 rad of spherical interpolation
        up to 10 rad/s.

        Parameters
        ----------
        clip, time, looping
            As for `locate`.
        out, scratch
            (S, 10, J) float32 arrays to work in; the poses are in `out` afterwards.

        Returns
        -------
        (S, 10, J) float32
            `out`.
        """
        before, weight = self.locate(clip, time, looping)
        after = np.minimum(before + 1, self.start[clip] + self.intervals[clip])
        np.take(self.frames, before, axis=0, out=out, mode="clip")
        np.take(self.frames, after, axis=0, out=scratch, mode="clip")
        np.subtract(scratch, out, out=scratch)
        np.multiply(scratch, weight[:, None, None], out=scratch)
        np.add(out, scratch, out=out)
        return out

    def sample_one(self, clip: int, time: float) -> NDArray[np.float32]:
        """Pose row (1, 10, J) of one clip at one time, wrapped if the clip loops."""
        shape = (1, CHANNELS, self.joint_count)
        out, scratch = np.empty(shape, np.float32), np.empty(shape, np.float32)
        which = np.array([clip])
        return self.sample(which, np.array([time]), self.looping[which], out, scratch)
