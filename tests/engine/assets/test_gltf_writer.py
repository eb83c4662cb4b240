"""What the writer writes, read back by other libraries and by the package's own reader."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tifo.engine.animation.clip import Clip
from tifo.engine.animation.skeleton import Skeleton
from tifo.engine.assets.character import Character, Material, SkinnedMesh
from tifo.engine.assets.gltf import load_gltf
from tifo.engine.assets.gltf_writer import character_to_glb, write_glb
from tifo.engine.assets.levels import grouped_by_level, level_name


def make_skeleton() -> Skeleton:
    """Three joints in a row along +Y, the last turned by 90 degrees about +X at rest."""
    inverse_bind = np.zeros((3, 3, 4), dtype=np.float32)
    inverse_bind[:, :, :3] = np.eye(3)
    inverse_bind[:, 1, 3] = (0.0, -1.0, -1.5)
    # The last joint's bind frame is turned too: (x, y, z) -> (x, z, -y).
    inverse_bind[2] = ((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 1.5))
    rotation = np.array([[0, 0, 0, 1], [0, 0, 0, 1], [0.5**0.5, 0, 0, 0.5**0.5]], np.float32)
    return Skeleton(
        names=("base", "middle", "tip"),
        parents=np.array([-1, 0, 1], dtype=np.int32),
        rest_rotation=rotation,
        rest_translation=np.array([[0, 0, 0], [0, 1, 0], [0, 0.5, 0]], np.float32),
        rest_scale=np.ones((3, 3), np.float32),
        inverse_bind=inverse_bind,
    )


def make_mesh(name: str, material: int, size: float, seed: int) -> SkinnedMesh:
    rng = np.random.default_rng(seed)
    count = 6
    weights = rng.random((count, 4)).astype(np.float32)
    normals = rng.normal(size=(count, 3))
    return SkinnedMesh(
        name=name,
        positions=(size * rng.random((count, 3))).astype(np.float32),
        normals=(normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype(np.float32),
        uvs=rng.random((count, 2)).astype(np.float32),
        colors=(rng.integers(0, 256, (count, 4)) / 255).astype(np.float32),
        joints=np.tile(np.array([0, 1, 2, 0], np.uint16), (count, 1)),
        weights=weights / weights.sum(axis=1, keepdims=True),
        triangles=np.array([[0, 1, 2], [3, 4, 5], [0, 2, 4]], np.uint32),
        material=material,
    )


def make_clip(name: str, looping: bool = True) -> Clip:
    """The middle joint turns by one radian about Z in a second; the tip stays at rest."""
    skeleton = make_skeleton()
    rotation = np.tile(skeleton.rest_rotation, (61, 1, 1))
    angle = np.linspace(0.0, 1.0, 61)
    rotation[:, 1, 2], rotation[:, 1, 3] = np.sin(angle / 2), np.cos(angle / 2)
    translation = np.tile(skeleton.rest_translation, (61, 1, 1))
    translation[:, 0, 0] = angle
    scale = np.ones((61, 3, 3), np.float32)
    return Clip(name, 1.0, rotation, translation, scale, looping=looping)


def make_character(**changes: object) -> Character:
    picture = np.random.default_rng(7).integers(0, 256, (4, 8, 4), dtype=np.uint8)
    fields: dict[str, object] = {
        "name": "figure",
        "skeleton": make_skeleton(),
        "meshes": (make_mesh("coat", 0, 1.0, 1), make_mesh("hat", 1, 2.0, 2)),
        "materials": (
            Material("shirt", (0.25, 0.5, 0.75, 1.0)),
            Material("print", image=picture, double_sided=True),
        ),
        "clips": (make_clip("turn"),),
        "lower_levels": ((make_mesh("coat", 0, 1.0, 3),),),
    }
    return Character(**{**fields, **changes})  # type: ignore[arg-type]


def document_of(content: bytes) -> dict[str, object]:
    length = struct.unpack_from("<I", content, 12)[0]
    document: dict[str, object] = json.loads(content[20 : 20 + length])
    return document


def test_container_follows_the_format() -> None:
    content = character_to_glb(make_character())
    magic, version, total = struct.unpack_from("<4sII", content, 0)
    json_length, json_type = struct.unpack_from("<I4s", content, 12)
    bin_length, bin_type = struct.unpack_from("<I4s", content, 20 + json_length)
    assert (magic, version, total) == (b"glTF", 2, len(content))
    assert (json_type, bin_type) == (b"JSON", b"BIN\0")
    assert json_length % 4 == 0
    assert bin_length % 4 == 0
    assert 20 + json_length + 8 + bin_length == total


def test_pygltflib_reads_the_same_numbers(tmp_path: Path) -> None:
    pygltflib = pytest.importorskip("pygltflib")
    character = make_character()
    write_glb(character, tmp_path / "figure.glb")
    document = pygltflib.GLTF2().load(str(tmp_path / "figure.glb"))
    blob = document.binary_blob()

    def floats(accessor: int, width: int) -> np.ndarray:
        entry = document.accessors[accessor]
        start = document.bufferViews[entry.bufferView].byteOffset
        return np.frombuffer(blob, "<f4", entry.count * width, start).reshape(-1, width)

    assert [mesh.name for mesh in document.meshes] == ["coat", "hat", "coat_LOD1"]
    positions = floats(document.meshes[1].primitives[0].attributes.POSITION, 3)
    np.testing.assert_array_equal(positions, character.meshes[1].positions)
    entry = document.accessors[document.meshes[1].primitives[0].attributes.POSITION]
    assert entry.min == positions.min(axis=0).tolist()
    assert entry.max == positions.max(axis=0).tolist()
    # Column-major: the last four numbers of a matrix are its translation.
    matrices = floats(document.skins[0].inverseBindMatrices, 16)
    np.testing.assert_array_equal(matrices[1], [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1])
    assert document.materials[0].pbrMetallicRoughness.baseColorFactor == [0.25, 0.5, 0.75, 1.0]
    assert document.materials[1].doubleSided is True
    assert len(document.skins) == 2
    assert document.nodes[0].children == [1]


def test_channels_at_rest_are_left_out() -> None:
    animation = document_of(character_to_glb(make_character()))["animations"][0]  # type: ignore[index]
    moved = [(c["target"]["node"], c["target"]["path"]) for c in animation["channels"]]
    assert moved == [(1, "rotation"), (0, "translation")]
    assert "extras" not in animation


def test_a_constant_offset_from_rest_takes_one_key() -> None:
    clip = make_clip("raised")
    clip.translation[:, 2] = (0.0, 0.75, 0.0)
    document = document_of(character_to_glb(make_character(clips=(clip,))))
    animation, accessors = document["animations"][0], document["accessors"]  # type: ignore[index]
    channel = next(c for c in animation["channels"] if c["target"]["node"] == 2)
    assert accessors[animation["samplers"][channel["sampler"]]["output"]]["count"] == 1  # type: ignore[index]


def test_a_clip_that_does_not_loop_says_so() -> None:
    content = character_to_glb(make_character(clips=(make_clip("once", looping=False),)))
    assert document_of(content)["animations"][0]["extras"] == {"looping": False}  # type: ignore[index]


def test_reader_gets_back_what_was_written(tmp_path: Path) -> None:
    character = make_character()
    write_glb(character, tmp_path / "figure.glb")
    read = grouped_by_level(load_gltf(tmp_path / "figure.glb"))
    assert read.notes == ()
    assert read.skeleton.names == character.skeleton.names
    for name in ("parents", "rest_rotation", "rest_translation", "rest_scale", "inverse_bind"):
        np.testing.assert_allclose(
            getattr(read.skeleton, name), getattr(character.skeleton, name), atol=1e-6
        )
    assert [mesh.name for mesh in read.meshes] == ["coat", "hat"]
    assert [[mesh.name for mesh in level] for level in read.lower_levels] == [["coat_LOD1"]]
    written = (*character.meshes, *character.lower_levels[0])
    for got, put in zip((*read.meshes, *read.lower_levels[0]), written, strict=True):
        np.testing.assert_array_equal(got.triangles, put.triangles)
        np.testing.assert_allclose(got.positions, put.positions, atol=1e-6)
        np.testing.assert_allclose(got.normals, put.normals, atol=1e-6)
        np.testing.assert_allclose(got.uvs, put.uvs, atol=1e-6)
        np.testing.assert_allclose(got.colors, put.colors, atol=1e-6)
        assert got.material == put.material
        for joint in range(3):
            share = [np.where(m.joints == joint, m.weights, 0).sum(axis=1) for m in (got, put)]
            np.testing.assert_allclose(share[0], share[1], atol=1e-5)
    assert [m.name for m in read.materials] == ["shirt", "print"]
    assert read.materials[0].base_color == pytest.approx((0.25, 0.5, 0.75, 1.0))
    np.testing.assert_array_equal(read.materials[1].image, character.materials[1].image)
    np.testing.assert_allclose(read.clip("turn").rotation, character.clips[0].rotation, atol=1e-6)
    np.testing.assert_allclose(
        read.clip("turn").translation, character.clips[0].translation, atol=1e-6
    )


def test_a_clip_at_rest_keeps_its_duration(tmp_path: Path) -> None:
    skeleton = make_skeleton()
    still = Clip(
        "still",
        2.0,
        np.tile(skeleton.rest_rotation, (121, 1, 1)),
        np.tile(skeleton.rest_translation, (121, 1, 1)),
        np.ones((121, 3, 3), np.float32),
    )
    write_glb(make_character(clips=(still,)), tmp_path / "figure.glb")
    assert load_gltf(tmp_path / "figure.glb").clip("still").duration == pytest.approx(2.0)


def test_colours_above_one_are_kept_as_floats() -> None:
    mesh = make_mesh("coat", 0, 1.0, 1)
    mesh.colors[0] = (2.0, 0.5, 0.25, 1.0)
    document = document_of(character_to_glb(make_character(meshes=(mesh,), lower_levels=())))
    accessor = document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]  # type: ignore[index]
    assert document["accessors"][accessor]["componentType"] == 5126  # type: ignore[index]


@pytest.mark.parametrize(
    ("name", "level", "expected"),
    [("shirt", 0, "shirt"), ("shirt", 2, "shirt_LOD2"), ("shirt_LOD1", 2, "shirt_LOD2")],
)
def test_level_names(name: str, level: int, expected: str) -> None:
    assert level_name(name, level) == expected


def test_levels_are_sorted_by_their_number() -> None:
    names = ("b_LOD3", "a", "b_LOD0", "a_lod1", "b_LOD1")
    meshes = tuple(make_mesh(name, 0, 1.0, 1) for name in names)
    grouped = grouped_by_level(make_character(meshes=meshes, lower_levels=()))
    assert [mesh.name for mesh in grouped.meshes] == ["a", "b_LOD0"]
    assert [[m.name for m in level] for level in grouped.lower_levels] == [
        ["a_lod1", "b_LOD1"],
        ["b_LOD3"],
    ]


def test_compact_files_are_smaller_and_hardly_differ(tmp_path: Path) -> None:
    short = make_clip("short")
    smooth = replace(short, name="smooth", duration=2.0)
    rng = np.random.default_rng(4)
    shaken = smooth.rotation + 0.05 * rng.normal(size=smooth.rotation.shape)
    shaken /= np.linalg.norm(shaken, axis=2, keepdims=True)
    rough = replace(smooth, name="rough", rotation=shaken.astype(np.float32))
    character = Character(
        name="small", skeleton=make_skeleton(), meshes=(make_mesh("body", 0, 1.0, 1),),
        materials=(Material("skin"),), clips=(short, smooth, rough),
    )  # fmt: skip
    whole, small = character_to_glb(character), character_to_glb(character, compact=True)
    assert len(small) < 0.8 * len(whole)
    (length,) = struct.unpack_from("<I", small, 12)
    document = json.loads(small[20 : 20 + length])
    counts = []
    for animation in document["animations"]:
        keys = [document["accessors"][s["output"]] for s in animation["samplers"]]
        assert {k["componentType"] for k in keys if k["type"] == "VEC4"} == {5122}
        counts.append(max(k["count"] for k in keys))
    # Every second key of the smooth long clip is left out, and none of the others.
    assert counts == [61, 31, 61]
    path = tmp_path / "small.glb"
    path.write_bytes(small)
    for made, read in zip((short, smooth, rough), load_gltf(path).clips, strict=True):
        assert read.duration == pytest.approx(made.duration)
        every = (read.frame_count - 1) // (made.frame_count - 1)
        dots = np.abs(np.einsum("fjk,fjk->fj", read.rotation[::every], made.rotation))
        assert 2 * np.arccos(np.clip(dots, 0, 1)).max() < (0.004 if made is smooth else 0.001)
        np.testing.assert_allclose(read.translation[::every], made.translation, atol=0.004)
