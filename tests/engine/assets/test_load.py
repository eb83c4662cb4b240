"""Opening a character by its suffix, and adding the motions of other files to it."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tifo.engine.animation.clip import Clip
from tifo.engine.assets import gltf
from tifo.engine.assets.character import Character
from tifo.engine.assets.load import add_motions, load_character
from tifo.engine.errors import AssetError

DATA = Path(__file__).resolve().parents[4] / "shared" / "data"


def bvh(
    path: Path,
    *,
    unit: float = 1.0,
    hand: tuple[float, float, float] = (0, -60, 0),
    hand_name: str = "Hand",
    arm_parent: str = "Hips",
    turn: float = 40.0,
) -> Path:
    """Two frames of Hips, Head, Arm and Hand, 1.7 m tall in centimetres times `unit`."""
    hips = f"OFFSET 0 {90 * unit} 0\nCHANNELS 4 Xposition Yposition Zposition Yrotation\n"
    head = f"JOINT Head {{ OFFSET 0 {80 * unit} 0 End Site {{ OFFSET 0 0 0 }} "
    x, y, z = (unit * value for value in hand)
    arm = (
        f"JOINT Arm {{ OFFSET {20 * unit} {50 * unit} 0 CHANNELS 1 Zrotation\n"
        f"JOINT {hand_name} {{ OFFSET {x} {y} {z} CHANNELS 1 Zrotation\n}} }}\n"
    )
    leg = f"End Site {{ OFFSET 0 {-90 * unit} 0 }}\n"
    body = head + "}\n" + arm if arm_parent == "Hips" else head + arm + "}\n"
    path.write_text(
        f"HIERARCHY\nROOT Hips {{\n{hips}{body}{leg}}}\n"
        f"MOTION\nFrames: 2\nFrame Time: 0.0166667\n"
        f"0 {90 * unit} 0 0 0 0\n{30 * unit} {90 * unit} 0 10 20 {turn}\n"
    )
    return path


def test_a_bvh_file_becomes_a_figure_with_one_clip(tmp_path: Path) -> None:
    character = load_character(bvh(tmp_path / "Jump.BVH"))
    assert character.name == "Jump"
    assert [clip.name for clip in character.clips] == ["Jump"]
    assert character.skeleton.names == ("Hips", "Head", "Arm", "Hand")
    assert character.triangle_count > 0
    assert "centimetre" in character.notes[0]
    assert load_character(str(tmp_path / "Jump.BVH"), scale=0.5).notes == ()


def test_a_gltf_file_goes_to_its_reader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sentinel = load_character(bvh(tmp_path / "a.bvh"))
    seen: list[Path] = []

    def fake(path: Path) -> Character:
        seen.append(path)
        return sentinel

    monkeypatch.setattr(gltf, "load_gltf", fake)
    for name in ("fan.glb", "fan.gltf", "FAN.GLB"):
        (tmp_path / name).write_bytes(b"")
        assert load_character(tmp_path / name) is sentinel
    assert [path.name for path in seen] == ["fan.glb", "fan.gltf", "FAN.GLB"]
    with pytest.raises(AssetError, match="a scale is for BVH files only"):
        load_character(tmp_path / "fan.glb", scale=2.0)


def test_files_that_can_not_be_opened(tmp_path: Path) -> None:
    (tmp_path / "folder.bvh").mkdir()
    (tmp_path / "scene.fbx").write_bytes(b"x")
    (tmp_path / "plain").write_bytes(b"x")
    for name, cause in (
        ("none.glb", "there is no such file"),
        ("none.bvh", "there is no such file"),
        ("none.xyz", "there is no such file"),
        ("folder.bvh", "is a folder, expected a file (.glb, .gltf, .bvh)"),
        ("scene.fbx", "'.fbx' files can't be read, only .glb, .gltf, .bvh"),
        ("plain", "files without a suffix can't be read"),
        ("x" * 5000 + ".bvh", "can't be read: File name too long"),
        ("a\0b.bvh", "there is no such file"),
    ):
        with pytest.raises(AssetError) as caught:
            load_character(tmp_path / name)
        assert cause in caught.value.cause
        assert caught.value.path == tmp_path / name
        character = load_character(bvh(tmp_path / "a.bvh"))
        with pytest.raises(AssetError):
            add_motions(character, [tmp_path / name])


@pytest.mark.skipif(os.name != "posix", reason="file modes and pipes are of POSIX")
def test_files_that_may_not_be_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.bvh")
    with pytest.raises(AssetError, match="is not a regular file"):
        load_character(tmp_path / "pipe.bvh")
    if os.geteuid() == 0:
        return
    path = bvh(tmp_path / "locked.bvh")
    path.chmod(0)
    with pytest.raises(AssetError, match="can't be read: Permission denied"):
        load_character(path)


def test_a_motion_of_the_same_skeleton_is_added(tmp_path: Path) -> None:
    """This one is no human body, so nothing is retargeted."""
    character = load_character(bvh(tmp_path / "walk.bvh"))
    more = add_motions(character, [bvh(tmp_path / "wave.bvh", turn=80.0)])
    assert [clip.name for clip in more.clips] == ["walk", "wave"]
    assert more.skeleton is character.skeleton
    assert more.meshes is character.meshes
    assert len(character.clips) == 1
    hand = more.skeleton.index("Hand")
    assert more.clip("wave").rotation[1, hand] == pytest.approx(
        [0, 0, np.sin(np.radians(40)), np.cos(np.radians(40))], abs=1e-6
    )
    np.testing.assert_array_equal(more.clip("wave").translation[:, 0, 0], np.float32([0, 0.3]))
    assert more.notes[-1].startswith("wave.bvh: BVH states no unit")


@pytest.mark.parametrize(
    "change", [{"hand_name": "hand"}, {"hand": (0, -66, 0)}, {"arm_parent": "Head"}]
)
def test_motions_of_another_skeleton_must_be_human(
    tmp_path: Path, change: dict[str, object]
) -> None:
    character = load_character(bvh(tmp_path / "walk.bvh"))
    other = bvh(tmp_path / "other.bvh", **change)
    with pytest.raises(AssetError) as caught:
        add_motions(character, [other])
    assert caught.value.path == other
    assert "is not humanoid: no joint was found for left_upper_leg" in caught.value.cause
    assert caught.value.cause.endswith("other motions must be of the same skeleton")


def test_clip_names_stay_unique(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    character = load_character(bvh(tmp_path / "walk.bvh"))
    (tmp_path / "again").mkdir()
    same = bvh(tmp_path / "again" / "walk.bvh")
    pack = tmp_path / "pack.gltf"
    clips: tuple[Clip, ...] = tuple(
        replace(character.clips[0], name=name) for name in ("walk", "run", "pack")
    )
    skinned = '{"asset":{"version":"2.0"},"nodes":[{"mesh":0,"skin":0}]}'
    pack.write_text(skinned)
    monkeypatch.setattr(gltf, "load_gltf", lambda path: replace(character, clips=clips))
    found = add_motions(character, [same, same, pack, pack])
    assert [clip.name for clip in found.clips] == [
        "walk", "walk 2", "walk 3", "pack.walk", "run", "pack", "pack.walk 2", "pack.run", "pack 2",
    ]  # fmt: skip
    monkeypatch.setattr(gltf, "load_gltf", lambda path: replace(character, clips=()))
    with pytest.raises(AssetError, match="holds no motion"):
        add_motions(character, [pack])


def test_human_motions_go_to_any_human_body(tmp_path: Path) -> None:
    if not DATA.is_dir():
        pytest.skip(f"the motion files are not at {DATA}")
    runner = load_character(DATA / "bvh" / "cmu_09_06.bvh")
    more = add_motions(runner, [DATA / "bvh" / "cmu_02_03.bvh"])
    assert [clip.name for clip in more.clips] == ["cmu_09_06", "cmu_02_03"]
    assert more.clip("cmu_02_03").joint_count == runner.skeleton.joint_count
    figure = load_character(bvh(tmp_path / "walk.bvh"))
    with pytest.raises(AssetError, match="can't be given to this character, which is not humanoid"):
        add_motions(figure, [DATA / "bvh" / "cmu_02_03.bvh"])
    knight = load_character(DATA / "gltf" / "KayKit_Knight.glb")
    again = add_motions(knight, [DATA / "gltf" / "KayKit_Knight.glb"])
    # The very same skeleton: taken as it is, weapons and all.
    np.testing.assert_array_equal(
        again.clip("KayKit_Knight.Cheer").rotation, knight.clip("Cheer").rotation
    )
