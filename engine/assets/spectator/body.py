"""The spectator's body as one signed distance and the borders between skin, hair and clothes.

Only the left half is described; points are mirrored into it first, so the body is exactly
symmetric. Clothes are solids of their own, a centimetre proud of what they cover, which gives
sleeves, shirt and trousers a real hem.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .shapes import Field, ellipsoid, loft, round_cone, smooth_max, smooth_min
from .skeleton import ARM, HEIGHT, PALM, SHOULDER

HEAD_SCALE = 1.07
"""Heads are drawn a little larger than life, because faces read from afar."""

SLEEVE_END = 0.172
SHIRT_HEM = 0.910
TROUSER_HEM = 0.070

REGIONS = ("shoes", "hair", "trousers", "shirt")
"""What covers the skin, in the order in which `region_fields` decides."""

# (height, half width, half depth, centre x, centre z)
_SHIRT = (
    (SHIRT_HEM, 0.170, 0.116, 0.0, -0.016),
    (0.960, 0.163, 0.110, 0.0, -0.010),
    (1.020, 0.152, 0.102, 0.0, -0.004),
    (1.080, 0.147, 0.098, 0.0, -0.002),
    (1.160, 0.154, 0.103, 0.0, -0.002),
    (1.240, 0.167, 0.111, 0.0, -0.004),
    (1.300, 0.174, 0.112, 0.0, -0.008),
    (1.350, 0.172, 0.104, 0.0, -0.014),
    (1.400, 0.146, 0.084, 0.0, -0.020),
    (1.435, 0.100, 0.066, 0.0, -0.022),
    (1.460, 0.064, 0.060, 0.0, -0.022),
)
_PELVIS = (
    (0.790, 0.100, 0.080, 0.0, -0.020),
    (0.830, 0.150, 0.106, 0.0, -0.024),
    (0.880, 0.164, 0.112, 0.0, -0.022),
    (0.930, 0.158, 0.104, 0.0, -0.014),
    (0.990, 0.140, 0.090, 0.0, -0.004),
)
_LEG = (
    (TROUSER_HEM, 0.053, 0.060, 0.118, -0.020),
    (0.170, 0.053, 0.058, 0.116, -0.020),
    (0.270, 0.055, 0.060, 0.113, -0.018),
    (0.360, 0.058, 0.064, 0.110, -0.012),
    (0.440, 0.059, 0.062, 0.108, 0.000),
    (0.500, 0.061, 0.065, 0.106, 0.006),
    (0.580, 0.067, 0.073, 0.102, 0.005),
    (0.680, 0.077, 0.084, 0.097, 0.000),
    (0.780, 0.086, 0.094, 0.092, -0.008),
    (0.860, 0.087, 0.100, 0.088, -0.014),
    (0.930, 0.075, 0.090, 0.080, -0.016),
)
_NECK = (
    (1.400, 0.062, 0.062, 0.0, -0.026),
    (1.450, 0.054, 0.056, 0.0, -0.022),
    (1.500, 0.048, 0.052, 0.0, -0.016),
    (1.600, 0.050, 0.055, 0.0, -0.010),
)
# (distance from the shoulder, half thickness, half width, centre towards the back, centre z)
_SLEEVE = (
    (-0.030, 0.040, 0.048, -0.004, -0.004),
    (0.010, 0.053, 0.060, -0.004, -0.004),
    (0.060, 0.057, 0.061, -0.002, -0.002),
    (0.120, 0.056, 0.058, 0.000, 0.000),
    (SLEEVE_END, 0.056, 0.057, 0.000, 0.000),
)
_BARE_ARM = (
    (0.060, 0.046, 0.048, 0.0, 0.0),
    (0.160, 0.043, 0.044, 0.0, 0.002),
    (0.230, 0.039, 0.040, 0.0, 0.002),
    (0.280, 0.037, 0.039, 0.002, 0.0),
    (0.330, 0.037, 0.042, 0.002, 0.002),
    (0.400, 0.033, 0.037, 0.001, 0.002),
    (0.480, 0.026, 0.030, 0.0, 0.0),
    (0.530, 0.023, 0.029, 0.0, 0.0),
    (0.560, 0.021, 0.033, 0.0, 0.002),
)
_HAND = (
    (0.530, 0.018, 0.028, 0.0, 0.0),
    (0.560, 0.020, 0.038, 0.001, 0.003),
    (0.595, 0.020, 0.045, 0.002, 0.002),
    (0.625, 0.018, 0.046, 0.000, 0.000),
    (0.660, 0.015, 0.043, -0.004, -0.002),
    (0.700, 0.012, 0.037, -0.010, -0.004),
    (0.722, 0.008, 0.026, -0.014, -0.004),
)


def arm_coordinates(points: Field) -> tuple[Field, Field, Field]:
    """Distance along the left arm from the shoulder, towards the back of the hand, and +Z."""
    offset = points - SHOULDER.astype(np.float32)
    return offset @ ARM.astype(np.float32), -(offset @ PALM.astype(np.float32)), offset[:, 2]


def arm_distance(points: Field) -> Field:
    """Distance to the left arm with its sleeve."""
    along, back, depth = arm_coordinates(points)
    sleeve = loft(along, back, depth, _SLEEVE, 0.012)
    bare = loft(along, back, depth, _BARE_ARM, 0.01)
    hand = loft(along, back, depth, _HAND, 0.014)
    local = np.stack([along, back, depth], axis=1)
    thumb = smooth_min(
        round_cone(local, (0.562, 0.000, 0.022), (0.605, -0.012, 0.054), 0.019, 0.015),
        round_cone(local, (0.605, -0.012, 0.054), (0.642, -0.018, 0.066), 0.014, 0.011),
        0.01,
    )
    limb = smooth_min(smooth_min(bare, hand, 0.02), thumb, 0.014)
    return smooth_min(sleeve, limb, 0.004)


def torso_distance(points: Field) -> Field:
    """Distance to the shirt without its sleeves."""
    x, y, z = points.T
    trunk = loft(y, x, z, _SHIRT, 0.012)
    slope = round_cone(points, (0.03, 1.437, -0.028), (0.150, 1.405, -0.022), 0.042, 0.048)
    pectoral = ellipsoid(points, (0.068, 1.318, 0.066), (0.078, 0.060, 0.034))
    blade = ellipsoid(points, (0.085, 1.330, -0.090), (0.070, 0.085, 0.036))
    return smooth_min(smooth_min(trunk, slope, 0.05), smooth_min(pectoral, blade, 0.01), 0.05)


def leg_distance(points: Field) -> Field:
    """Distance to the left leg with half the pelvis, without the shoe."""
    x, y, z = points.T
    pelvis = loft(y, x, z, _PELVIS, 0.03)
    buttock = ellipsoid(points, (0.075, 0.865, -0.075), (0.078, 0.078, 0.060))
    return smooth_min(loft(y, x, z, _LEG, 0.008), smooth_min(pelvis, buttock, 0.05), 0.04)


def shoe_distance(points: Field) -> Field:
    """Distance to the left shoe, flat on y = 0."""
    heel = round_cone(points, (0.117, 0.036, -0.038), (0.121, 0.032, 0.07), 0.046, 0.048)
    toe = round_cone(points, (0.121, 0.030, 0.07), (0.122, 0.024, 0.142), 0.048, 0.036)
    ankle = round_cone(points, (0.117, 0.05, -0.028), (0.117, 0.10, -0.022), 0.042, 0.040)
    whole = smooth_min(smooth_min(heel, toe, 0.03), ankle, 0.04)
    return smooth_max(whole, -points[:, 1], 0.008)


def head_points(points: Field) -> Field:
    """Points in the frame that the head is described in: natural size, same crown."""
    crown = np.array([0.0, HEIGHT, 0.0], dtype=np.float32)
    result: Field = (points - crown) / np.float32(HEAD_SCALE) + crown
    return result


def hairline(points: Field) -> Field:
    """Height of the hair's edge above a point of `head_points`; negative within the hair."""
    _, y, z = points.T
    line = np.interp(
        z,
        (-0.11, -0.05, -0.022, -0.006, 0.012, 0.024, 0.055, 0.10),
        (1.560, 1.572, 1.590, 1.632, 1.640, 1.668, 1.696, 1.704),
    )
    result: Field = (line - y).astype(np.float32)
    return result


def head_distance(points: Field) -> Field:
    """Distance to head, neck and hair."""
    x, y, z = points.T
    neck = loft(y, x, z, _NECK, 0.01)
    points = head_points(points)
    skull = ellipsoid(points, (0.0, 1.645, -0.004), (0.076, 0.092, 0.094))
    jaw = ellipsoid(points, (0.0, 1.586, 0.030), (0.058, 0.066, 0.060))
    chin = ellipsoid(points, (0.0, 1.542, 0.064), (0.028, 0.022, 0.024))
    head = smooth_min(smooth_min(skull, jaw, 0.05), chin, 0.035)
    nose = round_cone(points, (0.0, 1.634, 0.086), (0.0, 1.604, 0.104), 0.009, 0.0145)
    socket = ellipsoid(points, (0.033, 1.634, 0.108), (0.020, 0.013, 0.018))
    head = smooth_max(head, -socket, 0.02)
    ear = ellipsoid(points, (0.080, 1.615, -0.010), (0.012, 0.032, 0.019))
    head = smooth_min(smooth_min(head, nose, 0.014), ear, 0.008)
    cap = ellipsoid(points, (0.0, 1.648, -0.012), (0.087, 0.101, 0.104))
    quiff = ellipsoid(points, (0.0, 1.712, 0.058), (0.064, 0.030, 0.042))
    hair = smooth_max(smooth_min(cap, quiff, 0.03), hairline(points) * np.float32(0.8), 0.008)
    whole = smooth_min(head, hair, 0.004) * np.float32(HEAD_SCALE)
    return smooth_min(whole, neck, 0.014)


def body_distance(points: NDArray[np.floating]) -> Field:
    """Signed distance to the whole dressed body, metres, for (N, 3) points of either side."""
    mirrored = np.array(points, dtype=np.float32)
    mirrored[:, 0] = np.abs(mirrored[:, 0])
    upper = smooth_min(torso_distance(mirrored), arm_distance(mirrored), 0.04)
    lower = smooth_min(leg_distance(mirrored), shoe_distance(mirrored), 0.004)
    body = smooth_min(upper, lower, 0.005)
    return smooth_min(body, head_distance(mirrored), 0.006)


def region_fields(points: NDArray[np.floating]) -> dict[str, Field]:
    """Which cloth covers a point of the surface: negative inside, zero on the border.

    The first negative field in the order of `REGIONS` decides; where none is negative it is skin.
    The fields are only meant for points on or near the surface.
    """
    mirrored = np.array(points, dtype=np.float32)
    mirrored[:, 0] = np.abs(mirrored[:, 0])
    x, y, z = mirrored.T
    along, back, depth = arm_coordinates(mirrored)
    sleeve = np.minimum(along - np.float32(SLEEVE_END), np.float32(0.11) - np.hypot(back, depth))
    collar = np.minimum(
        np.float32(0.0675) - np.hypot(x, z + np.float32(0.016)), y - np.float32(1.36)
    )
    shirt = np.maximum(np.maximum(sleeve, collar), y - np.float32(1.475))
    return {
        "shoes": y - np.float32(TROUSER_HEM + 0.003),
        "hair": np.maximum(hairline(head_points(mirrored)), np.float32(1.5) - y),
        "trousers": np.maximum(y - np.float32(SHIRT_HEM + 0.003), x - np.float32(0.3)),
        "shirt": shirt.astype(np.float32),
    }


def surface_normals(points: NDArray[np.floating], step: float = 0.003) -> NDArray[np.float32]:
    """Unit gradient of the distance at (N, 3) points, outward, by central differences."""
    base = np.asarray(points, dtype=np.float32)
    gradient = np.empty_like(base)
    for axis in range(3):
        shift = np.zeros(3, dtype=np.float32)
        shift[axis] = step
        gradient[:, axis] = body_distance(base + shift) - body_distance(base - shift)
    gradient /= np.linalg.norm(gradient, axis=1, keepdims=True) + np.float32(1e-12)
    return gradient


def occlusion(points: NDArray[np.floating], normals: NDArray[np.float32]) -> Field:
    """How open the surface is, 0 (enclosed) to 1: the distance field walked along the normal.

    Ambient occlusion after Evans, "Fast approximations for global illumination on dynamic scenes"
    (2006): what the distance at a few steps lacks to the length of the step.
    """
    base = np.asarray(points, dtype=np.float32)
    closed = np.zeros(len(base), dtype=np.float32)
    for reach, weight in ((0.02, 0.30), (0.05, 0.30), (0.10, 0.25), (0.18, 0.15)):
        lack = reach - body_distance(base + normals * np.float32(reach))
        closed += np.float32(weight / reach) * np.maximum(lack, 0.0)
    result: Field = np.clip(1.0 - closed, 0.0, 1.0)
    return result
