"""How finely an agent is drawn."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray


class Level(IntEnum):
    """Levels of detail, finest first: three meshes and the figure of strokes."""

    NEAR = 0
    MID = 1
    LOW = 2
    FAR = 3


def _nobody() -> tuple[NDArray[np.uint32], ...]:
    return tuple(np.zeros(0, np.uint32) for _ in Level)


@dataclass(slots=True, eq=False)
class Detail:
    """Per crowd: the agents in view at each level.

    Attributes
    ----------
    agents
        For each `Level` the (n,) uint32 ids of the agents drawn at it, ascending.
    """

    agents: tuple[NDArray[np.uint32], ...] = field(default_factory=_nobody)
