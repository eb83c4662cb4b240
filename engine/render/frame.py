"""What every pass knows of the picture."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..gl.program import Program

SUN = np.array([0.42, 0.78, 0.46], np.float32) / np.float32(np.linalg.norm([0.42, 0.78, 0.46]))
"""Unit vector towards the sun, stadium frame."""


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """Camera, size and time of one picture.

    Parameters
    ----------
    view, projection
        (4, 4) float32 column-vector matrices.
    size
        Pixels (width, height) that are drawn to.
    tick, alpha
        Pose tick and the fraction of it that has passed.
    sun
        (3,) unit vector towards the sun.
    encode
        Whether shaders write sRGB instead of linear light; see `tifo.engine.gl.takes_srgb_bytes`.
    """

    view: NDArray[np.float32]
    projection: NDArray[np.float32]
    size: tuple[int, int]
    tick: int
    alpha: float
    sun: NDArray[np.float32] = field(default_factory=SUN.copy)
    encode: bool = False

    def apply(self, program: Program) -> None:
        """Set the uniforms of ``lib/frame.glsl`` and use the program."""
        program.use()
        program["view"] = self.view
        program["projection"] = self.projection
        program["eye"] = -self.view[:3, :3].T @ self.view[:3, 3]
        program["sun"] = self.sun
        program["encode"] = self.encode
