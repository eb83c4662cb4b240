"""Cameras of other programs as the passes want them: in the crowd's own metres."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float32]


def as_matrix(name: str, given: Any) -> NDArray[np.float64]:
    """(4, 4) float64 column-vector matrix.

    Parameters
    ----------
    name
        Of the argument, for messages.
    given
        A NumPy matrix for column vectors, or 16 numbers column by column, such as a ``Mat4`` of
        pyglet.

    Raises
    ------
    ValueError
        For anything else, or numbers that are not finite.
    """
    try:
        numbers = np.asarray(given, np.float64)
    except (TypeError, ValueError):
        numbers = np.zeros(0)
    if numbers.shape == (16,):
        numbers = numbers.reshape(4, 4).T
    if numbers.shape != (4, 4) or not np.isfinite(numbers).all():
        raise ValueError(
            f"{name} is {given!r}, expected a (4, 4) matrix for column vectors, or 16 finite "
            "numbers column by column"
        )
    return numbers


def placed_view(view: Any, projection: Any, world_from_crowd: Any = None) -> tuple[Matrix, Matrix]:
    """View and projection for a crowd that is placed in a world.

    A uniform scale s, of the view or of the crowd, is moved behind the projection: with
    ``V' = V / s`` in the first three rows, ``P V = P diag(s, s, s, 1) V'``, and dividing by s,
    which means nothing to clip coordinates, leaves P with its last column divided. So the
    passes see a rigid view in the crowd's metres, and depths are those of the world.

    Parameters
    ----------
    view, projection, world_from_crowd
        World to camera, camera to clip, and the crowd's frame to the world; see `as_matrix`.

    Returns
    -------
    view, projection
        (4, 4) float32, from the crowd's frame.

    Raises
    ------
    ValueError
        If view and place are more than a rotation, a translation and a uniform scale, or the
        projection is no perspective one.
    """
    seen = as_matrix("view", view)
    if world_from_crowd is not None:
        seen = seen @ as_matrix("world_from_crowd", world_from_crowd)
    lens = as_matrix("projection", projection).copy()
    linear = seen[:3, :3]
    scale = float(np.cbrt(max(np.linalg.det(linear), 0.0)))
    rigid = scale > 1e-12 and np.allclose(
        linear @ linear.T, scale**2 * np.eye(3), atol=1e-4 * scale**2
    )
    if not rigid or not np.allclose(seen[3], (0.0, 0.0, 0.0, 1.0), atol=1e-6):
        raise ValueError(
            f"view @ world_from_crowd is {seen.tolist()}, expected a rotation, a translation and a "
            "uniform scale above 0"
        )
    depth = -lens[3, 2]
    if not depth > 0.0 or np.abs(lens[3, [0, 1, 3]]).max() > 1e-6 * depth or not lens[1, 1] > 0.0:
        raise ValueError(
            f"projection is {lens.tolist()}, expected a perspective one, of a camera that looks "
            "down -Z with y up"
        )
    seen[:3] /= scale
    lens /= depth
    lens[:, 3] /= scale
    return seen.astype(np.float32), lens.astype(np.float32)
