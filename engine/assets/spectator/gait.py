"""Walking and running on the spot: the ground moves backwards at a constant speed.

A foot on the ground moves with it exactly: it touches with the heel (or flat), rolls onto the
sole, and leaves over the ball, and each of these points travels at the gait's speed while it
bears. The swing in between is a cubic whose ends match that speed. The hips are as high as both
legs allow, smoothed, so no leg is ever drawn straight; trunk and arms turn against the legs.
Shares of the cycle and angles follow J. Perry and J. Burnfield, *Gait Analysis* (2nd ed., 2010),
chapters 1 to 7, and T. Novacheck, *The biomechanics of running* (Gait and Posture 7, 1998).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .curves import Performance, keyed
from .poses import standing
from .rotations import Array, about, from_pitch_yaw_roll, rotate
from .skeleton import bind_positions

_GROUND = 0.028
"""Height of the ball joint of a flat foot, metres."""
_HEEL = np.array([0.0, -0.028, -0.178])
"""From the ball joint to the back of the heel's sole, in the frame of the flat foot."""
_DROP = 0.5
"""Metres a second at which a foot comes down."""
_LEG = 0.994
"""Share of its full length that a leg on the ground is drawn out to, at most."""


@dataclass(frozen=True, slots=True)
class Gait:
    """A way to walk or run.

    Parameters
    ----------
    speed
        Metres a second.
    seconds
        Of one cycle, two steps.
    stance
        Share of the cycle that a foot is on the ground; below a half it is a run.
    heel
        Radians that the toes are up when the heel touches.
    push
        Radians that the heel is up when the ball leaves.
    kick
        Metres that the foot is lifted behind in the swing.
    width
        Metres of each foot from the middle.
    lean
        Radians that the trunk leans forward.
    arms
        Metres that the hands swing to and fro.
    elbow
        Metres that the forearms are raised: 0 hanging, 0.25 bent at a right angle.
    bounce
        Metres of vertical motion on top of what the legs make.
    sway
        Metres to the bearing leg.
    twist
        Radians of the hips against the shoulders.
    ahead
        Share of the stance that lies before the hips.
    """

    speed: float
    seconds: float
    stance: float
    heel: float = 0.30
    push: float = 1.02
    kick: float = 0.055
    width: float = 0.085
    lean: float = 0.03
    arms: float = 0.17
    elbow: float = 0.03
    bounce: float = 0.0
    sway: float = 0.020
    twist: float = 0.09
    ahead: float = 0.50


WALKS = (
    Gait(1.30, 1.08, 0.61),
    Gait(1.62, 0.96, 0.59, push=1.08, arms=0.24, elbow=0.06, twist=0.12, lean=0.05),
    Gait(0.85, 1.26, 0.64, heel=0.20, push=0.85, arms=0.10, sway=0.030, lean=0.0, twist=0.06),
    Gait(1.18, 1.14, 0.62, width=0.115, sway=0.036, arms=0.15, elbow=0.05, lean=-0.03, twist=0.13),
)
JOGS = (
    Gait(
        2.5, 0.74, 0.38, heel=0.10, push=1.02, kick=0.20, width=0.060, lean=0.09, arms=0.22,
        elbow=0.22, bounce=0.030, sway=0.012, twist=0.14, ahead=0.44,
    ),
    Gait(
        2.1, 0.78, 0.40, heel=0.06, push=0.95, kick=0.13, width=0.085, lean=0.05, arms=0.15,
        elbow=0.20, bounce=0.024, sway=0.018, twist=0.10, ahead=0.44,
    ),
)  # fmt: skip
RUNS = (
    Gait(
        4.0, 0.66, 0.27, heel=0.04, push=1.10, kick=0.36, width=0.045, lean=0.16, arms=0.32,
        elbow=0.25, bounce=0.035, sway=0.008, twist=0.20, ahead=0.41,
    ),
    Gait(
        4.9, 0.56, 0.24, heel=-0.05, push=1.12, kick=0.40, width=0.035, lean=0.22, arms=0.38,
        elbow=0.26, bounce=0.035, sway=0.006, twist=0.24, ahead=0.38,
    ),
)  # fmt: skip


def contacts(gait: Gait) -> tuple[float, float]:
    """Seconds at which the left and the right foot touch the ground."""
    left = 0.25 * gait.seconds
    return left, left + 0.5 * gait.seconds


def moving(name: str, gait: Gait) -> Performance:
    """One cycle of a gait; it begins with the right foot bearing and the left one swinging by."""
    p = Performance(name, gait.seconds, standing())
    turn = p.times / gait.seconds
    feet = {}
    for side, touch in zip(("_l", "_r"), contacts(gait), strict=True):
        phase = (turn - touch / gait.seconds) % 1.0
        feet[side] = _foot(gait, phase)
    hips, hips_turn = _hips(gait, turn, feet)
    _set(p, "hips", hips)
    _set(p, "hips_turn", hips_turn)
    for side, (ball, lift, toes) in feet.items():
        _set(p, "ball" + side, ball)
        _set(p, "foot" + side, np.stack([lift, np.full_like(lift, 0.10)], axis=1))
        _set(p, "toes" + side, toes[:, None])
        _set(p, "knee" + side, np.tile([0.06, 0.0, 1.0], (len(turn), 1)))
    _upper(p, gait, turn)
    return p


def _foot(gait: Gait, phase: Array) -> tuple[Array, Array, Array]:
    """Ball (F, 3), heel lift (F,) and toe levelling (F,) of one foot, `phase` 0 at its contact."""
    step = gait.speed * gait.seconds * gait.stance
    front = step * gait.ahead
    flat, rise = 0.16 * gait.stance, 0.46 * gait.stance
    # Heel lift: negative while the heel bears, zero on the sole, then over the ball.
    swing = gait.stance + (1 - gait.stance) * np.array([0.22, 0.62, 0.9])
    angle = np.array(
        [
            (0.0, -gait.heel),
            (flat, 0.0),
            (rise, 0.0),
            (0.80 * gait.stance, 0.36 * gait.push),
            (gait.stance, gait.push),
            (swing[0], gait.push + 0.05 + 1.5 * gait.kick),
            (swing[1], 0.10 + 1.6 * gait.kick),
            (swing[2], -gait.heel),
            (1.0, -gait.heel),
        ]
    )
    lift = keyed(angle[:, 0], angle[:, 1:], phase)[:, 0]
    # On the ground: the ball where the bearing point wants it.
    ground = front - gait.speed * gait.seconds * phase
    ball = np.stack([np.full_like(phase, gait.width), np.full_like(phase, _GROUND), ground], axis=1)
    tipped = np.minimum(lift, 0.0)
    ball += _HEEL - rotate(about(0, tipped), np.broadcast_to(_HEEL, ball.shape))
    # In the air: back a little with the ground, forward, and back again to meet it.
    air = phase > gait.stance
    u = np.clip((phase - gait.stance) / (1 - gait.stance), 0.0, 1.0)
    travel = -gait.speed * gait.seconds * (1 - gait.stance)
    landing = (_HEEL - rotate(about(0, np.array([min(-gait.heel, 0.0)])), _HEEL[None]))[0]
    start, goal = front - step, front + landing[2]
    along = _hermite(
        u,
        (0.0, 0.15, 0.90, 1.0),
        (start, start + 0.07 * travel, goal - 0.04 * travel, goal),
        (travel, 0.0, 0.0, travel),
    )
    skewed = u**2 * (1 - u) ** 3 / 0.03456
    arc = gait.kick * skewed + 0.03 * np.sin(np.pi * u) ** 2
    ball[air, 2] = along[air]
    # It comes down at a speed, not on a soft landing that would scrape along the ground.
    drop = _DROP * gait.seconds * (1 - gait.stance) * u**3 * (1 - u)
    ball[air, 1] = (_GROUND + landing[1] * u * u * (3 - 2 * u) + arc + drop)[air]
    # Level on the ground; in the air the toes go on from the sole.
    late = gait.stance + (0.42 - 0.7 * gait.kick) * (1 - gait.stance)
    level = keyed(
        np.array([0.0, 0.999 * flat, flat, gait.stance, late, 1.0]),
        np.array([[0.0], [0.0], [1.0], [1.0], [0.2], [0.0]]),
        phase,
    )[:, 0]
    return ball, lift, np.where(lift > 0, level, 0.0)


def _hermite(
    at: Array, knots: tuple[float, ...], values: tuple[float, ...], slopes: tuple[float, ...]
) -> Array:
    """Cubic through values with given slopes."""
    k = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, len(knots) - 2)
    x, y, m = (np.array(part) for part in (knots, values, slopes))
    gap = x[k + 1] - x[k]
    u = (at - x[k]) / gap
    result: Array = (
        y[k] * (1 + 2 * u) * (1 - u) ** 2
        + m[k] * gap * u * (1 - u) ** 2
        + y[k + 1] * u * u * (3 - 2 * u)
        + m[k + 1] * gap * u * u * (u - 1)
    )
    return result


def _hips(
    gait: Gait, turn: Array, feet: dict[str, tuple[Array, Array, Array]]
) -> tuple[Array, Array]:
    """Place and turn of the hips: as high as the bearing legs allow, smooth and even."""
    one, two = 2 * np.pi * turn, 4 * np.pi * turn
    # The left foot touches at a quarter turn, so its leg is foremost there.
    yaw = -gait.twist * np.sin(one)
    # Half way through its stance a leg bears most; the left one half a stance after its contact.
    bearing = np.cos(2 * np.pi * (turn - 0.25 - gait.stance / 2))
    aside = gait.sway * bearing
    pitch = np.full_like(turn, 0.9 * gait.lean + 0.03)
    angles = np.stack([pitch, yaw, 2.0 * aside], axis=1)
    rotation = from_pitch_yaw_roll(angles)
    place = bind_positions()
    full = float(
        np.linalg.norm(place["lower_leg_l"] - place["upper_leg_l"])
        + np.linalg.norm(place["foot_l"] - place["lower_leg_l"])
    )
    highest = np.full(len(turn), np.inf)
    for side, (ball, lift, _) in feet.items():
        sign = 1.0 if side == "_l" else -1.0
        mirror = np.array([sign, 1.0, 1.0])
        own = {name: place[name + "_l"] * mirror for name in ("upper_leg", "foot", "toe")}
        ankle = ball * mirror + rotate(
            about(0, lift), np.broadcast_to(own["foot"] - own["toe"], ball.shape)
        )
        joint = rotate(rotation, np.broadcast_to(own["upper_leg"] - place["hips"], ball.shape))
        flat = (ankle - joint)[:, [0, 2]] - np.stack([aside, np.zeros_like(aside)], axis=1)
        reach = np.maximum((_LEG * full) ** 2 - (flat**2).sum(axis=1), 0.01)
        allowed = ankle[:, 1] - joint[:, 1] + np.sqrt(reach)
        phase = (turn - (0.25 if side == "_l" else 0.75)) % 1.0
        # Near contact and leaving the leg counts as well; in mid-swing it is bent anyway.
        bears = (phase < gait.stance + 0.01) | (phase > (0.99 if gait.stance > 0.5 else 0.92))
        highest = np.where(bears, np.minimum(highest, allowed), highest)
    known = np.isfinite(highest)
    heights = np.interp(turn, turn[known], highest[known], period=1.0)
    # Two beats a cycle, the same for both legs; then down until it fits everywhere.
    once = heights[:-1]
    if gait.stance < 0.5:
        # Lowest in the middle of each stance, highest in the air.
        smooth = once.mean() - gait.bounce * np.cos(4 * np.pi * (turn - 0.25 - gait.stance / 2))
    else:
        cosine, sine = (2 * (once * wave(two[:-1])).mean() for wave in (np.cos, np.sin))
        smooth = once.mean() + cosine * np.cos(two) + sine * np.sin(two)
    excess = float((smooth - highest)[known].max())
    height = smooth - max(excess, 0.0)
    return np.stack([aside, height, np.full_like(turn, -0.01)], axis=1), angles


def _upper(p: Performance, gait: Gait, turn: Array) -> None:
    """Trunk, head and arms against the legs."""
    one, two = 2 * np.pi * turn, 4 * np.pi * turn
    counter = gait.twist * np.sin(one)
    lean = np.full_like(turn, gait.lean)
    tilt = 0.03 * gait.sway / 0.02 * np.cos(2 * np.pi * (turn - 0.25 - gait.stance / 2))
    _set(p, "spine", np.stack([0.4 * lean, 0.9 * counter, -tilt], axis=1))
    _set(
        p, "chest", np.stack([0.4 * lean + 0.015 * np.cos(two), 1.3 * counter, -0.5 * tilt], axis=1)
    )
    _set(p, "neck", np.stack([0.06 - 0.5 * lean, -0.6 * counter, 0.3 * tilt], axis=1))
    nod = 0.02 * np.cos(two - 0.6)
    _set(p, "head", np.stack([-0.06 - 0.6 * lean + nod, -0.6 * counter, 0.4 * tilt], axis=1))
    for side, sign in (("_l", 1.0), ("_r", -1.0)):
        # The left hand is behind when the left leg is in front.
        swing = -sign * np.sin(one - 0.25)
        forward = np.maximum(swing, 0.0)
        e = gait.elbow
        place = np.stack(
            [
                0.245 - 0.10 * e / 0.25 * forward - 0.02 * forward,
                -0.315
                + 0.95 * e
                + (0.45 * e + 0.10 * gait.arms) * swing
                + 0.12 * gait.arms * swing**2,
                0.05 + 0.55 * e + gait.arms * (0.9 * swing + (0.1 - 1.8 * e) * forward),
            ],
            axis=1,
        )
        _set(p, "hand" + side, place)
        _set(p, "curl" + side, (0.45 + 4.2 * e + 0.08 * swing)[:, None])
        _set(p, "elbow" + side, np.tile([0.35, -0.35 * e / 0.25, -1.0], (len(turn), 1)))
        _set(p, "palm" + side, np.tile([-1.0, 0.0, -0.1], (len(turn), 1)))


def _set(p: Performance, name: str, values: Array) -> None:
    p.add(name, values - p.base[name])
