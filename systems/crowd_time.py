"""What a crowd's users ask of time: how far behind the streams agents play, and what they pass."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..components import AgentAnimID, Dilation
from ..engine.crowd.spec import CrowdSpec
from ..engine.streams.asking import ask_dilation
from ..engine.streams.event_feed import ClipEventFeed, Listener
from ..engine.streams.pool import StreamPool


class TimeCalls:
    """Calls of a `Crowd` about offsets and clip events."""

    __slots__ = ()

    anim: AgentAnimID | None
    clip_feed: ClipEventFeed | None
    dilation: Dilation
    pool: StreamPool | None
    spec: CrowdSpec

    @abstractmethod
    def __len__(self) -> int:
        """Number of agents."""

    def dilate(
        self, agents: NDArray[np.int64], targets: NDArray[np.float32], seconds: float
    ) -> None:
        """Let agents play closer to their stream's head or farther behind, from the next pose tick.

        They get there a little faster or slower than their motion, so nothing jumps. Where
        `seconds` is too short to be unseen it takes longer, which `dilation.lengthened` counts.

        Parameters
        ----------
        agents, targets
            (K,) ids, and offsets in poses that their streams' histories have room for.
        seconds
            How long it may take.

        Raises
        ------
        ValueError
            For a baked crowd, unknown agents, targets that no stream has room for, or a time
            outside 0 to 86,400 s.
        """
        ask_dilation(self.dilation, self._streams(), len(self), agents, targets, seconds)

    def set_history(self, history: int, seconds: float = 3.0) -> None:
        """Let all streams keep more or fewer poses; agents spread over them as they were spread.

        Parameters
        ----------
        history
            M, 2 to the ring's capacity less 2.
        seconds
            How long agents may take to get where they shall be; it takes longer where that would
            be seen.

        Raises
        ------
        ValueError
            For a baked crowd, a history that the ring has no room for, or a wrong time.
        """
        pool = self._streams()
        assert self.anim is not None
        row = self.anim.row[0]
        agents = np.flatnonzero(row < pool.store.stream_rows)
        before = np.maximum(pool.history_goal[row[agents]] - 2, 1)
        for stream in np.flatnonzero(pool.alive):
            pool.set_history(pool.stream(int(stream)), history)
        share = np.float32(history - 2) / before.astype(np.float32)
        targets = np.minimum(self.anim.target[0, agents] * share, np.float32(history - 2))
        self.dilate(agents, targets, seconds)

    def on_clip_event(self, name: str, listener: Listener) -> Callable[[], None]:
        """Call `listener(agents, weights)` whenever agents play past the event.

        The arrays are as for `clip_events`.

        Returns
        -------
        Callable
            Ends the subscription.

        Raises
        ------
        ValueError
            For a baked crowd, or a name that no clip has.
        """
        self._streams()
        assert self.clip_feed is not None
        return self.clip_feed.on(name, listener)

    def clip_events(self, name: str) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Agents (K,) that played past the event in the current pose tick, and weights (K,).

        Errors as for `on_clip_event`.
        """
        self._streams()
        assert self.clip_feed is not None
        return self.clip_feed.passed(name)

    def _streams(self) -> StreamPool:
        if self.pool is None:
            kept = self.spec.poses
            raise ValueError(f"this crowd's poses are {kept}; streams have offsets and clip events")
        return self.pool
