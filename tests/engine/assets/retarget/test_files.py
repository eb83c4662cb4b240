"""Captured walks, runs, jumps and kicks on real characters: lengths, sliding feet and the floor."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bodies import model_places
from numpy.typing import NDArray

import tifo
from tifo.engine.animation.clip import Clip
from tifo.engine.animation.skeleton import Skeleton

DATA = Path(__file__).resolve().parents[5] / "shared" / "data"
TARGETS = ("spectator", "gltf/KayKit_Knight.glb", "gltf/CesiumMan.gltf")
QUICK = ("cmu_02_01", "cmu_09_06", "cmu_02_04", "cmu_10_01_soccerkick_30fps")
SLOW = (
    "cmu_02_02", "cmu_02_02_daz43", "cmu_02_03", "cmu_07_01", "cmu_07_04", "cmu_09_10",
    "cmu_09_12", "cmu_12_01_crlf", "cmu_131_01_max", "cmu_02_06", "mh_walk1", "100style_elated",
    "pybvh_test1_mixedorder", "derived_02_03_slowrun_on09skel",
)  # fmt: skip

Array = NDArray[Any]


@cache
def target_skeleton(name: str) -> Skeleton:
    if name == "spectator":
        return tifo.builtin_spectator().skeleton
    return tifo.load_motions(DATA / name).skeleton


@cache
def source(name: str) -> tuple[Skeleton, Clip]:
    motions = tifo.load_motions(DATA / "bvh" / f"{name}.bvh")
    return motions.skeleton, motions.clips[0]


def standing(skeleton: Skeleton, clip: Clip) -> dict[str, list[tuple[int, int]]]:
    """Spans in which a ball of a foot (the toe joint, else the ankle) of the source stands still.

    Below 0.2 m/s and within 3 cm of its lowest: plainer than what the code does, and stricter.
    """
    body = tifo.humanoid(skeleton)
    places = model_places(skeleton, clip)
    up = 2 if np.ptp(places[:, :, 2], axis=1).mean() > 1.3 else 1
    step = clip.duration / (clip.frame_count - 1)
    reach = max(round(0.03 / step), 1)
    found = {}
    for side in ("left", "right"):
        part = f"{side}_toe" if f"{side}_toe" in body.joints else f"{side}_foot"
        path = places[:, body.joints[part]]
        way = np.full(len(path), np.inf)
        way[reach:-reach] = np.linalg.norm(path[2 * reach :] - path[: -2 * reach], axis=1)
        low = path[:, up] < np.percentile(path[:, up], 3) + 0.03
        still = (way / (2 * reach * step) < 0.2) & low
        edges = np.flatnonzero(np.diff(np.concatenate([[0], still.astype(int), [0]])))
        spans = edges.reshape(-1, 2).tolist()
        # Who stands for long shifts their feet; a step is what lasts up to a second and a half.
        piece = round(1.5 / step)
        found[side] = [
            (first, min(first + piece, b))
            for a, b in spans
            for first in range(a, b, piece)
            if (min(first + piece, b) - first) * step > 0.08
        ]
    return found


def check(name: str, goal: str) -> None:
    skeleton, clip = source(name)
    target = target_skeleton(goal)
    body = tifo.humanoid(target)
    moved = tifo.retarget(clip, skeleton, target)
    places = model_places(target, moved)

    # Bones keep their lengths.
    for part, joint in body.joints.items():
        parent = int(target.parents[joint])
        if part != "hips" and parent >= 0:
            lengths = np.linalg.norm(places[:, joint] - places[:, parent], axis=1)
            assert np.ptp(lengths) < 1e-5, part

    rest = model_places(target, _rest(target))[0]
    bind = -np.einsum("jba,jb->ja", target.inverse_bind[:, :, :3], target.inverse_bind[:, :, 3])
    spans = standing(skeleton, clip)
    for side in ("left", "right"):
        toe = body.joints[f"{side}_toe"]
        stands = bind[toe, 1] if np.any(bind[toe]) else rest[toe, 1]
        # The ball of the foot never sinks, and while it stands it neither slides nor floats.
        assert places[:, toe, 1].min() > stands - 0.02
        for first, last in spans[side]:
            span = places[first:last, toe]
            slide = np.linalg.norm(np.ptp(span[:, [0, 2]], axis=0))
            assert slide < 0.02, f"{side} {first}-{last}: {100 * slide:.2f} cm"
            assert np.median(span[:, 1]) < stands + 0.03


def _rest(skeleton: Skeleton) -> Clip:
    return Clip(
        "rest",
        0.0,
        skeleton.rest_rotation[None],
        skeleton.rest_translation[None],
        skeleton.rest_scale[None],
    )


@pytest.mark.parametrize("goal", TARGETS)
@pytest.mark.parametrize("name", QUICK)
def test_a_walk_a_run_a_jump_and_a_kick(name: str, goal: str) -> None:
    if not DATA.is_dir():
        pytest.skip(f"the files are not at {DATA}")
    check(name, goal)


@pytest.mark.slow
@pytest.mark.parametrize("goal", TARGETS)
@pytest.mark.parametrize("name", SLOW)
def test_every_other_file(name: str, goal: str) -> None:
    if not DATA.is_dir():
        pytest.skip(f"the files are not at {DATA}")
    check(name, goal)


def test_the_poses_of_a_library_go_to_the_spectator() -> None:
    if not DATA.is_dir():
        pytest.skip(f"the files are not at {DATA}")
    knight = tifo.load_motions(DATA / "gltf" / "KayKit_Knight.glb")
    clips = {clip.name: clip for clip in knight.clips}
    spectator = target_skeleton("spectator")
    body = tifo.humanoid(spectator)
    cheer = model_places(spectator, tifo.retarget(clips["Cheer"], knight.skeleton, spectator))
    hand, head = (cheer[:, body.joints[part], 1] for part in ("left_hand", "head"))
    assert (hand - head).max() > 0.1
    # A single pose.
    pose = tifo.retarget(clips["T-Pose"], knight.skeleton, spectator)
    places = model_places(spectator, pose)[0]
    arm = places[body.joints["left_hand"]] - places[body.joints["left_upper_arm"]]
    assert pose.frame_count == 1
    assert arm[0] > 0.95 * np.linalg.norm(arm)


def test_a_body_that_its_file_collapses_is_put_up_again() -> None:
    if not DATA.is_dir():
        pytest.skip(f"the files are not at {DATA}")
    skeleton, clip = source("mh_tpose")
    moved = tifo.retarget(clip, skeleton, target_skeleton("spectator"))
    body = tifo.humanoid(target_skeleton("spectator"))
    places = model_places(target_skeleton("spectator"), moved)[0]
    # A T-pose of 173 joints along Z, whose position channels mean displacements.
    arm = places[body.joints["right_hand"]] - places[body.joints["right_upper_arm"]]
    assert arm[0] < -0.9 * np.linalg.norm(arm)
    assert places[body.joints["head"], 1] > 1.4
