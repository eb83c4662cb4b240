"""The static geometry that the stadium pass draws, and the builder that collects it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

F64 = NDArray[np.float64]

UP = np.array([0.0, 1.0, 0.0])

_LEAST_AREA = 1e-7


class Surface(IntEnum):
    """What a vertex belongs to, so that one shader can treat surfaces differently.

    ``SEATS`` has u in seats: an integer is the border between two of them. ``GRASS`` has uv =
    (x, z) in metres from the centre of the pitch. Everywhere else uv is metres along and across.
    """

    CONCRETE = 0
    SEATS = 1
    GRASS = 2
    LINE = 3
    BOARD = 4
    ROOF = 5
    WALL = 6
    STAIRS = 7
    STEEL = 8
    GROUND = 9


@dataclass(frozen=True, slots=True, eq=False)
class StadiumMesh:
    """Triangles of everything that does not move.

    Parameters
    ----------
    positions, normals
        (V, 3) float32, metres; normals have length 1.
    uvs
        (V, 2) float32, see `Surface`.
    colors
        (V, 4) uint8 sRGB albedo, alpha 255.
    surface
        (V,) uint8 `Surface`.
    triangles
        (T, 3) uint32, counter-clockwise seen from the side that the normals point to.
    """

    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    uvs: NDArray[np.float32]
    colors: NDArray[np.uint8]
    surface: NDArray[np.uint8]
    triangles: NDArray[np.uint32]


class MeshBuilder:
    """Collects strips and boxes; `build` joins them."""

    def __init__(self) -> None:
        """Start with nothing."""
        self._parts: list[tuple[F64, F64, F64, NDArray[np.uint8], int]] = []
        self._triangles: list[NDArray[np.int64]] = []
        self._count = 0

    def strip(
        self,
        first: ArrayLike,
        second: ArrayLike,
        normal: ArrayLike,
        surface: Surface,
        color: ArrayLike,
        *,
        u: ArrayLike | None = None,
        v: tuple[float, float] | None = None,
    ) -> None:
        """Quads between two lines of points, for many strips at once.

        Parameters
        ----------
        first, second
            (..., P, 3) the two edges, metres.
        normal
            Broadcasts to the same shape; the visible side. The winding follows it.
        color
            sRGB (r, g, b), broadcasts to (..., P, 3).
        u
            Broadcasts to (..., P); metres along the first edge if left out.
        v
            At the first and the second edge; 0 and the distance between them if left out.
        """
        a, b = np.asarray(first, dtype=np.float64), np.asarray(second, dtype=np.float64)
        a, b = np.broadcast_arrays(a, b)
        shape = a.shape[:-1]
        if u is None:
            steps = np.linalg.norm(np.diff(a, axis=-2), axis=-1)
            u = np.concatenate([np.zeros((*shape[:-1], 1)), np.cumsum(steps, axis=-1)], axis=-1)
        width = np.linalg.norm(b - a, axis=-1)
        across = np.stack(
            [np.zeros(shape), width] if v is None else [np.full(shape, v[0]), np.full(shape, v[1])],
            axis=-1,
        )
        along = np.broadcast_to(np.asarray(u, dtype=np.float64)[..., None], across.shape)
        points = np.stack([a, b], axis=-2)
        normals = np.broadcast_to(np.asarray(normal, dtype=np.float64)[..., None, :], points.shape)
        colors = np.broadcast_to(np.asarray(color, dtype=np.uint8)[..., None, :], points.shape)
        index = np.arange(points.size // 3).reshape(*shape, 2)
        corners = [index[..., :-1, 0], index[..., 1:, 0], index[..., 1:, 1], index[..., :-1, 1]]
        quads = np.stack(corners, axis=-1).reshape(-1, 4)
        self.add(
            points.reshape(-1, 3),
            normals.reshape(-1, 3),
            np.stack([along, across], axis=-1).reshape(-1, 2),
            colors.reshape(-1, 3),
            surface,
            np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]),
        )

    def add(
        self,
        points: F64,
        normals: F64,
        uvs: F64,
        colors: NDArray[np.uint8],
        surface: Surface,
        triangles: NDArray[np.int64],
    ) -> None:
        """Add (T, 3) triangles over (V, ...) vertices, with either winding."""
        self._triangles.append(triangles + self._count)
        self._parts.append((points, normals, uvs, colors, int(surface)))
        self._count += len(points)

    def quad(
        self, corners: ArrayLike, normal: ArrayLike, surface: Surface, color: ArrayLike
    ) -> None:
        """One flat quad; corners (4, 3) in order round it, u from the first to the second."""
        p = np.asarray(corners, dtype=np.float64)
        self.strip(p[[0, 1]], p[[3, 2]], normal, surface, color)

    def beam(
        self,
        start: ArrayLike,
        end: ArrayLike,
        width: float,
        height: float,
        surface: Surface,
        color: ArrayLike,
    ) -> None:
        """Boxes along lines (..., 3), `width` sideways and `height` upward, centred on the line."""
        a, b = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
        axis = b - a
        axis = axis / np.linalg.norm(axis, axis=-1, keepdims=True)
        upright = np.abs(axis[..., 1:2]) > 0.9
        side = np.cross(axis, np.where(upright, [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]))
        side /= np.linalg.norm(side, axis=-1, keepdims=True)
        up = np.cross(side, axis)
        s, t = 0.5 * width * side, 0.5 * height * up
        ring = [
            (-s - t, -s + t, -side),
            (-s + t, s + t, up),
            (s + t, s - t, side),
            (s - t, -s - t, -up),
        ]
        for from_, to, normal in ring:
            first = np.stack([a + from_, b + from_], axis=-2)
            second = np.stack([a + to, b + to], axis=-2)
            self.strip(first, second, normal[..., None, :], surface, color)
        for point, normal in ((a, -axis), (b, axis)):
            first = np.stack([point - s - t, point + s - t], axis=-2)
            second = np.stack([point - s + t, point + s + t], axis=-2)
            self.strip(first, second, normal[..., None, :], surface, color)

    def build(self) -> StadiumMesh:
        """Everything so far as one mesh.

        Triangles are turned to the side of their normals; those without an area are dropped, and
        so are vertices that no triangle uses.
        """
        points, normals, uvs, colors = (
            np.concatenate([part[i] for part in self._parts]) for i in range(4)
        )
        surface = np.repeat(
            np.array([part[4] for part in self._parts], dtype=np.uint8),
            [len(part[0]) for part in self._parts],
        )
        triangles = np.concatenate(self._triangles)
        a, b, c = (points[triangles[:, i]] for i in range(3))
        face = np.cross(b - a, c - a)
        away = np.einsum("ij,ij->i", face, normals[triangles[:, 0]]) < 0.0
        triangles = np.where(away[:, None], triangles[:, ::-1], triangles)
        triangles = triangles[np.einsum("ij,ij->i", face, face) > _LEAST_AREA**2]
        used = np.zeros(len(points), dtype=bool)
        used[triangles] = True
        number = np.cumsum(used) - 1
        return StadiumMesh(
            positions=points[used].astype(np.float32),
            normals=normals[used].astype(np.float32),
            uvs=uvs[used].astype(np.float32),
            colors=np.concatenate(
                [colors[used], np.full((int(used.sum()), 1), 255)], axis=1
            ).astype(np.uint8),
            surface=surface[used],
            triangles=number[triangles].astype(np.uint32),
        )
