"""A drum that hangs before the belly on a strap, and a stick in each hand.

It is skinned with the spectator's own joints, so one part has all three: the drum moves with the
lower trunk, the strap with the chest, the sticks with the hands. `drumming` beats it.
"""

from __future__ import annotations

import numpy as np

from ...animation.skeleton import Skeleton
from ..character import Character, Material
from ..spectator.skeleton import spectator_skeleton
from .prop import TEAM, WHITE, Array, Faces, Prop, Surface, make_meshes, rigid, smooth_curve
from .solids import capsule, cylinder, disc

RADIUS, HEIGHT = 0.200, 0.270
"""Metres."""
CENTRE = np.array([0.0, 0.885, 0.375])
"""Of the drum, in the bind pose."""
LEAN = 0.16
"""Radians by which its upper skin leans away from the drummer."""
STICK = 0.30
"""Metres from the fist to the stick's tip."""

_LEVELS = ((24, 2, 7, 25), (12, 1, 5, 11), (6, 1, 3, 3))
"""Corners of the drum; rings of the sticks' round ends, and their corners; points of the strap."""
_SKIN = Material("drumhead", (0.86, 0.84, 0.78, 1.0))
_WOOD = Material("stick", (0.56, 0.40, 0.22, 1.0))
_STRAP = Material("strap", (0.10, 0.10, 0.11, 1.0), double_sided=True)

# Middle of the strap from the drum's rim over the left shoulder to behind the neck.
_OVER = np.array(
    [
        (0.150, 0.990, 0.300),
        (0.128, 1.120, 0.190),
        (0.110, 1.250, 0.150),
        (0.094, 1.360, 0.138),
        (0.086, 1.436, 0.085),
        (0.084, 1.472, 0.010),
        (0.058, 1.462, -0.070),
        (0.000, 1.440, -0.108),
    ]
)
_STRAP_WIDTH = 0.020


def make_drum() -> Prop:
    """Make drum, strap and sticks."""
    skeleton = spectator_skeleton()
    meshes = [
        make_meshes(_surfaces(skeleton, *counts), level) for level, counts in enumerate(_LEVELS)
    ]
    character = Character(
        name="drum",
        skeleton=skeleton,
        meshes=meshes[0],
        materials=(TEAM, WHITE, _SKIN, _WOOD, _STRAP),
        clips=(),
        lower_levels=tuple(meshes[1:]),
    )
    return Prop(character, None, None, "body")


def stick_tip(side: float) -> Array:
    """(3,) where a stick ends in the bind pose; `side` is 1 for the left hand, -1 for the right."""
    fist, way = _stick(side)
    return fist + STICK * way


def _stick(side: float) -> tuple[Array, Array]:
    """Where a stick leaves the fist in the bind pose, and its direction."""
    skeleton = spectator_skeleton()
    name = "hand_l" if side > 0 else "hand_r"
    wrist = -skeleton.inverse_bind[skeleton.index(name), :, 3].astype(float)
    mirror = np.array([side, 1.0, 1.0])
    fingers = np.array([1.0, -1.0, 0.0]) * np.sqrt(0.5) * mirror
    palm = np.array([-1.0, -1.0, 0.0]) * np.sqrt(0.5) * mirror
    way = 0.86 * fingers + 0.10 * palm + np.array([0.0, 0.0, -0.10])
    return wrist + 0.070 * fingers + 0.020 * palm, way / np.linalg.norm(way)


def _surfaces(
    skeleton: Skeleton, corners: int, rings: int, thin: int, strap: int
) -> tuple[Surface, ...]:
    joints, trunk = skeleton.joint_count, skeleton.index("spine")

    def hung(shape: tuple[Array, Faces], material: int) -> Surface:
        points = shape[0].copy()
        y, z = points[:, 1].copy(), points[:, 2].copy()
        points[:, 1] = np.cos(LEAN) * y - np.sin(LEAN) * z
        points[:, 2] = np.cos(LEAN) * z + np.sin(LEAN) * y
        points += CENTRE
        return Surface(points, shape[1], rigid(points, trunk, joints), material)

    half, rim = 0.5 * HEIGHT, 0.028
    wide = RADIUS + 0.008
    found = [
        hung(cylinder(RADIUS, rim - half, half - rim, corners), 0),
        hung(cylinder(wide, -half, rim - half, corners), 1),
        hung(cylinder(wide, half - rim, half, corners), 1),
        hung(disc(wide, -half, corners, up=False), 2),
        hung(disc(wide, half, corners, up=True), 2),
    ]
    for side in (1.0, -1.0):
        fist, way = _stick(side)
        hand = skeleton.index("hand_l" if side > 0 else "hand_r")
        start, end = fist - 0.07 * way, fist + (STICK - 0.012) * way
        points, faces = capsule(start, end, (0.008, 0.012), thin, rings)
        found.append(Surface(points, faces, rigid(points, hand, joints), 3))
    found.append(_strap(skeleton, strap))
    return tuple(found)


def _strap(skeleton: Skeleton, count: int) -> Surface:
    """A band round the neck; the chest moves it above the belly, the trunk below."""
    mirror = np.array([-1.0, 1.0, 1.0])
    middle = smooth_curve(np.concatenate([_OVER, _OVER[-2::-1] * mirror]), count)
    along = np.gradient(middle, axis=0)
    # It lies flat on the body: outwards is away from the trunk's axis.
    out = middle - np.array([0.0, 1.30, -0.01])
    out[:, 1] = np.clip(4.0 * (middle[:, 1] - 1.40), 0.0, 1.0) * 0.12
    out -= (
        np.sum(out * along, axis=1, keepdims=True)
        * along
        / np.sum(along * along, axis=1, keepdims=True)
    )
    across = np.cross(along, out)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    edges = [middle + sign * _STRAP_WIDTH * across for sign in (1.0, -1.0)]
    points = np.concatenate(edges)
    a, b = np.arange(count - 1), np.arange(count - 1) + count
    faces = np.concatenate([np.stack([a, b, b + 1], axis=1), np.stack([a, b + 1, a + 1], axis=1)])
    normal = np.cross(points[faces[0, 1]] - points[faces[0, 0]], points[faces[0, 2]] - points[0])
    if normal @ out[0] < 0:
        faces = faces[:, ::-1]
    weights = np.zeros((len(points), skeleton.joint_count))
    upper = np.clip((points[:, 1] - 1.10) / 0.20, 0.0, 1.0)
    weights[:, skeleton.index("chest")] = upper
    weights[:, skeleton.index("spine")] = 1.0 - upper
    return Surface(points, faces, weights, 4)
