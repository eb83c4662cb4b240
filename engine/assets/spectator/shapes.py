"""Signed distances of the simple solids that the spectator's body is made of.

All take (N, 3) float32 points and give (N,) float32 metres, negative inside. Those of stretched
solids are estimates that are right to first order at the surface, which is all that meshing,
normals and occlusion need (the ellipsoid bound and the polynomial smooth minimum are those of
Inigo Quilez, "Distance functions").
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Field = NDArray[np.float32]
Knots = Sequence[tuple[float, float, float, float, float]]


def smooth_min(a: Field, b: Field, radius: float) -> Field:
    """Union of two solids whose seam is rounded over `radius` metres."""
    overlap: Field = np.maximum(radius - np.abs(a - b), 0.0)
    overlap = overlap / np.float32(radius)
    result: Field = np.minimum(a, b) - overlap * overlap * np.float32(radius * 0.25)
    return result


def smooth_max(a: Field, b: Field, radius: float) -> Field:
    """Intersection of two solids whose edge is rounded over `radius` metres."""
    return -smooth_min(-a, -b, radius)


def ellipsoid(points: Field, centre: Sequence[float], radii: Sequence[float]) -> Field:
    """An axis-aligned ellipsoid."""
    size = np.asarray(radii, dtype=np.float32)
    scaled = (points - np.asarray(centre, dtype=np.float32)) / size
    outer = np.sqrt(np.einsum("ij,ij->i", scaled, scaled)) + np.float32(1e-9)
    slope = scaled / size
    inner = np.sqrt(np.einsum("ij,ij->i", slope, slope)) + np.float32(1e-9)
    result: Field = outer * (outer - 1) / inner
    return result


def round_cone(
    points: Field, start: Sequence[float], end: Sequence[float], radius0: float, radius1: float
) -> Field:
    """A rod from `start` to `end` whose radius runs from `radius0` to `radius1`."""
    origin = np.asarray(start, dtype=np.float32)
    axis = np.asarray(end, dtype=np.float32) - origin
    offset = points - origin
    along = np.clip(offset @ axis / np.float32(axis @ axis), 0.0, 1.0)
    offset -= along[:, None] * axis
    result: Field = np.sqrt(np.einsum("ij,ij->i", offset, offset)) - (
        radius0 + (radius1 - radius0) * along
    )
    return result


def loft(along: Field, across: Field, depth: Field, knots: Knots, edge: float) -> Field:
    """A tube of elliptic cross-sections that follow `knots`, flat at both ends.

    Parameters
    ----------
    along, across, depth
        (N,) coordinates of the points on the tube's axis and on the two axes of its ellipses.
    knots
        Rows (along, half width, half depth, centre across, centre depth), sorted by `along`;
        between them a monotone cubic.
    edge
        Rounding of the two ends, metres.
    """
    from scipy.interpolate import PchipInterpolator

    table = np.asarray(knots, dtype=np.float64)
    steps = np.linspace(table[0, 0], table[-1, 0], 512)
    curves = PchipInterpolator(table[:, 0], table[:, 1:])(steps)
    width, thick, cx, cz = (np.interp(along, steps, curve).astype(np.float32) for curve in curves.T)
    x, z = (across - cx) / width, (depth - cz) / thick
    outer = np.sqrt(x * x + z * z) + np.float32(1e-9)
    inner = np.sqrt((x / width) ** 2 + (z / thick) ** 2) + np.float32(1e-9)
    side: Field = outer * (outer - 1) / inner
    ends: Field = np.maximum(table[0, 0] - along, along - table[-1, 0]).astype(np.float32)
    return smooth_max(side, ends, edge)
