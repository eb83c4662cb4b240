"""Skeletons, clips, planar poses and forward kinematics."""

from .clip import Clip
from .clip_bank import ClipBank
from .kinematics import Kinematics
from .pose import PoseLayout
from .skeleton import Skeleton

__all__ = ["Clip", "ClipBank", "Kinematics", "PoseLayout", "Skeleton"]
