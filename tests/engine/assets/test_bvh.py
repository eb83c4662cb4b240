"""From a BVH file to a skeleton and a clip: conventions, units, keys and speed."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from tifo.engine.assets.bvh import BvhMotion, load_bvh, local_transforms
from tifo.engine.assets.bvh_document import parse_bvh
from tifo.engine.assets.rotations import angle_between, from_euler
from tifo.engine.errors import AssetError

# Depth first the joints are Hips, Left, Toe, Right; breadth first Hips, Left, Right, Toe.
HIERARCHY = """HIERARCHY
ROOT Hips
{
  OFFSET 10 90 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Left
  {
    OFFSET 20 -40 0
    CHANNELS 3 Yrotation Zrotation Xrotation
    JOINT Toe
    {
      OFFSET 0 -100 10
      CHANNELS 0
      End Site
      {
        OFFSET 0 -20 10
      }
    }
  }
  JOINT Right
  {
    OFFSET -20 -40 0
    CHANNELS 2 Zposition Xrotation
  }
}
"""


def write(tmp_path: Path, rows: list[list[float]], frame_time: float) -> Path:
    lines = [" ".join(repr(float(value)) for value in row) for row in rows]
    path = tmp_path / "a kick.bvh"
    path.write_text(
        f"{HIERARCHY}MOTION\nFrames: {len(rows)}\nFrame Time: {frame_time}\n" + "\n".join(lines)
    )
    return path


def load(tmp_path: Path, rows: list[list[float]], frame_time: float = 1 / 60) -> BvhMotion:
    return load_bvh(write(tmp_path, rows, frame_time), scale=0.01)


def row(*, x: float = 0.0, turn: float = 0.0, right: float = 0.0) -> list[float]:
    return [x, 90, 0, turn, 0, 0, 0, 0, 0, right, 0]


def test_the_skeleton_is_breadth_first_in_metres(tmp_path: Path) -> None:
    motion = load(tmp_path, [row()])
    skeleton = motion.skeleton
    assert skeleton.names == ("Hips", "Left", "Right", "Toe")
    assert skeleton.parents.tolist() == [-1, 0, 0, 1]
    np.testing.assert_allclose(
        skeleton.rest_translation,
        [[0.1, 0.9, 0], [0.2, -0.4, 0], [-0.2, -0.4, 0], [0, -1, 0.1]],
        rtol=1e-6,
    )
    np.testing.assert_array_equal(skeleton.rest_rotation, [[0, 0, 0, 1]] * 4)
    np.testing.assert_array_equal(skeleton.rest_scale, np.ones((4, 3)))
    np.testing.assert_allclose(
        -skeleton.inverse_bind[:, :, 3],
        [[0.1, 0.9, 0], [0.3, 0.5, 0], [-0.1, 0.5, 0], [0.3, -0.5, 0.1]],
        rtol=1e-6,
    )
    (end,) = motion.end_sites
    assert skeleton.names[end.joint] == "Toe"
    assert end.offset == pytest.approx((0.0, -0.2, 0.1))


def test_a_position_channel_replaces_its_component_of_the_offset(tmp_path: Path) -> None:
    clip = load(tmp_path, [row(x=7, right=30)]).clip
    np.testing.assert_allclose(clip.translation[0, 0], [0.07, 0.9, 0], rtol=1e-6)
    np.testing.assert_allclose(clip.translation[0, 2], [-0.2, -0.4, 0.3], rtol=1e-6)
    np.testing.assert_allclose(clip.translation[0, 3], [0, -1, 0.1], rtol=1e-6)


def test_rotations_are_multiplied_in_the_order_of_the_channels(tmp_path: Path) -> None:
    # Hips: Z 90, X 90 is Rz Rx, which takes +Y over +Z to +Z and +Z over -Y to +X.
    # Left: Y 90, Z 90 is Ry Rz, which takes +X over +Y to +Y and +Y over -X to +Z.
    clip = load(tmp_path, [[0, 90, 0, 90, 90, 0, 90, 90, 0, 0, 0]]).clip
    half = np.sqrt(0.5)
    z, x = np.array([0, 0, half, half]), np.array([half, 0, 0, half])
    y = np.array([0, half, 0, half])
    hips = np.array([z[3] * x[0], z[2] * x[0], z[2] * x[3], z[3] * x[3]])
    left = np.array([y[1] * z[2], y[1] * z[3], y[3] * z[2], y[3] * z[3]])
    assert angle_between(clip.rotation[0, 0].astype(float), hips) < 1e-6
    assert angle_between(clip.rotation[0, 1].astype(float), left) < 1e-6
    assert _turn(clip.rotation[0, 0], [0, 1, 0]) == pytest.approx([0, 0, 1], abs=1e-6)
    assert _turn(clip.rotation[0, 0], [0, 0, 1]) == pytest.approx([1, 0, 0], abs=1e-6)
    assert _turn(clip.rotation[0, 1], [1, 0, 0]) == pytest.approx([0, 1, 0], abs=1e-6)
    assert _turn(clip.rotation[0, 1], [0, 1, 0]) == pytest.approx([0, 0, 1], abs=1e-6)


def _turn(quaternion: np.ndarray, vector: list[float]) -> np.ndarray:
    xyz, w = quaternion[:3].astype(float), float(quaternion[3])
    across = np.cross(xyz, vector)
    return np.asarray(vector + 2 * (w * across + np.cross(xyz, across)))


@pytest.mark.parametrize(
    ("frame_time", "frames", "keys", "step"),
    [
        (1 / 240, 5, 5, 1),
        (0.0083333, 5, 5, 1),
        (0.016667, 5, 5, 1),
        (1 / 59.94, 5, 5, 1),
        (1 / 59, 5, 9, 2),
        (0.0333333, 5, 9, 2),
        (1 / 29.97, 5, 9, 2),
        (0.04, 5, 13, 3),
        (0.041667, 5, 13, 3),
        (1.0, 3, 121, 60),
        (0.0333333, 1, 1, 2),
    ],
)
def test_keys_are_whole_steps_between_the_frames(
    tmp_path: Path, frame_time: float, frames: int, keys: int, step: int
) -> None:
    path = write(tmp_path, [row(x=i, turn=10 * i**2) for i in range(frames)], frame_time)
    clip = load_bvh(path, scale=0.01).clip
    assert clip.name == "a kick"
    assert clip.frame_count == keys
    assert clip.duration == pytest.approx((frames - 1) * frame_time)
    assert clip.resampling_error == 0.0
    # The file's own frames are keys, to the last bit of float32.
    rotation, translation = local_transforms(parse_bvh(path))
    names = load_bvh(path, scale=0.01).skeleton.names
    order = [parse_bvh(path).names.index(name) for name in names]
    np.testing.assert_array_equal(
        np.abs(clip.rotation[::step]), np.abs(rotation[:, order]).astype(np.float32)
    )
    np.testing.assert_array_equal(
        clip.translation[::step], (0.01 * translation[:, order]).astype(np.float32)
    )
    np.testing.assert_array_equal(clip.scale, np.ones((keys, 4, 3)))


def test_keys_between_frames_lie_on_the_arc_and_on_the_line(tmp_path: Path) -> None:
    clip = load(tmp_path, [row(x=0, turn=170), row(x=6, turn=-160)], 1 / 20).clip
    # From 170 to 200 degrees over 180, the short way, and not back over 0.
    expected = from_euler((2,), np.radians([[170.0], [180.0], [190.0], [200.0]]))
    assert angle_between(clip.rotation[:, 0].astype(float), expected).max() < 1e-6
    np.testing.assert_allclose(clip.translation[:, 0, 0], [0, 0.02, 0.04, 0.06], atol=1e-7)


def test_neighbouring_keys_lie_in_one_hemisphere(tmp_path: Path) -> None:
    clip = load(tmp_path, [row(turn=turn) for turn in np.linspace(0, 1000, 120)]).clip
    assert (np.sum(clip.rotation[1:] * clip.rotation[:-1], axis=-1) > 0.9).all()


@pytest.mark.parametrize("scale", [0.0, -1.0, float("nan"), float("inf"), 1e-7, 1e7])
def test_a_scale_that_makes_no_sense(tmp_path: Path, scale: float) -> None:
    with pytest.raises(ValueError, match=r"scale is .*, expected metres a file unit"):
        load_bvh(write(tmp_path, [row()], 1 / 60), scale)


def test_a_scale_silences_the_guess(tmp_path: Path) -> None:
    path = write(tmp_path, [row()], 1 / 60)
    assert load_bvh(path, 0.5).scale == 0.5
    assert not load_bvh(path, 0.5).notes
    assert load_bvh(path).scale == 0.01
    assert "centimetre" in load_bvh(path).notes[0]


def test_several_roots_stand_side_by_side(tmp_path: Path) -> None:
    one = "ROOT {} {{ OFFSET 0 100 0 CHANNELS 1 Xposition JOINT {} {{ OFFSET 0 70 0 }} }}\n"
    path = tmp_path / "two.bvh"
    path.write_text(
        "HIERARCHY\n"
        + one.format("A", "a")
        + one.format("B", "b")
        + "MOTION\nFrames: 1\nFrame Time: 0.01\n-50 50\n"
    )
    motion = load_bvh(path, 0.01)
    assert motion.skeleton.names == ("A", "B", "a", "b")
    assert motion.skeleton.parents.tolist() == [-1, -1, 0, 1]
    np.testing.assert_allclose(motion.clip.translation[0, :2, 0], [-0.5, 0.5])


def test_a_file_with_more_keys_than_memory_is_refused_before_it_is_filled(tmp_path: Path) -> None:
    joints = "JOINT j{} {{ OFFSET 0 0 0 }}\n"
    path = tmp_path / "bomb.bvh"
    path.write_text(
        "HIERARCHY\nROOT r { OFFSET 0 0 0 CHANNELS 1 Xposition\n"
        + "".join(joints.format(number) for number in range(2000))
        + "}\nMOTION\nFrames: 2000\nFrame Time: 1\n"
        + "0\n" * 2000
    )
    with pytest.raises(AssetError, match="120000 keys of 2001 joints are more than"):
        load_bvh(path)


def test_speed_of_60_joints_and_1000_frames(tmp_path: Path) -> None:
    channels = "CHANNELS 3 Zrotation Xrotation Yrotation"
    rng = np.random.default_rng(1)
    path = tmp_path / "long.bvh"
    path.write_text(
        "HIERARCHY\nROOT r { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation "
        "Xrotation Yrotation\n"
        + "".join(f"JOINT j{n} {{ OFFSET 0 3 0 {channels}\n" for n in range(59))
        + "}" * 60
        + "\nMOTION\nFrames: 1000\nFrame Time: 0.01\n"
        + "\n".join(" ".join(f"{v:.6f}" for v in line) for line in rng.normal(0, 9, (1000, 183)))
    )
    best = np.inf
    for _ in range(3):
        start = time.perf_counter()
        motion = load_bvh(path)
        best = min(best, time.perf_counter() - start)
    assert motion.clip.rotation.shape == (1000, 60, 4)
    # About 0.1 s; the rest is room for a busy machine.
    assert best < 0.6
