"""Round solids that props are put together from: capsules, cylinders and discs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .prop import Array, Faces, grid_faces


def capsule(
    start: Sequence[float] | Array,
    end: Sequence[float] | Array,
    radii: tuple[float, float],
    corners: int,
    rings: int,
    *,
    flat: float = 1.0,
    flat_axis: Sequence[float] = (0.0, 0.0, 1.0),
) -> tuple[Array, Faces]:
    """A tube between two points with round ends.

    Parameters
    ----------
    start, end
        Centres of the round ends, metres.
    radii
        There.
    corners, rings
        Of a ring, and rings of each round end.
    flat, flat_axis
        Factor on all distances from the axis along a direction that is no multiple of the axis.
    """
    a, b = np.array(start, float), np.array(end, float)
    along = (b - a) / np.linalg.norm(b - a)
    aside = np.array(flat_axis, float) - along * (along @ np.array(flat_axis, float))
    aside /= np.linalg.norm(aside)
    across = np.cross(aside, along)
    angle = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    circle = np.cos(angle)[:, None] * across + flat * np.sin(angle)[:, None] * aside
    # Latitudes of the rings, without the poles.
    low = 0.5 * np.pi * (np.arange(rings) / rings - 1.0 + 0.5 / rings)
    rows = [a + radii[0] * (np.cos(t) * circle + np.sin(t) * along) for t in low]
    rows += [b + radii[1] * (np.cos(t) * circle + np.sin(t) * along) for t in -low[::-1]]
    poles = [a - radii[0] * along, b + radii[1] * along]
    count = 2 * rings
    points = np.concatenate([*rows, np.array(poles)])
    first, last = np.arange(corners), (count - 1) * corners + np.arange(corners)
    bottom = np.stack([np.roll(first, -1), first, np.full(corners, count * corners)], axis=1)
    top = np.stack([last, np.roll(last, -1), np.full(corners, count * corners + 1)], axis=1)
    return points, np.concatenate([grid_faces(count, corners, closed=True), bottom, top])


def cylinder(radius: float, low: float, high: float, corners: int) -> tuple[Array, Faces]:
    """An open cylinder about +Y from one height to another."""
    points = np.concatenate([_ring(radius, low, corners), _ring(radius, high, corners)])
    return points, grid_faces(2, corners, closed=True)


def disc(radius: float, height: float, corners: int, *, up: bool) -> tuple[Array, Faces]:
    """A flat disc about +Y that is seen from above, or from below."""
    fan = np.arange(1, corners - 1)
    faces = np.stack([np.zeros_like(fan), fan, fan + 1], axis=1)
    return _ring(radius, height, corners), faces if up else faces[:, ::-1]


def _ring(radius: float, height: float, corners: int) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    return np.stack(
        [radius * np.sin(angle), np.full(corners, height), radius * np.cos(angle)], axis=1
    )
