"""A striped scarf round the neck, its ends hanging down the chest on two joints each."""

from __future__ import annotations

import numpy as np

from ...animation.clip import Clip
from ...animation.skeleton import Skeleton
from ..character import Character
from .prop import (
    TEAM,
    WHITE,
    Array,
    Prop,
    Surface,
    grid_faces,
    joint_tree,
    loop_times,
    make_meshes,
    smooth_curve,
    turning_clip,
)

CHEST = np.array([0.0, 1.210, -0.016])
"""The spectator's chest joint in its bind pose, metres: the origin of the scarf's model space."""

# Middle of the band from the left end round the neck to its back, and which way it faces there.
_LEFT = np.array(
    [
        (0.082, 0.985, 0.128),
        (0.080, 1.070, 0.122),
        (0.078, 1.160, 0.122),
        (0.076, 1.250, 0.128),
        (0.072, 1.330, 0.128),
        (0.066, 1.395, 0.104),
        (0.070, 1.450, 0.060),
        (0.080, 1.484, 0.005),
        (0.064, 1.497, -0.055),
        (0.000, 1.500, -0.094),
    ]
)
_FACING = np.array(
    [
        (0.10, 0.0, 1.0),
        (0.10, 0.0, 1.0),
        (0.10, 0.0, 1.0),
        (0.12, 0.1, 1.0),
        (0.15, 0.3, 1.0),
        (0.25, 0.5, 0.8),
        (0.60, 0.5, 0.6),
        (1.00, 0.4, 0.1),
        (0.70, 0.3, -0.8),
        (0.00, 0.3, -1.0),
    ]
)
_WIDE = np.array([0.052, 0.052, 0.051, 0.050, 0.048, 0.044, 0.040, 0.036, 0.034, 0.034])
"""Half the width there."""
_THICK = 0.013
_STRIPES = 13
_LEVELS = ((5, 8), (2, 6), (1, 4))
"""Rings of each stripe and corners of a ring."""
_KNEES = (1.34, 1.17)
"""Heights at which the ends bend."""
_NAMES = ("scarf", "left_1", "right_1", "left_2", "right_2")


def make_scarf() -> Prop:
    """Make the scarf."""
    places = [(0.0, 0.0, 0.0)]
    for height in _KNEES:
        for side in (1.0, -1.0):
            places.append(tuple(np.array([side * 0.078, height, 0.120]) - CHEST))
    skeleton = joint_tree(_NAMES, [-1, 0, 0, 1, 2], np.array(places))
    meshes = [
        make_meshes(_bands(rings, corners), level) for level, (rings, corners) in enumerate(_LEVELS)
    ]
    character = Character(
        name="scarf",
        skeleton=skeleton,
        meshes=meshes[0],
        materials=(TEAM, WHITE),
        clips=(_sway("hang", 4.0, 0.05, skeleton), _sway("swing", 1.1, 0.24, skeleton)),
        lower_levels=tuple(meshes[1:]),
    )
    return Prop(character, "chest", np.eye(4))


def _bands(rings: int, corners: int) -> tuple[Surface, ...]:
    """Stripes along the band: all of one colour are one surface."""
    count = _STRIPES * rings + 1
    mirror = np.array([-1.0, 1.0, 1.0])
    middle = smooth_curve(np.concatenate([_LEFT, _LEFT[-2::-1] * mirror]), count)
    facing = smooth_curve(np.concatenate([_FACING, _FACING[-2::-1] * mirror]), count)
    wide = smooth_curve(np.concatenate([_WIDE, _WIDE[-2::-1]])[:, None], count)
    along = np.gradient(middle, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    facing -= np.sum(facing * along, axis=1, keepdims=True) * along
    facing /= np.linalg.norm(facing, axis=1, keepdims=True)
    across = np.cross(facing, along)
    angle = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False) + np.pi / corners
    tube = (
        middle[:, None]
        + (wide * np.cos(angle))[..., None] * across[:, None]
        + (_THICK * np.sin(angle))[None, :, None] * facing[:, None]
    )
    surfaces = []
    for colour in (0, 1):
        points, faces, used = [], [], 0
        for stripe in range(colour, _STRIPES, 2):
            rows = tube[stripe * rings : (stripe + 1) * rings + 1]
            points.append(rows.reshape(-1, 3))
            faces.append(grid_faces(len(rows), corners, closed=True) + used)
            used += len(points[-1])
            for end in (0, _STRIPES - 1):
                if stripe == end:
                    first = used - corners if end else used - len(points[-1])
                    fan = np.arange(1, corners - 1)
                    cap = np.stack([np.zeros_like(fan), fan, fan + 1], axis=1) + first
                    faces.append(cap if end else cap[:, ::-1])
        joined = np.concatenate(points)
        surfaces.append(Surface(joined - CHEST, np.concatenate(faces), _weights(joined), colour))
    return tuple(surfaces)


def _weights(points: Array) -> Array:
    """(V, 5): the ends are moved by their joints, a hand's breadth about a bend by both."""
    weights = np.zeros((len(points), len(_NAMES)))
    front = points[:, 2] > 0.05
    upper, lower = (np.clip((knee + 0.05 - points[:, 1]) / 0.10, 0.0, 1.0) for knee in _KNEES)
    upper *= front
    lower *= front
    left = points[:, 0] > 0
    weights[:, 0] = 1.0 - upper
    weights[:, 1] = np.where(left, upper - lower, 0.0)
    weights[:, 2] = np.where(left, 0.0, upper - lower)
    weights[:, 3] = np.where(left, lower, 0.0)
    weights[:, 4] = np.where(left, 0.0, lower)
    return weights


def _sway(name: str, duration: float, reach: float, skeleton: Skeleton) -> Clip:
    """The ends swing to the side and away from the chest, never into it; the lower halves later."""
    share = loop_times(duration)
    angles = np.zeros((len(share), len(_NAMES), 3))
    for joint, late, side in ((1, 0.0, 1.0), (2, 0.9, -1.0), (3, 0.8, 1.0), (4, 1.7, -1.0)):
        swing = np.sin(2 * np.pi * share - late)
        angles[:, joint, 0] = -0.5 * reach * (1.0 + swing)
        angles[:, joint, 1] = 0.6 * reach * np.sin(2 * np.pi * share - late - 0.6) * side
    return turning_clip(name, duration, skeleton, angles)
