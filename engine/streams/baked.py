"""The baked alternative: all frames of all clips stored once (*Algorithms* 1 and 2).

Nothing is evaluated at run time: an agent has a clip, a speed and a start time, and shows frame
``round(t * speed * fps) mod frames``. It costs memory for every frame of every clip, and can't
blend, react or be driven by controllers; streams exist for that. It is right for a few short clips.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..animation.clip_bank import ClipBank
from ..animation.kinematics import Kinematics
from ..animation.skeleton import Skeleton


class BakedPoses:
    """Palettes of every frame of every clip.

    Parameters
    ----------
    skeleton
        The joint tree; joints that a clip doesn't animate stay where its frame 0 has them.
    bank
        The clips.
    fps
        Frames a second to bake.
    markers
        (K,) joints whose positions are kept for the farthest level of detail.

    Attributes
    ----------
    palettes
        (F, J, 3, 4) float32, clip after clip: ``parent x local x inverse bind``.
    markers
        (F, K, 4) float32, model space, w unused.
    start, frames
        (clips,) int64: first frame and number of frames of each clip. A looping clip's last key
        equals its first and is left out.
    """

    __slots__ = ("fps", "frames", "markers", "palettes", "start")

    def __init__(
        self,
        skeleton: Skeleton,
        bank: ClipBank,
        *,
        fps: float = 30.0,
        markers: NDArray[np.int64] | None = None,
    ) -> None:
        if not (np.isfinite(fps) and fps > 0):
            raise ValueError(f"fps is {fps}, expected a positive number")
        joints = np.zeros(0, np.int64) if markers is None else markers
        self.fps = fps
        whole = np.round(bank.duration * fps).astype(np.int64)
        self.frames = np.maximum(np.where(bank.looping, whole, whole + 1), 1)
        self.start = np.concatenate([[0], np.cumsum(self.frames)[:-1]])
        total = int(self.frames.sum())
        self.palettes = np.empty((total, skeleton.joint_count, 3, 4), np.float32)
        self.markers = np.zeros((total, len(joints), 4), np.float32)
        for clip, (start, count) in enumerate(zip(self.start, self.frames, strict=True)):
            workspace = Kinematics(skeleton, int(count))
            time = np.minimum(np.arange(count) / fps, bank.duration[clip])
            pose = bank.sample(
                np.full(count, clip),
                time,
                np.zeros(count, np.bool_),
                workspace.mixed,
                workspace.scratch,
            )
            workspace.evaluate(pose, self.palettes[start : start + count])
            self.markers[start : start + count, :, :3] = workspace.joint_positions(joints)

    @property
    def nbytes(self) -> int:
        """Bytes of all palettes."""
        return self.palettes.nbytes

    def frame_rows(
        self, clip: NDArray[np.int64], speed: NDArray[np.float32], time: NDArray[np.float64]
    ) -> NDArray[np.int64]:
        """Row of `palettes` that each agent shows.

        A 40-frame clip baked at 30 Hz shows frame 5 at 1.5 s and speed 1, since 45 mod 40 = 5.

        Parameters
        ----------
        clip, speed, time
            (N,) clip index, playback speed, and seconds since the agent's clip began.

        Returns
        -------
        (N,) int64
        """
        played = np.floor(time * speed * self.fps + 0.5).astype(np.int64)
        return self.start[clip] + np.mod(played, self.frames[clip])
