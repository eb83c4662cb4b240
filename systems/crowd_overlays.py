"""What a crowd's users ask of overlays."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from ..components.overlays import NO_MASK
from ..engine.animation.controllers import Mask
from ..engine.crowd.agents import agent_ids, agent_values
from ..engine.crowd.spec import CrowdSpec
from ..engine.streams.overlaying import OverlayStage
from ..engine.streams.pool import POSE_RATE, Stream
from ..engine.streams.uniques import Unique

BLEND_SECONDS = 0.4
"""Length of a blend that nobody chose."""


class OverlayCalls:
    """Calls of a `Crowd` that lay motions over some joints."""

    __slots__ = ()

    overlays: OverlayStage | None
    spec: CrowdSpec

    @abstractmethod
    def __len__(self) -> int:
        """Number of agents."""

    def add_mask(self, name: str, mask: Mask | Mapping[str, float]) -> None:
        """Name the joints that an overlay can move, and how much of each.

        A crowd of humanoids has ``upper_body``, ``arms``, ``arm_l``, ``arm_r`` and ``head``.

        Parameters
        ----------
        name
            A new one.
        mask
            Weights of joints, 0 to 1; a plain mapping holds for the joints below as well.

        Raises
        ------
        ValueError
            For a baked crowd, unknown joints, weights out of range, or a name that is taken.
        """
        self._overlays().masks.add(name, mask)

    def overlay(
        self,
        agents: int | ArrayLike,
        motion: Stream | Unique,
        mask: str,
        *,
        layer: int = 0,
        weight: float | ArrayLike = 1.0,
        duration: float | ArrayLike = BLEND_SECONDS,
        offset: float | ArrayLike | None = None,
    ) -> None:
        """Let some joints of agents follow another motion, whatever the rest of them does.

        Asked again with the same mask, the joints blend from their motion to the new one; with
        another mask, the old overlay fades out before.

        Parameters
        ----------
        agents
            An id, ids, or a (N,) boolean mask.
        motion
            A stream of `pool` or a unique of `uniques`.
        mask
            Name of the joints' mask.
        layer
            0, or 1 for what is laid over that.
        weight
            How much they follow, above 0 up to 1, for all or for each.
        duration, offset
            As for `transition_to_streamed`.

        Raises
        ------
        ValueError
            For a baked crowd, agents that don't exist, a stale motion, an unknown mask or layer,
            or values out of range.
        """
        stage = self._overlays()
        ladder = stage.ladder
        if isinstance(motion, Stream):
            row = ladder.pool.row(motion)
            longest = float(ladder.pool.history[row] - 2)
        else:
            row, longest = ladder.uniques.row(motion), 0.0
        number = stage.masks.index(mask)
        ids = agent_ids(agents, len(self))
        given = np.nan if offset is None else offset
        offsets = agent_values("offset", given, len(ids), 0.0, longest, drawn=True)
        weights = agent_values("weight", weight, len(ids), 1e-3, 1.0)
        seconds = agent_values("duration", duration, len(ids), 0.0, np.inf)
        ticks = seconds * np.float32(POSE_RATE)
        rows = ladder.own_rows(ids, row)
        stage.ask(self._layer(layer), ids, number, rows, offsets, weights, ticks)

    def clear_overlay(
        self,
        agents: int | ArrayLike,
        *,
        layer: int = 0,
        duration: float | ArrayLike = BLEND_SECONDS,
    ) -> None:
        """Let agents' own motion have all their joints again; parameters as for `overlay`."""
        stage = self._overlays()
        ids = agent_ids(agents, len(self))
        seconds = agent_values("duration", duration, len(ids), 0.0, np.inf)
        ticks = seconds * np.float32(POSE_RATE)
        stage.ask(self._layer(layer), ids, NO_MASK, 0, 0.0, 0.0, ticks)

    def _layer(self, layer: int) -> int:
        layers = len(self._overlays().columns.mask)
        if not 0 <= layer < layers:
            raise ValueError(f"layer is {layer}, expected 0 to {layers - 1}")
        return layer

    def _overlays(self) -> OverlayStage:
        if self.overlays is None:
            kept = unstreamed(self.spec)
            raise ValueError(f"this crowd {kept} and has no overlays; use poses='streams'")
        return self.overlays


def unstreamed(spec: CrowdSpec) -> str:
    """What a crowd is that has no streams, in words."""
    return "is baked" if spec.poses == "baked" else "has no poses"
