"""The spectator's bodies and clothes as numbers: what `body` makes solids of.

All bodies hang on the same joints, so shoulders differ by their flesh and not by their bones. Only
what every body has in common is written in `body` itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from .shapes import Knots

Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Bulge:
    """An ellipsoid that rounds the trunk, and the metres over which it blends into it."""

    centre: Point
    radii: Point
    blend: float


@dataclass(frozen=True, slots=True)
class Outfit:
    """A dressed body.

    Parameters
    ----------
    name
        Of the choice that agents have.
    shares
        How many of which people have it; see `Variant`.
    trunk
        Cross-sections of the shirt: (height, half width, half depth, centre x, centre z). The
        first height is its hem.
    slope
        Ends and radii of the rod from the neck to the shoulder.
    bulges
        Of the left half of the trunk.
    sleeve
        (distance from the shoulder, half thickness, half width, centre towards the back, centre z);
        the last distance is the sleeve's end.
    pelvis, leg, seat
        Cross-sections like the trunk's, and the left buttock.
    bare_leg
        Cross-sections of the left leg below short trousers or a skirt; empty where trousers reach
        the shoes.
    skirt
        Cross-sections round both legs; empty without one.
    hem
        Height at which trousers or skirt end.
    limb, neck, jaw
        Factors on the thickness of arms and hands, of the neck, and on the width of the jaw.
    collar
        Radius of the neckline, metres.
    """

    name: str
    shares: Mapping[str, float]
    trunk: Knots
    slope: tuple[Point, Point, float, float]
    bulges: tuple[Bulge, ...]
    sleeve: Knots
    pelvis: Knots
    leg: Knots
    seat: Bulge
    bare_leg: Knots = ()
    skirt: Knots = ()
    hem: float = 0.070
    limb: float = 1.0
    neck: float = 1.0
    jaw: float = 1.0
    collar: float = 0.0675

    @property
    def shirt_hem(self) -> float:
        """Height at which the shirt ends."""
        return self.trunk[0][0]

    @property
    def sleeve_end(self) -> float:
        """Metres from the shoulder to the sleeve's end."""
        return self.sleeve[-1][0]


def _thick(knots: Knots, factor: float) -> Knots:
    """Tube with its half widths and depths multiplied."""
    return tuple((t, factor * a, factor * b, x, z) for t, a, b, x, z in knots)


_LONG_SLEEVE: Knots = (
    (-0.030, 0.040, 0.048, -0.004, -0.004),
    (0.010, 0.053, 0.060, -0.004, -0.004),
    (0.060, 0.057, 0.061, -0.002, -0.002),
    (0.160, 0.053, 0.055, 0.000, 0.001),
    (0.240, 0.049, 0.051, 0.000, 0.002),
    (0.290, 0.048, 0.051, 0.002, 0.000),
    (0.360, 0.046, 0.050, 0.002, 0.002),
    (0.440, 0.041, 0.044, 0.001, 0.001),
    (0.512, 0.037, 0.041, 0.000, 0.000),
)
_BARE_LEG: Knots = (
    (0.050, 0.036, 0.042, 0.117, -0.026),
    (0.110, 0.034, 0.040, 0.116, -0.026),
    (0.200, 0.043, 0.049, 0.114, -0.026),
    (0.310, 0.053, 0.060, 0.111, -0.024),
    (0.400, 0.051, 0.056, 0.109, -0.010),
    (0.480, 0.050, 0.055, 0.106, 0.006),
    (0.560, 0.056, 0.062, 0.103, 0.006),
    (0.680, 0.068, 0.074, 0.098, 0.000),
    (0.760, 0.074, 0.082, 0.094, -0.006),
)
_SHORTS_HEM = 0.520
_SHORTS: Knots = (
    (_SHORTS_HEM, 0.079, 0.086, 0.106, 0.004),
    (0.600, 0.080, 0.086, 0.102, 0.003),
    (0.700, 0.083, 0.089, 0.097, -0.002),
    (0.780, 0.088, 0.095, 0.092, -0.008),
    (0.860, 0.088, 0.101, 0.088, -0.014),
    (0.930, 0.076, 0.090, 0.080, -0.016),
)

MAN = Outfit(
    name="man_shirt",
    shares={"man": 0.5, "old man": 0.4},
    trunk=(
        (0.910, 0.170, 0.116, 0.0, -0.016),
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
    ),
    slope=((0.03, 1.437, -0.028), (0.150, 1.405, -0.022), 0.042, 0.048),
    bulges=(
        Bulge((0.068, 1.318, 0.066), (0.078, 0.060, 0.034), 0.05),
        Bulge((0.085, 1.330, -0.090), (0.070, 0.085, 0.036), 0.05),
    ),
    sleeve=(
        (-0.030, 0.040, 0.048, -0.004, -0.004),
        (0.010, 0.053, 0.060, -0.004, -0.004),
        (0.060, 0.057, 0.061, -0.002, -0.002),
        (0.120, 0.056, 0.058, 0.000, 0.000),
        (0.172, 0.056, 0.057, 0.000, 0.000),
    ),
    pelvis=(
        (0.790, 0.100, 0.080, 0.0, -0.020),
        (0.830, 0.150, 0.106, 0.0, -0.024),
        (0.880, 0.164, 0.112, 0.0, -0.022),
        (0.930, 0.158, 0.104, 0.0, -0.014),
        (0.990, 0.140, 0.090, 0.0, -0.004),
    ),
    leg=(
        (0.070, 0.053, 0.060, 0.118, -0.020),
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
    ),
    seat=Bulge((0.075, 0.865, -0.075), (0.078, 0.078, 0.060), 0.05),
)

MAN_SWEATER = replace(
    MAN,
    name="man_sweater",
    shares={"man": 0.3, "old man": 0.6},
    trunk=(
        (0.865, 0.181, 0.130, 0.0, -0.022),
        (0.900, 0.186, 0.130, 0.0, -0.018),
        (0.960, 0.180, 0.124, 0.0, -0.011),
        (1.030, 0.172, 0.117, 0.0, -0.004),
        (1.100, 0.169, 0.114, 0.0, -0.002),
        (1.180, 0.172, 0.117, 0.0, -0.002),
        (1.250, 0.179, 0.120, 0.0, -0.004),
        (1.310, 0.182, 0.118, 0.0, -0.009),
        (1.355, 0.177, 0.109, 0.0, -0.014),
        (1.405, 0.148, 0.088, 0.0, -0.020),
        (1.440, 0.098, 0.072, 0.0, -0.022),
        (1.484, 0.070, 0.070, 0.0, -0.020),
    ),
    sleeve=_thick(_LONG_SLEEVE, 1.05),
    collar=0.061,
)
MAN_SHORTS = replace(
    MAN,
    name="man_shorts",
    shares={"man": 0.2},
    leg=_SHORTS,
    bare_leg=_BARE_LEG,
    hem=_SHORTS_HEM,
)

WOMAN = Outfit(
    name="woman_shirt",
    shares={"woman": 0.45, "old woman": 0.35},
    trunk=(
        (0.922, 0.171, 0.117, 0.0, -0.020),
        (0.965, 0.158, 0.107, 0.0, -0.011),
        (1.015, 0.140, 0.094, 0.0, -0.004),
        (1.080, 0.125, 0.085, 0.0, 0.000),
        (1.140, 0.125, 0.086, 0.0, 0.000),
        (1.220, 0.138, 0.094, 0.0, -0.004),
        (1.290, 0.148, 0.096, 0.0, -0.009),
        (1.345, 0.146, 0.090, 0.0, -0.016),
        (1.400, 0.124, 0.074, 0.0, -0.020),
        (1.432, 0.086, 0.060, 0.0, -0.022),
        (1.456, 0.057, 0.054, 0.0, -0.021),
    ),
    slope=((0.03, 1.430, -0.027), (0.148, 1.399, -0.020), 0.034, 0.040),
    bulges=(
        Bulge((0.066, 1.282, 0.070), (0.058, 0.058, 0.050), 0.035),
        Bulge((0.075, 1.330, -0.080), (0.062, 0.080, 0.032), 0.05),
    ),
    sleeve=(
        (-0.030, 0.035, 0.042, -0.004, -0.004),
        (0.010, 0.046, 0.052, -0.004, -0.004),
        (0.060, 0.049, 0.052, -0.002, -0.002),
        (0.105, 0.047, 0.050, 0.000, 0.000),
        (0.145, 0.047, 0.049, 0.000, 0.000),
    ),
    pelvis=(
        (0.780, 0.100, 0.080, 0.0, -0.022),
        (0.820, 0.154, 0.108, 0.0, -0.027),
        (0.870, 0.170, 0.115, 0.0, -0.026),
        (0.930, 0.158, 0.106, 0.0, -0.016),
        (0.990, 0.132, 0.086, 0.0, -0.004),
    ),
    leg=(
        (0.070, 0.044, 0.051, 0.117, -0.022),
        (0.170, 0.044, 0.050, 0.115, -0.022),
        (0.270, 0.050, 0.057, 0.112, -0.021),
        (0.360, 0.054, 0.060, 0.109, -0.014),
        (0.440, 0.053, 0.057, 0.107, 0.000),
        (0.500, 0.056, 0.060, 0.105, 0.006),
        (0.580, 0.065, 0.071, 0.102, 0.005),
        (0.680, 0.078, 0.085, 0.097, 0.000),
        (0.780, 0.089, 0.097, 0.093, -0.008),
        (0.860, 0.090, 0.103, 0.089, -0.016),
        (0.930, 0.076, 0.091, 0.080, -0.016),
    ),
    seat=Bulge((0.077, 0.862, -0.080), (0.080, 0.080, 0.064), 0.05),
    limb=0.86,
    neck=0.86,
    jaw=0.92,
    collar=0.066,
)
WOMAN_SWEATER = replace(
    WOMAN,
    name="woman_sweater",
    shares={"woman": 0.35, "old woman": 0.35},
    trunk=(
        (0.872, 0.182, 0.128, 0.0, -0.026),
        (0.915, 0.181, 0.124, 0.0, -0.020),
        (0.965, 0.168, 0.115, 0.0, -0.011),
        (1.020, 0.152, 0.104, 0.0, -0.004),
        (1.080, 0.141, 0.098, 0.0, 0.000),
        (1.150, 0.141, 0.099, 0.0, 0.000),
        (1.220, 0.149, 0.103, 0.0, -0.004),
        (1.290, 0.156, 0.102, 0.0, -0.009),
        (1.345, 0.152, 0.095, 0.0, -0.016),
        (1.400, 0.128, 0.078, 0.0, -0.020),
        (1.435, 0.086, 0.064, 0.0, -0.022),
        (1.480, 0.062, 0.062, 0.0, -0.020),
    ),
    sleeve=_thick(_LONG_SLEEVE, 0.90),
    collar=0.053,
)
WOMAN_SKIRT = replace(
    WOMAN,
    name="woman_skirt",
    shares={"woman": 0.20, "old woman": 0.30},
    bare_leg=_thick(_BARE_LEG, 0.93),
    leg=WOMAN.leg[6:],
    skirt=(
        (0.585, 0.190, 0.140, 0.0, -0.010),
        (0.680, 0.186, 0.134, 0.0, -0.012),
        (0.780, 0.182, 0.128, 0.0, -0.018),
        (0.860, 0.178, 0.124, 0.0, -0.022),
        (0.930, 0.162, 0.110, 0.0, -0.016),
    ),
    hem=0.585,
)

CHILD = replace(
    MAN,
    name="child_shirt",
    shares={"boy": 0.55, "girl": 0.7},
    trunk=(
        (0.905, 0.158, 0.114, 0.0, -0.012),
        (0.960, 0.154, 0.112, 0.0, -0.004),
        (1.020, 0.149, 0.110, 0.0, 0.002),
        (1.080, 0.146, 0.108, 0.0, 0.004),
        (1.160, 0.145, 0.104, 0.0, 0.001),
        (1.240, 0.149, 0.102, 0.0, -0.004),
        (1.300, 0.151, 0.099, 0.0, -0.010),
        (1.350, 0.148, 0.093, 0.0, -0.016),
        (1.400, 0.126, 0.078, 0.0, -0.020),
        (1.432, 0.090, 0.062, 0.0, -0.022),
        (1.458, 0.060, 0.056, 0.0, -0.022),
    ),
    slope=((0.03, 1.430, -0.027), (0.148, 1.400, -0.020), 0.036, 0.043),
    bulges=(),
    sleeve=_thick(MAN.sleeve, 0.93),
    pelvis=_thick(MAN.pelvis, 0.95),
    leg=_thick(MAN.leg, 0.97),
    limb=0.94,
    neck=0.84,
    jaw=0.96,
)
CHILD_SHORTS = replace(
    CHILD,
    name="child_shorts",
    shares={"boy": 0.45, "girl": 0.3},
    leg=_thick(_SHORTS, 0.97),
    bare_leg=_thick(_BARE_LEG, 0.94),
    hem=_SHORTS_HEM,
)

OUTFITS = (
    MAN,
    MAN_SWEATER,
    MAN_SHORTS,
    WOMAN,
    WOMAN_SWEATER,
    WOMAN_SKIRT,
    CHILD,
    CHILD_SHORTS,
)
"""The bodies that ship; the first is what is drawn where nobody chose."""
