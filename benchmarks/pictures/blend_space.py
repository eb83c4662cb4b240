"""A blend space: its points, its Delaunay triangles, and where positions in and outside lead."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ...engine.animation.clip_bank import ClipBank
from ...engine.animation.controllers import BlendSpace2D, ClipNode
from ...engine.animation.controllers.triangulation import hull_segments, triangulate
from ...engine.animation.skeleton import Skeleton
from ...engine.assets.spectator import builtin_spectator
from ...engine.streams.pool import StreamPool
from .canvas import BLUE, GROUND, INK, ORANGE, PALE, Canvas, Place, mixed
from .figures import draw_figure

SPACE = BlendSpace2D(
    [
        ((-1.0, -0.75), ClipNode("sit_idle")),
        ((0.25, -0.95), ClipNode("sit_clap")),
        ((-0.95, 0.45), ClipNode("stand_idle")),
        ((-0.1, 0.0), ClipNode("clap")),
        ((0.0, 0.95), ClipNode("wave")),
        ((1.1, 0.6), ClipNode("cheer")),
        ((1.0, -0.5), ClipNode("jump")),
    ],
    position=(0.38, 0.5),
)
OUTSIDE = (1.42, 0.0)
SECONDS = 0.55
_SIZE = (900, 690)
_UNIT = (275.0, 235.0)
"""Pixels of one unit to the right and up."""


def draw_blend_space() -> Image.Image:
    """The picture."""
    points = np.array([at for at, _ in SPACE.points])
    triangles = triangulate(points)
    canvas = Canvas(*_SIZE)
    inside, shares = shares_at(points, triangles, np.array(SPACE.position))
    chosen = [_pixel(points[corner]) for corner in inside]
    canvas.polygon(chosen, mixed(GROUND, BLUE, 0.16))
    for a, b, c in triangles:
        corners = [_pixel(points[k]) for k in (a, b, c, a)]
        canvas.line(corners, PALE, 2.0)
    canvas.line([*chosen, chosen[0]], BLUE, 2.5)

    place = _pixel(np.array(SPACE.position))
    for corner, share in zip(inside, shares, strict=True):
        end = _pixel(points[corner])
        canvas.line([place, end], BLUE, 1.5, dashed=True)
        middle = (0.5 * (place[0] + end[0]), 0.5 * (place[1] + end[1]))
        canvas.text(middle, f"{share:.2f}", 14, BLUE, halo=True)
    near = nearest_on_hull(points, triangles, np.array(OUTSIDE))
    canvas.arrow([_pixel(np.array(OUTSIDE)), _pixel(near)], ORANGE, 2.0, dashed=True)
    canvas.disc(_pixel(np.array(OUTSIDE)), 6, GROUND, ORANGE)

    skeleton, palettes = _poses()
    for (at, node), pose in zip(SPACE.points, palettes, strict=False):
        x, y = _pixel(np.array(at))
        draw_figure(canvas, skeleton, pose, (x - 34, y + 12), 52, mixed(GROUND, INK, 0.55))
        canvas.disc((x, y), 6, INK)
        assert isinstance(node, ClipNode)
        canvas.text((x + 12, y + 2), str(node.clip), 15, INK, "lm", halo=True)
    draw_figure(canvas, skeleton, palettes[-1], (place[0] + 36, place[1] + 42), 60, BLUE)
    canvas.disc(place, 7.5, BLUE, GROUND)
    canvas.text((_SIZE[0] / 2, 26), "A blend space of seven clips", 20)
    words = "position (0.38, 0.50): three clips of one triangle, weighted as shown"
    canvas.text((_SIZE[0] / 2, 640), words, 15, BLUE)
    words = "outside the triangles the nearest point of their hull counts"
    canvas.text((_SIZE[0] / 2, 666), words, 15, ORANGE)
    return canvas.finish()


def shares_at(
    points: NDArray[np.float64], triangles: NDArray[np.int64], position: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Corners (3,) of the triangle that holds a position, and their shares (3,), which sum to 1."""
    corners = np.concatenate([points[triangles], np.ones((len(triangles), 3, 1))], axis=2)
    target = np.append(position, 1.0)
    shares = np.linalg.solve(
        np.swapaxes(corners, 1, 2), np.tile(target[:, None], (len(corners), 1, 1))
    )
    best = int(np.argmax(shares[..., 0].min(axis=1)))
    return triangles[best], shares[best, :, 0]


def nearest_on_hull(
    points: NDArray[np.float64], triangles: NDArray[np.int64], position: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(2,) the point of the triangles' border that is nearest to a position."""
    ends = points[hull_segments(points, triangles)]
    along = ends[:, 1] - ends[:, 0]
    share = ((position - ends[:, 0]) * along).sum(axis=1) / (along**2).sum(axis=1)
    found = ends[:, 0] + np.clip(share, 0.0, 1.0)[:, None] * along
    best: NDArray[np.float64] = found[np.argmin(((found - position) ** 2).sum(axis=1))]
    return best


def _poses() -> tuple[Skeleton, NDArray[np.float32]]:
    """The clips' poses and, last, the pose of the space, some time after they began."""
    spectator = builtin_spectator()
    bank = ClipBank(spectator.skeleton, spectator.clips)
    pool = StreamPool(spectator.skeleton, bank, capacity=8, history=2)
    rows = [pool.add(node, time=SECONDS).row for _, node in SPACE.points]
    rows.append(pool.add(SPACE, time=SECONDS).row)
    pool.evaluate(1)
    return spectator.skeleton, pool.store.ring[pool.store.slice_of(1), rows]


def _pixel(at: NDArray[np.float64]) -> Place:
    return 410 + _UNIT[0] * float(at[0]), 385 - _UNIT[1] * float(at[1])
