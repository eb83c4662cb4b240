"""How an agent is built."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True, eq=False)
class Body:
    """Per agent: its body type, and how its bind pose differs from others of the type.

    Attributes
    ----------
    kind
        (N,) uint8 body type: 0 is the character as it is, others are those of the crowd's pool.
    girth
        (N,) float32 metres by which the waist's surface lies farther out; negative is slimmer.
    head
        (N,) float32 by how much of its size the head is larger; negative is smaller.
    woman
        (N,) bool.
    choice
        (G, N) uint8 for each group of the character's mesh variants which of its choices an agent
        has, in the order of `variant_groups`; 255 is none.
    version
        Grows with every change.
    """

    kind: NDArray[np.uint8]
    girth: NDArray[np.float32]
    head: NDArray[np.float32]
    woman: NDArray[np.bool_]
    choice: NDArray[np.uint8]
    version: int = 0

    @classmethod
    def allocate(cls, agents: int) -> Body:
        """Everybody is built like the character, and nobody has made a choice yet."""
        zeros = np.zeros(agents, np.float32)
        return cls(
            np.zeros(agents, np.uint8),
            zeros,
            zeros.copy(),
            np.zeros(agents, np.bool_),
            np.zeros((0, agents), np.uint8),
        )
