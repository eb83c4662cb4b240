"""The seven joints that stand for a body."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest

from tifo.engine.assets.character import Character
from tifo.engine.crowd.figure import MARKERS, make_figure

NAMINGS = {
    "built-in": "hips chest foot_l foot_r head hand_l hand_r",
    "cmu": "Hips Spine LeftFoot RightFoot Head LeftHand RightHand",
    "mixamo": (
        "mixamorig:Hips mixamorig:Spine2 mixamorig:LeftFoot mixamorig:RightFoot mixamorig:Head "
        "mixamorig:LeftHand mixamorig:RightHand"
    ),
    "rigify": "hips chest foot.L foot.R head hand.L hand.R",
    "kaykit": "hips chest foot.l foot.r head hand.l hand.r",
    "robot": "Hips Torso FootL FootR Head Palm1L Palm1R",
    "unreal": "pelvis spine_03 foot_l foot_r head hand_l hand_r",
    "prefixes": "Pelvis Chest L_Ankle R_Ankle Head L_Wrist R_Wrist",
    "camel": "hip upperChest lFoot rFoot head lHand rHand",
    "shouting": "HIPS CHEST LEFT_FOOT RIGHT_FOOT HEAD LEFT_HAND RIGHT_HAND",
    "in the middle": "Bip01_Pelvis Bip01_Spine B_L_Foot B_R_Foot Bip01_Head B_L_Hand B_R_Hand",
}
IN_ORDER = (4, 1, 0, 5, 6, 2, 3)
"""Joints of the small person in the order of `MARKERS`."""


def _found(character: Character) -> dict[str, str]:
    joints = make_figure(character).joints
    return {m: character.skeleton.names[j] for m, j in zip(MARKERS, joints, strict=True)}


@pytest.mark.parametrize("naming", NAMINGS)
def test_joints_are_recognised_by_name(factories: ModuleType, naming: str) -> None:
    names = NAMINGS[naming].split()
    # Turned upside down and mirrored, so that places would give other joints than names.
    mirrored = factories.make_character(names=names, size=-1.0)
    assert make_figure(mirrored).joints.tolist() == list(IN_ORDER)
    assert make_figure(mirrored).joints.dtype == np.int64


def test_exact_names_win_over_names_that_contain_them(factories: ModuleType) -> None:
    parents = [-1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
    names = ["HipsControl", "Hips", "HeadTop_End", "Head", "LeftHandIndex1", "LeftHand"]
    names += ["RightHandThumb", "RightHand", "LeftFootIK", "LeftFoot", "RightFootIK", "RightFoot"]
    skeleton = factories.make_skeleton(parents, np.zeros((12, 3)), names=names)
    character = replace(factories.make_character(), skeleton=skeleton, clips=())
    found = _found(character)
    del found["chest"]
    assert found == {
        "head": "Head",
        "hips": "Hips",
        "hand_l": "LeftHand",
        "hand_r": "RightHand",
        "foot_l": "LeftFoot",
        "foot_r": "RightFoot",
    }


def test_hand_slots_and_shoulders_are_no_hands(factories: ModuleType) -> None:
    names = ["handslot.l", "LeftShoulder", "handslot.r", "RightFinger", "head"]
    names += ["palm.l", "palm.r"]
    found = _found(factories.make_character(names=names))
    assert (found["hand_l"], found["hand_r"]) == ("palm.l", "palm.r")


def test_other_bodies_get_the_joints_that_reach_farthest(factories: ModuleType) -> None:
    # A person again, but its joints are called by numbers.
    names = [f"node {k}" for k in range(7)]
    character = factories.make_character(names=names)
    joints = np.zeros((8, 4), np.uint16)
    joints[:7, 0] = np.arange(7)
    mesh = replace(character.meshes[0], joints=joints)
    found = _found(replace(character, meshes=(mesh,)))
    assert found["head"] == "node 4"
    assert (found["hand_l"], found["hand_r"]) == ("node 5", "node 6")
    assert (found["foot_l"], found["foot_r"]) == ("node 2", "node 3")
    assert {found["chest"], found["hips"]} == {"node 0", "node 1"}


def test_joints_that_move_no_vertex_do_not_stand_for_a_body(factories: ModuleType) -> None:
    # Only joint 0 has weights, wherever the others are.
    names = [f"node {k}" for k in range(7)]
    assert set(_found(factories.make_character(names=names)).values()) == {"node 0"}


def test_one_joint_is_enough(factories: ModuleType) -> None:
    skeleton = factories.make_skeleton([-1], np.zeros((1, 3)))
    character = replace(factories.make_character(), skeleton=skeleton, clips=())
    assert make_figure(character).joints.tolist() == [0] * 7


@pytest.mark.parametrize("size", [1.0, 0.01, 100.0])
def test_the_height_is_that_of_the_mesh(factories: ModuleType, size: float) -> None:
    assert make_figure(factories.make_character(size=size)).height == pytest.approx(1.75 * size)


def test_a_flat_body_has_some_height(factories: ModuleType) -> None:
    character = factories.make_character()
    flat = replace(character.meshes[0], positions=character.meshes[0].positions * [1, 0, 1])
    assert make_figure(replace(character, meshes=(flat,))).height > 0
