"""This tick's poses become the heads of their streams."""

from __future__ import annotations

import esper

from ..components import Detail
from ..engine.clock import Clock
from ..engine.streams.pool import StreamPool
from ..engine.streams.uniques import UniquePool
from .query import crowds


class HistorySystem(esper.Processor):
    """Commits the tick in every pose store and records what drawing has to copy."""

    def process(self, clock: Clock) -> None:
        """One base tick; works at pose ticks."""
        for entity, _ in crowds(Detail):
            # What draws a crowd must know its time, whoever keeps the clock.
            if esper.try_component(entity, Clock) is not clock:
                esper.add_component(entity, clock)
        if clock.is_pose_tick:
            for _, (pool,) in crowds(StreamPool):
                pool.commit(clock.pose_tick)
            for _, (uniques,) in crowds(UniquePool):
                uniques.commit(clock.pose_tick)
