"""What a crowd's users ask of blends from motion to motion."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..engine.crowd.spec import CrowdSpec
from ..engine.streams.asking import ask_streamed, ask_unique
from ..engine.streams.blend_counts import LadderCounts
from ..engine.streams.ladder import BlendLadder, Focus
from ..engine.streams.pool import Stream
from ..engine.streams.uniques import Unique, UniquePool
from .crowd_overlays import BLEND_SECONDS, unstreamed

FOCUS_RADIUS = 60.0
"""Metres around a focus in which agents never jump."""


class BlendCalls:
    """Calls of a `Crowd` that let agents change over to other motions."""

    __slots__ = ()

    ladder: BlendLadder | None
    spec: CrowdSpec

    @property
    def uniques(self) -> UniquePool:
        """Motions that are not shared; ValueError in a baked crowd."""
        return self._ladder().uniques

    @property
    def blend_counts(self) -> LadderCounts:
        """How many changes of motion took which rung of the blend ladder."""
        return self._ladder().counts

    def transition_to_streamed(
        self,
        agents: int | ArrayLike,
        stream: Stream,
        part: int = 0,
        *,
        duration: float | ArrayLike = BLEND_SECONDS,
        offset: float | ArrayLike | None = None,
    ) -> None:
        """Ask agents to blend to a stream; it begins at the next pose tick.

        Never fails for want of room, and the last request of an agent is the one it ends on; see
        `tifo.engine.streams.ladder`.

        Parameters
        ----------
        agents
            An id, ids, or a (N,) boolean mask.
        stream
            One of `pool`.
        part
            0 for the body; ``1 + k`` for the motion of overlay layer k, see `overlay`.
        duration
            Seconds of the blend, for all or for each; 0 jumps.
        offset
            Poses behind the stream's head, for all or for each; None draws one for each agent.

        Raises
        ------
        ValueError
            For a baked crowd, agents that don't exist, a stale stream, or values out of range.
        """
        ask_streamed(self._ladder(), agents, stream, part, duration, offset)

    def transition_to_unique(
        self,
        agents: int | ArrayLike,
        unique: Unique,
        part: int = 0,
        *,
        duration: float | ArrayLike = BLEND_SECONDS,
    ) -> None:
        """Ask agents to blend to a unique; as `transition_to_streamed`, without an offset."""
        ask_unique(self._ladder(), agents, unique, part, duration)

    def set_focus(
        self, place: tuple[float, float, float] | None, *, radius: float = FOCUS_RADIUS
    ) -> None:
        """Say where people look, so that only agents farther away may ever jump.

        Parameters
        ----------
        place
            Metres in the stadium's frame; None, as at first, lets nobody jump.
        radius
            Metres around it.
        """
        if place is None:
            self._ladder().focus = None
            return
        if not np.isfinite(place).all() or np.shape(place) != (3,):
            raise ValueError(f"place is {place}, expected three finite numbers")
        if not radius >= 0:
            raise ValueError(f"radius is {radius}, expected metres >= 0")
        self._ladder().focus = Focus(place, radius)

    def _ladder(self) -> BlendLadder:
        if self.ladder is None:
            raise ValueError(
                f"this crowd {unstreamed(self.spec)} and can't blend; use poses='streams'"
            )
        return self.ladder
