"""Skeletons, clips, planar poses and forward kinematics."""

from .clip import Clip, ClipEvent
from .clip_bank import ClipBank
from .kinematics import Kinematics
from .pose import pack_poses, unpack_poses
from .skeleton import Skeleton

__all__ = ["Clip", "ClipBank", "ClipEvent", "Kinematics", "Skeleton", "pack_poses", "unpack_poses"]
