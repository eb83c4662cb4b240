"""A small flag on a stick. Its cloth hangs on two chains of joints, one along each long edge.

The flag stands upright in its own model space: the stick along +Y with the grip at the origin, the
cloth towards +X. The clips are travelling waves that grow towards the free end.
"""

from __future__ import annotations

import numpy as np

from ...animation.clip import Clip
from ...animation.skeleton import Skeleton
from ..character import Character, Material
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
    rigid,
    turning_clip,
)

LENGTH, HEIGHT = 0.52, 0.34
"""Of the cloth, metres."""
TOP, BOTTOM, RADIUS = 0.66, -0.10, 0.008
"""Ends and thickness of the stick."""
LINKS = 5
"""Joints of each chain."""

_LEVELS = ((11, 3, 8), (6, 2, 5), (4, 1, 3))
"""Columns of the cloth, rows of each of its three stripes, and corners of the stick."""
_STICK = Material("stick", (0.46, 0.33, 0.19, 1.0))

# Directions in the bind pose of the right hand: along the fingers, the back of the hand, the thumb.
_FINGERS = np.array([-np.sqrt(0.5), -np.sqrt(0.5), 0.0])
_BACK = np.array([-np.sqrt(0.5), np.sqrt(0.5), 0.0])
_THUMB = np.array([0.0, 0.0, 1.0])


def make_flag() -> Prop:
    """Make the flag."""
    skeleton = _joints()
    meshes = [
        make_meshes((*_cloth(columns, rows), _stick(corners)), level)
        for level, (columns, rows, corners) in enumerate(_LEVELS)
    ]
    character = Character(
        name="flag",
        skeleton=skeleton,
        meshes=meshes[0],
        materials=(TEAM, WHITE, _STICK),
        clips=(_wave(skeleton), _hang(skeleton)),
        lower_levels=tuple(meshes[1:]),
    )
    return Prop(character, "hand_r", _grip())


def _grip() -> Array:
    """From the flag's model space to the right hand's frame.

    The stick leaves the fist between thumb and fingers, leaning to the back of the hand: up when
    the arm is raised or the hand rests on a thigh, down when the arm hangs.
    """
    up = 0.62 * _FINGERS + 0.50 * _BACK + 0.60 * _THUMB
    up /= np.linalg.norm(up)
    # The cloth flies to the side, and to where it would fall while the hand rests.
    fly = 0.75 * (_FINGERS - _THUMB) / np.sqrt(2.0) - 0.66 * _BACK
    fly -= (fly @ up) * up
    fly /= np.linalg.norm(fly)
    whole = np.eye(4)
    whole[:3, 0], whole[:3, 1], whole[:3, 2] = fly, up, np.cross(fly, up)
    whole[:3, 3] = 0.075 * _FINGERS - 0.022 * _BACK + 0.008 * _THUMB
    return whole


def _joints() -> Skeleton:
    names, parents, places = ["stick"], [-1], [(0.0, 0.0, 0.0)]
    for link in range(LINKS):
        for edge, y in (("top", TOP), ("bottom", TOP - HEIGHT)):
            parents.append(0 if link == 0 else len(names) - 2)
            names.append(f"{edge}_{link}")
            places.append((LENGTH * link / LINKS, y, 0.0))
    return joint_tree(names, parents, np.array(places))


def _cloth(columns: int, rows: int) -> tuple[Surface, ...]:
    """Three stripes, each a surface of its own with the colour's sharp edge between them."""
    stripes = []
    for stripe in range(3):
        down = np.linspace(stripe / 3, (stripe + 1) / 3, rows + 1)
        along = np.linspace(0.0, 1.0, columns)
        share_down, share = (grid.ravel() for grid in np.meshgrid(down, along, indexing="ij"))
        y = TOP - HEIGHT * share_down
        points = np.stack([LENGTH * share, y, np.zeros(len(share))], axis=1)
        # A joint moves what lies beyond it; half a link about it both joints do.
        link = np.clip(share * LINKS - 0.5, 0.0, LINKS - 1.0)
        first = np.minimum(link.astype(int), LINKS - 2)
        further = link - first
        weights = np.zeros((len(points), 1 + 2 * LINKS))
        for edge, part in ((0, 1.0 - share_down), (1, share_down)):
            np.add.at(weights, (np.arange(len(points)), 1 + 2 * first + edge), part * (1 - further))
            np.add.at(weights, (np.arange(len(points)), 3 + 2 * first + edge), part * further)
        faces = grid_faces(rows + 1, columns)[:, ::-1]
        stripes.append(Surface(points, faces, weights, stripe % 2))
    return tuple(stripes)


def _stick(corners: int) -> Surface:
    angle = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    ring = np.stack([RADIUS * np.sin(angle), np.zeros(corners), RADIUS * np.cos(angle)], axis=1)
    ends = ((BOTTOM, 1.0), (TOP, 0.8), (TOP + 0.012, 0.1))
    points = np.concatenate([ring * (wide, 0, wide) + (0, y, 0) for y, wide in ends])
    faces = grid_faces(len(ends), corners, closed=True)
    return Surface(points, faces, rigid(points, 0, 1 + 2 * LINKS), 2)


def _wave(skeleton: Skeleton) -> Clip:
    """Three waves run along the cloth in two seconds, and a slow one lets it swing."""
    share = loop_times(2.0)[:, None]
    link = np.arange(LINKS)
    angles = np.zeros((len(share), 1 + 2 * LINKS, 3))
    for edge, late in ((0, 0.0), (1, 0.7)):
        run = 2 * np.pi * 3 * share - 1.25 * link - late
        heading = (0.30 + 0.11 * link) * np.sin(run) + 0.22 * np.sin(2 * np.pi * share)
        angles[:, 1 + edge :: 2, 2] = _relative(heading)
        drop = -0.10 - 0.03 * link + 0.05 * np.sin(run + 0.8)
        angles[:, 1 + edge :: 2, 1] = _relative(drop)
    return turning_clip("wave", 2.0, skeleton, angles)


def _hang(skeleton: Skeleton) -> Clip:
    """The cloth falls along the stick and stirs."""
    share = loop_times(4.0)[:, None]
    link = np.arange(LINKS)
    angles = np.zeros((len(share), 1 + 2 * LINKS, 3))
    for edge, late in ((0, 0.0), (1, 0.5)):
        run = 2 * np.pi * 2 * share - 0.8 * link - late
        angles[:, 1 + edge :: 2, 1] = _relative(-1.05 - 0.09 * link + 0.04 * np.sin(run))
        fold = 0.55 * np.where(link % 2, 1.0, -1.0) * (link > 0)
        angles[:, 1 + edge :: 2, 2] = _relative(fold + 0.12 * np.sin(run))
    return turning_clip("hang", 4.0, skeleton, angles)


def _relative(heading: Array) -> Array:
    """(F, L) angles of links against the one before, from angles against the stick."""
    out = heading.copy()
    out[:, 1:] -= heading[:, :-1]
    return out
