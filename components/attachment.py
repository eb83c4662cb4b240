"""What hangs on a crowd's agents: hats, scarves, flags, and clusters of a body."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

MOST_PARTS = 32
"""Parts that a crowd can have: bits of `PartBits`."""


@dataclass(slots=True, eq=False)
class PartBits:
    """Per agent of a crowd: which of its parts it has.

    *Techniques 2022*, 4.2: clearing a part's bit removes the part.

    Attributes
    ----------
    bits
        (N,) uint32; bit k is that of the part with `Attachment.bit` k.
    """

    bits: NDArray[np.uint32]

    def has(self, bit: int) -> NDArray[np.bool_]:
        """(N,) agents that have the part of a bit."""
        found: NDArray[np.bool_] = (self.bits & np.uint32(1 << bit)) != 0
        return found


@dataclass(slots=True, eq=False)
class Attachment:
    """An entity of its own: a part, and where it is on the agents of its crowd.

    Attributes
    ----------
    name
        Unique in the crowd.
    parent
        Entity of the crowd.
    bit
        Number of its bit in the crowd's `PartBits`.
    joint
        Joint of the crowd's skeleton that it hangs on; -1 is the agent's own frame.
    place
        (3, 4) float32: from the part's model space to that of the joint's *palette*, so that the
        joint's palette times it is where the part is.
    follows_body
        Whether the part is skinned by the poses of the body itself.
    """

    name: str
    parent: int
    bit: int
    joint: int = -1
    place: NDArray[np.float32] = field(default_factory=lambda: np.eye(3, 4, dtype=np.float32))
    follows_body: bool = False
