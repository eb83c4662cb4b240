"""Animation streams, their pose store, and the rule for which pose an agent shows."""

from .baked import BakedPoses
from .offsets import initial_offsets
from .pool import POSE_RATE, Stream, StreamPool
from .store import PoseStore

__all__ = ["POSE_RATE", "BakedPoses", "PoseStore", "Stream", "StreamPool", "initial_offsets"]
