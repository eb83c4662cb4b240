"""Opening a character by its suffix, and adding the motions of other files to it."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tifo.engine.animation.clip import Clip
from tifo.engine.animation.skeleton import Skeleton
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


def test_a_motion_is_scaled_to_the_character(tmp_path: Path) -> None:
    character = load_character(bvh(tmp_path / "walk.bvh"))
    # The same body in inches: the unit is guessed well, or overridden badly, and never matters.
    inches = bvh(tmp_path / "inches.bvh", unit=1 / 2.54)
    for scale in (None, 1.0):
        clip = add_motions(character, [inches], scale).clip("inches")
        np.testing.assert_allclose(clip.translation[:, 0, 0], [0, 0.3], rtol=1e-5)
        np.testing.assert_allclose(
            clip.translation[0], character.skeleton.rest_translation, atol=1e-6
        )


def test_joints_that_the_motion_lacks_stay_at_rest(tmp_path: Path) -> None:
    character = load_character(bvh(tmp_path / "walk.bvh"))
    short = tmp_path / "short.bvh"
    short.write_text(
        "HIERARCHY\nROOT Hips { OFFSET 0 90 0 CHANNELS 1 Yrotation\n"
        "JOINT Head { OFFSET 0 80 0 CHANNELS 1 Xrotation } }\n"
        "MOTION\nFrames: 1\nFrame Time: 0.01\n0 90\n"
    )
    clip = add_motions(character, [short]).clip("short")
    arm, head = character.skeleton.index("Arm"), character.skeleton.index("Head")
    np.testing.assert_array_equal(clip.rotation[0, arm], [0, 0, 0, 1])
    np.testing.assert_array_equal(
        clip.translation[0, arm], character.skeleton.rest_translation[arm]
    )
    assert clip.rotation[0, head] == pytest.approx([np.sqrt(0.5), 0, 0, np.sqrt(0.5)])


@pytest.mark.parametrize(
    ("change", "cause"),
    [
        ({"hand_name": "hand"}, "moves joint 'hand', which the character lacks"),
        (
            {"hand": (0, -66, 0)},
            "joint 'Hand' lies at (0.0000, -0.6600, 0.0000) m from its parent, in the character "
            "at (0.0000, -0.6000, 0.0000) m",
        ),
        ({"hand": (60, 0, 0)}, "joint 'Hand' lies at (0.6000, 0.0000, 0.0000)"),
        ({"hand": (0, 0, 0)}, "joint 'Hand' lies at (0.0000, 0.0000, 0.0000)"),
        ({"arm_parent": "Head"}, "joint 'Arm' hangs below 'Head', in the character below 'Hips'"),
    ],
)
def test_a_motion_of_another_skeleton_is_refused(
    tmp_path: Path, change: dict[str, object], cause: str
) -> None:
    character = load_character(bvh(tmp_path / "walk.bvh"))
    other = bvh(tmp_path / "other.bvh", **change)
    with pytest.raises(AssetError) as caught:
        add_motions(character, [other])
    assert caught.value.path == other
    assert cause in caught.value.cause
    assert caught.value.cause.endswith("motions must be made for the same skeleton")


def test_a_joint_that_never_moves_may_be_missing(tmp_path: Path) -> None:
    character = load_character(bvh(tmp_path / "walk.bvh"))
    still = bvh(tmp_path / "still.bvh", hand_name="hand", turn=0.0)
    assert add_motions(character, [still]).clip("still").joint_count == 4


def test_a_file_with_no_joint_of_the_character_is_refused(tmp_path: Path) -> None:
    character = load_character(bvh(tmp_path / "walk.bvh"))
    ball = tmp_path / "ball.bvh"
    ball.write_text(
        "HIERARCHY\nROOT Ball { OFFSET 0 0 0 CHANNELS 1 Yrotation }\n"
        "MOTION\nFrames: 1\nFrame Time: 0.01\n0\n"
    )
    with pytest.raises(AssetError, match="has no joint of the character"):
        add_motions(character, [ball])


def test_a_root_below_a_turned_joint_is_refused(tmp_path: Path) -> None:
    character = load_character(bvh(tmp_path / "walk.bvh"))
    old = character.skeleton
    rotation = np.concatenate([np.float32([[np.sqrt(0.5), 0, 0, np.sqrt(0.5)]]), old.rest_rotation])

    def below(armature: np.ndarray) -> Character:
        return replace(
            character,
            clips=(),
            skeleton=Skeleton(
                names=("Armature", *old.names),
                parents=np.concatenate([[-1], old.parents + 1]).astype(np.int32),
                rest_rotation=armature,
                rest_translation=np.concatenate([np.zeros((1, 3)), old.rest_translation]).astype(
                    np.float32
                ),
                rest_scale=np.ones((5, 3), np.float32),
                inverse_bind=np.tile(np.eye(3, 4, dtype=np.float32), (5, 1, 1)),
            ),
        )

    motion = bvh(tmp_path / "wave.bvh")
    with pytest.raises(AssetError, match=r"root 'Hips' hangs below 'Armature' .* turned or scaled"):
        add_motions(below(rotation), [motion])
    rotation[0] = [0, 0, 0, 1]
    clip = add_motions(below(rotation), [motion]).clip("wave")
    assert clip.joint_count == 5
    np.testing.assert_array_equal(clip.translation[:, 1, 0], np.float32([0, 0.3]))


def test_clip_names_stay_unique(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    character = load_character(bvh(tmp_path / "walk.bvh"))
    (tmp_path / "again").mkdir()
    same = bvh(tmp_path / "again" / "walk.bvh")
    pack = tmp_path / "pack.glb"
    pack.write_bytes(b"")
    clips: tuple[Clip, ...] = tuple(
        replace(character.clips[0], name=name) for name in ("walk", "run", "pack")
    )
    monkeypatch.setattr(gltf, "load_gltf", lambda path: replace(character, clips=clips))
    found = add_motions(character, [same, same, pack, pack])
    assert [clip.name for clip in found.clips] == [
        "walk", "walk 2", "walk 3", "pack.walk", "run", "pack", "pack.walk 2", "pack.run", "pack 2",
    ]  # fmt: skip
    monkeypatch.setattr(gltf, "load_gltf", lambda path: replace(character, clips=()))
    with pytest.raises(AssetError, match="holds no motion"):
        add_motions(character, [pack])


def test_real_motions_of_one_and_of_two_skeletons() -> None:
    if not DATA.is_dir():
        pytest.skip(f"the motion files are not at {DATA}")
    runner = load_character(DATA / "bvh" / "cmu_09_06.bvh")
    slow = DATA / "bvh" / "derived_02_03_slowrun_on09skel.bvh"
    names = [clip.name for clip in add_motions(runner, [slow]).clips]
    assert names == ["cmu_09_06", "derived_02_03_slowrun_on09skel"]
    with pytest.raises(AssetError, match=r"joint '.*' lies at .* same skeleton"):
        add_motions(runner, [DATA / "bvh" / "cmu_02_03.bvh"])
    with pytest.raises(AssetError, match="which the character lacks"):
        add_motions(runner, [DATA / "bvh" / "100style_elated.bvh"])
