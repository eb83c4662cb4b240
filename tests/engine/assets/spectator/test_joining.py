"""Clips join: loops close, shared poses are equal, and every pose leads to every other."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest
from joint_motion import JointMotion

from tifo.engine.assets.character import Character
from tifo.engine.assets.spectator import MOTIONS
from tifo.engine.assets.spectator.clips import performances, spectator_clips
from tifo.engine.assets.spectator.poses import POSES
from tifo.engine.assets.spectator.rig import solve
from tifo.engine.assets.spectator.skeleton import spectator_skeleton

SEATED = {
    *("look_left", "look_right", "turn_left", "turn_right", "talk", "point", "laugh", "drink"),
    *("clap", "arm_up", "cheer", "arm_down", "fist_pump", "wave", "chant", "scarf_raise", "boo"),
    *("mexican_wave", "disappointed", "anticipate", "protest", "angry", "hit_by_ball", "duck"),
    *("reach", "let_pass"),
}
STANDING = SEATED | {
    *(
        "stand_idle",
        "jump",
        "hug_a",
        "hug_b",
        "side_step",
        "walk",
        "jog",
        "run",
        "kick",
        "sit_down",
    ),
}
FOUR = {
    *("sit_idle", "stand_idle", "talk", "sit_talk", "clap", "sit_clap", "arm_up", "sit_arm_up"),
    *("cheer", "sit_cheer", "arm_down", "sit_arm_down", "jump", "fist_pump", "wave", "chant"),
    *("anticipate", "disappointed", "sit_disappointed", "walk"),
}


def kinds(names: Iterable[str]) -> dict[str, int]:
    """How many variants there are of each motion."""
    found: dict[str, int] = {}
    for name in names:
        stem, _, number = name.rpartition("_")
        kind = stem if number.isdigit() else name
        found[kind] = found.get(kind, 0) + 1
    return found


def test_every_motion_is_there_and_the_common_ones_four_times(spectator: Character) -> None:
    names = [clip.name for clip in spectator.clips]
    assert sorted(names) == sorted(MOTIONS)
    assert len(set(names)) == len(names)
    found = kinds(names)
    assert found.keys() >= STANDING | {f"sit_{kind}" for kind in SEATED} | {"sit", "stand_up"}
    assert {kind for kind in FOUR if found[kind] < 4} == set()


def test_existing_names_are_kept(spectator: Character) -> None:
    names = """sit_idle sit_idle_2 sit_clap stand_up sit_down stand_idle stand_idle_2 clap cheer
    cheer_2 jump wave dismay"""
    for name in names.split():
        spectator.clip(name)


def test_loops_close(motions: dict[str, JointMotion]) -> None:
    for name, motion in motions.items():
        assert motion.clip.looping == MOTIONS[name].looping
        if motion.clip.looping:
            np.testing.assert_allclose(motion.places[-1], motion.places[0], atol=2e-4, err_msg=name)
            np.testing.assert_allclose(motion.turns[-1], motion.turns[0], atol=5e-4, err_msg=name)


def test_clips_start_and_end_in_the_poses_that_they_say(motions: dict[str, JointMotion]) -> None:
    """The poses are solved afresh from their controls, not taken from another clip."""
    skeleton = spectator_skeleton()
    wanted = {}
    for name, pose in POSES.items():
        rotation, translation = solve(skeleton, {k: v[None] for k, v in pose().items()})
        wanted[name] = (rotation[0], translation[0])
    checked = 0
    for name, motion in motions.items():
        known = MOTIONS[name]
        for key, pose_name in ((0, known.start), (-1, known.end)):
            if pose_name == "moving":
                continue
            rotation, translation = wanted[pose_name]
            dots = np.abs(np.einsum("jk,jk->j", motion.clip.rotation[key], rotation))
            assert dots.min() > 1 - 2e-7, f"{name} {pose_name}"
            np.testing.assert_allclose(motion.clip.translation[key], translation, atol=1e-5)
            checked += 1
    assert checked > 350


def test_every_pose_leads_to_every_other_without_a_blend() -> None:
    """Apart from gaits, and hands on the head, which are entered and left by a blend."""
    ways = {(motion.start, motion.end) for motion in MOTIONS.values()}
    poses = set(POSES) - {"hands_on_head"}
    for start in poses:
        reached = {start}
        while True:
            more = {end for begin, end in ways if begin in reached} | reached
            if more == reached:
                break
            reached = more
        assert reached >= poses, start


@pytest.mark.parametrize(
    ("kind", "frames"),
    [
        *(("arm_up", (10, 10)), ("sit_arm_up", (10, 10)), ("arm_down", (12, 12))),
        *(("cheer_beat", (10, 14)), ("sit_cheer_beat", (10, 14)), ("clap_beat", (7, 15))),
        *(("clap_begin", (10, 10)), ("clap_end", (12, 12))),
    ],
)
def test_reactions_are_short_pieces_of_whole_pose_frames(
    motions: dict[str, JointMotion], kind: str, frames: tuple[int, int]
) -> None:
    found = [motion for name, motion in motions.items() if name.startswith(kind)]
    assert found
    for motion in found:
        count = motion.clip.duration * 30
        assert count == pytest.approx(round(count), abs=1e-3), motion.name
        assert frames[0] <= round(count) <= frames[1], motion.name


def test_variants_differ(motions: dict[str, JointMotion]) -> None:
    """At some time some joint of a variant is 4 cm away from where it is in any other."""
    groups: dict[str, list[JointMotion]] = {}
    for name, motion in motions.items():
        stem, _, number = name.rpartition("_")
        groups.setdefault(stem if number.isdigit() else name, []).append(motion)
    share = np.linspace(0, 1, 25)
    for kind, members in groups.items():
        sampled = [
            motion.places[np.rint(share * (motion.clip.frame_count - 1)).astype(int)]
            for motion in members
        ]
        limit = 0.02 if "_beat" in kind else 0.04
        for k, one in enumerate(sampled):
            for other in sampled[:k]:
                assert np.linalg.norm(one - other, axis=2).max() > limit, kind


def test_clips_are_not_kept_up_by_the_file_alone(spectator: Character) -> None:
    skeleton = spectator_skeleton()
    assert spectator.skeleton.names == skeleton.names
    for name in ("parents", "rest_rotation", "rest_translation", "inverse_bind"):
        np.testing.assert_allclose(
            getattr(spectator.skeleton, name), getattr(skeleton, name), atol=1e-5
        )
    shipped = {clip.name: clip for clip in spectator.clips}
    for performance in performances():
        clip = shipped[performance.name]
        assert clip.looping == performance.looping
        assert clip.duration == pytest.approx(performance.duration, abs=1e-4)
        assert clip.frame_count == len(performance.times)


@pytest.mark.slow
def test_shipped_clips_are_what_the_code_makes(spectator: Character) -> None:
    made = spectator_clips(spectator_skeleton())
    assert [clip.name for clip in made] == [clip.name for clip in spectator.clips]
    for clip, shipped in zip(made, spectator.clips, strict=True):
        dots = np.abs(np.einsum("fjk,fjk->fj", shipped.rotation, clip.rotation))
        # Half of the angle that a thinned clip may be off.
        assert dots.min() > np.cos(0.002), clip.name
        np.testing.assert_allclose(shipped.translation, clip.translation, atol=3.1e-3)
