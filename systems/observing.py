"""Recorders of a crowd are shown every pose tick, once its poses are committed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import esper

from ..engine.clock import Clock
from .query import crowds


class CrowdObserver(ABC):
    """Something that looks at a crowd every pose tick and changes nothing."""

    @abstractmethod
    def see(self, tick: int) -> None:
        """Look at the crowd, in pose tick `tick`."""


@dataclass(slots=True, eq=False)
class Observers:
    """A crowd's component: who looks at it."""

    active: list[CrowdObserver] = field(default_factory=list)

    def remove(self, observer: CrowdObserver) -> None:
        """Let an observer see no more; nothing if it didn't."""
        self.active = [one for one in self.active if one is not observer]


class RecordSystem(esper.Processor):
    """Shows crowds to their observers, the last of a tick's systems."""

    def process(self, clock: Clock) -> None:
        """One base tick; works at pose ticks."""
        if clock.is_pose_tick:
            for _, (observers,) in crowds(Observers):
                for observer in observers.active:
                    observer.see(clock.pose_tick)
