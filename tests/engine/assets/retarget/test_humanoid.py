"""Finding the parts of a human body in skeletons of all naming styles, and in nameless ones."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bodies import STYLES, Body, anatomy
from characters import make_body, make_skeleton
from scipy.spatial.transform import Rotation

import tifo
from tifo.engine.assets.retarget.names import read_name

DATA = Path(__file__).resolve().parents[5] / "shared" / "data"


@pytest.mark.parametrize("style", STYLES)
def test_every_style_of_names_is_understood(style: str) -> None:
    body = Body(style)
    found = tifo.humanoid(body.skeleton)
    wanted = {part: k for k, part in enumerate(body.parts)}
    wanted["spine_1"], wanted["spine_2"] = wanted.pop("spine"), wanted.pop("chest")
    wanted["neck_1"] = wanted.pop("neck")
    assert dict(found.joints) == wanted
    assert found.found_by == ("shape" if style == "nameless" else "names")
    assert found.unmapped == ()
    assert found.missing == ("left_fingers", "right_fingers")


@pytest.mark.parametrize("angle", [0.0, 45.0, 80.0])
@pytest.mark.parametrize("yaw", [0.0, 90.0, 180.0])
def test_a_nameless_body_is_told_by_its_shape(angle: float, yaw: float) -> None:
    limbs = {
        "left_upper_arm": Rotation.from_euler("z", -angle, degrees=True),
        "right_upper_arm": Rotation.from_euler("z", angle, degrees=True),
    }
    body = Body("nameless", limbs=limbs, world=Rotation.from_euler("y", yaw, degrees=True))
    joints = tifo.humanoid(body.skeleton).joints
    # The toes tell where the body faces, and so left from right.
    for part in ("left_upper_leg", "right_toe", "left_hand", "right_clavicle", "head"):
        assert body.parts[joints[part]] == part


@pytest.mark.parametrize(
    ("name", "side", "part", "numbers", "is_body"),
    [
        ("LHipJoint", "left", "hip", (), True),
        ("DEF-upper_arm.L.001", "left", "upperarm", (1,), True),
        ("kneeIK.l", "left", "kneeik", (), False),
        ("rShldr", "right", "shldr", (), True),
        ("lefthand", "left", "hand", (), True),
        ("upperarm_twist_01_l", "left", "upperarmtwist", (1,), False),
        ("mixamorig:HeadTop_End", "", "headtopend", (), False),
        ("__UpLeg_L", "left", "upleg", (), False),
        ("control-toe-roll.l", "left", "controltoeroll", (), False),
        ("Palm2L", "left", "palm", (2,), True),
    ],
)
def test_names_are_read(
    name: str, side: str, part: str, numbers: tuple[int, ...], is_body: bool
) -> None:
    found = read_name(name)
    # "Joint" is a word of rigs; CMU has a better name than hip for the thigh below it.
    assert (found.side, found.part, found.numbers, found.is_body) == (side, part, numbers, is_body)


def test_what_is_no_human_body_is_refused() -> None:
    with pytest.raises(tifo.NotHumanoidError, match="no joint was found for left_upper_leg"):
        tifo.humanoid(make_body())
    line = make_skeleton([-1, 0, 1, 2], np.tile([0.0, 0.3, 0.0], (4, 1)))
    with pytest.raises(tifo.NotHumanoidError, match="is not humanoid"):
        tifo.humanoid(line)
    one = make_skeleton([-1], np.zeros((1, 3)))
    with pytest.raises(tifo.NotHumanoidError):
        tifo.humanoid(one)


def test_a_mapping_overrides_what_is_found() -> None:
    body = Body("plain")
    found = tifo.humanoid(
        body.skeleton,
        {"head": None, "left_hand": "left_lower_arm"} | {"left_lower_arm": "left_hand"},
    )
    assert "head" not in found.joints
    assert "head" in found.unmapped
    assert "head" in found.missing
    assert body.parts[found.joints["left_hand"]] == "left_lower_arm"
    assert "head" in found.describe().splitlines()[-1]
    assert "left_foot: left_foot" in found.describe()


def test_a_mapping_alone_makes_a_body_of_any_names() -> None:
    names, _, _ = anatomy()
    body = Body("plain")
    strange = replace(body.skeleton, names=tuple(f"x{k}" for k in range(len(body.parts))))
    mapping = {
        part: f"x{k}" for k, part in enumerate(body.parts) if part.startswith(("left", "right"))
    }
    found = tifo.humanoid(strange, mapping)
    assert found.found_by == "mapping"
    assert {body.parts[found.joints[part]] for part in mapping} == set(mapping)
    assert found.joints["hips"] == body.parts.index("hips")
    assert set(names) >= set(mapping)


def test_arms_may_be_left_out_by_hand_only() -> None:
    mapping: dict[str, str | None] = {
        f"{side}_{part}": None
        for side in ("left", "right")
        for part in ("clavicle", "upper_arm", "lower_arm", "hand")
    }
    assert "left_hand" in tifo.humanoid(Body().skeleton, mapping).missing


@pytest.mark.parametrize(
    ("mapping", "cause"),
    [
        ({"tail": "head"}, "'tail' is no part of the body"),
        ({"head": "nose"}, "no joint 'nose'"),
        ({"head": "neck", "left_hand": "neck"}, "joint 'neck' is named for two parts"),
        ({"left_foot": None}, "no joint was found for left_foot"),
    ],
)
def test_wrong_mappings(mapping: dict[str, str | None], cause: str) -> None:
    with pytest.raises(ValueError, match=cause):
        tifo.humanoid(Body().skeleton, mapping)


def test_numbers_that_are_not_finite_are_refused() -> None:
    skeleton = Body().skeleton
    broken = skeleton.rest_translation.copy()
    broken[3, 1] = np.nan
    with pytest.raises(ValueError, match="rest_translation of the skeleton"):
        tifo.humanoid(replace(skeleton, rest_translation=broken))


FILES: dict[str, dict[str, str]] = {
    "bvh/cmu_02_01.bvh": {
        "left_upper_leg": "LeftUpLeg", "left_clavicle": "LeftShoulder", "spine_3": "Spine1",
    },
    "bvh/cmu_10_01_soccerkick_30fps.bvh": {
        "left_upper_leg": "LeftHip", "left_upper_arm": "LeftShoulder", "right_foot": "RightAnkle",
    },
    "bvh/cmu_02_02_daz43.bvh": {
        "hips": "hip", "left_index_2": "lIndex2", "right_upper_arm": "rShldr",
    },
    "bvh/mh_walk1.bvh": {
        "hips": "Root", "left_upper_leg": "UpLeg_L", "right_little_3": "Pinky3_R",
    },
    "bvh/mh_tpose.bvh": {
        "spine_5": "spine01", "left_clavicle": "clavicle.L", "left_thumb_2": "finger1-2.L",
    },
    "bvh/100style_elated.bvh": {"spine_4": "Chest4", "left_toe": "LeftToe"},
    "gltf/KayKit_Knight.glb": {"left_hand": "wrist.l", "hips": "hips", "right_toe": "toes.r"},
    "gltf/RobotExpressive.glb": {"hips": "Body", "left_foot": "FootL", "spine_1": "Hips"},
    "gltf/CesiumMan.gltf": {
        "hips": "node 2", "left_foot": "node 9", "left_hand": "node 18", "head": "node 20",
    },
}  # fmt: skip


@pytest.mark.parametrize("file", FILES)
def test_files_of_many_programs(file: str) -> None:
    if not DATA.is_dir():
        pytest.skip(f"the files are not at {DATA}")
    motions = tifo.load_motions(DATA / file)
    body = tifo.humanoid(motions.skeleton)
    assert body.found_by == ("shape" if "Cesium" in file else "names")
    some = FILES[file]
    assert {part: motions.skeleton.names[body.joints[part]] for part in some} == some


def test_a_bird_is_no_human() -> None:
    if not DATA.is_dir():
        pytest.skip(f"the files are not at {DATA}")
    with pytest.raises(tifo.NotHumanoidError, match="left_upper_arm"):
        tifo.humanoid(tifo.load_motions(DATA / "gltf" / "phoenix_bird.glb").skeleton)
