"""From a solid's signed distance to triangles, coarser ones and mirrored ones.

Meshing works on the left half, x >= 0, and mirrors the result, so the spectator is exactly
symmetric and its surface closes at x = 0.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .solids import Distance

Vertices = NDArray[np.float64]
Triangles = NDArray[np.int64]

Box = tuple[tuple[float, float, float], tuple[float, float, float]]
"""Lowest and highest corner."""

BODY_BOX: Box = ((0.0, -0.02, -0.20), (0.74, 1.78, 0.24))
HEAD_BOX: Box = ((0.0, 1.22, -0.24), (0.20, 1.84, 0.16))


def half_surface(distance: Distance, step: float, box: Box) -> tuple[Vertices, Triangles]:
    """Marching cubes over the left half of a solid with cubes of `step` metres.

    The fine grid is only evaluated near the surface: a grid four times coarser tells where.

    Returns
    -------
    vertices, triangles
        (V, 3) float64 with x >= 0 and (T, 3) int64, counter-clockwise seen from outside; the open
        edge lies at x = 0.
    """
    from scipy.ndimage import zoom
    from skimage.measure import marching_cubes

    coarse = 4 * step
    corner, far = np.array(box)
    shape = np.ceil((far - corner) / coarse).astype(int) + 1
    axes = [low + coarse * np.arange(n) for low, n in zip(corner, shape, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    rough = distance(grid.reshape(-1, 3)).reshape(shape)
    fine_shape = (shape - 1) * 4 + 1
    volume = zoom(rough, fine_shape / shape, order=1, grid_mode=False, mode="nearest")
    near = np.argwhere(np.abs(volume) < 1.5 * coarse)
    volume[tuple(near.T)] = distance(corner + step * near)
    vertices, triangles, _, _ = marching_cubes(
        volume, 0.0, spacing=(step, step, step), gradient_direction="ascent"
    )
    vertices = vertices.astype(np.float64) + corner
    triangles = triangles.astype(np.int64)
    if signed_volume(vertices, triangles) < 0:
        triangles = triangles[:, ::-1].copy()
    return vertices, triangles


def signed_volume(vertices: Vertices, triangles: Triangles) -> float:
    """Cubic metres enclosed by a closed surface, positive where it is wound outward."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def thin_out(vertices: Vertices, triangles: Triangles, count: int) -> tuple[Vertices, Triangles]:
    """Bring a fine closed surface down to a few thousand triangles, quickly."""
    import fast_simplification

    if len(triangles) <= count:
        return vertices, triangles

    points, faces = fast_simplification.simplify(
        vertices, triangles.astype(np.int32), target_count=count, agg=4
    )
    return np.asarray(points, dtype=np.float64), np.asarray(faces, dtype=np.int64)


def rim_vertices(triangles: Triangles) -> NDArray[np.int64]:
    """Vertices on the open edge of a surface."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    unique, uses = np.unique(edges, axis=0, return_counts=True)
    return np.unique(unique[uses == 1])


def mirrored(vertices: Vertices, triangles: Triangles) -> tuple[Vertices, Triangles]:
    """Both halves as one closed surface; the second half of the triangles is the mirror image."""
    count = len(vertices)
    rim = rim_vertices(triangles)
    own = np.ones(count, dtype=bool)
    own[rim] = False
    image = np.arange(count)
    image[own] = count + np.arange(int(own.sum()))
    other = vertices[own] * np.array([-1.0, 1.0, 1.0])
    return (
        np.concatenate([vertices, other]),
        np.concatenate([triangles, image[triangles][:, ::-1]]),
    )
