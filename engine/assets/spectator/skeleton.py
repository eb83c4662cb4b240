"""Joints of the built-in spectator: where they are and how they hang together.

The bind pose is an A-pose with the arms 45 degrees below the horizontal, half way between hanging
and raised overhead, so that both deform equally well. All rest rotations are the identity: every
joint's frame is parallel to the model's (+X the character's left, +Y up, +Z forward), so a positive
turn about X bends the spine forward, flexes the knee and lowers the toes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...animation.skeleton import Skeleton, breadth_first_order

HEIGHT = 1.75
"""Metres from the soles to the top of the hair."""

ARM = np.array([np.sqrt(0.5), -np.sqrt(0.5), 0.0])
"""Direction of the left arm in the bind pose, from the shoulder to the fingertips."""

PALM = np.array([-np.sqrt(0.5), -np.sqrt(0.5), 0.0])
"""Where the left palm faces in the bind pose; the thumb points to +Z."""

SHOULDER = np.array([0.172, 1.398, -0.012])
"""Left shoulder joint."""

UPPER_ARM, LOWER_ARM, PALM_LENGTH = 0.280, 0.250, 0.088
"""Metres from shoulder to elbow, elbow to wrist and wrist to knuckles."""

_CENTRE: tuple[tuple[str, str | None, tuple[float, float, float]], ...] = (
    ("root", None, (0.0, 0.0, 0.0)),
    ("hips", "root", (0.0, 0.955, -0.005)),
    ("spine", "hips", (0.0, 1.06, -0.010)),
    ("chest", "spine", (0.0, 1.21, -0.016)),
    ("neck", "chest", (0.0, 1.448, -0.022)),
    ("head", "neck", (0.0, 1.540, -0.002)),
)


def _arm(distance: float) -> tuple[float, float, float]:
    x, y, z = SHOULDER + ARM * distance
    return float(x), float(y), float(z)


_LEFT: tuple[tuple[str, str, tuple[float, float, float]], ...] = (
    ("shoulder", "chest", (0.028, 1.395, 0.012)),
    ("upper_arm", "shoulder", _arm(0.0)),
    ("lower_arm", "upper_arm", _arm(UPPER_ARM)),
    ("hand", "lower_arm", _arm(UPPER_ARM + LOWER_ARM)),
    ("fingers", "hand", _arm(UPPER_ARM + LOWER_ARM + PALM_LENGTH)),
    ("upper_leg", "hips", (0.092, 0.900, -0.004)),
    ("lower_leg", "upper_leg", (0.106, 0.492, 0.010)),
    ("foot", "lower_leg", (0.116, 0.088, -0.022)),
    ("toe", "foot", (0.124, 0.028, 0.105)),
)


def _joints() -> tuple[list[str], list[int], NDArray[np.float64]]:
    names = [name for name, _, _ in _CENTRE]
    parent_names = [parent for _, parent, _ in _CENTRE]
    positions = [position for _, _, position in _CENTRE]
    paired = {name for name, _, _ in _LEFT}
    for name, parent, (x, y, z) in _LEFT:
        for side, sign in (("_l", 1.0), ("_r", -1.0)):
            names.append(name + side)
            parent_names.append(parent + side if parent in paired else parent)
            positions.append((sign * x, y, z))
    parents = [-1 if parent is None else names.index(parent) for parent in parent_names]
    order = breadth_first_order(parents)
    new_index = {int(old): new for new, old in enumerate(order)}
    return (
        [names[old] for old in order],
        [-1 if parents[old] < 0 else new_index[parents[old]] for old in order],
        np.array([positions[old] for old in order]),
    )


def bind_positions() -> dict[str, NDArray[np.float64]]:
    """Model-space position of each joint in the bind pose, metres: name to (3,) float64."""
    names, _, positions = _joints()
    return dict(zip(names, positions, strict=True))


def spectator_skeleton() -> Skeleton:
    """The 24 joints of the spectator, rest pose equal to the bind pose."""
    names, parents, positions = _joints()
    count = len(names)
    local = positions.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            local[joint] = positions[joint] - positions[parent]
    inverse_bind = np.zeros((count, 3, 4), dtype=np.float32)
    inverse_bind[:, :, :3] = np.eye(3)
    inverse_bind[:, :, 3] = -positions
    rotation = np.zeros((count, 4), dtype=np.float32)
    rotation[:, 3] = 1.0
    return Skeleton(
        names=tuple(names),
        parents=np.array(parents, dtype=np.int32),
        rest_rotation=rotation,
        rest_translation=local.astype(np.float32),
        rest_scale=np.ones((count, 3), dtype=np.float32),
        inverse_bind=inverse_bind,
    )
