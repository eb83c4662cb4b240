"""Runs the systems: those of a tick for every tick that is due, those of a frame once.

One processor in esper's world, so that a game which calls ``esper.process(delta)`` once a frame
gets fixed ticks without keeping them itself. A game with fixed ticks of its own can add the systems
one by one instead (`add_systems`) and call ``esper.process(clock)``.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from time import perf_counter

import esper
import numpy as np

from ..engine.clock import Clock
from .behaviour import BehaviourSystem
from .clip_events import ClipEventSystem
from .contagion import ClapSystem
from .controllers import ControllerSystem
from .detail import DetailSystem
from .dilation import DilationSystem
from .history import HistorySystem
from .observing import RecordSystem
from .phases import Phase
from .transitions import TransitionSystem
from .walking import WalkingSystem


class Schedule(esper.Processor):
    """Fixed ticks inside frames of any length.

    Parameters
    ----------
    clock
        Counts the ticks.
    tick_systems, frame_systems
        In the order in which they run.

    Attributes
    ----------
    times
        Seconds of each run of each system since `keep_times` was set, by class name.
    keep_times
        Whether runs are timed.
    """

    def __init__(
        self,
        clock: Clock,
        tick_systems: Sequence[esper.Processor],
        frame_systems: Sequence[esper.Processor] = (),
    ) -> None:
        self.clock = clock
        self.tick_systems = list(tick_systems)
        self.frame_systems = list(frame_systems)
        self.keep_times = False
        self.times: dict[str, list[float]] = defaultdict(list)

    def process(self, delta: float) -> None:
        """Advance by `delta` seconds: at most 4 ticks, then the systems of the frame."""
        for _ in range(self.clock.due(delta)):
            self.tick()
        self.frame()

    def tick(self) -> None:
        """One base tick."""
        self.clock.advance()
        self._run(self.tick_systems)

    def frame(self) -> None:
        """The systems of one frame."""
        self._run(self.frame_systems)

    def _run(self, systems: Sequence[esper.Processor]) -> None:
        if not self.keep_times:
            for system in systems:
                system.process(self.clock)
            return
        for system in systems:
            begin = perf_counter()
            system.process(self.clock)
            self.times[type(system).__name__].append(perf_counter() - begin)


def tick_systems(seed: int) -> list[esper.Processor]:
    """New systems of a tick, in order; each draws from a generator of its own."""
    behaviour, transitions = np.random.SeedSequence([seed, 1]).spawn(2)
    return [
        WalkingSystem(),
        BehaviourSystem(np.random.default_rng(behaviour)),
        TransitionSystem(np.random.default_rng(transitions)),
        DilationSystem(),
        ClapSystem(),
        ControllerSystem(),
        HistorySystem(),
        ClipEventSystem(),
        RecordSystem(),
    ]


def add_systems(seed: int, *, levels: bool = True) -> None:
    """Add the systems to the current esper world one by one, by `Phase`.

    ``esper.process(clock)`` then runs one tick and one frame.
    """
    phases = (
        Phase.WALKING,
        Phase.BEHAVIOUR,
        Phase.TRANSITIONS,
        Phase.DILATION,
        Phase.CLAPS,
        Phase.CONTROLLERS,
        Phase.HISTORY,
        Phase.CLIP_EVENTS,
        Phase.RECORD,
    )
    for system, phase in zip(tick_systems(seed), phases, strict=True):
        esper.add_processor(system, phase)
    esper.add_processor(DetailSystem(levels=levels), Phase.DETAIL)
