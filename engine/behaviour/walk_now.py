"""Where people on their way are, from the columns of their walk, and how they go on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.walk import Errand, Walk

F32 = NDArray[np.float32]
FAR = 1e6


@dataclass(slots=True)
class Now:
    """What follows from the columns of a walk at one moment.

    Parameters
    ----------
    x, y, z
        (W,) places, metres.
    tangent, normal
        (2, W) x and z along the route and to the right of it.
    steep, in_row
        (W,) bool: on stairs, and among seats.
    covered, to_mouth
        (W,) metres since the beginning, and to the row where somebody goes to one.
    seat
        (W,) where among the seats of the row: 1.5 is half way from the second to the third.
    passes
        (W,) how many seats of the row are passed, one's own not counted.
    """

    x: F32
    y: F32
    z: F32
    tangent: F32
    normal: F32
    steep: NDArray[np.bool_]
    in_row: NDArray[np.bool_]
    covered: F32
    to_mouth: F32
    seat: F32
    passes: NDArray[np.int32]


def look(walk: Walk) -> Now:
    """Where everybody is."""
    count, most = walk.reach.shape
    row = np.arange(count) * most
    at = row + np.minimum(walk.vertex, walk.last - 1)
    after = at + 1
    route, side = walk.route.reshape(-1, 3), walk.normal.reshape(-1, 2)
    reach = walk.reach.ravel()
    begin = route.take(at, axis=0).T
    span = route.take(after, axis=0).T - begin
    before = reach.take(at)
    length = np.maximum(reach.take(after) - before, np.float32(1e-6))
    ends = walk.vertex >= walk.last
    part = np.where(ends, np.float32(1.0), np.minimum(walk.along / length, np.float32(1.0)))
    normal = side.take(at, axis=0).T
    normal += part * (side.take(after, axis=0).T - normal)
    x, y, z = begin + part * span
    flat = np.maximum(np.sqrt(span[0] ** 2 + span[2] ** 2), np.float32(1e-6))
    leaves = walk.errand == Errand.LEAVE
    comes = walk.errand == Errand.ARRIVE
    in_row = (walk.mouth >= 0) & ((walk.vertex < walk.mouth) == leaves)
    covered = before + part * length
    mouth = reach.take(row + np.maximum(walk.mouth, 0))
    return Now(
        x=x + walk.aside * normal[0],
        y=y,
        z=z + walk.aside * normal[1],
        tangent=span[::2] / flat,
        normal=normal,
        steep=np.abs(span[1]) > np.float32(0.2) * length,
        in_row=in_row,
        covered=covered,
        to_mouth=np.where(comes & ~in_row, mouth - covered, np.float32(FAR)),
        seat=(walk.vertex - walk.seat0 + np.where(ends, 0.0, part)).astype(np.float32),
        passes=np.where(leaves, walk.mouth, walk.last - walk.seat0),
    )


def advance(walk: Walk, seconds: float) -> None:
    """Let everybody go on at the present speed."""
    count, most = walk.reach.shape
    row, reach = np.arange(count) * most, walk.reach.ravel()
    walk.along += walk.speed * np.float32(seconds)
    walk.aside += walk.drift * np.float32(seconds)
    while True:
        after = reach.take(row + np.minimum(walk.vertex + 1, walk.last))
        length = after - reach.take(row + walk.vertex)
        over = (walk.along >= length) & (walk.vertex < walk.last)
        if not over.any():
            break
        walk.along[over] -= length[over]
        walk.vertex[over] += 1
    walk.along[walk.vertex >= walk.last] = 0.0
