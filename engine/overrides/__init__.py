"""Joints that a user's own code poses, on top of what animation does with them."""

from .look_at import LookAt, look_at
from .override import JointOverride
from .override_set import OverrideSet
from .posed_joints import Bodies, OverriddenJoints, turn_about

__all__ = [
    "Bodies",
    "JointOverride",
    "LookAt",
    "OverriddenJoints",
    "OverrideSet",
    "look_at",
    "turn_about",
]
