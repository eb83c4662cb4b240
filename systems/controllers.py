"""Running streams are evaluated into this tick's ring slice, and uniques beside them."""

from __future__ import annotations

import esper

from ..engine.clock import Clock
from ..engine.streams.pool import StreamPool
from ..engine.streams.uniques import UniquePool
from .query import crowds


class ControllerSystem(esper.Processor):
    """Samples clips and does forward kinematics for all running streams and uniques."""

    def process(self, clock: Clock) -> None:
        """One base tick; works at pose ticks."""
        if clock.is_pose_tick:
            for _, (pool,) in crowds(StreamPool):
                pool.evaluate(clock.pose_tick)
            for _, (uniques,) in crowds(UniquePool):
                uniques.evaluate(clock.pose_tick)
