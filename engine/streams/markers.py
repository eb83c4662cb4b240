"""The few joints whose positions the pose store keeps beside its palettes.

The farthest level of detail draws only these. A palette takes the bind pose's joint to where the
joint is, so positions follow from palettes, mixed ones and a user's own included.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Markers:
    """Joints and where the bind pose has them.

    Parameters
    ----------
    joints
        (K,) int64.
    bind
        (K, 3) float32 model-space positions, metres.
    """

    joints: NDArray[np.int64]
    bind: NDArray[np.float32]

    def places(self, palettes: NDArray[np.float32]) -> NDArray[np.float32]:
        """(N, K, 3) positions in poses given as (N, J, 3, 4) palettes."""
        chosen = palettes[:, self.joints]
        linear = np.einsum("nkrc,kc->nkr", chosen[..., :3], self.bind)
        placed: NDArray[np.float32] = linear + chosen[..., 3]
        return placed
