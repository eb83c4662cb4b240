"""Body types: the same motions on other proportions.

A type scales the bones of a skeleton, and the flesh about each joint with the bone that begins
there. Its palettes are those of its own joints, times what turns the character's bind pose into
the type's, so one mesh serves all types.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .skeleton import Skeleton


@dataclass(frozen=True, slots=True, eq=False)
class BodyType:
    """Proportions of one type of body.

    Parameters
    ----------
    name
        Such as ``"child"``.
    bones
        (J,) float32 factor on each joint's translation from its parent.
    flesh
        (J,) float32 factor on what each joint moves, about the joint's place in the bind pose.

    Raises
    ------
    ValueError
        For factors that are not finite and positive.
    """

    name: str
    bones: NDArray[np.float32]
    flesh: NDArray[np.float32]

    def __post_init__(self) -> None:
        """Check the factors."""
        for what in ("bones", "flesh"):
            factors = getattr(self, what)
            if not (np.isfinite(factors) & (factors > 0)).all():
                raise ValueError(f"body type '{self.name}': {what} must be finite and above 0")

    def refit(self, skeleton: Skeleton) -> NDArray[np.float32]:
        """(J, 4, 4) float32 what a palette is multiplied with, from the right.

        Raises
        ------
        ValueError
            If the type has another number of joints.
        """
        count = skeleton.joint_count
        if self.bones.shape != (count,) or self.flesh.shape != (count,):
            raise ValueError(
                f"body type '{self.name}' has {len(self.bones)} bones and {len(self.flesh)} "
                f"flesh factors, but the skeleton has {count} joints"
            )
        bind = np.zeros((count, 4, 4))
        bind[:, :3], bind[:, 3, 3] = skeleton.inverse_bind, 1.0
        place = np.linalg.inv(bind)[:, :3, 3]
        out = np.zeros((count, 4, 4))
        out[:, [0, 1, 2], [0, 1, 2]] = self.flesh[:, None]
        out[:, :3, 3] = (1.0 - self.flesh[:, None]) * place
        out[:, 3, 3] = 1.0
        return out.astype(np.float32)
