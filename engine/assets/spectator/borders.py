"""Cut triangles along the zero line of a field, so that materials meet in a crisp line.

Decimated triangles know nothing of sleeves and hairlines; a triangle that straddles one is split
exactly on it. Vertices close to the line are first moved onto it, which avoids slivers.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .meshing import Triangles, Vertices, rim_vertices

_ON_LINE = 1e-7


def _crossing_edges(
    triangles: Triangles, values: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    a, b = values[edges].T
    edges = edges[a * b < 0]
    a, b = values[edges].T
    return edges, a / (a - b)


def _snap(
    vertices: Vertices, triangles: Triangles, values: NDArray[np.float64], snap: float
) -> tuple[Vertices, NDArray[np.float64]]:
    """Move vertices onto the line where it crosses one of their edges close by."""
    vertices, values = vertices.copy(), values.copy()
    rim = np.zeros(len(vertices), dtype=bool)
    rim[rim_vertices(triangles)] = True
    edges, along = _crossing_edges(triangles, values)
    best: dict[int, tuple[float, int]] = {}
    for (a, b), t in zip(edges.tolist(), along.tolist(), strict=True):
        for vertex, other, way in ((a, b, t), (b, a, 1 - t)):
            may_move = not rim[vertex] or rim[other]
            if may_move and way < min(snap, best.get(vertex, (1.0, 0))[0]):
                best[vertex] = (way, other)
    moved: set[int] = set()
    for vertex, (way, other) in sorted(best.items(), key=lambda item: item[1]):
        if other not in moved:
            vertices[vertex] += way * (vertices[other] - vertices[vertex])
            values[vertex] = 0.0
            moved.add(vertex)
    return vertices, values


def cut(
    vertices: Vertices, triangles: Triangles, values: NDArray[np.floating], snap: float
) -> tuple[Vertices, Triangles, NDArray[np.bool_], NDArray[np.int64]]:
    """Split the triangles of a surface where a field changes its sign.

    Parameters
    ----------
    vertices, triangles
        (V, 3) and (T, 3); every vertex is shared by the triangles around it.
    values
        (V,) the field at the vertices, taken as linear along edges.
    snap
        A vertex that is nearer to the line than this share of an edge is moved onto it.

    Returns
    -------
    vertices, triangles
        (V', 3) with the old vertices first, and (T', 3) with the same winding; a closed surface
        stays closed.
    inside
        (T',) whether the field is negative on the triangle.
    source
        (T',) the triangle that each one came from.
    """
    field = np.where(np.abs(values) < _ON_LINE, 0.0, values).astype(np.float64)
    vertices, field = _snap(vertices, triangles, field, snap)
    edges, along = _crossing_edges(triangles, field)
    start, end = vertices[edges[:, 0]], vertices[edges[:, 1]]
    middle = {(a, b): len(vertices) + k for k, (a, b) in enumerate(map(tuple, edges.tolist()))}
    vertices = np.concatenate([vertices, start + along[:, None] * (end - start)])
    field = np.concatenate([field, np.zeros(len(edges))])
    result: list[tuple[int, int, int]] = []
    source: list[int] = []
    for index, corners in enumerate(triangles.tolist()):
        pieces = _split(corners, middle)
        result += pieces
        source += [index] * len(pieces)
    pieces_array = np.array(result, dtype=np.int64)
    inside = field[pieces_array].min(axis=1) < 0
    return vertices, pieces_array, inside, np.array(source, dtype=np.int64)


def _split(corners: list[int], middle: dict[tuple[int, int], int]) -> list[tuple[int, int, int]]:
    """The pieces of one triangle, given the new vertex of each cut edge."""
    cuts = [
        middle.get((min(a, b), max(a, b)))
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    ]
    count = sum(new is not None for new in cuts)
    if count == 0:
        return [(corners[0], corners[1], corners[2])]
    if count == 1:
        k = next(i for i, new in enumerate(cuts) if new is not None)
        a, b, c = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
        new = cuts[k]
        assert new is not None
        return [(a, new, c), (new, b, c)]
    # Two cut edges share the corner that lies alone on its side of the line.
    k = next(i for i in range(3) if cuts[i] is not None and cuts[i - 1] is not None)
    a, b, c = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
    ab, ca = cuts[k], cuts[k - 1]
    assert ab is not None
    assert ca is not None
    return [(a, ab, ca), (ab, b, ca), (b, c, ca)]
