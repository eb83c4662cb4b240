"""From where the stadium is looked at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(slots=True, eq=False)
class View:
    """An entity of its own: a camera as culling and drawing need it.

    Attributes
    ----------
    view, projection
        (4, 4) float32 column-vector matrices: stadium to camera space, camera to clip space.
    height
        Picture height in pixels.
    """

    view: NDArray[np.float32]
    projection: NDArray[np.float32]
    height: int

    @property
    def eye(self) -> NDArray[np.float32]:
        """(3,) position of the camera in the stadium's frame."""
        rotation = self.view[:3, :3]
        position: NDArray[np.float32] = -rotation.T @ self.view[:3, 3]
        return position
