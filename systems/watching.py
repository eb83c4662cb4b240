"""What a program asks of a crowd that it runs without pictures: time series and clip schedules."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from contextlib import AbstractContextManager
from math import isfinite
from typing import TYPE_CHECKING

import esper

from ..engine.clock import BASE_RATE
from .observing import Observers

if TYPE_CHECKING:
    from ..engine.export.clip_schedule import ClipSchedule
    from .clip_recorder import ClipRecorder
    from .recording import Agents
    from .state_recorder import Grouping, StateRecorder

LONGEST = 24 * 3600.0
"""Seconds of a clip schedule, at most."""


class WatchingCalls:
    """Calls of a `Crowd` that take down what it does."""

    __slots__ = ()

    observers: Observers

    @abstractmethod
    def _active(self) -> AbstractContextManager[None]:
        """Make the crowd's world the current one."""

    def watch(
        self, *, every: float = 1.0, by: Sequence[Grouping] = ("team", "section")
    ) -> StateRecorder:
        """Take time series of what people do from the next pose tick on, until `stop`.

        Parameters
        ----------
        every
            Seconds from sample to sample; 0 takes one every pose tick.
        by
            What shares can be asked for beside those of all: ``"team"``, ``"section"``.

        Raises
        ------
        ValueError
            For wrong seconds, or an unknown grouping.

        Examples
        --------
        >>> watch = crowd.watch(every=0.1)
        >>> simulation.run(seconds=10.0)
        >>> cheering = watch.share("cheer", by="team")  # (samples, sides)
        """
        from .crowd import Crowd
        from .state_recorder import StateRecorder

        assert isinstance(self, Crowd)
        recorder = StateRecorder(self, every=every, by=by, observers=self.observers)
        self.observers.active.append(recorder)
        return recorder

    def watch_clips(self, agents: Agents = None) -> ClipRecorder:
        """Take down which clips agents play from now on, until its `finish`.

        Parameters
        ----------
        agents
            An id, ids, a (N,) mask, or seats as text such as ``"section 5"``; everybody if None.

        Raises
        ------
        ValueError
            For agents that don't exist, or nobody.
        """
        from .clip_recorder import ClipRecorder
        from .crowd import Crowd

        assert isinstance(self, Crowd)
        recorder = ClipRecorder(self, agents, observers=self.observers)
        self.observers.active.append(recorder)
        return recorder

    def schedule(self, seconds: float, agents: Agents = None) -> ClipSchedule:
        """Let time pass, and say which clips agents play in it, from when to when, and how.

        The events that were sent for this time happen. *Thesis* 3.1.1 expands the sequences of
        motions for the whole time in advance in the same way.

        Parameters
        ----------
        seconds
            How long, above 0 and at most a day, rounded to pose ticks.
        agents
            As for `watch_clips`.

        Raises
        ------
        ValueError
            For wrong seconds or agents, or in a world that has no `Schedule` to let time pass;
            step it yourself there, with `watch_clips`.
        """
        from .schedule import Schedule

        if not isfinite(seconds) or not 1.0 / BASE_RATE <= seconds <= LONGEST:
            raise ValueError(f"seconds is {seconds}, expected more than 0, at most {LONGEST:g}")
        with self._active():
            schedule = esper.get_processor(Schedule)
            if not isinstance(schedule, Schedule):
                raise ValueError(
                    "this crowd's world has no Schedule to let time pass; use watch_clips"
                )
            recorder = self.watch_clips(agents)
            ticks = max(round(seconds * BASE_RATE / 2), 1) * 2
            for _ in range(ticks):
                schedule.tick()
        return recorder.finish()
