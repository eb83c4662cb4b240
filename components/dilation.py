"""What a crowd's offsets are doing."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class DilationRequest(NamedTuple):
    """Offsets that agents shall have, from the next pose tick on.

    Attributes
    ----------
    part, agents, targets, seconds
        Part, (K,) ids, (K,) offsets in poses, and how long it may take.
    """

    part: int
    agents: NDArray[np.int64]
    targets: NDArray[np.float32]
    seconds: float


@dataclass(slots=True, eq=False)
class Dilation:
    """Per crowd: requests that wait for the next pose tick, and what became of earlier ones.

    Attributes
    ----------
    waiting
        In the order in which they were made.
    started, arrived
        Changes of an agent's offset that began, and that reached their target.
    lengthened
        How many of them take longer than was asked for, since they would be seen otherwise.
    """

    waiting: list[DilationRequest] = field(default_factory=list)
    started: int = 0
    arrived: int = 0
    lengthened: int = 0
