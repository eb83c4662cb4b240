"""Feet and seats: nobody slides, sinks or floats."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from joint_motion import Array, JointMotion

from tifo.engine.assets.spectator import MOTIONS

Variants = Callable[..., Iterator[JointMotion]]

# Points of the sole in the bind pose, from the joint that carries them.
HEEL = ("foot", (0.0, -0.088, -0.060))
BALL = ("toe", (0.0, -0.028, 0.0))
TIP = ("toe", (0.0, -0.028, 0.060))
ON_GROUND = 0.004
"""Metres below which a point of the sole bears."""
SLIDE = 0.02
"""Metres that a planted point may move while it bears."""


def sole(motion: JointMotion, side: str) -> list[Array]:
    """Heel, ball and tip of a foot, (F, 3) each."""
    return [motion.point(joint + side, offset) for joint, offset in (HEEL, BALL, TIP)]


def contacts(bears: Array) -> Iterator[slice]:
    """Runs of keys in which something bears."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], bears.astype(int), [0]])))
    for start, stop in edges.reshape(-1, 2):
        yield slice(start, stop)


def test_soles_are_never_below_the_ground(motions: dict[str, JointMotion]) -> None:
    for motion in motions.values():
        for side in ("_l", "_r"):
            for point in sole(motion, side):
                assert point[:, 1].min() > -0.004, motion.name


def test_planted_feet_do_not_slide(motions: dict[str, JointMotion]) -> None:
    """On a ground that moves backwards at the clip's speed, which is 0 for all but gaits."""
    for name, motion in motions.items():
        moved = motion.times[:, None] * np.array([0.0, 0.0, MOTIONS[name].speed])
        for side in ("_l", "_r"):
            for point in sole(motion, side):
                for run in contacts(point[:, 1] < ON_GROUND):
                    track = (point + moved)[run][:, [0, 2]]
                    assert np.ptp(track, axis=0).max() < SLIDE, f"{name} {side} {run}"


def test_those_who_stay_stay_exactly(motions: dict[str, JointMotion]) -> None:
    walkers = ("walk", "jog", "run", "kick", "turn", "side_step", "let_pass", "hit_by", "angry")
    lifters = (*walkers, "jump", "stand_idle_5", "anticipate", "mexican", "duck", "reach_2")
    for name, motion in motions.items():
        if name.removeprefix("sit_").startswith(lifters):
            continue
        feet = np.stack([motion.place(f"{joint}{side}") for joint in ("foot", "toe")
                         for side in ("_l", "_r")])  # fmt: skip
        assert np.linalg.norm(feet - feet[:, :1], axis=2).max() < 0.005, name


def test_one_foot_bears_unless_it_is_a_jump_or_a_run(motions: dict[str, JointMotion]) -> None:
    for name, motion in motions.items():
        low = np.min([p[:, 1] for side in ("_l", "_r") for p in sole(motion, side)], axis=0)
        if name.startswith(("jump", "jog", "run")):
            assert low.max() > 0.015, f"{name} never leaves the ground"
        else:
            assert low.max() < 0.012, f"{name} floats"


def test_gaits_keep_their_speed_on_each_foot(variants: Variants) -> None:
    found = list(variants("walk", "jog", "run"))
    assert len(found) == 8
    for motion in found:
        speed = MOTIONS[motion.name].speed
        for side in ("_l", "_r"):
            ball = motion.point("toe" + side, BALL[1])
            run = max(contacts(ball[:, 1] < 0.001), key=lambda s: s.stop - s.start)
            z = ball[run, 2]
            assert len(z) >= 4
            np.testing.assert_allclose(np.diff(z) / motion.step, -speed, atol=0.12 * speed)
            assert np.ptp(motion.point("toe" + side, BALL[1])[run, 0]) < 0.01


def test_gaits_are_walks_and_runs(variants: Variants) -> None:
    """Walks have both feet down at times and never none; jogs and runs fly."""
    speeds = {}
    for motion in variants("walk", "jog", "run"):
        bears = [
            np.min([p[:, 1] for p in sole(motion, side)], axis=0) < ON_GROUND
            for side in ("_l", "_r")
        ]
        share = float(np.mean([b[:-1].mean() for b in bears]))
        both, none = (bears[0] & bears[1])[:-1].mean(), (~bears[0] & ~bears[1])[:-1].mean()
        if motion.name.startswith("walk"):
            assert 0.55 < share < 0.72
            assert both > 0.1
            assert none == 0
        else:
            assert share < 0.5
            assert none > 0.05
        # Left and right are half a cycle apart.
        left, right = motion.place("toe_l")[:-1], motion.place("toe_r")[:-1]
        half = len(left) // 2
        if len(left) % 2 == 0:
            np.testing.assert_allclose(np.roll(left[:, 2], half), right[:, 2], atol=0.02)
        speeds[motion.name] = MOTIONS[motion.name].speed
    assert speeds["walk_3"] < speeds["walk"] < speeds["walk_2"] < speeds["jog"] < speeds["run"]


def test_jumps_leave_the_ground_and_fall_freely(variants: Variants) -> None:
    for motion in variants("jump"):
        feet = [np.min([p[:, 1] for p in sole(motion, side)], axis=0) for side in ("_l", "_r")]
        flying = np.flatnonzero(np.minimum(*feet) > 0.012)
        seconds = len(flying) * motion.step
        assert 0.15 < seconds < 0.46, motion.name
        # In the air nothing but gravity moves the body's middle.
        hips = motion.place("hips")[flying[1] : flying[-1], 1]
        fall = np.diff(hips, n=2) / motion.step**2
        np.testing.assert_allclose(np.median(fall), -9.81, atol=0.8)
        landed = motion.place("toe_l")[-1] - motion.place("toe_l")[0]
        np.testing.assert_allclose(landed, 0.0, atol=1e-4)


def test_the_seated_stay_on_the_seat(motions: dict[str, JointMotion]) -> None:
    leaving = ("sit_down", "sit_mexican_wave")
    for name, motion in motions.items():
        if not name.startswith("sit") or name in leaving:
            continue
        hips = motion.place("hips")
        assert np.ptp(hips[:, 1]) < 0.012, name
        np.testing.assert_allclose(hips[:, 1], 0.612, atol=0.012, err_msg=name)
        np.testing.assert_allclose(hips[:, 2], -0.42, atol=0.05, err_msg=name)


@pytest.mark.parametrize("name", ["stand_up", "sit_down", "sit_mexican_wave"])
def test_hips_clear_the_seat_on_the_way(motions: dict[str, JointMotion], name: str) -> None:
    hips = motions[name].place("hips")
    assert hips[:, 1].min() > 0.600
    assert hips[:, 2].max() < 0.10
    if name == "sit_mexican_wave":
        assert hips[:, 1].max() > 0.90


def test_side_steps_go_aside_and_come_back(variants: Variants) -> None:
    for motion in variants("side_step"):
        far = np.abs(motion.place("hips")[:, 0] - motion.place("hips")[0, 0]).max()
        assert 0.2 < far < 0.4
        np.testing.assert_allclose(motion.place("foot_l")[-1], motion.place("foot_l")[0], atol=1e-4)
