"""From what an animator thinks in (where the hands are, how the trunk leans) to joint rotations.

A performance is a set of *controls* over time. The trunk is turned joint by joint, hands and feet
are placed and the limbs follow by two-bone inverse kinematics, so feet stay planted and clapping
hands meet whatever the body does. Controls of the limbs are in mirrored coordinates: x points
outward on both sides, so a symmetric pose has equal values left and right.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...animation.skeleton import Skeleton
from ..rotations import multiply
from .limbs import bend_limb
from .rotations import (
    Array,
    about,
    about_axis,
    across,
    between_frames,
    from_pitch_yaw_roll,
    inverse,
    rotate,
    twist_angle,
    unit,
)
from .skeleton import ARM, PALM, bind_positions

CONTROLS: dict[str, tuple[float, ...]] = {
    "hips": (0.0, 0.947, -0.005),
    "hips_turn": (0.0, 0.0, 0.0),
    "spine": (0.0, 0.0, 0.0),
    "chest": (0.0, 0.0, 0.0),
    "neck": (0.0, 0.0, 0.0),
    "head": (0.0, 0.0, 0.0),
    "hand": (0.245, -0.315, 0.05),
    "rest": (0.125, 0.615, -0.16),
    "hold": (0.0,),
    "clasp": (0.0,),
    "elbow": (0.4, 0.0, -1.0),
    "palm": (-1.0, 0.0, -0.25),
    "finger": (0.0, 0.0, 1.0),
    "wrist": (0.0,),
    "curl": (0.35,),
    "shrug": (0.0,),
    "ball": (0.135, 0.028, 0.105),
    "foot": (0.0, 0.14),
    "toes": (1.0,),
    "knee": (0.16, 0.0, 1.0),
}
"""Controls and their values when standing at ease.

``hips`` is the joint's place in model space and the four turns after it are pitch, yaw and roll in
radians (pitch bends forward). The rest exist per side, with ``_l`` or ``_r`` added: ``hand`` is the
wrist relative to the chest joint in the chest's frame (in the head's, from the head joint, as far
as ``clasp`` is 1), ``rest`` the wrist in model space, used as far as ``hold`` is 1; ``elbow`` and
``knee`` say which way these point; ``palm`` is where the palm faces and ``finger`` where the
fingers point as far as ``wrist`` is 1 (else they go on from the forearm), in the frame of the
hand's place; ``curl`` closes the fingers, ``shrug`` lifts the shoulder (radians). ``ball`` is the
ball of the foot in model space, ``foot`` the lift of the heel and the outward turn in radians;
``toes`` 1 keeps the toes level.
"""

CENTRAL = ("hips", "hips_turn", "spine", "chest", "neck", "head")

_FOREARM_SHARE = 0.6
"""Part of the hand's turn about the forearm that the forearm's skin takes along."""

Controls = Mapping[str, Array]


def channels() -> dict[str, Array]:
    """Every control with its side, at the values of `CONTROLS`: name to (K,) float64."""
    full: dict[str, Array] = {}
    for name, value in CONTROLS.items():
        sides = ("",) if name in CENTRAL else ("_l", "_r")
        full.update({name + side: np.array(value) for side in sides})
    return full


def solve(skeleton: Skeleton, controls: Controls) -> tuple[Array, Array]:
    """Local joint transforms of a performance.

    Parameters
    ----------
    skeleton
        The spectator's.
    controls
        Every channel of `channels` over F frames, (F, K).

    Returns
    -------
    rotation, translation
        (F, J, 4) xyzw and (F, J, 3); only the hips' translation moves.
    """
    frames = len(controls["hips"])
    place = bind_positions()
    rotation = np.zeros((frames, skeleton.joint_count, 4))
    rotation[..., 3] = 1.0
    translation = np.tile(skeleton.rest_translation.astype(np.float64), (frames, 1, 1))
    hips = skeleton.index("hips")
    translation[:, hips] = controls["hips"]

    turned = {"hips": from_pitch_yaw_roll(controls["hips_turn"])}
    at = {"hips": np.asarray(controls["hips"])}
    rotation[:, hips] = turned["hips"]
    for parent, name in (
        ("hips", "spine"),
        ("spine", "chest"),
        ("chest", "neck"),
        ("neck", "head"),
    ):
        local = from_pitch_yaw_roll(controls[name])
        rotation[:, skeleton.index(name)] = local
        turned[name] = multiply(turned[parent], local)
        at[name] = at[parent] + rotate(turned[parent], place[name] - place[parent])
    for side, sign in (("_l", 1.0), ("_r", -1.0)):
        own = {name[:-2]: value for name, value in controls.items() if name.endswith(side)}
        mirror = np.array([sign, 1.0, 1.0])
        for joints in (
            _arm(own, at, turned, place, mirror),
            _leg(own, at["hips"], turned["hips"], place, mirror),
        ):
            for name, local in joints.items():
                rotation[:, skeleton.index(name + side)] = local
    return rotation, translation


def _arm(
    own: Controls,
    at: Mapping[str, Array],
    turned: Mapping[str, Array],
    place: Mapping[str, Array],
    mirror: Array,
) -> dict[str, Array]:
    """Local rotations of one arm, from the collar bone to the fingers."""
    bone = {
        name: place[name + "_l"] * mirror for name in ("shoulder", "upper_arm", "lower_arm", "hand")
    }
    chest, chest_turn = at["chest"], turned["chest"]
    hold, clasp = own["hold"], own["clasp"]

    def steer(direction: Array) -> Array:
        """A direction given in the frame of the hand's place, in model space."""
        vector = unit(direction * mirror)
        on_body = rotate(chest_turn, vector) * (1 - clasp) + rotate(turned["head"], vector) * clasp
        return unit(on_body * (1 - hold) + vector * hold)

    offset = own["hand"] * mirror
    free = chest + rotate(chest_turn, offset)
    on_head = at["head"] + rotate(turned["head"], offset)
    target = (free * (1 - clasp) + on_head * clasp) * (1 - hold) + own["rest"] * mirror * hold

    collar = _collar(own, target, chest, chest_turn, bone["upper_arm"] - place["chest"], mirror)
    shoulder_turn = multiply(chest_turn, collar)
    shoulder = chest + rotate(chest_turn, bone["shoulder"] - place["chest"])
    start = shoulder + rotate(shoulder_turn, bone["upper_arm"] - bone["shoulder"])
    upper, lower, _ = bend_limb(
        start,
        target,
        rotate(chest_turn, unit(own["elbow"] * mirror)),
        (bone["upper_arm"], bone["lower_arm"], bone["hand"]),
        np.array([0.0, 0.0, -1.0]),
        ease=0.06,
    )
    arm, palm = ARM * mirror, PALM * mirror
    straight = rotate(lower, arm)
    finger = unit(straight * (1 - own["wrist"]) + steer(own["finger"]) * own["wrist"])
    hand = between_frames(arm, palm, finger, across(steer(own["palm"]), finger))
    twist = twist_angle(multiply(inverse(lower), hand), arm)
    lower = multiply(
        lower, about_axis(np.broadcast_to(arm, straight.shape), _FOREARM_SHARE * twist)
    )
    close = np.broadcast_to(np.cross(arm, palm), straight.shape)
    return {
        "shoulder": collar,
        "upper_arm": multiply(inverse(shoulder_turn), upper),
        "lower_arm": multiply(inverse(upper), lower),
        "hand": multiply(inverse(lower), hand),
        "fingers": about_axis(close, own["curl"][:, 0]),
    }


def _collar(
    own: Controls, target: Array, chest: Array, chest_turn: Array, shoulder: Array, mirror: Array
) -> Array:
    """The collar bone lifts and comes forward with the hand, as the shoulder blade lets it."""
    reach = unit(rotate(inverse(chest_turn), target - chest) - shoulder) * mirror
    raised = np.clip((np.arcsin(np.clip(reach[:, 1], -1, 1)) + 0.6) / 2.1, 0.0, 1.0)
    lift = 0.55 * raised * raised * (3 - 2 * raised) + own["shrug"][:, 0]
    forward = 0.22 * reach[:, 2] * (1 - 0.5 * raised)
    sign = mirror[0]
    return multiply(about(1, -sign * forward), about(2, sign * lift))


def _leg(
    own: Controls, hips: Array, hips_turn: Array, place: Mapping[str, Array], mirror: Array
) -> dict[str, Array]:
    """Local rotations of one leg; the ball of the foot is where the controls say."""
    names = ("upper_leg", "lower_leg", "foot", "toe")
    bone = {name: place[name + "_l"] * mirror for name in names}
    lift, outward = own["foot"].T
    level = about(1, mirror[0] * outward)
    foot = multiply(level, about(0, lift))
    ankle = own["ball"] * mirror + rotate(foot, bone["foot"] - bone["toe"])
    start = hips + rotate(hips_turn, bone["upper_leg"] - place["hips"])
    upper, lower, _ = bend_limb(
        start,
        ankle,
        unit(own["knee"] * mirror),
        (bone["upper_leg"], bone["lower_leg"], bone["foot"]),
        np.array([0.0, 0.0, 1.0]),
        ease=0.0,
    )
    return {
        "upper_leg": multiply(inverse(hips_turn), upper),
        "lower_leg": multiply(inverse(upper), lower),
        "foot": multiply(inverse(lower), foot),
        "toe": about(0, -lift * own["toes"][:, 0]),
    }
