from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from characters import make_body, make_box

from tifo.engine.assets.character import Character, Material
from tifo.engine.crowd.figure import MARKERS, Figure
from tifo.engine.crowd.morphs import morph_weights, morphed_positions
from tifo.engine.errors import AssetError
from tifo.engine.export.gltf_file import exact
from tifo.engine.export.morph_targets import morph_targets
from tifo.engine.export.paints import mix_paints
from tifo.engine.export.pixels import to_linear
from tifo.engine.export.recording import Recording
from tifo.engine.export.targets import check_size, check_target, replacing
from tifo.engine.export.usd_layer import identifiers


def make_recording(frames: int = 2, agents: int = 3, **fields) -> Recording:
    skeleton = make_body()
    mesh = make_box(skeleton, np.array([-0.3, 0.0, -0.2]), np.array([0.3, 1.75, 0.2]), joint=1)
    mesh.joints[4:] = [4, 0, 0, 0]
    mesh.joints[:, 1], mesh.weights[:] = 1, [0.75, 0.25, 0.0, 0.0]
    palettes = np.tile(np.eye(3, 4, dtype=np.float32), (frames, agents, 7, 1, 1))
    marked = {"hips": 0, "chest": 1, "head": 4, "hand_l": 5, "hand_r": 6, "foot_l": 2, "foot_r": 3}
    figure = Figure(np.array([marked[name] for name in MARKERS]), 1.75)
    values = {
        "character": Character("box", skeleton, (mesh,), (Material("shirt"),), ()),
        "agents": np.arange(agents) + 10,
        "labels": tuple(f"0|{k}" for k in range(agents)),
        "fps": 10.0,
        "palettes": palettes,
        "position": np.zeros((frames, agents, 3), np.float32),
        "yaw": np.zeros((frames, agents), np.float32),
        "scale": np.ones((frames, agents), np.float32),
        "girth": np.array([0.0, 0.05, -0.02], np.float32)[:agents],
        "head": np.array([0.0, 0.08, -0.05], np.float32)[:agents],
        "colors": np.full((agents, 5, 3), 188, np.uint8),
        "morphs": morph_weights(skeleton, figure),
    }
    return Recording(**{**values, **fields})


def test_three_targets_are_the_morphs_of_the_crowd() -> None:
    recording = make_recording()
    (mesh,) = recording.meshes(0)
    targets = morph_targets(recording, (mesh,))
    assert targets.names == ("girth", "head", "girth_head")
    for k in range(3):
        moved = mesh.positions + sum(
            weight * offset
            for weight, offset in zip(targets.weights[k], targets.offsets[0], strict=True)
        )
        girth, head = float(recording.girth[k]), float(recording.head[k])
        expected = morphed_positions(mesh, recording.morphs, girth, head)
        np.testing.assert_allclose(moved, expected, atol=1e-6)
    # The second agent is wide enough for that to mean something.
    assert np.abs(targets.offsets[0][2]).max() > 5e-4


def test_nobody_is_morphed_without_targets() -> None:
    still = np.zeros(3, np.float32)
    targets = morph_targets(make_recording(girth=still, head=still), make_recording().meshes(0))
    assert targets.names == ()
    assert targets.weights.shape == (3, 0)


def test_colours_are_linear_and_shared() -> None:
    np.testing.assert_allclose(
        to_linear(np.array([0, 10, 188, 255], np.uint8)),
        [0.0, 0.0030353, 0.5028865, 1.0],
        atol=1e-7,
    )
    colors = np.full((3, 5, 3), 188, np.uint8)
    colors[1, 2] = (255, 0, 10)
    recording = make_recording(colors=colors)
    paints, chosen = mix_paints(recording, recording.meshes(0))
    assert [paint.name for paint in paints] == ["shirt #bcbcbc", "shirt #ff000a"]
    assert chosen.tolist() == [[0], [1], [0]]


def test_parts_of_a_recording() -> None:
    recording = make_recording(frames=4)
    recording.position[2, 1] = (1, 2, 3)
    part = recording.select([12, 11]).frame(2)
    assert part.agents.tolist() == [12, 11]
    assert part.labels == ("0|2", "0|1")
    assert part.position.tolist() == [[[0, 0, 0], [1, 2, 3]]]
    assert (part.frames, recording.seconds) == (1, 0.3)
    for call, said in (
        (lambda: recording.select(3), "agent 3 was not recorded"),
        (lambda: recording.select([]), "expected an id or ids"),
        (lambda: recording.frame(4), "expected 0 to 3"),
        (lambda: recording.meshes(1), "level is 1, expected 0 to 0"),
        (lambda: make_recording(girth=np.zeros(2, np.float32)), "girth has shape"),
        (lambda: make_recording(fps=0.0), "fps is 0.0"),
        (lambda: make_recording(frames=0), "is empty"),
    ):
        with pytest.raises(ValueError, match=said):
            call()


def test_targets_are_checked_before_the_work(tmp_path: Path) -> None:
    kinds = (".glb", ".gltf")
    assert check_target(tmp_path / "a.GLB", kinds) == tmp_path / "a.GLB"
    (tmp_path / "b.glb").mkdir()
    for path, said in (
        (tmp_path / "a.fbx", "must end in .glb or .gltf"),
        (tmp_path / "b.glb", "is a folder"),
        (tmp_path / "no" / "a.glb", "there is no folder"),
    ):
        with pytest.raises(AssetError, match=said):
            check_target(path, kinds)
    with pytest.raises(AssetError, match=r"would take 3\.0 GB.*; less"):
        check_size(tmp_path / "a.glb", 3 * 10**9, "less")


def test_a_file_is_replaced_only_when_its_successor_is_whole(tmp_path: Path) -> None:
    path = tmp_path / "a.glb"
    path.write_text("old")

    def fail() -> None:
        with replacing(path) as part:
            part.write_text("ha")
            raise OSError(28, "disk is full")

    with pytest.raises(AssetError, match="can't be written: disk is full"):
        fail()
    assert path.read_text() == "old"
    with replacing(path) as part:
        part.write_text("new")
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_numbers_and_names_of_files() -> None:
    assert str(exact(np.float32([0.1, 1e-9]))) == "[0.1, 1e-09]"
    assert identifiers(("mixamorig:Hips", "mixamorig_Hips", "3d", "", "ü")) == (
        *("mixamorig_Hips", "mixamorig_Hips_2", "_3d", "_", "__2"),
    )
