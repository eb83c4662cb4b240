"""A part of a crowd as its users hold it: one entity, and the calls that act on it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..components import Attachment, Dilation, DilationRequest, PartBits
from ..engine.assets.character import Character
from ..engine.crowd.agents import agent_ids
from ..engine.crowd.hooks import compose, grown
from ..engine.streams.asking import ask_dilation, ask_streamed, ask_unique
from ..engine.streams.blending import agent_palettes
from ..engine.streams.ladder import BlendLadder
from ..engine.streams.pool import Stream, StreamPool
from ..engine.streams.uniques import Unique, UniquePool
from .crowd import Crowd
from .crowd_overlays import BLEND_SECONDS

DRIFT_SECONDS = 4.0
"""How long agents take to drift apart on the streams of a part that nobody had."""


@dataclass(slots=True, eq=False)
class Part:
    """One part of a crowd: an entity, and its components at hand.

    Attributes
    ----------
    crowd, entity, character, attachment
        What it hangs on, the entity, its meshes, and where it hangs.
    ladder, dilation
        Streams, blends and requests for them; None for a part that follows the body.
    """

    crowd: Crowd
    entity: int
    character: Character
    attachment: Attachment
    bits: PartBits
    ladder: BlendLadder | None = None
    dilation: Dilation | None = None
    _resting: NDArray[np.int64] | None = None

    @property
    def name(self) -> str:
        """What the crowd knows it by."""
        return self.attachment.name

    @property
    def pool(self) -> StreamPool:
        """Its streams; ValueError for a part that follows the body."""
        return self._ladder().pool

    @property
    def uniques(self) -> UniquePool:
        """Its motions that are not shared; ValueError for a part that follows the body."""
        return self._ladder().uniques

    @property
    def visible(self) -> NDArray[np.bool_]:
        """(N,) agents that have the part; it is drawn on those of them that are there."""
        self._check()
        return self.bits.has(self.attachment.bit)

    def attach(self, agents: int | ArrayLike) -> None:
        """Give the part to agents: an id, ids, or a (N,) boolean mask."""
        self._check()
        ids = agent_ids(agents, len(self.crowd))
        if len(ids):
            self.bits.bits[ids] |= np.uint32(1 << self.attachment.bit)
            self._wake()

    def detach(self, agents: int | ArrayLike) -> None:
        """Take the part from agents: an id, ids, or a (N,) boolean mask.

        Streams of its own rest while nobody has the part, and cost nothing then.
        """
        self._check()
        ids = agent_ids(agents, len(self.crowd))
        self.bits.bits[ids] &= ~np.uint32(1 << self.attachment.bit)
        self._rest()

    def streams(self, clip: str) -> tuple[Stream, ...]:
        """The live streams that play a clip; ValueError lists the known names if there is none."""
        pool = self.pool
        index = pool.bank.index(clip)
        rows = np.flatnonzero(pool.alive & (pool.clip == index))
        return tuple(pool.stream(int(row)) for row in rows)

    def transition_to_streamed(
        self,
        agents: int | ArrayLike,
        stream: Stream,
        *,
        duration: float | ArrayLike = BLEND_SECONDS,
        offset: float | ArrayLike | None = None,
    ) -> None:
        """Let the part of agents blend to a stream of `pool`; as `Crowd.transition_to_streamed`."""
        ask_streamed(self._ladder(), agents, stream, 0, duration, offset)

    def transition_to_unique(
        self,
        agents: int | ArrayLike,
        unique: Unique,
        *,
        duration: float | ArrayLike = BLEND_SECONDS,
    ) -> None:
        """Let the part of agents blend to one of `uniques`; as `Crowd.transition_to_unique`."""
        ask_unique(self._ladder(), agents, unique, 0, duration)

    def dilate(
        self, agents: NDArray[np.int64], targets: NDArray[np.float32], seconds: float
    ) -> None:
        """Let the part of agents play other offsets behind its streams; as `Crowd.dilate`."""
        pool = self.pool
        assert self.dilation is not None
        ask_dilation(self.dilation, pool, len(self.crowd), agents, targets, seconds)

    def hooks(self, agents: int | ArrayLike, tick: int, alpha: float = 1.0) -> NDArray[np.float32]:
        """Where the part is on agents, evaluated on the CPU.

        Parameters
        ----------
        agents
            An id, ids, or a (N,) boolean mask.
        tick, alpha
            Pose tick and the fraction of it that has passed.

        Returns
        -------
        (K, 3, 4) float32 from the part's model space to that of the agent's character
        """
        self._check()
        ids = agent_ids(agents, len(self.crowd))
        attachment = self.attachment
        if attachment.joint < 0:
            return np.broadcast_to(attachment.place, (len(ids), 3, 4)).copy()
        joints = self.crowd.palettes(ids, tick, alpha)[:, attachment.joint]
        physique = self.crowd.physique
        assert physique is not None
        morphs = physique.morphs
        growth = self.crowd.body.head[ids] * morphs.head[attachment.joint]
        return compose(joints, grown(attachment.place, growth, morphs.head_centre))

    def palettes(
        self, agents: int | ArrayLike, tick: int, alpha: float = 1.0
    ) -> NDArray[np.float32]:
        """What the part shows on agents, evaluated on the CPU; parameters as for `hooks`.

        Returns
        -------
        (K, J, 3, 4) float32 palettes that lead to the model space of the *crowd's* character
        """
        self._check()
        ids = agent_ids(agents, len(self.crowd))
        if self.attachment.follows_body:
            return self.crowd.palettes(ids, tick, alpha)
        ladder = self._ladder()
        own = agent_palettes(ladder.pool, ladder.anim, ladder.transition, 0, ids, tick, alpha)
        return compose(self.hooks(ids, tick, alpha)[:, None], own)

    def columns(self) -> list[Any]:
        """Components whose columns are part of the crowd's state."""
        ladder = self.ladder
        return [self.bits, *((ladder.anim, ladder.transition) if ladder else ())]

    def _ladder(self) -> BlendLadder:
        self._check()
        if self.ladder is None:
            raise ValueError(f"part '{self.name}' follows the body and has no motions of its own")
        return self.ladder

    def _check(self) -> None:
        if self.crowd.parts.get(self.name) is not self:
            raise ValueError(f"part '{self.name}' was removed")

    def _shares_pool(self) -> bool:
        return self.ladder is None or self.ladder.pool is self.crowd.pool

    def _rest(self) -> None:
        if self._resting is None and not self._shares_pool() and not self.visible.any():
            pool = self.pool
            self._resting = np.flatnonzero(pool.running)
            for row in self._resting:
                pool.stop(pool.stream(int(row)))

    def _wake(self) -> None:
        if self._resting is None:
            return
        pool, anim, rows = self.pool, self._ladder().anim, self._resting
        self._resting = None
        rows = rows[pool.alive[rows] & ~pool.running[rows]]
        for row in rows:
            pool.run(pool.stream(int(row)))
        # The streams have no past now: their agents begin at the heads and drift apart.
        agents = np.flatnonzero(np.isin(anim.row[0], rows))
        assert self.dilation is not None
        request = DilationRequest(0, agents, anim.target[0, agents].copy(), DRIFT_SECONDS)
        self.dilation.waiting.append(request)
