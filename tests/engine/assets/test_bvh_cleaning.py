"""Guessed units, calibration rows, teleports and loops, on numbers made by hand."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.engine.assets.bvh_cleaning import (
    glitch_notes,
    guess_scale,
    leading_glitch,
    loops,
    rest_notes,
)
from tifo.engine.assets.bvh_document import BvhDocument
from tifo.engine.assets.bvh_hierarchy import EndSite
from tifo.engine.assets.rotations import from_euler

RATE = 1 / 120


def pole(height: float, axis: int = 1) -> BvhDocument:
    """A joint in the middle of a pole, another below it, and a tip above."""
    part = np.zeros(3)
    part[axis] = height / 2
    return BvhDocument(
        names=("middle", "foot"),
        parents=(-1, 0),
        offsets=np.array([[50.0, 50.0, 50.0], -part]),
        channels=(("xposition",), ("xposition", "yposition", "zposition")),
        end_sites=(EndSite(0, (part[0], part[1], part[2])),),
        frame_time=RATE,
        values=np.array([[0.0, *-part]]),
        notes=(),
    )


@pytest.mark.parametrize(
    ("height", "scale", "name"),
    [
        (1.75, 1.0, "metre"),
        (1.05, 1.0, "metre"),
        (17.2, 0.1, "decimetre"),
        (28.0, 0.0254 / 0.45, "CMU unit"),
        (68.0, 0.0254, "inch"),
        (178.0, 0.01, "centimetre"),
        (1690.0, 0.001, "millimetre"),
        # 40 is 1.02 m in inches, 2.26 m in CMU units and 0.4 m in centimetres.
        (40.0, 0.0254 / 0.45, "CMU unit"),
    ],
)
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_the_unit_that_makes_a_person(height: float, scale: float, name: str, axis: int) -> None:
    guessed, note = guess_scale(pole(height, axis))
    assert guessed == scale
    assert f"1 unit is taken as 1 {name}" in note
    assert f"{height * scale:.2f} m tall" in note


def test_a_skeleton_of_no_human_size_is_made_one() -> None:
    scale, note = guess_scale(pole(5.0))
    assert scale == pytest.approx(0.35)
    assert "1 unit is taken as 0.35 m, so that the skeleton is 1.75 m tall" in note


def test_a_skeleton_of_no_size() -> None:
    scale, note = guess_scale(pole(0.0))
    assert scale == 1.0
    assert "no size" in note


def test_notes_on_the_rest_pose() -> None:
    assert rest_notes(pole(2.0)) == []
    assert "Z up" in rest_notes(pole(2.0, axis=2))[0]
    on_parents = pole(2.0)
    on_parents.values[:] = 0.01
    assert "position channels of 1 joints put them onto their parents" in rest_notes(on_parents)[0]


def walk(frames: int = 60, joints: int = 6) -> tuple[np.ndarray, np.ndarray]:
    """Joints that swing by up to 40 degrees once in `frames`, a root that goes 1.5 m a second."""
    phase = 2 * np.pi * np.arange(frames)[:, None] / (frames - 1) + np.arange(joints)
    rotation = from_euler((0,), np.radians(40 * np.sin(phase))[..., None])
    root = np.zeros((frames, 1, 3))
    root[:, 0, 2] = 1.5 * RATE * np.arange(frames)
    return rotation, root


def t_pose(count: int, joints: int = 6) -> np.ndarray:
    return np.tile([0.0, 0.0, 0.0, 1.0], (count, joints, 1))


def test_clean_motion_keeps_all_rows() -> None:
    rotation, root = walk()
    assert leading_glitch(rotation, root, RATE) == 0
    assert glitch_notes(rotation, root, RATE, 0) == []


@pytest.mark.parametrize("rows", [1, 5, 10])
def test_a_t_pose_at_the_start_is_dropped(rows: int) -> None:
    rotation, root = walk()
    rotation = np.concatenate([t_pose(rows), rotation])
    root = np.concatenate([root[:1].repeat(rows, axis=0), root])
    assert leading_glitch(rotation, root, RATE) == rows
    (note,) = glitch_notes(rotation, root, RATE, rows)
    span = "row 0 is" if rows == 1 else f"rows 0 to {rows - 1} are"
    assert note.startswith(f"{span} a calibration pose")


def test_rows_elsewhere_at_the_start_are_dropped() -> None:
    rotation, root = walk()
    root[:3] += [0.0, 0.0, -2.0]
    assert leading_glitch(rotation, root, RATE) == 3


def test_a_glitch_is_not_looked_for_beyond_ten_rows_or_half_the_file() -> None:
    rotation, root = walk()
    late = np.concatenate([t_pose(11), rotation])
    assert leading_glitch(late, root[:1].repeat(len(late), axis=0), RATE) == 0
    assert leading_glitch(late[7:15], root[:8], RATE) == 4
    assert leading_glitch(late[6:14], root[:8], RATE) == 0


def test_a_list_of_poses_is_no_glitch() -> None:
    rng = np.random.default_rng(3)
    poses = from_euler((0, 1, 2), rng.uniform(-np.pi, np.pi, (20, 6, 3)))
    assert leading_glitch(poses, rng.normal(0, 1, (20, 1, 3)), RATE) == 0
    assert leading_glitch(poses[:2], np.zeros((2, 1, 3)), RATE) == 0
    assert leading_glitch(poses[:1], np.zeros((1, 1, 3)), RATE) == 0


def test_a_teleport_in_the_middle_is_kept_and_noted() -> None:
    rotation, root = walk()
    root[40:] += [3.0, 0.0, 0.0]
    assert leading_glitch(rotation, root, RATE) == 0
    assert glitch_notes(rotation, root, RATE, 0) == [
        "the root teleports at row 40; kept as the file has it"
    ]


def test_a_walk_on_the_spot_that_ends_as_it_begins_loops() -> None:
    rotation, root = walk()
    assert loops(rotation, np.zeros_like(root))
    # A loop that was keyed without its first pose at the end lacks one step.
    assert loops(rotation[:-1], np.zeros_like(root)[:-1])


def test_what_does_not_loop() -> None:
    rotation, root = walk()
    assert not loops(rotation, root + np.arange(len(root))[:, None, None] ** 2)
    assert not loops(rotation[:30], np.zeros((30, 1, 3)))
    assert not loops(rotation[:1], root[:1])


def test_a_walk_that_travels_does_not_loop() -> None:
    rotation, root = walk()
    assert not loops(rotation, root)
