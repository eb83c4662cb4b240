"""Reducing a surface by quadric error, and saying where each vertex went.

M. Garland and P. Heckbert, "Surface simplification using quadric error metrics" (1997), done by the
compiled `fast_simplification`. It ignores what lies open: collapsing along a flat strip costs
nothing, so capes, visors and bands would shrink to nothing. Here fins stand on all open edges; a
fin's plane makes it costly to move its edge, and the fin itself costs nothing to collapse.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def collapse_edges(points: Floats, triangles: Ints, target: int) -> tuple[Ints, Floats]:
    """Collapse edges until about `target` triangles are left.

    Parameters
    ----------
    points, triangles
        (W, 3) float64 places and (T, 3) int64, each with three different corners.
    target
        Triangles wanted; a surface that has no more stays as it is.

    Returns
    -------
    into, places
        (W,) int64: the vertex into which each vertex was drawn, itself if it stayed; and (W, 3)
        float64 places of those that stayed. A triangle is left if its corners, put through `into`,
        still differ.
    """
    import fast_simplification

    count = len(points)
    if len(triangles) <= target:
        return np.arange(count), points.copy()
    fins, tips = _fins(points, triangles)
    faces = np.concatenate([triangles, fins])
    moved_points, _, collapses = fast_simplification.simplify(
        np.concatenate([points, tips]),
        faces.astype(np.int32),
        target_count=target,
        return_collapses=True,
    )
    into = _follow(count + len(tips), np.asarray(collapses, np.int64).reshape(-1, 2))
    a, b, c = into[faces].T
    left = np.flatnonzero((a != b) & (b != c) & (c != a))
    # The simplifier keeps the vertices of what is left, in their old order.
    names = np.unique(into[faces[left]])
    if len(names) != len(moved_points):
        return np.arange(count), points.copy()
    places = np.concatenate([points, tips])
    places[names] = moved_points
    # A vertex that was drawn into the tip of a fin stands for it from now on.
    stands = np.arange(count + len(tips))
    drawn = np.flatnonzero(into[:count] >= count)
    stands[into[drawn[::-1]]] = drawn[::-1]
    into = stands[into]
    places[stands] = places.copy()
    return into[:count], places[:count]


def _follow(count: int, collapses: Ints) -> Ints:
    """The last of the vertices into which each of `count` vertices was drawn, step by step."""
    into = np.arange(count)
    into[collapses[:, 1]] = collapses[:, 0]
    while True:
        further = into[into]
        if np.array_equal(further, into):
            return into
        into = further


def _fins(points: Floats, triangles: Ints) -> tuple[Ints, Floats]:
    """Triangles (F, 3) that stand on the open edges of a surface, and their (F, 3) tips."""
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, number, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    open_edges = np.flatnonzero(count[number.reshape(-1)] == 1)
    a, b, c = (points[triangles[open_edges // 3, corner]] for corner in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    start, end = edges[open_edges].T
    length = np.linalg.norm(points[end] - points[start], axis=1, keepdims=True)
    tips = (points[start] + points[end]) / 2.0 + length * normal
    return np.stack([end, start, len(points) + np.arange(len(start))], axis=1), tips
