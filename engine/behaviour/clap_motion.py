"""Hands that meet when the rhythm says so: clappers' offsets on the crowd's clap streams.

Which streams are clap streams is told by their clips: those whose tags ``clap_contact`` are evenly
spaced. An agent on one shows its beat by its offset (`clap_stream`), so the clip events that are
delivered to it follow its beat as well. Where nobody has poses, whoever would show such a clip has
a beat.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...components.animation import AgentAnimID
from ..animation.clip import Clip
from ..streams.pool import POSE_RATE, StreamPool
from .clap_stream import ClapOffsets
from .rhythm import Rhythm

CONTACT = "clap_contact"
_LOOK_EVERY = 3
_MANY = 8192
"""Of more clappers than this, half are compared with their beats in each pose tick."""
_STEEPEST = 0.9
"""Poses a pose tick by which an offset may change."""


class ClapMotion:
    """Keeps clappers' offsets at their beats.

    Parameters
    ----------
    clips
        Of the pool's bank.
    count
        Agents.

    Attributes
    ----------
    clappers
        (K,) int64 ids on clap streams, ascending; of those who show a clap clip, if there are none.
    """

    def __init__(self, clips: Sequence[Clip], count: int) -> None:
        beats = [_beat(clip) for clip in clips]
        self._period = np.array([period for period, _ in beats])  # seconds of the clip; 0 none
        self._first = np.array([first for _, first in beats])
        self._count = count
        self._offsets: ClapOffsets | None = None
        self._longest = 0.0
        self.clappers = np.zeros(0, np.int64)

    def step(self, tick: int, pool: StreamPool, anim: AgentAnimID, rhythm: Rhythm) -> None:
        """Advance the beats, and write offsets that are not true to them any more.

        Called at pose tick `tick` before poses are evaluated, after agents were put on their rows.
        """
        rows = len(pool.clip)
        clip = np.maximum(pool.clip, 0)
        speed = np.maximum(pool.speed, 1e-3)
        period = np.where(pool.clip >= 0, self._period[clip], 0.0) / speed * POSE_RATE
        longest = float(pool.history_goal.min() - 2)
        good = pool.alive & pool.running & (pool.speed > 0) & (period > 0)
        good &= 2.0 * period <= longest
        begun = self._find(tick, anim.row[0], np.append(good, False))
        if longest != self._longest or self._offsets is None:
            self._longest = longest
            self._offsets = ClapOffsets(self._count, max(longest, 1.0), ahead=3)
        if len(begun):
            rhythm.begin(begun)
            self._offsets.forget(begun)
        rhythm.step(self.clappers, 1.0 / POSE_RATE)
        agents = self.clappers
        if len(agents) > _MANY:
            half = len(agents) // 2
            agents = agents[half:] if tick % 2 else agents[:half]
        if not len(agents):
            return
        row = np.minimum(anim.row[0, agents], rows - 1)
        beat = period[row].astype(np.float32)
        # The streams have not been advanced to this tick yet, unless they were cut before it.
        seconds = pool.time + np.where(pool.valid > 0, pool.speed / POSE_RATE, 0.0)
        turns = (seconds - self._first[clip]) / np.maximum(self._period[clip], 1e-6)
        shown = (turns - np.floor(turns))[row].astype(np.float32)
        rate = np.clip(
            rhythm.speed[agents],
            (1.0 - _STEEPEST) * POSE_RATE / beat,
            (1.0 + _STEEPEST) * POSE_RATE / beat,
        )
        change = self._offsets.step(tick, agents, rhythm.phase[agents], rate, shown, beat)
        if len(change.agents):
            self._write(anim, tick, change.agents, change.start, change.slope, period)

    def step_unseen(
        self,
        tick: int,
        shown: NDArray[np.integer],
        clips: NDArray[np.integer],
        rhythm: Rhythm,
    ) -> None:
        """Advance the beats of a crowd without streams: `shown` (N,) motions have `clips` (K,)."""
        begun = self._find(tick, shown, np.append(self._period[clips] > 0, False))
        if len(begun):
            rhythm.begin(begun)
        rhythm.step(self.clappers, 1.0 / POSE_RATE)

    def _write(
        self,
        anim: AgentAnimID,
        tick: int,
        agents: NDArray[np.int64],
        start: NDArray[np.float32],
        slope: NDArray[np.float32],
        period: NDArray[np.float64],
    ) -> None:
        """New lines of offsets; they count from the tick before, which the next picture begins at.

        An agent that enters its row in this very tick keeps that time, as clip events need it.
        """
        fresh = anim.t0[0, agents] == tick
        start = np.where(fresh, start, start - slope)
        beat = period[anim.row[0, agents]].astype(np.float32)
        start = np.where(start < 0, start + beat, start)
        start = np.where(start > self._longest, start - beat, start).astype(np.float32)
        target = np.where(slope < 0, np.float32(0.0), np.where(slope > 0, self._longest, start))
        at = (0, agents)
        anim.start[at], anim.target[at], anim.rate[at] = start, target, slope
        anim.t0[at] = np.where(fresh, tick, tick - 1)
        anim.version += 1

    def _find(
        self, tick: int, row: NDArray[np.integer], good: NDArray[np.bool_]
    ) -> NDArray[np.int64]:
        """Keep `clappers` up to date; ids of new ones."""
        before = self.clappers
        if tick % _LOOK_EVERY:
            on = good[np.minimum(row[before], len(good) - 1)]
            self.clappers = before if on.all() else before[on]
            return before[:0]
        self.clappers = np.flatnonzero(np.take(good, row, mode="clip"))
        if not len(self.clappers):
            return self.clappers
        return np.setdiff1d(self.clappers, before, assume_unique=True)


def _beat(clip: Clip) -> tuple[float, float]:
    """Seconds from clap to clap of a looping clip, and of the first clap; zeros if it has none."""
    times = np.sort([event.time for event in clip.events if event.name == CONTACT])
    if not len(times) or clip.duration <= 0 or not clip.looping:
        return 0.0, 0.0
    if len(times) > 1 and times[-1] - times[0] >= clip.duration - 1e-6:
        times = times[:-1]  # both ends of the loop are the seam
    period = clip.duration / len(times)
    even = np.abs(times - times[0] - period * np.arange(len(times))).max() < 0.1 * period
    return (float(period), float(times[0])) if even else (0.0, 0.0)
