"""Delaunay triangles of a few points in the plane, for blend spaces.

Coordinates are rounded to integers of 40 bits first, so every sign below is exact and no special
place of the points (on a line, on a circle, nearly equal) leads the construction astray: points are
added from left to right, each joined to the hull's edges that it sees, then edges are flipped until
no circle of a triangle holds a fourth point (Lawson 1977). Points that agree in 40 bits count once.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Indices = NDArray[np.int64]
_Opposite = dict[tuple[int, int], int]
"""Third corner of the triangle to the left of each directed edge."""

_BITS = 40
_THINNEST = 1e-9
"""Twice the area of the smallest triangle that is kept, where the points' extent is 1."""


def triangulate(points: Points) -> Indices:
    """(T, 3) int64 corners of the Delaunay triangles, counter-clockwise; none for points on a line.

    The corners of a unit square give two triangles, whichever diagonal they share.

    Parameters
    ----------
    points
        (n, 2) finite coordinates.
    """
    low = points.min(axis=0)
    extent = float((points - low).max()) or 1.0
    whole = np.round((points - low) / extent * 2.0**_BITS).astype(np.int64)
    place = [(int(x), int(y)) for x, y in whole]
    order: list[int] = []
    for number in sorted(range(len(place)), key=lambda k: place[k]):
        if not order or place[number] != place[order[-1]]:
            order.append(number)
    opposite = _sweep(place, order)
    _flip(place, opposite)
    least = _THINNEST * 4.0**_BITS
    found = {
        (a, b, c)
        for (a, b), c in opposite.items()
        if a < b and a < c and _turn(place, a, b, c) > least
    }
    return np.array(sorted(found), np.int64).reshape(-1, 3)


def hull_segments(points: Points, triangles: Indices) -> Indices:
    """(E, 2) int64 ends of the segments around the triangles; along the line if there are none.

    A single point is one segment of no length.
    """
    if len(triangles):
        edges = {(int(t[k]), int(t[(k + 1) % 3])) for t in triangles for k in range(3)}
        return np.array(sorted((a, b) for a, b in edges if (b, a) not in edges), np.int64)
    if len(points) == 1:
        return np.zeros((1, 2), np.int64)
    spread = points - points[0]
    far = points - points[int(np.argmax(np.square(spread).sum(axis=1)))]
    along = np.argsort(far @ far[int(np.argmax(np.square(far).sum(axis=1)))], kind="stable")
    return np.stack([along[:-1], along[1:]], axis=1)


def _turn(p: list[tuple[int, int]], a: int, b: int, c: int) -> int:
    """Twice the area of a triangle; positive if a, b, c go round counter-clockwise."""
    (ax, ay), (bx, by), (cx, cy) = p[a], p[b], p[c]
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def _in_circle(p: list[tuple[int, int]], a: int, b: int, c: int, d: int) -> bool:
    """Whether d lies inside the circle of the counter-clockwise triangle a, b, c."""
    dx, dy = p[d]
    (ax, ay), (bx, by), (cx, cy) = ((p[k][0] - dx, p[k][1] - dy) for k in (a, b, c))
    a2, b2, c2 = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    return ax * (by * c2 - b2 * cy) - ay * (bx * c2 - b2 * cx) + a2 * (bx * cy - by * cx) > 0


def _add(opposite: _Opposite, a: int, b: int, c: int) -> None:
    opposite[a, b], opposite[b, c], opposite[c, a] = c, a, b


def _sweep(p: list[tuple[int, int]], order: list[int]) -> _Opposite:
    """Some triangulation of the points, which are sorted by x, then y."""
    opposite: _Opposite = {}
    hull: list[int] = []  # counter-clockwise
    line: list[int] = []  # the first points, as long as they are on one line
    for new in order:
        if not hull:
            turn = _turn(p, line[0], line[1], new) if len(line) > 1 else 0
            if turn == 0:
                line.append(new)
                continue
            chain = line if turn > 0 else line[::-1]
            for a, b in pairwise(chain):
                _add(opposite, a, b, new)
            hull = [*chain, new]
            continue
        count = len(hull)
        seen = [_turn(p, hull[k], hull[(k + 1) % count], new) < 0 for k in range(count)]
        first = next(k for k in range(count) if seen[k] and not seen[k - 1])
        k = first
        while seen[k % count]:
            _add(opposite, hull[(k + 1) % count], hull[k % count], new)
            k += 1
        # From the last seen edge's end round to the first one's beginning, then the new point.
        hull = [hull[i % count] for i in range(k, first + count + 1)] + [new]
    return opposite


def _flip(p: list[tuple[int, int]], opposite: _Opposite) -> None:
    """Flip edges until the triangles are Delaunay."""
    waiting = sorted(opposite)
    while waiting:
        a, b = waiting.pop()
        if (a, b) not in opposite or (b, a) not in opposite:
            continue
        c, d = opposite[a, b], opposite[b, a]
        if _in_circle(p, a, b, c, d):
            del opposite[a, b], opposite[b, a]
            _add(opposite, a, d, c)
            _add(opposite, d, b, c)
            waiting += [(a, d), (d, b), (b, c), (c, a)]
