"""Hair and beards: closed solids that the head pokes into.

They need no seam with the skin, so any hair goes with any body: what lies within the head is a
cheap flat bottom that nobody sees.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .body import HEAD_SCALE, head_points, jaw_distance
from .shapes import Field, Knots, ellipsoid, loft, round_cone, smooth_max, smooth_min

Line = tuple[tuple[float, ...], tuple[float, ...]]
"""Depths z, rising, and the height of the hair's lower edge at each."""

_EDGE = 0.010
"""Rounding of the edge, metres."""

_ABOVE_EARS: Line = (
    (-0.11, -0.05, -0.022, -0.006, 0.012, 0.024, 0.055, 0.10),
    (1.560, 1.572, 1.590, 1.632, 1.640, 1.668, 1.696, 1.704),
)
_OVER_EARS: Line = (
    (-0.02, 0.012, 0.020, 0.030, 0.055, 0.10),
    (1.40, 1.545, 1.60, 1.668, 1.694, 1.706),
)
_RECEDING: Line = (
    (-0.11, -0.05, -0.022, -0.006, 0.012, 0.026),
    (1.562, 1.574, 1.592, 1.632, 1.640, 1.690),
)


@dataclass(frozen=True, slots=True)
class Style:
    """One hair or beard.

    Parameters
    ----------
    group, name
        Of the variant.
    shares
        How many of which people have it.
    solid
        Distance of (N, 3) `head_points` of the left half, in the head's natural size.
    hangs
        Whether it follows neck and chest below the head.
    triangles
        At each level of detail; nothing is made of it where there are none.
    """

    group: str
    name: str
    shares: Mapping[str, float]
    solid: Callable[[Field], Field]
    hangs: bool = False
    triangles: tuple[int, int, int] = (300, 100, 36)

    def distance(self, points: NDArray[np.floating]) -> Field:
        """Signed distance in metres for (N, 3) points of either side."""
        mirrored = np.array(points, dtype=np.float32)
        mirrored[:, 0] = np.abs(mirrored[:, 0])
        result: Field = self.solid(head_points(mirrored)) * np.float32(HEAD_SCALE)
        return result


def _edge(points: Field, line: Line) -> Field:
    """How far points lie below the hair's edge."""
    _, y, z = points.T
    below: Field = ((np.interp(z, *line) - y) * 0.8).astype(np.float32)
    return below


def _cap(points: Field, grow: float = 0.0) -> Field:
    return ellipsoid(points, (0.0, 1.648, -0.010), (0.087 + grow, 0.101 + grow, 0.105 + grow))


def _short(points: Field) -> Field:
    quiff = ellipsoid(points, (0.0, 1.712, 0.058), (0.064, 0.030, 0.042))
    hair = smooth_min(_cap(points), quiff, 0.03)
    return smooth_max(hair, _edge(points, _ABOVE_EARS), _EDGE)


def _crop(points: Field) -> Field:
    return smooth_max(_cap(points, -0.003), _edge(points, _ABOVE_EARS), _EDGE / 2)


def _ring(points: Field) -> Field:
    """What is left around a bald head."""
    _, y, z = points.T
    top = y - np.interp(z, (-0.11, -0.06, 0.0, 0.03), (1.700, 1.690, 1.668, 1.650))
    ring = smooth_max(_cap(points, -0.001), _edge(points, _RECEDING), _EDGE)
    return smooth_max(ring, top.astype(np.float32) * np.float32(0.8), 0.014)


def _curly(points: Field) -> Field:
    x, y, z = points.T
    ball = ellipsoid(points, (0.0, 1.664, -0.020), (0.108, 0.112, 0.114))
    waves = np.sin(105 * x + 0.7) * np.sin(105 * y) * np.sin(105 * z + 0.4)
    ball = ball - np.float32(0.006) * waves.astype(np.float32)
    return smooth_max(ball, _edge(points, _ABOVE_EARS), 0.02)


def _bob(points: Field) -> Field:
    x, y, z = points.T
    knots: Knots = (
        (1.530, 0.094, 0.080, 0.0, -0.038),
        (1.570, 0.099, 0.092, 0.0, -0.032),
        (1.620, 0.097, 0.098, 0.0, -0.022),
        (1.680, 0.086, 0.096, 0.0, -0.014),
    )
    hair = smooth_min(_cap(points, 0.002), loft(y, x, z, knots, 0.015), 0.03)
    return smooth_max(hair, _edge(points, _OVER_EARS), _EDGE)


def _long(points: Field) -> Field:
    x, y, z = points.T
    knots: Knots = (
        (1.320, 0.072, 0.022, 0.0, -0.136),
        (1.380, 0.092, 0.030, 0.0, -0.126),
        (1.440, 0.098, 0.042, 0.0, -0.104),
        (1.500, 0.096, 0.062, 0.0, -0.066),
        (1.560, 0.095, 0.082, 0.0, -0.038),
        (1.620, 0.094, 0.095, 0.0, -0.022),
        (1.680, 0.085, 0.096, 0.0, -0.014),
    )
    hair = smooth_min(_cap(points, 0.002), loft(y, x, z, knots, 0.015), 0.03)
    return smooth_max(hair, _edge(points, _OVER_EARS), _EDGE)


def _ponytail(points: Field) -> Field:
    tail = smooth_min(
        round_cone(points, (0.0, 1.690, -0.100), (0.0, 1.668, -0.146), 0.018, 0.026),
        round_cone(points, (0.0, 1.668, -0.146), (0.0, 1.530, -0.156), 0.028, 0.012),
        0.02,
    )
    return smooth_min(
        smooth_max(_cap(points, -0.0015), _edge(points, _ABOVE_EARS), _EDGE), tail, 0.012
    )


def _bun(points: Field) -> Field:
    bun = ellipsoid(points, (0.0, 1.722, -0.092), (0.044, 0.040, 0.042))
    return smooth_min(
        smooth_max(_cap(points, -0.0015), _edge(points, _ABOVE_EARS), _EDGE), bun, 0.006
    )


def _beard(points: Field) -> Field:
    _, y, z = points.T
    line = np.interp(z, (-0.02, 0.02, 0.045, 0.062, 0.10), (1.636, 1.622, 1.588, 1.566, 1.566))
    chin = jaw_distance(points, 1.0) - np.float32(0.0065)
    back = np.float32(-0.012) - z
    front = smooth_max(chin, (y - line).astype(np.float32) * np.float32(0.8), 0.008)
    return smooth_min(smooth_max(front, back, 0.008), _moustache(points), 0.008)


def _moustache(points: Field) -> Field:
    return round_cone(points, (0.004, 1.5885, 0.0965), (0.030, 1.5755, 0.0855), 0.0090, 0.0060)


STYLES = (
    Style(
        "hair",
        "short",
        {"man": 0.46, "boy": 0.62, "old man": 0.34, "woman": 0.06, "old woman": 0.3},
        _short,
    ),
    Style("hair", "crop", {"man": 0.22, "boy": 0.2, "old man": 0.14}, _crop),
    Style("hair", "ring", {"man": 0.12, "old man": 0.52}, _ring, triangles=(260, 96, 40)),
    Style(
        "hair",
        "curly",
        {"man": 0.10, "woman": 0.12, "boy": 0.12, "girl": 0.1, "old woman": 0.12},
        _curly,
        triangles=(460, 130, 40),
    ),
    Style(
        "hair",
        "bob",
        {"man": 0.06, "woman": 0.22, "boy": 0.06, "girl": 0.22, "old woman": 0.38},
        _bob,
    ),
    Style(
        "hair",
        "long",
        {"man": 0.04, "woman": 0.32, "girl": 0.34},
        _long,
        hangs=True,
        triangles=(360, 120, 44),
    ),
    Style(
        "hair",
        "ponytail",
        {"woman": 0.2, "girl": 0.34},
        _ponytail,
        triangles=(360, 120, 44),
    ),
    Style("hair", "bun", {"woman": 0.08, "old woman": 0.2}, _bun, triangles=(360, 120, 44)),
    Style("beard", "full", {"man": 0.17, "old man": 0.22}, _beard, triangles=(260, 84, 30)),
    Style(
        "beard",
        "moustache",
        {"man": 0.06, "old man": 0.12},
        _moustache,
        triangles=(60, 24, 0),
    ),
)
"""Hair and beards that ship; the first hair is what is drawn where nobody chose."""
