"""A spectator's body as one signed distance and the borders between skin and clothes.

Only the left half is described; points are mirrored into it first, so the body is exactly
symmetric. Clothes are solids of their own, a centimetre proud of what they cover, which gives
sleeves, shirt and trousers a real hem.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .shapes import Field, ellipsoid, loft, round_cone, smooth_max, smooth_min
from .skeleton import ARM, HEIGHT, PALM, SHOULDER
from .wardrobe import Outfit

HEAD_SCALE = 1.07
"""Heads are drawn a little larger than life, because faces read from afar."""

REGIONS = ("shoes", "trousers", "shirt")
"""What covers the skin, in the order in which `Body.regions` decides."""

_NECK = (
    (1.400, 0.062, 0.062, 0.0, -0.026),
    (1.450, 0.054, 0.056, 0.0, -0.022),
    (1.500, 0.048, 0.052, 0.0, -0.016),
    (1.600, 0.050, 0.055, 0.0, -0.010),
)
# (distance from the shoulder, half thickness, half width, centre towards the back, centre z)
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


def head_points(points: Field) -> Field:
    """Points in the frame that the head is described in: natural size, same crown."""
    crown = np.array([0.0, HEIGHT, 0.0], dtype=np.float32)
    result: Field = (points - crown) / np.float32(HEAD_SCALE) + crown
    return result


def jaw_distance(points: Field, width: float) -> Field:
    """Distance to jaw and chin, for `head_points`; `width` is a factor."""
    jaw = ellipsoid(points, (0.0, 1.586, 0.030), (0.058 * width, 0.066, 0.060))
    chin = ellipsoid(points, (0.0, 1.542, 0.064), (0.028 * width, 0.022, 0.024))
    return smooth_min(jaw, chin, 0.035)


def shoe_distance(points: Field) -> Field:
    """Distance to the left shoe, flat on y = 0."""
    heel = round_cone(points, (0.117, 0.036, -0.038), (0.121, 0.032, 0.07), 0.046, 0.048)
    toe = round_cone(points, (0.121, 0.030, 0.07), (0.122, 0.024, 0.142), 0.048, 0.036)
    ankle = round_cone(points, (0.117, 0.05, -0.028), (0.117, 0.10, -0.022), 0.042, 0.040)
    whole = smooth_min(smooth_min(heel, toe, 0.03), ankle, 0.04)
    return smooth_max(whole, -points[:, 1], 0.008)


class Body:
    """One dressed body without hair, as a solid.

    Parameters
    ----------
    outfit
        Its measures.
    """

    def __init__(self, outfit: Outfit) -> None:
        self.outfit = outfit

    def arm(self, points: Field) -> Field:
        """Distance to the left arm with its sleeve."""
        limb = self.outfit.limb
        along, back, depth = arm_coordinates(points)
        sleeve = loft(along, back, depth, self.outfit.sleeve, 0.012)
        bare = loft(along, back / limb, depth / limb, _BARE_ARM, 0.01)
        hand = loft(along, back / limb, depth / limb, _HAND, 0.014)
        local = np.stack([along, back, depth], axis=1)
        thumb = smooth_min(
            round_cone(
                local, (0.562, 0.0, 0.022), (0.605, -0.012, 0.054), 0.019 * limb, 0.015 * limb
            ),
            round_cone(
                local, (0.605, -0.012, 0.054), (0.642, -0.018, 0.066), 0.014 * limb, 0.011 * limb
            ),
            0.01,
        )
        whole = smooth_min(smooth_min(bare, hand, 0.02), thumb, 0.014)
        return smooth_min(sleeve, whole, 0.004)

    def torso(self, points: Field) -> Field:
        """Distance to the shirt without its sleeves."""
        x, y, z = points.T
        trunk = loft(y, x, z, self.outfit.trunk, 0.012)
        whole = smooth_min(trunk, round_cone(points, *self.outfit.slope), 0.05)
        for bulge in self.outfit.bulges:
            whole = smooth_min(whole, ellipsoid(points, bulge.centre, bulge.radii), bulge.blend)
        return whole

    def leg(self, points: Field) -> Field:
        """Distance to the left leg with half the pelvis, without the shoe."""
        x, y, z = points.T
        outfit = self.outfit
        pelvis = loft(y, x, z, outfit.pelvis, 0.03)
        seat = ellipsoid(points, outfit.seat.centre, outfit.seat.radii)
        hips = smooth_min(pelvis, seat, outfit.seat.blend)
        whole = smooth_min(loft(y, x, z, outfit.leg, 0.008), hips, 0.04)
        if outfit.skirt:
            whole = smooth_min(whole, loft(y, x, z, outfit.skirt, 0.008), 0.01)
        if outfit.bare_leg:
            whole = smooth_min(whole, loft(y, x, z, outfit.bare_leg, 0.008), 0.004)
        return whole

    def head(self, points: Field) -> Field:
        """Distance to head and neck."""
        x, y, z = points.T
        thin = self.outfit.neck
        neck = loft(y, x / thin, (z + 0.016) / thin - 0.016, _NECK, 0.01) * np.float32(thin)
        points = head_points(points)
        skull = ellipsoid(points, (0.0, 1.645, -0.004), (0.076, 0.092, 0.094))
        head = smooth_min(skull, jaw_distance(points, self.outfit.jaw), 0.05)
        nose = round_cone(points, (0.0, 1.634, 0.086), (0.0, 1.604, 0.104), 0.009, 0.0145)
        socket = ellipsoid(points, (0.033, 1.634, 0.108), (0.020, 0.013, 0.018))
        head = smooth_max(head, -socket, 0.02)
        ear = ellipsoid(points, (0.080, 1.615, -0.010), (0.012, 0.032, 0.019))
        head = smooth_min(smooth_min(head, nose, 0.014), ear, 0.008)
        return smooth_min(head * np.float32(HEAD_SCALE), neck, 0.014)

    def distance(self, points: NDArray[np.floating]) -> Field:
        """Signed distance to the whole body, metres, for (N, 3) points of either side."""
        mirrored = np.array(points, dtype=np.float32)
        mirrored[:, 0] = np.abs(mirrored[:, 0])
        upper = smooth_min(self.torso(mirrored), self.arm(mirrored), 0.04)
        lower = smooth_min(self.leg(mirrored), shoe_distance(mirrored), 0.004)
        return smooth_min(smooth_min(upper, lower, 0.005), self.head(mirrored), 0.006)

    def regions(self, points: NDArray[np.floating]) -> dict[str, Field]:
        """Which cloth covers a point of the surface: negative inside, zero on the border.

        The first negative field in the order of `REGIONS` decides; where none is negative it is
        skin. The fields are only meant for points on or near the surface.
        """
        outfit = self.outfit
        mirrored = np.array(points, dtype=np.float32)
        mirrored[:, 0] = np.abs(mirrored[:, 0])
        x, y, z = mirrored.T
        along, back, depth = arm_coordinates(mirrored)
        on_arm = np.float32(0.11) - np.hypot(back, depth)
        sleeve = np.minimum(along - np.float32(outfit.sleeve_end), on_arm)
        neckline = np.float32(outfit.collar) - np.hypot(x, z + np.float32(0.016))
        collar = np.minimum(neckline, y - np.float32(1.36))
        top = outfit.trunk[-1][0] + 0.015
        shirt = np.maximum(np.maximum(sleeve, collar), y - np.float32(top))
        trousers = np.maximum(y - np.float32(outfit.shirt_hem + 0.003), x - np.float32(0.3))
        shoes = 0.073
        if outfit.bare_leg:
            shoes = 0.098
            trousers = np.maximum(trousers, np.float32(outfit.hem - 0.003) - y)
            shirt = np.maximum(shirt, np.float32(outfit.hem) - y)
        return {
            "shoes": y - np.float32(shoes),
            "trousers": trousers,
            "shirt": shirt.astype(np.float32),
        }
