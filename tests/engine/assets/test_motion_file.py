"""Opening files for their motions, with and without meshes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gltf_files import HALF, File, two_joints

import tifo


def library(folder: Path, *, animated: bool = True) -> Path:
    """Three nodes without a mesh; the middle one is turned a quarter in a second."""
    file = File()
    file.gltf.nodes = []
    root = file.node(name="Armature", children=[1])
    hips = file.node(root=False, name="hips", translation=[0, 1, 0], children=[2])
    file.node(root=False, name="spine", translation=[0, 0.5, 0])
    assert (root, hips) == (0, 1)
    if animated:
        times = file.put([[0.0], [1.0]], kind="SCALAR")
        turns = file.put([[0, 0, 0, 1], [HALF, 0, 0, HALF]])
        up = file.put([[0, 0.5, 0], [0, 0.5, 0]])
        file.animation("bow", [(1, "rotation", times, turns), (2, "translation", times, up)])
    return file.save(folder)


def test_a_library_without_a_mesh_has_a_skeleton_and_clips(tmp_path: Path) -> None:
    motions = tifo.load_motions(library(tmp_path))
    assert motions.skeleton.names == ("Armature", "hips", "spine")
    assert motions.skeleton.parents.tolist() == [-1, 0, 1]
    (clip,) = motions.clips
    assert (clip.name, clip.duration) == ("bow", 1.0)
    np.testing.assert_allclose(clip.rotation[-1, 1], [HALF, 0, 0, HALF], atol=1e-6)
    # The bind pose is the rest pose: the spine is 1.5 m up.
    np.testing.assert_allclose(motions.skeleton.inverse_bind[2, :, 3], [0, -1.5, 0], atol=1e-6)


def test_a_file_in_which_nothing_moves_is_refused(tmp_path: Path) -> None:
    with pytest.raises(tifo.AssetError, match="has no animation of nodes"):
        tifo.load_motions(library(tmp_path, animated=False))
    with pytest.raises(tifo.AssetError, match="holds no motion"):
        tifo.load_motions(two_joints([[1, 0, 0, 0]] * 3).save(tmp_path))
    with pytest.raises(tifo.AssetError, match="there is no such file"):
        tifo.load_motions(tmp_path / "none.glb")


def test_a_bvh_file(tmp_path: Path) -> None:
    path = tmp_path / "nod.bvh"
    path.write_text(
        "HIERARCHY\nROOT Head { OFFSET 0 0 0 CHANNELS 1 Xrotation }\n"
        "MOTION\nFrames: 2\nFrame Time: 0.01\n0\n9\n"
    )
    motions = tifo.load_motions(path, scale=0.1)
    assert motions.skeleton.names == ("Head",)
    assert [clip.name for clip in motions.clips] == ["nod"]
