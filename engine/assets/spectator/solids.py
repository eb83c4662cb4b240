"""What meshing asks of any solid: which way its surface looks, and how open it is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .shapes import Field

Distance = Callable[[NDArray[np.floating]], Field]
"""(N, 3) points of either side to (N,) signed metres."""


def surface_normals(
    distance: Distance, points: NDArray[np.floating], step: float = 0.003
) -> NDArray[np.float32]:
    """Unit gradient of the distance at (N, 3) points, outward, by central differences."""
    base = np.asarray(points, dtype=np.float32)
    gradient = np.empty_like(base)
    for axis in range(3):
        shift = np.zeros(3, dtype=np.float32)
        shift[axis] = step
        gradient[:, axis] = distance(base + shift) - distance(base - shift)
    gradient /= np.linalg.norm(gradient, axis=1, keepdims=True) + np.float32(1e-12)
    return gradient


def occlusion(
    distance: Distance, points: NDArray[np.floating], normals: NDArray[np.float32]
) -> Field:
    """How open the surface is, 0 (enclosed) to 1: the distance field walked along the normal.

    Ambient occlusion after Evans, "Fast approximations for global illumination on dynamic scenes"
    (2006): what the distance at a few steps lacks to the length of the step.
    """
    base = np.asarray(points, dtype=np.float32)
    closed = np.zeros(len(base), dtype=np.float32)
    for reach, weight in ((0.02, 0.30), (0.05, 0.30), (0.10, 0.25), (0.18, 0.15)):
        lack = reach - distance(base + normals * np.float32(reach))
        closed += np.float32(weight / reach) * np.maximum(lack, 0.0)
    result: Field = np.clip(1.0 - closed, 0.0, 1.0)
    return result
