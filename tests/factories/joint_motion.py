"""Where every joint of a clip is at every key, and which way it is turned."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tifo.engine.animation.clip import Clip
from tifo.engine.animation.kinematics import Kinematics
from tifo.engine.animation.pose import pack_poses
from tifo.engine.animation.skeleton import Skeleton

Array = NDArray[np.float64]


@dataclass(frozen=True)
class JointMotion:
    """One clip with its skeleton, and what follows from them.

    Parameters
    ----------
    clip
        The clip.
    skeleton
        Its joints.
    turns
        (F, J, 3, 3) model-space turns from the bind pose.
    places
        (F, J, 3) joints in model space, metres.
    """

    clip: Clip
    skeleton: Skeleton
    turns: Array
    places: Array

    @property
    def name(self) -> str:
        return self.clip.name

    @property
    def times(self) -> Array:
        """(F,) seconds of the keys."""
        return np.linspace(0.0, self.clip.duration, self.clip.frame_count)

    @property
    def step(self) -> float:
        """Seconds from key to key."""
        return self.clip.duration / (self.clip.frame_count - 1)

    def place(self, name: str) -> Array:
        """(F, 3) of one joint."""
        return self.places[:, self.skeleton.index(name)]

    def turn(self, name: str) -> Array:
        """(F, 3, 3) of one joint."""
        return self.turns[:, self.skeleton.index(name)]

    def point(self, name: str, offset: tuple[float, float, float] | Array) -> Array:
        """(F, 3) of a point that a joint carries, given from the joint in the bind pose."""
        result: Array = self.place(name) + self.turn(name) @ np.asarray(offset, float)
        return result

    def bind(self, name: str) -> Array:
        """(3,) where a joint is in the bind pose."""
        return -self.skeleton.inverse_bind[self.skeleton.index(name), :, 3].astype(np.float64)

    def within(self, child: str, parent: str) -> Array:
        """(F, 3, 3) turn of a joint in the frame of another one."""
        result: Array = np.swapaxes(self.turn(parent), 1, 2) @ self.turn(child)
        return result

    def along(self, start: str, end: str, frame: str) -> Array:
        """(F, 3) unit direction from a joint to another, in the frame of a third."""
        way = self.place(end) - self.place(start)
        way /= np.linalg.norm(way, axis=1, keepdims=True)
        result: Array = np.einsum("fba,fb->fa", self.turn(frame), way)
        return result

    def around(self, values: Array) -> Array:
        """Values with two more at the end where the clip is a loop, so that the seam is in it."""
        return np.concatenate([values, values[1:3]]) if self.clip.looping else values


def follow_joints(skeleton: Skeleton, clip: Clip) -> JointMotion:
    """Evaluate every key of a clip."""
    palettes = np.empty((clip.frame_count, clip.joint_count, 3, 4), np.float32)
    pose = pack_poses(clip.rotation, clip.translation, clip.scale)
    Kinematics(skeleton, clip.frame_count).evaluate(pose, palettes)
    turns = palettes[..., :3].astype(np.float64)
    bind = -skeleton.inverse_bind[:, :, 3].astype(np.float64)
    places = np.einsum("fjab,jb->fja", turns, bind) + palettes[..., 3]
    return JointMotion(clip, skeleton, turns, places)
