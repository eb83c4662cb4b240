"""Triangle reduction that stays sound down to a hundred triangles.

The compiled simplifier of the build extra is fast, but it takes edges by a rising threshold and not
in the order of their error, which mangles a body below a few hundred triangles. So it only thins
the fine mesh out; this module does the rest, edge by edge from a queue.

It looks at the body in two poses at once, as a surface in six dimensions: a straight knee would
lose its vertices, the same knee bent keeps them. That is the generalised quadric error of
M. Garland and P. Heckbert, "Simplifying surfaces with color and texture" (1998), with a second
position in place of colours.
"""

from __future__ import annotations

import heapq

import numpy as np
from numpy.typing import NDArray

from .meshing import Triangles, Vertices

_LEAST_TURN = 0.25
"""Cosine between a triangle's normals before and after a collapse that is still allowed."""


class _Collapser:
    """A closed surface whose edges are collapsed in the order of their quadric error.

    `points` is (V, n): the first three of n coordinates are the surface in its first pose.
    """

    def __init__(self, points: Vertices, triangles: Triangles) -> None:
        self.points = points.copy()
        self.size = points.shape[1]
        self.faces: list[list[int] | None] = [list(t) for t in triangles.tolist()]
        self.around: list[set[int]] = [set() for _ in points]
        for index, face in enumerate(triangles.tolist()):
            for vertex in face:
                self.around[vertex].add(index)
        self.quadrics = _quadrics(points, triangles)
        self.version = [0] * len(points)
        self.left = len(triangles)
        self.queue: list[tuple[float, int, int, int, int]] = []
        edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
        for a, b in edges.tolist():
            self._push(a, b)

    def _best(self, a: int, b: int) -> tuple[float, NDArray[np.float64]]:
        n = self.size
        quadric = self.quadrics[a] + self.quadrics[b]
        middle = (self.points[a] + self.points[b]) / 2
        # A little pull to the middle keeps the system solvable on flat and straight parts.
        pull = 1e-3 * np.trace(quadric[:n, :n]) + 1e-12
        place = np.linalg.solve(quadric[:n, :n] + pull * np.eye(n), pull * middle - quadric[:n, n])
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
            old = self.points[face, :3]
            new = np.array([(place if v in (a, b) else self.points[v])[:3] for v in face])
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


def _quadrics(points: Vertices, triangles: Triangles) -> NDArray[np.float64]:
    """Squared distances to the planes around each vertex, by area: (V, n + 1, n + 1)."""
    count, n = points.shape
    p, q, r = (points[triangles[:, k]] for k in range(3))
    first = q - p
    length = np.linalg.norm(first, axis=1, keepdims=True)
    first = first / (length + 1e-30)
    second = (r - p) - first * np.sum(first * (r - p), axis=1, keepdims=True)
    height = np.linalg.norm(second, axis=1, keepdims=True)
    second = second / (height + 1e-30)
    along, across = (np.sum(p * e, axis=1, keepdims=True) for e in (first, second))
    planes = np.empty((len(triangles), n + 1, n + 1))
    planes[:, :n, :n] = (
        np.eye(n) - np.einsum("fi,fj->fij", first, first) - np.einsum("fi,fj->fij", second, second)
    )
    planes[:, :n, n] = along * first + across * second - p
    planes[:, n, :n] = planes[:, :n, n]
    planes[:, n, n] = np.sum(p * p, axis=1) - along[:, 0] ** 2 - across[:, 0] ** 2
    planes *= (length * height)[:, :, None]
    quadrics = np.zeros((count, n + 1, n + 1))
    for k in range(3):
        np.add.at(quadrics, triangles[:, k], planes)
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
    vertices: Vertices, bent: Vertices, triangles: Triangles, counts: tuple[int, ...]
) -> list[tuple[Vertices, Triangles]]:
    """Reduce a closed surface to several numbers of triangles by quadric error.

    Guards against flipped triangles and broken topology are those of M. Garland and P. Heckbert,
    "Surface simplification using quadric error metrics" (1997).

    Parameters
    ----------
    vertices, bent, triangles
        (V, 3) float64 in the bind pose, the same in a pose that bends what has to stay bendable,
        and (T, 3) int64 of a closed surface, a few thousand triangles.
    counts
        Triangles wanted, falling; more are left where no further edge can be collapsed.

    Returns
    -------
    list of (vertices, triangles)
        One closed surface in the bind pose for each count.
    """
    collapser = _Collapser(np.concatenate([stretched(vertices), bent], axis=1), triangles)
    levels = []
    for count in counts:
        collapser.reduce(count)
        points, faces = collapser.surface()
        levels.append((stretched(points[:, :3], inverse=True), faces))
    return levels
