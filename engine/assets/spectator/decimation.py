"""Triangle reduction that stays sound down to a hundred triangles.

The compiled simplifier of the build extra is fast, but it takes edges by a rising threshold and not
in the order of their error, which mangles a body below a few hundred triangles. So it only thins
the fine mesh out; this module does the rest, edge by edge from a queue.
"""

from __future__ import annotations

import heapq

import numpy as np
from numpy.typing import NDArray

from .meshing import Triangles, Vertices

_LEAST_TURN = 0.25
"""Cosine between a triangle's normals before and after a collapse that is still allowed."""


class _Collapser:
    """A closed surface whose edges are collapsed in the order of their quadric error."""

    def __init__(self, vertices: Vertices, triangles: Triangles) -> None:
        self.points = vertices.copy()
        self.faces: list[list[int] | None] = [list(t) for t in triangles.tolist()]
        self.around: list[set[int]] = [set() for _ in vertices]
        for index, face in enumerate(triangles.tolist()):
            for vertex in face:
                self.around[vertex].add(index)
        self.quadrics = _quadrics(vertices, triangles)
        self.version = [0] * len(vertices)
        self.left = len(triangles)
        self.queue: list[tuple[float, int, int, int, int]] = []
        edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
        for a, b in edges.tolist():
            self._push(a, b)

    def _best(self, a: int, b: int) -> tuple[float, NDArray[np.float64]]:
        quadric = self.quadrics[a] + self.quadrics[b]
        middle = (self.points[a] + self.points[b]) / 2
        # A little pull to the middle keeps the system solvable on flat and straight parts.
        pull = 1e-3 * np.trace(quadric[:3, :3]) + 1e-12
        place = np.linalg.solve(
            quadric[:3, :3] + pull * np.eye(3), pull * middle - quadric[:3, 3]
        )
        whole = np.append(place, 1.0)
        return float(whole @ quadric @ whole), place

    def _push(self, a: int, b: int) -> None:
        cost, _ = self._best(a, b)
        heapq.heappush(self.queue, (cost, a, b, self.version[a], self.version[b]))

    def _ring(self, vertex: int) -> set[int]:
        ring: set[int] = set()
        for index in self.around[vertex]:
            face = self.faces[index]
            assert face is not None
            ring.update(face)
        ring.discard(vertex)
        return ring

    def _allowed(self, a: int, b: int, place: NDArray[np.float64]) -> bool:
        """Whether the surface stays a surface and no triangle turns over."""
        if len(self._ring(a) & self._ring(b)) != 2 or self.left <= 4:
            return False
        for index in self.around[a] ^ self.around[b]:
            face = self.faces[index]
            assert face is not None
            old = self.points[face]
            new = np.array([place if v in (a, b) else self.points[v] for v in face])
            before, after = (np.cross(p[1] - p[0], p[2] - p[0]) for p in (old, new))
            size = np.linalg.norm(before) * np.linalg.norm(after)
            if size <= 0 or before @ after < _LEAST_TURN * size:
                return False
        return True

    def _collapse(self, a: int, b: int, place: NDArray[np.float64]) -> None:
        self.points[a] = place
        self.quadrics[a] += self.quadrics[b]
        for index in list(self.around[b]):
            face = self.faces[index]
            assert face is not None
            if a in face:
                for vertex in face:
                    self.around[vertex].discard(index)
                self.faces[index] = None
                self.left -= 1
            else:
                face[face.index(b)] = a
                self.around[a].add(index)
        self.around[b].clear()
        self.version[a] += 1
        self.version[b] += 1
        for neighbour in self._ring(a):
            self._push(min(a, neighbour), max(a, neighbour))

    def reduce(self, count: int) -> None:
        """Collapse edges until `count` triangles are left or none can be collapsed."""
        while self.left > count and self.queue:
            _, a, b, version_a, version_b = heapq.heappop(self.queue)
            if (version_a, version_b) != (self.version[a], self.version[b]) or not self.around[b]:
                continue
            _, place = self._best(a, b)
            if self._allowed(a, b, place):
                self._collapse(a, b, place)

    def surface(self) -> tuple[Vertices, Triangles]:
        """The triangles that are left and the vertices that they use."""
        faces = np.array([face for face in self.faces if face is not None], dtype=np.int64)
        used, faces = np.unique(faces, return_inverse=True)
        return self.points[used], faces.reshape(-1, 3)


def _quadrics(vertices: Vertices, triangles: Triangles) -> NDArray[np.float64]:
    """Sum of the squared distances to the planes around each vertex, by area: (V, 4, 4)."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    area = np.linalg.norm(normal, axis=1, keepdims=True)
    normal /= area + 1e-30
    plane = np.concatenate([normal, -np.einsum("ij,ij->i", normal, a)[:, None]], axis=1)
    outer = np.einsum("fi,fj,f->fij", plane, plane, area[:, 0])
    quadrics = np.zeros((len(vertices), 4, 4))
    for k in range(3):
        np.add.at(quadrics, triangles[:, k], outer)
    return quadrics


def stretched(vertices: Vertices, inverse: bool = False) -> Vertices:
    """Enlarge head and hands, so that decimation, which counts metres, spares them."""
    y = np.linspace(-0.1, 1.9, 801)
    head = 1 + 0.75 / (1 + np.exp(-(y - 1.50) / 0.012))
    far_y = np.concatenate([[y[0]], y[0] + np.cumsum((head[1:] + head[:-1]) / 2 * np.diff(y))])
    x = np.linspace(-0.1, 0.9, 801)
    hand = 1 + 0.45 / (1 + np.exp(-(x - 0.52) / 0.012))
    far_x = np.concatenate([[x[0]], x[0] + np.cumsum((hand[1:] + hand[:-1]) / 2 * np.diff(x))])
    far_x -= np.interp(0.0, x, far_x)
    side, across = np.sign(vertices[:, 0]), np.abs(vertices[:, 0])
    if inverse:
        old_y = np.interp(vertices[:, 1], far_y, y)
        scale = np.interp(old_y, y, head)
        old_x = np.interp(across / scale, far_x, x)
        depth = vertices[:, 2] / scale / np.interp(old_x, x, hand)
        return np.stack([side * old_x, old_y, depth], axis=1)
    scale = np.interp(vertices[:, 1], y, head)
    wide = side * np.interp(across, x, far_x) * scale
    deep = vertices[:, 2] * scale * np.interp(across, x, hand)
    return np.stack([wide, np.interp(vertices[:, 1], y, far_y), deep], axis=1)


def reduce_surface(
    vertices: Vertices, triangles: Triangles, counts: tuple[int, ...]
) -> list[tuple[Vertices, Triangles]]:
    """Reduce a closed surface to several numbers of triangles by quadric error.

    M. Garland and P. Heckbert, "Surface simplification using quadric error metrics" (1997), with
    their guards against flipped triangles and broken topology.

    Parameters
    ----------
    vertices, triangles
        (V, 3) float64 and (T, 3) int64 of a closed surface, a few thousand triangles.
    counts
        Triangles wanted, falling; more are left where no further edge can be collapsed.

    Returns
    -------
    list of (vertices, triangles)
        One closed surface for each count.
    """
    collapser = _Collapser(stretched(vertices), triangles)
    levels = []
    for count in counts:
        collapser.reduce(count)
        points, faces = collapser.surface()
        levels.append((stretched(points, inverse=True), faces))
    return levels
