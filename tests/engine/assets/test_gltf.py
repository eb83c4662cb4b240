"""Accessors, clips and materials of small glTF files, with results computed by hand."""

from __future__ import annotations

import base64
import io
import json

import numpy as np
import pygltflib as pg
import pytest
from gltf_files import CORNERS, HALF, File, two_joints
from PIL import Image

from tifo.engine.assets.gltf import load_gltf
from tifo.engine.assets.gltf_accessor import read_floats
from tifo.engine.assets.gltf_clips import unique_names
from tifo.engine.assets.gltf_document import GltfDocument
from tifo.engine.errors import AssetError


def test_sparse_accessors_without_and_with_a_base(tmp_path):
    file = File()
    rows, values = (
        file.view(np.array([1, 3], "<u2")),
        file.view(np.array([[7, 8, 9], [1, 2, 3]], "<f4")),
    )
    sparse = pg.Sparse(
        count=2,
        indices=pg.AccessorSparseIndices(bufferView=rows, componentType=pg.UNSIGNED_SHORT),
        values=pg.AccessorSparseValues(bufferView=values),
    )
    base = file.put([[5, 5, 5]] * 4)
    for view in (None, file.gltf.accessors[base].bufferView):
        file.gltf.accessors.append(
            pg.Accessor(
                bufferView=view, componentType=pg.FLOAT, count=4, type="VEC3", sparse=sparse
            )
        )
    document = GltfDocument(file.save(tmp_path))
    zero, five = [0, 0, 0], [5, 5, 5]
    assert read_floats(document, 1, "VEC3").tolist() == [zero, [7, 8, 9], zero, [1, 2, 3]]
    assert read_floats(document, 2, "VEC3").tolist() == [five, [7, 8, 9], five, [1, 2, 3]]
    sparse.count = 9
    with pytest.raises(AssetError, match="sparse"):
        read_floats(GltfDocument(file.save(tmp_path)), 2, "VEC3")


def test_strides_and_normalised_integers(tmp_path):
    file = File()
    table = np.zeros(3, np.dtype([("p", "<f4", 3), ("c", "i1", 4), ("d", "<u2", 2)]))
    table["p"] = CORNERS
    table["c"] = [[127, -128, 0, 64]] * 3
    table["d"] = [[65535, 0]] * 3
    view = file.view(table, stride=table.itemsize)
    for kind, component, offset in (("VEC3", 5126, 0), ("VEC4", 5120, 12), ("VEC2", 5123, 16)):
        file.gltf.accessors.append(
            pg.Accessor(
                bufferView=view,
                byteOffset=offset,
                componentType=component,
                normalized=component != 5126,
                count=3,
                type=kind,
            )
        )
    document = GltfDocument(file.save(tmp_path))
    assert read_floats(document, 0, "VEC3").tolist() == CORNERS
    np.testing.assert_allclose(read_floats(document, 1, "VEC4")[2], [1, -1, 0, 64 / 127])
    assert read_floats(document, 2, "VEC2")[1].tolist() == [1, 0]
    with pytest.raises(AssetError, match=r"accessors\[0\].type: is VEC3, expected SCALAR or VEC2"):
        read_floats(document, 0, "SCALAR", "VEC2")


def test_clips_of_all_interpolations(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    times = file.put([0.5, 1.5], kind="SCALAR")
    moved = file.put([[0, 0, 0], [6, 0, 0]])
    spline = file.put([[9, 9, 9], [0, 0, 0], [1, 1, 1], [-1, -1, -1], [2, 2, 2], [9, 9, 9]])
    turned = file.put([[0, 0, 0, 32767], [0, 32767, 0, 0]], "i2", normalized=True)
    file.animation("walk", [(0, "translation", times, moved)])
    file.animation("walk", [(0, "translation", times, moved, "STEP")])
    file.animation(None, [(0, "translation", times, spline, "CUBICSPLINE")])
    file.animation(None, [(0, "rotation", times, turned), (1, "scale", times, moved)])
    character = file.load(tmp_path)
    assert [clip.name for clip in character.clips] == ["walk", "walk 2", "clip 2", "clip 3"]
    assert [clip.frame_count for clip in character.clips] == [61] * 4
    line, step, cubic, turn = character.clips
    assert line.duration == pytest.approx(1)
    assert line.translation[30, 0, 0] == pytest.approx(3, abs=1e-5)
    assert step.translation[:60, 0].max() == 0
    assert step.translation[60, 0, 0] == 6
    assert step.resampling_error == pytest.approx(3)
    assert cubic.translation[30, 0, 0] == pytest.approx(1.25, abs=1e-6)
    assert cubic.translation[15, 0, 0] == pytest.approx(0.5, abs=1e-6)
    np.testing.assert_allclose(turn.rotation[30, 0], [0, HALF, 0, HALF], atol=1e-6)
    np.testing.assert_allclose(turn.scale[30, 1], [3, 0, 0], atol=1e-5)
    assert any("4 clips begin after 0 s" in note for note in character.notes)


def test_channels_that_move_nothing_are_noted(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    camera = file.node()
    times, values = file.put([0.0, 1.0], kind="SCALAR"), file.put([[0, 0, 0], [6, 0, 0]])
    file.animation("pan", [(camera, "translation", times, values)])
    file.animation("morph", [(0, "weights", times, times)])
    file.animation("twice", [(0, "scale", times, values), (0, "scale", times, values, "STEP")])
    character = file.load(tmp_path)
    assert [clip.name for clip in character.clips] == ["twice"]
    assert character.clips[0].scale[30, 0, 0] == 0  # the later channel holds until its second key
    assert character.notes == (
        "Clip 'pan' moves no joint and is left out.",
        "Clip 'morph' moves no joint and is left out.",
        "animations[2].channels[1] replaces an earlier one of its target.",
        "1 channels of morph target weights are left out.",
        "1 channels of nodes that move no mesh are left out.",
    )


@pytest.mark.parametrize(
    ("values", "interpolation", "cause"),
    [
        ([[0, 0, 0, 1]], "LINEAR", "has 1 values, expected 2"),
        ([[0, 0, 0, 1]] * 2, "CUBICSPLINE", "has 2 values, expected 6"),
        ([[0, 0, 0, 1]] * 2, "CUBIC", "is 'CUBIC', which is unknown"),
        ([[0, 0, 0, 1], [0, 0, 0, 0]], "LINEAR", "zero quaternion as rotation key 1"),
    ],
)
def test_broken_samplers(tmp_path, values, interpolation, cause):
    file = two_joints([[1, 0, 0, 0]] * 3)
    times = file.put([0.0, 1.0], kind="SCALAR")
    file.animation("a", [(0, "rotation", times, file.put(values), interpolation)])
    with pytest.raises(AssetError, match=cause):
        file.load(tmp_path)


def test_materials_and_textures(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    pixels = np.arange(24, dtype=np.uint8).reshape(2, 3, 4) * 10
    pixels[..., 3] = 255
    stream = io.BytesIO()
    Image.fromarray(pixels[..., :3]).save(stream, "PNG")
    picture = np.frombuffer(stream.getvalue(), np.uint8)
    file.gltf.images = [
        pg.Image(bufferView=file.view(picture), mimeType="image/png"),
        pg.Image(bufferView=file.view(picture[:40]), mimeType="image/png"),
    ]
    file.gltf.textures = [pg.Texture(source=0), pg.Texture(source=1)]
    move = {"KHR_texture_transform": {"offset": [0, 1], "rotation": np.pi / 2, "scale": [0.5, 0.5]}}
    for texture, extensions in ((0, move), (1, {})):
        file.gltf.materials.append(
            pg.Material(
                name=f"m{texture}",
                doubleSided=texture == 0,
                alphaMode=None,
                pbrMetallicRoughness=pg.PbrMetallicRoughness(
                    baseColorFactor=[0.5, 0.25, 1, 1],
                    baseColorTexture=pg.TextureInfo(index=texture, extensions=extensions),
                ),
            )
        )
    uvs = file.put([[0, 0], [1, 0], [1, 1]])
    colors = file.put([[255, 0, 51]] * 3, "u1", normalized=True)
    for material in (0, 1):
        mesh = file.mesh(
            POSITION=file.put(CORNERS), TEXCOORD_0=uvs, COLOR_0=colors, material=material
        )
        held = file.node(mesh=mesh, root=False)
        file.gltf.nodes[material].children = [held]
    character = file.load(tmp_path)
    plain, first, second = character.materials
    assert (plain.name, plain.image) == ("default", None)
    assert first.base_color == (0.5, 0.25, 1, 1)
    assert first.double_sided
    np.testing.assert_array_equal(first.image, pixels)
    assert second.image is None
    assert any("Image 1 can't be decoded" in note for note in character.notes)
    mesh = next(m for m in character.meshes if character.materials[m.material] is first)
    # The extension's own example: the lower left quarter of the image, turned.
    np.testing.assert_allclose(mesh.uvs, [[0, 1], [0, 0.5], [0.5, 0.5]], atol=1e-6)
    np.testing.assert_allclose(mesh.colors[0], [1, 0, 0.2, 1], atol=1e-6)


def test_primitives_of_one_skin_and_material_are_merged(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    file.gltf.meshes.append(file.gltf.meshes[0])
    file.node(mesh=1, skin=0, name="again")
    character = file.load(tmp_path)
    assert len(character.meshes) == 1
    assert character.meshes[0].triangles.tolist() == [[0, 1, 2], [3, 4, 5]]


def test_vertices_that_no_triangle_uses_are_dropped(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    points = file.put([[9, 9, 9], *CORNERS])
    mesh = file.mesh(POSITION=points, indices=file.put([3, 1, 2], "u4", kind="SCALAR"))
    file.gltf.nodes[0].children = [file.node(mesh=mesh, root=False)]
    held = file.load(tmp_path).meshes[1]
    np.testing.assert_allclose(held.positions[held.triangles[0]], np.roll(CORNERS, 1, axis=0))
    assert len(held.positions) == 3


def test_external_and_inline_buffers(tmp_path):
    expected = two_joints([[1, 0, 0, 0]] * 3).load(tmp_path).meshes[0].positions
    file = two_joints([[1, 0, 0, 0]] * 3)
    file.finish()
    data = file.gltf.binary_blob()
    (tmp_path / "a b.bin").write_bytes(data + b"tail")
    file.gltf.buffers[0].uri = "a%20b.bin"
    external = tmp_path / "external.gltf"
    external.write_text("\ufeff" + file.gltf.gltf_to_json(), encoding="utf-8")
    inline = tmp_path / "inline.gltf"
    tree = json.loads(file.gltf.gltf_to_json())
    tree["buffers"][0]["uri"] = pg.DATA_URI_HEADER + base64.b64encode(data).decode()
    inline.write_text(json.dumps(tree))
    for path in (external, inline):
        np.testing.assert_array_equal(load_gltf(path).meshes[0].positions, expected)


def test_required_extensions(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    file.gltf.extensionsRequired = ["KHR_materials_unlit", "KHR_mesh_quantization"]
    assert file.load(tmp_path).meshes
    file.gltf.extensionsRequired = ["KHR_draco_mesh_compression"]
    with pytest.raises(AssetError, match="KHR_draco_mesh_compression is not supported"):
        file.load(tmp_path)


def test_names_are_unique():
    assert unique_names(["a", "a", "b", "a 2", "a"]) == ["a", "a 3", "b", "a 2", "a 4"]
