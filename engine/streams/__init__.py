"""Animation streams, their pose store, and the rule for which pose an agent shows."""

from .baked import BakedPoses
from .ladder import BlendLadder
from .offsets import initial_offsets
from .pool import POSE_RATE, Stream, StreamPool
from .slots import SlotPool
from .store import PoseStore
from .uniques import Unique, UniquePool

__all__ = [
    "POSE_RATE",
    "BakedPoses",
    "BlendLadder",
    "PoseStore",
    "SlotPool",
    "Stream",
    "StreamPool",
    "Unique",
    "UniquePool",
    "initial_offsets",
]
