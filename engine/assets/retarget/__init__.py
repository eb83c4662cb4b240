"""Motions of one human body for another: mapping, retargeting, mirroring, trimming and looping."""

from .cut import trim_clip
from .humanoid import Humanoid, NotHumanoidError, humanoid
from .loop import Loop, find_loop, loop_clip
from .mirror import mirror_clip
from .transfer import retarget

__all__ = [
    "Humanoid",
    "Loop",
    "NotHumanoidError",
    "find_loop",
    "humanoid",
    "loop_clip",
    "mirror_clip",
    "retarget",
    "trim_clip",
]
