"""Moving a clip of one human body to another, with bodies whose every limb is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bodies import Body, model_places
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import tifo
from tifo.engine.animation.clip import Clip, ClipEvent

LIMBS = [
    (f"{side}_{upper}", f"{side}_{lower}")
    for side in ("left", "right")
    for upper, lower in (
        ("upper_arm", "lower_arm"),
        ("lower_arm", "hand"),
        ("upper_leg", "lower_leg"),
        ("lower_leg", "foot"),
    )
]
"""Feet are not among them: they keep how they stand to the floor, not where their bones point."""


def turn(axis: str, degrees: float) -> Rotation:
    return Rotation.from_euler(axis, degrees, degrees=True)


STEP = {
    "hips": turn("y", 5),
    "chest": turn("y", -10),
    "head": turn("x", 20),
    "left_upper_arm": turn("z", -70) * turn("y", -20),
    "left_lower_arm": turn("y", -60),
    "right_upper_arm": turn("z", 60) * turn("x", 30),
    "right_lower_arm": turn("y", 80),
    "left_hand": turn("x", 25),
    "left_upper_leg": turn("x", -40) * turn("z", 5),
    "left_lower_leg": turn("x", 50),
    "right_upper_leg": turn("x", 20),
    "right_lower_leg": turn("x", 10),
}


def step_clip(body: Body, frames: int = 3) -> Clip:
    hips = np.array([[0.0, 0.9, 0.1 * k] for k in range(frames)])
    return body.clip([STEP] * frames, hips * body.flat[0, 1] / 0.94)


def directions(body: Body, clip: Clip) -> dict[tuple[str, str], np.ndarray]:
    places = model_places(body.skeleton, clip)
    found = {}
    for upper, lower in LIMBS:
        bone = places[:, body.parts.index(lower)] - places[:, body.parts.index(upper)]
        found[upper, lower] = bone / np.linalg.norm(bone, axis=1, keepdims=True)
    return found


A_POSE = {"left_upper_arm": turn("z", -45), "right_upper_arm": turn("z", 45)}
HANGING = {"left_upper_arm": turn("z", -90), "right_upper_arm": turn("z", 90)}
FORWARD = {"left_upper_arm": turn("y", -90), "right_upper_arm": turn("y", 90)}
SPREAD = {"left_upper_leg": turn("z", 20), "right_upper_leg": turn("z", -20)}
FACING_X, BACKWARD, Z_UP = turn("y", 90), turn("y", 180), turn("x", 90)


@pytest.mark.parametrize("limbs", [{}, A_POSE, HANGING, FORWARD, SPREAD])
@pytest.mark.parametrize("world", [Rotation.identity(), FACING_X, BACKWARD, Z_UP])
@pytest.mark.parametrize("absolute", [True, False])
def test_limbs_point_the_same_way_whatever_the_rest_poses_are(
    limbs: dict[str, Rotation], world: Rotation, absolute: bool
) -> None:
    """The source's true anatomy is known, so nothing is compared with what the code believes."""
    source = Body("mixamo", limbs=limbs, world=world, axes=np.random.default_rng(1))
    target = Body("plain", limbs=A_POSE, size=0.7, axes=np.random.default_rng(2))
    clip = step_clip(source)
    moved = tifo.retarget(clip, source.skeleton, target.skeleton, ground=False, absolute=absolute)
    wanted, found = directions(source, clip), directions(target, moved)
    heading = 0.0 if absolute else first_heading()
    for limb, bone in wanted.items():
        expected = turn("y", -heading).apply(bone)
        np.testing.assert_allclose(found[limb], expected, atol=2e-5, err_msg=str(limb))


def first_heading() -> float:
    """Heading between hips and chest, in degrees."""
    ahead = STEP["hips"].apply([0, 0, 1]) + (STEP["hips"] * STEP["chest"]).apply([0, 0, 1])
    return float(np.degrees(np.arctan2(ahead[0], ahead[2])))


@pytest.mark.parametrize("limbs", [{}, A_POSE, HANGING])
def test_twist_is_kept(limbs: dict[str, Rotation]) -> None:
    """A hand's palm faces where the source's does: the thumb's direction, from known anatomy."""
    source = Body(limbs=limbs, axes=np.random.default_rng(3))
    target = Body(limbs=A_POSE, axes=np.random.default_rng(4))
    clip = step_clip(source)
    moved = tifo.retarget(clip, source.skeleton, target.skeleton, ground=False, absolute=True)
    thumbs = []
    for body, motion in ((source, clip), (target, moved)):
        joint = body.parts.index("left_hand")
        model = Rotation.identity()
        chain = []
        while joint >= 0:
            chain.append(joint)
            joint = body.parents[joint]
        for joint in reversed(chain):
            model = model * Rotation.from_quat(motion.rotation[0, joint])
        hand = body.parts.index("left_hand")
        # In the T-pose thumbs point to +Z; a rest pose turned as a whole keeps that anatomy.
        thumb = body.frames[hand].inv() * body.rest_pose[hand]
        thumbs.append((model * thumb).apply([0, 0, 1]))
    np.testing.assert_allclose(thumbs[0], thumbs[1], atol=1e-5)


def test_a_motion_of_the_same_skeleton_is_itself() -> None:
    body = Body("unreal", limbs=A_POSE, axes=np.random.default_rng(5))
    clip = step_clip(body)
    moved = tifo.retarget(clip, body.skeleton, body.skeleton, ground=False, absolute=True)
    dots = np.abs(np.sum(moved.rotation * clip.rotation, axis=-1))
    np.testing.assert_allclose(dots, 1.0, atol=1e-6)
    here, there = model_places(body.skeleton, clip), model_places(body.skeleton, moved)
    # Only the floor is put to y = 0: the reference pose stands on it as the toes' height says.
    shift = (there - here)[0, 0]
    np.testing.assert_allclose(there, here + shift, atol=1e-5)
    np.testing.assert_allclose(shift[[0, 2]], 0, atol=1e-6)


@settings(max_examples=25, deadline=None)
@given(st.data())
def test_bones_keep_their_lengths_from_any_rest_pose(data: st.DataObject) -> None:
    angle = st.floats(-60, 60)
    names = ("left_upper_arm", "right_upper_arm", "left_lower_arm", "left_upper_leg", "chest")
    limbs = {n: turn("xyz"[k % 3], data.draw(angle)) for k, n in enumerate(names)}
    size = data.draw(st.sampled_from([0.0254, 1.0, 100.0]))
    seed = data.draw(st.integers(0, 99))
    source = Body(limbs=limbs, size=size, axes=np.random.default_rng(seed))
    target = Body(limbs=A_POSE, axes=np.random.default_rng(seed + 1))
    moved = tifo.retarget(step_clip(source), source.skeleton, target.skeleton)
    places = model_places(target.skeleton, moved)
    for joint, parent in enumerate(target.parents):
        if parent >= 0:
            length = np.linalg.norm(places[:, joint] - places[:, parent], axis=1)
            flat = np.linalg.norm(target.flat[joint] - target.flat[parent])
            np.testing.assert_allclose(length, flat, atol=1e-5)
    assert np.isfinite(moved.translation).all()
    # Whatever the unit of the source, the target stays a person on the floor.
    assert 0.5 < moved.translation[0, 0, 1] < 1.3


def test_hips_travel_by_the_ratio_of_the_legs() -> None:
    source, target = Body(), Body(size=0.5)
    moved = tifo.retarget(step_clip(source), source.skeleton, target.skeleton, ground=False)
    np.testing.assert_allclose(np.ptp(moved.translation[:, 0, 2]), 0.1, atol=0.005)


def test_relative_and_absolute_clips() -> None:
    """Figure 24 of the thesis: relative clips begin at the agent, absolute ones where they were."""
    body = Body()
    still = [{"hips": turn("y", 90)}] * 5
    clip = body.clip(still, np.array([[7.0 + 0.1 * k, 0.94, -3.0] for k in range(5)]))
    relative = tifo.retarget(clip, body.skeleton, body.skeleton)
    absolute = tifo.retarget(clip, body.skeleton, body.skeleton, absolute=True)
    np.testing.assert_allclose(relative.translation[0, 0, [0, 2]], 0, atol=1e-5)
    # It walked along +X, where it faced; now it walks along +Z.
    np.testing.assert_allclose(relative.translation[-1, 0, [0, 2]], [0, 0.4], atol=1e-5)
    np.testing.assert_allclose(
        Rotation.from_quat(relative.rotation[0, 0]).magnitude(), 0, atol=1e-3
    )
    np.testing.assert_allclose(absolute.translation[0, 0, [0, 2]], [7, -3], atol=1e-5)
    np.testing.assert_allclose(absolute.translation[-1, 0, [0, 2]], [7.4, -3], atol=1e-5)
    # The same pose either way.
    turned = Rotation.from_quat(absolute.rotation[0, 0]).as_euler("yxz", degrees=True)
    np.testing.assert_allclose(turned, [90, 0, 0], atol=1e-2)


def test_a_clip_below_a_root_is_relative_already() -> None:
    spectator = tifo.builtin_spectator()
    seated = spectator.clip("sit_idle")
    hips = spectator.skeleton.index("hips")
    moved = tifo.retarget(seated, spectator.skeleton, spectator.skeleton)
    # The seat is behind the feet, and stays there.
    np.testing.assert_allclose(moved.translation[:, hips], seated.translation[:, hips], atol=0.01)


def test_spines_of_other_lengths_share_the_bend() -> None:
    source, target = Body(), Body()
    bent = source.clip([{"spine": turn("x", 20), "chest": turn("x", 10)}], source.flat[:1])
    mapping = {"spine_1": "chest"}
    one = tifo.humanoid(target.skeleton, mapping)
    moved = tifo.retarget(bent, source.skeleton, one, ground=False)
    chest = target.parts.index("chest")
    # The only joint of that spine takes what the source's whole spine does.
    assert Rotation.from_quat(moved.rotation[0, chest]).magnitude() == pytest.approx(
        np.radians(30), abs=1e-4
    )


def stepping(body: Body, slide: float, sink: float) -> Clip:
    """Two seconds of standing in which the hips drift and so would the feet."""
    frames = 121
    share = np.linspace(0, 1, frames)
    hips = body.flat[0] + np.stack([0 * share, -sink * share, slide * share], axis=1)
    poses = []
    for k in share:
        bend = np.degrees(np.arccos(1 - (0.02 + sink * k) / 0.82))
        poses.append(
            {f"{s}_upper_leg": turn("x", -bend) for s in ("left", "right")}
            | {f"{s}_lower_leg": turn("x", 2 * bend) for s in ("left", "right")}
            | {f"{s}_foot": turn("x", -bend) for s in ("left", "right")}
        )
    return body.clip(poses, hips)


def test_planted_feet_stand_still() -> None:
    body = Body()
    clip = stepping(body, slide=0.15, sink=0.1)
    feet = [body.parts.index(f"{s}_foot") for s in ("left", "right")]
    loose = model_places(
        body.skeleton, tifo.retarget(clip, body.skeleton, body.skeleton, ground=False)
    )
    held = model_places(body.skeleton, tifo.retarget(clip, body.skeleton, body.skeleton))
    assert np.ptp(loose[:, feet, 2], axis=0).max() > 0.1
    assert np.ptp(held[:, feet], axis=0).max() < 1e-3
    # The body still moves over them.
    assert np.ptp(held[:, 0, 2]) > 0.1
    toes = [body.parts.index(f"{s}_toe") for s in ("left", "right")]
    np.testing.assert_allclose(held[:, toes, 1], body.flat[toes[0], 1], atol=1e-3)


def test_one_pose_stands_on_the_floor() -> None:
    body = Body()
    high = body.clip([STEP], np.array([[0.0, 5.0, 0.0]]))
    moved = tifo.retarget(high, body.skeleton, body.skeleton)
    assert moved.frame_count == 1
    places = model_places(body.skeleton, moved)
    toes = [body.parts.index(f"{s}_toe") for s in ("left", "right")]
    assert places[0, toes, 1].min() == pytest.approx(0.03, abs=0.02)


def test_events_and_names_are_kept() -> None:
    body = Body()
    clip = replace(step_clip(body), events=(ClipEvent(0.01, "clap"),))
    moved = tifo.retarget(clip, body.skeleton, Body("rigify").skeleton)
    assert (moved.name, moved.duration, moved.looping) == ("move", clip.duration, False)
    assert moved.events == clip.events


def test_bones_without_length_are_ignored() -> None:
    source, target = Body(), Body()
    skeleton = source.skeleton
    offsets = skeleton.rest_translation.copy()
    bind = skeleton.inverse_bind.copy()
    hand = source.parts.index("left_hand")
    offsets[hand] = 0
    bind[hand] = bind[source.parts.index("left_lower_arm")]
    flat = replace(skeleton, rest_translation=offsets, inverse_bind=bind)
    clip = step_clip(source)
    moved_hand = clip.translation.copy()
    moved_hand[:, hand] = 0
    moved = tifo.retarget(
        replace(clip, translation=moved_hand), flat, target.skeleton, ground=False, absolute=True
    )
    wanted, found = directions(source, clip), directions(target, moved)
    limb = ("left_upper_arm", "left_lower_arm")
    np.testing.assert_allclose(found[limb], wanted[limb], atol=1e-5)


def test_what_can_not_be_retargeted_says_why() -> None:
    body = Body()
    clip = step_clip(body)
    none = replace(
        body.skeleton,
        rest_translation=np.zeros_like(body.skeleton.rest_translation),
        inverse_bind=np.tile(np.eye(3, 4, dtype=np.float32), (len(body.parts), 1, 1)),
    )
    with pytest.raises(ValueError, match="legs of the skeleton have no length"):
        tifo.retarget(clip, none, body.skeleton)
    mirrored = body.skeleton.rest_scale.copy()
    mirrored[body.parts.index("chest"), 0] = -1
    with pytest.raises(ValueError, match="joint 'chest' is mirrored"):
        tifo.retarget(clip, body.skeleton, replace(body.skeleton, rest_scale=mirrored))
    spectator = tifo.builtin_spectator().skeleton
    with pytest.raises(ValueError, match="has 21 joints, its skeleton 24"):
        tifo.retarget(clip, spectator, body.skeleton)
    flat = clip.rotation.copy()
    flat[1, 3] = 0
    with pytest.raises(ValueError, match="rotations of length zero"):
        tifo.retarget(replace(clip, rotation=flat), body.skeleton, spectator)
    with pytest.raises(ValueError, match="mapping: the source is a Humanoid"):
        tifo.retarget(clip, tifo.humanoid(body.skeleton), spectator, mapping={})
