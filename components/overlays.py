"""What is laid over an agent's motion: some joints follow another one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NO_MASK = -1
NO_REQUEST = -2


@dataclass(slots=True, eq=False)
class Overlays:
    """Per layer and agent: which joints follow the layer's motion, how much, and what is asked.

    Layer k's motion itself, with its offset and its blends, is part ``1 + k`` of `AgentAnimID` and
    `Transition`. Its weight goes smoothly from `start` to `target`.

    Attributes
    ----------
    mask
        (L, N) int16 mask of the crowd's mask table; -1 where nothing is laid over.
    start, target
        (L, N) float32 weights, 0 to 1.
    begin
        (L, N) float64 pose tick at which the weight begins to change.
    duration
        (L, N) float32 pose ticks that it takes.
    next_mask
        (L, N) int16 mask of the last request that has not begun; -1 asks for none, -2 is no
        request.
    next_row, next_offset
        (L, N) int32 and float32: its row of the pose store and offset in poses (NaN is drawn).
    next_weight, next_duration
        (L, N) float32: its weight, and pose ticks to get there.
    version
        Grows with every change that drawing must know.
    """

    mask: NDArray[np.int16]
    start: NDArray[np.float32]
    target: NDArray[np.float32]
    begin: NDArray[np.float64]
    duration: NDArray[np.float32]
    next_mask: NDArray[np.int16]
    next_row: NDArray[np.int32]
    next_offset: NDArray[np.float32]
    next_weight: NDArray[np.float32]
    next_duration: NDArray[np.float32]
    version: int = 0

    @classmethod
    def allocate(cls, layers: int, agents: int) -> Overlays:
        """Nothing is laid over and nothing is asked for."""
        shape = (layers, agents)
        return cls(
            mask=np.full(shape, NO_MASK, np.int16),
            start=np.zeros(shape, np.float32),
            target=np.zeros(shape, np.float32),
            begin=np.zeros(shape, np.float64),
            duration=np.zeros(shape, np.float32),
            next_mask=np.full(shape, NO_REQUEST, np.int16),
            next_row=np.zeros(shape, np.int32),
            next_offset=np.zeros(shape, np.float32),
            next_weight=np.zeros(shape, np.float32),
            next_duration=np.zeros(shape, np.float32),
        )
