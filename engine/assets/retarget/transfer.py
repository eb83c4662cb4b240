"""Moves a clip of one human body to another: the steps of retargeting in order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...animation.clip import Clip, continuous_hemisphere
from ...animation.skeleton import Skeleton
from .contacts import find_contacts
from .figure import Figure, figure_of
from .ground import floor_of, keep_on_ground
from .humanoid import SIDES, Humanoid, humanoid
from .legs import Legs
from .motion import body_motion
from .pose import local_turns, posed_turns
from .turns import Array, matrices_of, quaternions_of, transposed, turned


def retarget(
    clip: Clip,
    source: Skeleton | Humanoid,
    target: Skeleton | Humanoid,
    *,
    mapping: Mapping[str, str | None] | None = None,
    absolute: bool = False,
    ground: bool = True,
) -> Clip:
    """The motion of one human body as a clip of another's skeleton.

    Limbs point where the source's point, in model space, whatever the two rest poses are; bones
    keep the target's lengths, and only the hips move. The way of the hips is scaled by the ratio
    of the legs, and planted feet are held on the floor.

    Parameters
    ----------
    clip
        The motion.
    source
        Its skeleton.
    target
        The skeleton that gets it; a `Humanoid` if its parts must be named by hand.
    mapping
        Overrides for `source`: part to joint name, or to None to leave a part alone.
    absolute
        Keep the place and the heading that the body has in the file. By default the clip is
        relative to its agent: it begins at the origin and faces +Z.
    ground
        Hold planted feet and keep soles above the floor, which is y = 0 of the target.

    Returns
    -------
    Clip
        With the name, the keys, the events and the looping of `clip`.

    Raises
    ------
    ValueError
        If a skeleton is no human body (`NotHumanoidError`), or a clip or a mapping does not fit.
    """
    if isinstance(source, Humanoid):
        if mapping is not None:
            raise ValueError("mapping: the source is a Humanoid, which has its parts already")
        body = source
    else:
        body = humanoid(source, mapping)
    figure = figure_of(body)
    goal = figure_of(target if isinstance(target, Humanoid) else humanoid(target))
    motion = body_motion(clip, figure, absolute=absolute)
    contacts = find_contacts(motion)
    ratio = goal.leg / figure.leg
    middle = ratio * motion.hips
    middle[:, 1] = ratio * (motion.hips[:, 1] - contacts.floor - figure.sole)
    middle[:, 1] += floor_of(goal) + goal.sole
    if absolute:
        middle[:, [0, 2]] += (1 - ratio) * motion.hips[0, [0, 2]]
    legs = Legs(goal, posed_turns(motion, goal))
    if ground:
        middle = keep_on_ground(legs, middle, contacts, motion.step, looping=clip.looping)
    return _clip(clip, goal, legs, middle, ratio)


def _clip(clip: Clip, goal: Figure, legs: Legs, middle: Array, ratio: float) -> Clip:
    """Fill a clip of the target with turns, and the places of its hips."""
    skeleton = goal.humanoid.skeleton
    frames = len(middle)
    rotation = quaternions_of(local_turns(goal, legs.turns))
    translation = np.tile(skeleton.rest_translation.astype(np.float64), (frames, 1, 1))
    hips_place = middle - legs.middle()
    hips = goal.joints["hips"]
    translation[:, hips] = _in_parent(legs, hips, hips_place)
    for side in SIDES:
        if legs.is_detached(side):
            joint = goal.joints[f"{side}_foot"]
            place = hips_place + legs.place(f"{side}_foot")
            translation[:, joint] = _in_parent(legs, joint, place)
    return replace(
        clip,
        rotation=continuous_hemisphere(rotation).astype(np.float32),
        translation=translation.astype(np.float32),
        scale=np.tile(skeleton.rest_scale, (frames, 1, 1)),
        resampling_error=clip.resampling_error * ratio,
    )


def _in_parent(legs: Legs, joint: int, place: Array) -> Array:
    """(F, 3) model-space places in the space of the parent of `joint`, which rests."""
    skeleton = legs.figure.humanoid.skeleton
    chain: list[int] = []
    parent = int(skeleton.parents[joint])
    while parent >= 0:
        chain.append(parent)
        parent = int(skeleton.parents[parent])
    for above in reversed(chain):
        local = matrices_of(skeleton.rest_rotation[above].astype(np.float64))
        place = turned(transposed(local), place - skeleton.rest_translation[above])
        place = place / skeleton.rest_scale[above].astype(np.float64)
    return place
