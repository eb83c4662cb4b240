"""Which seat a ray meets: what the mouse points at."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

REACH = 0.9
"""Metres between the ray and a spectator's chest within which the ray meets the spectator."""


def pick_seat(
    position: NDArray[np.float32], origin: NDArray[np.float64], direction: NDArray[np.float64]
) -> int | None:
    """Index of the first seat that a ray passes.

    Parameters
    ----------
    position
        (3, N) float32 places of the feet, metres.
    origin, direction
        (3,) start and unit direction of the ray.

    Returns
    -------
    int or None
        The nearest seat along the ray among those whose spectator's chest it passes within
        `REACH`; None if there is none.
    """
    to = position - origin.astype(np.float32)[:, None]
    to[1] += 1.0
    along = direction.astype(np.float32) @ to
    squared = np.einsum("kn,kn->n", to, to) - along * along
    met = np.flatnonzero((along > 0.0) & (squared < REACH * REACH))
    return int(met[np.argmin(along[met])]) if len(met) else None
