"""A large hand of foam with its forefinger up, worn on the right hand, in the colour of the side.

In its own model space it points along +Y, its palm faces +Z and its thumb +X; the wearer's wrist
is at the origin.
"""

from __future__ import annotations

import numpy as np

from ...animation.clip import rest_clip
from ..character import Character
from .prop import TEAM, WHITE, Array, Prop, Surface, joint_tree, make_meshes, rigid
from .solids import capsule

LENGTH = 0.47
"""From the wrist to the fingertip, metres."""

_LEVELS = ((10, 4), (6, 3), (4, 1))
"""Corners of a ring and rings of a round end, at each level."""

# Ends, radii and flatness of the solids: the palm, the forefinger, the thumb, the other fingers.
_PALM = ((-0.012, 0.062, 0.006), (0.0, 0.172, 0.008), (0.080, 0.098), 0.62)
_FOREFINGER = ((0.046, 0.190, 0.0), (0.052, 0.434, 0.0), (0.041, 0.036), 0.92)
_THUMB = ((0.052, 0.095, 0.006), (0.128, 0.190, 0.012), (0.036, 0.028), 0.9)
_CURLED = (
    ((-0.014, 0.180, 0.012), (-0.012, 0.244, 0.020), (0.036, 0.036), 1.0),
    ((-0.060, 0.168, 0.012), (-0.064, 0.222, 0.020), (0.033, 0.033), 1.0),
)
_CUFF = ((0.0, -0.012, 0.0), (0.0, 0.034, 0.0), (0.066, 0.066), 0.62)

# Directions in the bind pose of the right hand: along the fingers, the palm, the thumb.
_FINGERS = np.array([-np.sqrt(0.5), -np.sqrt(0.5), 0.0])
_PALM_FACES = np.array([np.sqrt(0.5), -np.sqrt(0.5), 0.0])


def make_foam_hand() -> Prop:
    """Make the foam hand."""
    skeleton = joint_tree(["foam hand"], [-1], np.zeros((1, 3)))
    meshes = [
        make_meshes(_solids(corners, rings, level), level)
        for level, (corners, rings) in enumerate(_LEVELS)
    ]
    character = Character(
        name="foam_hand",
        skeleton=skeleton,
        meshes=meshes[0],
        materials=(TEAM, WHITE),
        clips=(rest_clip(skeleton),),
        lower_levels=tuple(meshes[1:]),
    )
    return Prop(character, "hand_r", _worn())


def _worn() -> Array:
    """From the foam hand's model space to the right hand's frame; the hand is inside of it."""
    whole = np.eye(4)
    whole[:3, 1], whole[:3, 2] = _FINGERS, _PALM_FACES
    whole[:3, 0] = np.cross(whole[:3, 1], whole[:3, 2])
    whole[:3, 3] = 0.004 * _PALM_FACES
    return whole


def _solids(corners: int, rings: int, level: int) -> tuple[Surface, ...]:
    fingers = [_PALM, _FOREFINGER, _THUMB, *(_CURLED if level < 2 else ())]
    points, faces, used = [], [], 0
    for start, end, radii, flat in fingers:
        some, triangles = capsule(start, end, radii, corners, rings, flat=flat)
        points.append(some)
        faces.append(triangles + used)
        used += len(some)
    whole = np.concatenate(points)
    surfaces = [Surface(whole, np.concatenate(faces), rigid(whole, 0, 1), 0)]
    if level < 2:
        start, end, radii, flat = _CUFF
        some, triangles = capsule(start, end, radii, corners, rings, flat=flat)
        surfaces.append(Surface(some, triangles, rigid(some, 0, 1), 1))
    return tuple(surfaces)
