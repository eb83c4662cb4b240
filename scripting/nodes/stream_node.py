"""What the animation nodes share: a stream of the crowd above that is theirs."""

from __future__ import annotations

from abc import abstractmethod

from numpy.typing import ArrayLike

from ...engine.streams.pool import Stream, StreamPool
from ...systems.crowd import Crowd as CrowdColumns
from ...systems.crowd_overlays import BLEND_SECONDS
from ...systems.simulation import Simulation
from ..node import Node
from .crowd import Crowd
from .stadium import Stadium, above


class StreamNode(Node):
    """A node that owns one of its crowd's streams, made when it is first needed.

    Streams are scarce: a stadium's `spare_streams` says how many are left for nodes.
    """

    def _prepare(self) -> None:
        super()._prepare()
        self._held: tuple[CrowdColumns, Stream] | None = None
        self._listening_to: Stadium | None = None

    @property
    def crowd(self) -> Crowd:
        """The crowd above; ValueError if there is none."""
        return above(self, Crowd)

    @property
    def stream(self) -> Stream:
        """Its stream.

        Raises
        ------
        ValueError
            If the crowd is baked, has no free stream, or the node has nothing to play.
        """
        data = self.crowd.data
        if self._held is None or self._held[0] is not data:
            pool = _pool(data)
            if pool.alive.all():
                raise ValueError(
                    f"{self!r} finds no free stream; raise spare_streams of {self.crowd.stadium!r}"
                )
            self._held = (data, self._make(pool))
        return self._held[1]

    @property
    def pool(self) -> StreamPool:
        """The crowd's streams; ValueError for a baked crowd."""
        return _pool(self.crowd.data)

    def show(
        self,
        agents: int | ArrayLike,
        *,
        duration: float | ArrayLike = BLEND_SECONDS,
        offset: float | ArrayLike | None = None,
    ) -> None:
        """Let agents blend to this stream; see `tifo.Crowd.transition_to_streamed`."""
        stream = self.stream
        self.crowd.data.transition_to_streamed(agents, stream, duration=duration, offset=offset)

    @abstractmethod
    def _make(self, pool: StreamPool) -> Stream:
        """A new stream of the pool that plays what the node shall play."""

    def _running(self) -> tuple[StreamPool, Stream] | None:
        """Pool and stream, if it has one in the crowd that there is now."""
        if self._held is None or self._held[0].pool is None:
            return None
        data, stream = self._held
        pool = data.pool
        assert pool is not None
        if not pool.alive[stream.row] or pool.generation[stream.row] != stream.generation:
            return None
        return pool, stream

    def _entered(self) -> None:
        try:
            self._listening_to = self.crowd.stadium
        except ValueError:
            return
        self._listening_to._listeners[self] = None

    def _has_left(self, *, freed: bool) -> None:
        if self._listening_to is not None:
            self._listening_to._listeners.pop(self, None)
            self._listening_to = None
        if freed:
            running = self._running()
            if running is not None:
                running[0].remove(running[1])
            self._held = None

    def _pose_tick(self, simulation: Simulation) -> None:
        if self._held is not None and self._held[0] is simulation.crowd:
            self._after_tick(simulation)

    def _after_tick(self, simulation: Simulation) -> None:
        """After each pose tick in which it has a stream."""


def _pool(data: CrowdColumns) -> StreamPool:
    if data.pool is None:
        raise ValueError("this crowd has no streams; animation nodes need poses='streams'")
    return data.pool
