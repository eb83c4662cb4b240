"""Streams that nobody shows rest: more motions can exist than are evaluated.

*Streams 2017*, 4.1 keeps streams in two states, Running and Stopped. Here a stream is stopped once
no agent has shown it for a while, as what it plays or as what it blends from, and runs again when
somebody is put on it. It has no past then, so those agents begin at its head and drift apart.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...components.animation import AgentAnimID, Transition
from .dilation import Dilated, PoolUser, spread
from .pool import POSE_RATE, StreamPool


class StreamNeeds:
    """Stops and runs the streams of one pool by need.

    Streams that somebody else stopped are left alone.

    Parameters
    ----------
    rows
        Stream rows of the pool.
    patience
        Seconds without a spectator after which a stream rests.
    seconds
        How long agents may take to drift apart on a stream that runs again.
    always
        (R,) bool: streams that never rest, such as those that agents enter at a phase.

    Raises
    ------
    ValueError
        For negative seconds.

    Attributes
    ----------
    resting
        (R,) bool: streams that this policy has stopped.
    """

    __slots__ = ("_always", "_patience", "_seconds", "_shown_at", "resting")

    def __init__(
        self,
        rows: int,
        *,
        patience: float = 2.0,
        seconds: float = 4.0,
        always: NDArray[np.bool_] | None = None,
    ) -> None:
        if not patience >= 0 or not seconds >= 0:
            raise ValueError(f"patience is {patience} and seconds is {seconds}, expected >= 0")
        self._patience = patience * POSE_RATE
        self._seconds = seconds
        self._always = np.zeros(rows, np.bool_) if always is None else always.copy()
        self._shown_at: NDArray[np.int64] | None = None
        self.resting = np.zeros(rows, np.bool_)

    def update(
        self,
        pool: StreamPool,
        anim: AgentAnimID,
        transition: Transition,
        tick: int,
        *,
        others: Sequence[PoolUser] = (),
    ) -> Dilated:
        """One pose tick: run what is wanted again, stop what nobody has shown for a while.

        Called after agents were put on their rows and before the pool's evaluate. Agents that were
        just put on a resting stream keep the offset that they were given as their target.

        Parameters
        ----------
        pool, anim, transition
            The streams, and who plays them.
        tick
            Pose tick.
        others
            Columns of parts that play streams of the same pool.
        """
        users = [PoolUser(anim, transition), *others]
        shown = np.logical_or.reduce([self._shown(pool, *user) for user in users])
        if self._shown_at is None:
            self._shown_at = np.full(len(shown), tick, np.int64)
        self._shown_at[shown] = tick
        self.resting &= pool.alive & ~pool.running
        total = Dilated(0, 0, 0.0)
        wake = self.resting & shown
        if wake.any():
            for row in np.flatnonzero(wake):
                pool.run(pool.stream(int(row)))
            self.resting[wake] = False
            for user in users:
                total = total.plus(self._spread(pool, user.anim, wake, tick))
        idle = pool.running & ~self._always & (tick - self._shown_at > self._patience)
        for row in np.flatnonzero(idle):
            pool.stop(pool.stream(int(row)))
        self.resting |= idle
        return total

    def _shown(
        self, pool: StreamPool, anim: AgentAnimID, transition: Transition
    ) -> NDArray[np.bool_]:
        """(R,) whether any part of any agent shows each stream."""
        rows = len(pool.head)
        shown = np.bincount(np.minimum(anim.row, rows).ravel(), minlength=rows + 1)[:rows] > 0
        fading = transition.row[transition.duration > 0]
        shown[fading[fading < rows]] = True
        # A stream rests only with all its twins.
        twins = np.flatnonzero(shown & (pool.twins.base >= 0))
        shown[pool.twins.base[twins]] = True
        return shown

    def _spread(
        self, pool: StreamPool, anim: AgentAnimID, wake: NDArray[np.bool_], tick: int
    ) -> Dilated:
        moving, lengthened, ticks = 0, 0, 0.0
        on_wake = np.concatenate([wake, [False]])
        for part in range(len(anim.row)):
            agents = np.flatnonzero(on_wake[np.minimum(anim.row[part], len(wake))])
            longest = (pool.history_goal[anim.row[part, agents]] - 2).astype(np.float32)
            targets = np.clip(anim.target[part, agents], 0.0, longest)
            done = spread(pool, anim, part, agents, targets, self._seconds, tick)
            moving, lengthened = moving + done.moving, lengthened + done.lengthened
            ticks = max(ticks, done.ticks)
        return Dilated(moving, lengthened, ticks)
