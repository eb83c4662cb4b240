"""Motions are smooth and alive: bounded acceleration and jerk, and nothing stands quite still."""

from __future__ import annotations

import numpy as np
from joint_motion import JointMotion

# Metres a second squared of the fastest joint, by the beginning of a name, first match. A clapping
# hand stops dead, a running shin is thrown; slow gestures stay near what gravity does.
FASTEST = (
    *((("run",), 420.0), (("jog", "jump", "kick", "hit_by_ball", "duck", "side_step"), 215.0)),
    *((("clap", "arm_up", "arm_down"), 250.0), (("walk",), 120.0)),
    *((("fist_pump", "chant", "angry", "protest", "cheer", "wave", "mexican", "boo"), 135.0),),
    *((("stand_up",), 30.0), (("sit_down", "stand_idle", "let_pass"), 45.0)),
    *((("idle", "sit", "look", "talk", "drink", "dismay"), 30.0),),
    *((("",), 80.0),),
)
IDLE = (
    *("sit", "sit_idle", "sit_idle_2", "sit_idle_3", "sit_idle_4", "sit_idle_5"),
    *("stand_idle", "stand_idle_2", "stand_idle_3", "stand_idle_4", "stand_idle_5"),
)


def limit(name: str) -> float:
    plain = name if name == "sit_down" else name.removeprefix("sit_")
    return next(most for words, most in FASTEST if plain.startswith(words))


def test_no_joint_is_thrown_about(motions: dict[str, JointMotion]) -> None:
    wrong = []
    for name, motion in motions.items():
        paths = motion.around(motion.places)
        fastest = np.linalg.norm(np.diff(paths, n=2, axis=0), axis=2).max() / motion.step**2
        if fastest > limit(name):
            wrong.append(f"{name} {fastest:.0f} > {limit(name):.0f}")
    assert not wrong


def test_jerk_is_bounded(motions: dict[str, JointMotion]) -> None:
    """No acceleration comes or goes from one key to the next where nothing hits anything."""
    for name, motion in motions.items():
        paths = motion.around(motion.places)
        jerk = np.linalg.norm(np.diff(paths, n=3, axis=0), axis=2).max() / motion.step**3
        hits = ("run", "jog", "jump", "clap", "sit_clap", "kick", "side_step", "arm_", "sit_arm_")
        assert jerk < (40000 if name.startswith(hits) else 16000), f"{name} {jerk:.0f}"


def test_no_joint_turns_faster_than_a_human_can(motions: dict[str, JointMotion]) -> None:
    """Fastest known: a thrown forearm twists some 80 rad/s, but nobody here throws."""
    for name, motion in motions.items():
        rotation = motion.clip.rotation.astype(np.float64)
        dots = np.abs(np.einsum("fjk,fjk->fj", rotation[1:], rotation[:-1]))
        speed = 2 * np.arccos(np.clip(dots, 0, 1)).max() / motion.step
        assert speed < 30, f"{name} {speed:.0f}"


def test_the_idle_breathe_and_never_freeze(motions: dict[str, JointMotion]) -> None:
    for name in IDLE:
        head = motions[name].place("head")
        assert np.ptp(head, axis=0).max() > 0.005, name
        moved = np.linalg.norm(np.diff(motions[name].places, axis=0), axis=2).max(axis=1)
        still = moved < 1e-5
        assert still.mean() < 0.05, name


def test_gestures_overlap(motions: dict[str, JointMotion]) -> None:
    """When an arm goes up the hips move first and the hand comes last: no robot does that."""
    for name in ("fist_pump", "point", "wave_3", "disappointed"):
        motion = motions[name]
        first = {}
        for joint in ("hips", "hand_r", "hand_l", "head"):
            way = np.linalg.norm(motion.place(joint) - motion.place(joint)[0], axis=1)
            reached = np.flatnonzero(way > 0.5 * way.max())
            first[joint] = motion.times[reached[0]]
        assert len(set(first.values())) >= 3, name
