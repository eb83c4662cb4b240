"""A cap with a visor, in the colour of the side."""

from __future__ import annotations

import numpy as np

from ...animation.clip import rest_clip
from ..character import Character
from .prop import TEAM, WHITE, Array, Prop, Surface, grid_faces, joint_tree, make_meshes, rigid

HEAD = np.array([0.0, 1.540, -0.002])
"""The spectator's head joint in its bind pose, metres: the origin of the cap's model space."""

CENTRE = np.array([0.0, 1.660, 0.0])
RADII = np.array([0.114, 0.114, 0.136])
"""The crown is an ellipsoid about the spectator's hair."""

_RIM_FRONT, _RIM_BACK = 1.678, 1.632
"""Heights of the rim before the forehead and behind the head."""
_VISOR_LENGTH, _VISOR_DROP, _VISOR_WIDTH = 0.085, 0.020, 1.05
_LEVELS = ((5, 20, 4), (3, 12, 2), (2, 8, 1))
"""Rings and corners of the crown, and rows of the visor, at each level."""


def make_cap() -> Prop:
    """Make the cap."""
    skeleton = joint_tree(["cap"], [-1], np.zeros((1, 3)))
    meshes = [
        make_meshes((_crown(rings, corners), _visor(rows, corners)), level)
        for level, (rings, corners, rows) in enumerate(_LEVELS)
    ]
    character = Character(
        name="cap",
        skeleton=skeleton,
        meshes=meshes[0],
        materials=(TEAM, WHITE),
        clips=(rest_clip(skeleton),),
        lower_levels=tuple(meshes[1:]),
    )
    return Prop(character, "head", np.eye(4))


def _rim(angle: Array) -> Array:
    """(n, 3) points of the rim; angle 0 is in front, positive to the left."""
    # The rim lies on the ellipsoid and in a plane that leans back.
    height = 0.5 * (_RIM_FRONT + _RIM_BACK) + 0.5 * (_RIM_FRONT - _RIM_BACK) * np.cos(angle)
    round_ = np.sqrt(1.0 - ((height - CENTRE[1]) / RADII[1]) ** 2)
    x, z = RADII[0] * round_ * np.sin(angle), RADII[2] * round_ * np.cos(angle)
    return np.stack([x, height, CENTRE[2] + z], axis=1)


def _crown(rings: int, corners: int) -> Surface:
    angle = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    # Half of a polygon's edges lie within the circle that its corners are on.
    wide = np.array([1.0, 0.0, 1.0]) * 0.5 * (1.0 / np.cos(np.pi / corners) - 1.0) + 1.0
    rim = (_rim(angle) - CENTRE) / RADII
    low = np.arcsin(np.clip(rim[:, 1], -1.0, 1.0))
    rows = []
    for ring in range(rings):
        latitude = low + (0.5 * np.pi - low) * ring / rings
        flat = np.cos(latitude)
        rows.append(np.stack([flat * np.sin(angle), np.sin(latitude), flat * np.cos(angle)], 1))
    points = np.concatenate([*rows, [[0.0, 1.0, 0.0]]]) * RADII * wide + CENTRE - HEAD
    last = (rings - 1) * corners + np.arange(corners)
    top = np.stack([last, np.roll(last, -1), np.full(corners, rings * corners)], axis=1)
    faces = np.concatenate([grid_faces(rings, corners, closed=True), top])
    return Surface(points, faces, rigid(points, 0, 1), 0)


def _visor(rows: int, corners: int) -> Surface:
    angle = np.linspace(-_VISOR_WIDTH, _VISOR_WIDTH, max(corners // 2, 3) + 1)
    out = np.cos(angle * 0.5 * np.pi / _VISOR_WIDTH) ** 0.7
    inner = _rim(angle)
    points = []
    for row in range(rows + 1):
        share = row / rows
        moved = inner.copy()
        moved[:, 2] += _VISOR_LENGTH * share * out
        # It curves down at its sides and towards its edge.
        moved[:, 1] -= _VISOR_DROP * share * out + 0.012 * np.abs(np.sin(angle)) * share
        points.append(moved)
    joined = np.concatenate(points) - HEAD
    # Counter-clockwise seen from above.
    faces = grid_faces(rows + 1, len(angle))[:, ::-1]
    return Surface(joined, faces, rigid(joined, 0, 1), 1)
