"""Poses as figures of strokes, straight from the palettes of a pose store."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...engine.animation.skeleton import Skeleton
from ...engine.streams.pool import bind_positions
from .canvas import Canvas, Colour, Place

TURN = 0.45
"""Radians that figures are turned aside, so that arms before the body are seen."""
HEAD_HEIGHT = 0.12
"""Metres from the head's joint to the middle of the head."""


def joint_places(skeleton: Skeleton, palettes: NDArray[np.float32]) -> NDArray[np.float64]:
    """(J + 1, 2) places of the joints and the head's middle in the picture plane, metres, y up.

    Parameters
    ----------
    palettes
        (J, 3, 4) of one pose.
    """
    points = np.ones((skeleton.joint_count + 1, 4))
    points[:-1, :3] = bind_positions(skeleton)
    head = skeleton.index("head")
    points[-1, :3] = points[head, :3] + (0.0, HEAD_HEIGHT, 0.02)
    which = [*range(skeleton.joint_count), head]
    posed = np.einsum("jrc,jc->jr", palettes[which].astype(float), points)
    across = np.cos(TURN) * posed[:, 0] + np.sin(TURN) * posed[:, 2]
    return np.stack([across, posed[:, 1]], axis=1)


def draw_figure(
    canvas: Canvas,
    skeleton: Skeleton,
    palettes: NDArray[np.float32],
    feet: Place,
    metre: float,
    colours: Colour | Sequence[Colour],
) -> None:
    """Draw one pose.

    Parameters
    ----------
    palettes
        (J, 3, 4).
    feet
        Pixels, where the middle of the ground below the figure is.
    metre
        Pixels.
    colours
        One for all, or one for each joint.
    """
    places = joint_places(skeleton, palettes)
    of = [colours] * len(places) if isinstance(colours[0], int) else list(colours)
    pixels: list[Place] = [(feet[0] + metre * x, feet[1] - metre * y) for x, y in places]
    for joint, parent in enumerate(skeleton.parents):
        if parent > 0:  # the root is on the ground
            name = skeleton.names[joint]
            thick = 0.12 if name in ("spine", "chest") else 0.08
            thick = 0.055 if "hand" in name or "finger" in name or "toe" in name else thick
            canvas.line([pixels[parent], pixels[joint]], of[joint], max(metre * thick, 1.5))  # type: ignore[arg-type]
    head = skeleton.index("head")
    canvas.disc(pixels[-1], 0.105 * metre, of[head])  # type: ignore[arg-type]
