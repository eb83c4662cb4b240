"""Broken glTF files: each loads or gives one AssetError, never anything else."""

from __future__ import annotations

import base64
import copy
import json
import re
import struct
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.engine.assets.gltf import load_gltf
from tifo.engine.assets.gltf_accessor import read_floats
from tifo.engine.assets.gltf_document import GltfDocument
from tifo.engine.errors import AssetError

BAD = Path(__file__).resolve().parents[4] / "shared" / "data" / "bad"

CAUSES = {
    "truncated_chunk_data.glb": "says 48 bytes, but the file has 47",
    "invalid_magic.glb": "is not valid JSON",
    "empty_file.glb": "is empty",
    "chunk_too_big.glb": "cut off",
    "unknown_chunk.glb": "first chunk is not JSON",
    "not_found.gltf": "'not_found.bin': there is no such file",
    "wrong_bytelength.glb": "is 17, but there are 16 bytes",
    "node_loop.gltf": "its own ancestor",
    "RecursiveNodes.gltf": "its own ancestor",
    "node_parent_override.gltf": "is a child of nodes 0 and 1",
    "unresolved_child_node.gltf": r"nodes\[0\].children\[0\]: refers to number 1",
    "empty_joints_array.gltf": "is empty",
    "IndexOutOfRange.gltf": "refer to vertex 255",
    "BoxWithInfinites.glb": "element 0 is not finite",
    "NoScene.gltf": "scene: refers to number 0, but the file has 0",
    "BoxMeshopt.glb": "extension EXT_meshopt_compression is not supported",
}
"""What the message must say of files that are surely broken."""


def bad_files():
    return sorted(path for path in BAD.rglob("*.gl*") if path.suffix in (".glb", ".gltf"))


@pytest.mark.skipif(not BAD.is_dir(), reason="the folder of broken files is absent")
def test_every_broken_file_gives_one_clear_error():
    files = bad_files()
    assert len(files) >= 25
    for path in files:
        result = outcome(path)
        if path.name in CAUSES:
            assert isinstance(result, AssetError), path.name
            assert re.search(CAUSES[path.name], str(result)), path.name
        if isinstance(result, AssetError):
            assert str(path) in str(result)
            assert str(result).isprintable()


@pytest.mark.skipif(not BAD.is_dir(), reason="the folder of broken files is absent")
def test_integers_may_be_written_as_floats():
    document = GltfDocument(BAD / "validator" / "json" / "integer_written_as_float.gltf")
    assert document.items("nodes")[0].indices("children", 5) == [1, 2, 3, 4]
    assert document.scene_roots == [0]
    assert read_floats(document, 2, "VEC3").tolist() == [[0, 0, 0]] * 3


def test_the_small_file_is_sound(tmp_path):
    character = load(tmp_path, glb(*small()))
    assert character.skeleton.names == ("root", "tip")
    assert character.clips[0].frame_count == 7
    assert character.meshes[0].triangles.tolist() == [[0, 1, 2]]


def test_truncation_at_every_length(tmp_path):
    data = glb(*small())
    for length in range(len(data)):
        with pytest.raises(AssetError):
            load(tmp_path, data[:length])


def test_truncation_that_the_header_admits(tmp_path):
    data = glb(*small())
    for length in range(12, len(data), 2):
        honest = data[:8] + struct.pack("<I", length) + data[12:length]
        with pytest.raises(AssetError):
            load(tmp_path, honest)


def test_truncated_json(tmp_path):
    tree, binary = small()
    tree["buffers"][0]["uri"] = "data:;base64," + base64.b64encode(binary).decode()
    text = json.dumps(tree).encode()
    assert load(tmp_path, text).clips
    for length in range(0, len(text), 3):
        with pytest.raises(AssetError):
            load(tmp_path, text[:length])


@settings(max_examples=150, deadline=None)
@given(
    changes=st.lists(st.tuples(st.integers(0, 10**6), st.integers(0, 255)), min_size=1, max_size=4)
)
def test_changed_bytes(tmp_path_factory, changes):
    data = bytearray(glb(*small()))
    for position, value in changes:
        data[position % len(data)] = value
    loads_or_explains(tmp_path_factory.getbasetemp(), bytes(data))


@pytest.mark.parametrize(
    "value",
    [None, True, -1, 0, 3, 0.5, 1e300, 2**70, "x", "\ud800", [], {}, [1e300] * 4],
    ids=lambda value: repr(value)[:12],
)
def test_every_value_of_the_json_replaced(tmp_path, value):
    tree, binary = small()
    for path in paths(tree):
        changed = copy.deepcopy(tree)
        holder = changed
        for step in path[:-1]:
            holder = holder[step]
        holder[path[-1]] = copy.deepcopy(value)
        loads_or_explains(tmp_path, glb(changed, binary))


def test_every_value_of_the_json_removed(tmp_path):
    tree, binary = small()
    for path in paths(tree):
        changed = copy.deepcopy(tree)
        holder = changed
        for step in path[:-1]:
            holder = holder[step]
        del holder[path[-1]]
        loads_or_explains(tmp_path, glb(changed, binary))


@settings(max_examples=100, deadline=None)
@given(
    offset=st.integers(0, 10**6),
    number=st.floats(width=32),
)
def test_every_float_of_the_buffer_replaced(tmp_path_factory, offset, number):
    tree, binary = small()
    start = offset % (len(binary) // 4) * 4
    changed = binary[:start] + struct.pack("<f", number) + binary[start + 4 :]
    loads_or_explains(tmp_path_factory.getbasetemp(), glb(tree, changed))


@pytest.mark.parametrize(
    ("data", "cause"),
    [
        (b"[" * 100_000, "nested too deeply|not valid JSON"),
        (b'{"a":' * 100_000, "nested too deeply|not valid JSON"),
        (b"[]", "is a list, expected an object"),
        (b'{"asset":{"version":"2.0"},"scene":NaN}', "NaN is not a JSON number"),
        (b'{"asset":{"version":"1.0"}}', "only glTF 2.0"),
        (b'{"asset":{"version":"2.1","minVersion":"2.1"}}', "only glTF 2.0"),
        (b"{}", "not a glTF 2.0 file"),
        (b"\xff\xfe\x00", "neither a GLB file nor JSON"),
        (b'{"asset":{"version":"2.0"},"n":' + b"9" * 5000 + b"}", "."),
        (b"glTF\x01\x00\x00\x00\x0c\x00\x00\x00", "GLB version 1"),
        (b"glTF\x02\x00\x00\x00\x0c\x00\x00\x00", "no JSON chunk"),
    ],
)
def test_broken_containers(tmp_path, data, cause):
    with pytest.raises(AssetError, match=cause):
        load(tmp_path, data)


@pytest.mark.parametrize(
    ("uri", "cause"),
    [
        ("http://example.org/a.bin", "not an address relative to the file"),
        ("/etc/hostname", "not an address relative to the file"),
        ("C:\\a.bin", "not an address relative to the file"),
        ("%00.bin", "can't be read|no such file"),
        ("x" * 5000, "can't be read|no such file"),
        (".", "is not a file"),
        ("data:;base64", "no comma"),
        ("data:;base64,&&&", "not valid base64"),
        ("data:,abc", "there are 3 bytes"),
    ],
)
def test_broken_addresses(tmp_path, uri, cause):
    tree, _ = small()
    tree["buffers"][0]["uri"] = uri
    with pytest.raises(AssetError, match=cause):
        load(tmp_path, json.dumps(tree).encode())


def test_paths_that_are_no_files(tmp_path):
    with pytest.raises(AssetError, match="there is no such file"):
        load_gltf(tmp_path / "absent.glb")
    with pytest.raises(AssetError, match="is not a file"):
        load_gltf(tmp_path)


def test_deep_chain_of_nodes(tmp_path):
    tree, binary = small()
    depth = 4000
    first = len(tree["nodes"])
    tree["nodes"] += [{"children": [first + k + 1]} for k in range(depth - 1)] + [{"children": [0]}]
    tree["scenes"][0]["nodes"] = [first, 2]
    del tree["animations"]
    character = load(tmp_path, glb(tree, binary))
    assert character.skeleton.joint_count == depth + 2
    assert len(character.skeleton.levels) == depth + 2


def test_counts_beyond_all_bounds_are_refused_at_once(tmp_path):
    tree, binary = small()
    del tree["accessors"][0]["bufferView"]
    tree["accessors"][0]["count"] = 10**12
    with pytest.raises(AssetError, match="more than this reader accepts"):
        load(tmp_path, glb(tree, binary))


@pytest.mark.parametrize(
    ("times", "cause"),
    [
        ((0.0, 0.0), "do not increase after key 0"),
        ((0.5, 0.2), "do not increase after key 0"),
        ((-1.0, 0.1), "has the key time -1"),
        ((0.0, 1e9), "lasts 1000000000 seconds"),
        ((0.0, float("nan")), "is not finite"),
    ],
)
def test_broken_key_times(tmp_path, times, cause):
    tree, binary = small()
    start = tree["bufferViews"][tree["accessors"][5]["bufferView"]]["byteOffset"]
    changed = binary[:start] + struct.pack("<2f", *times) + binary[start + 8 :]
    with pytest.raises(AssetError, match=cause):
        load(tmp_path, glb(tree, changed))


def outcome(path):
    """The character, or the one error that is allowed."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return load_gltf(path)
        except AssetError as error:
            return error


def loads_or_explains(folder, data):
    path = folder / "file.glb"
    path.write_bytes(data)
    character = outcome(path)
    if isinstance(character, AssetError):
        assert str(character).isprintable()
        return
    for mesh in character.meshes:
        assert np.isfinite(mesh.positions).all()
        assert mesh.triangles.max() < len(mesh.positions)
        assert mesh.joints.max() < character.skeleton.joint_count
        np.testing.assert_allclose(mesh.weights.sum(axis=1), 1, atol=1e-5)
    assert np.isfinite(character.skeleton.inverse_bind).all()


def load(folder, data):
    path = folder / "file.glb"
    path.write_bytes(data)
    return load_gltf(path)


def glb(tree, binary):
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    return b"".join(
        [
            struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A),
            text,
            struct.pack("<II", len(binary), 0x004E4942),
            binary,
        ]
    )


def small():
    """A triangle on two joints with a clip: JSON and buffer."""
    arrays = [
        (np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4"), "VEC3", 5126),
        (np.array([[0, 1, 0, 0]] * 3, "<u2"), "VEC4", 5123),
        (np.array([[0.5, 0.5, 0, 0]] * 3, "<f4"), "VEC4", 5126),
        (np.array([0, 1, 2, 0], "<u2")[:3], "SCALAR", 5123),
        (np.tile(np.eye(4, dtype="<f4").ravel(), (2, 1)), "MAT4", 5126),
        (np.array([0.0, 0.1], "<f4"), "SCALAR", 5126),
        (np.array([[0, 0, 0, 1], [0, 1, 0, 0]], "<f4"), "VEC4", 5126),
    ]
    binary, views, accessors = b"", [], []
    for values, kind, component in arrays:
        data = values.tobytes()
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        accessors.append(
            {
                "bufferView": len(views) - 1,
                "componentType": component,
                "count": len(values),
                "type": kind,
            }
        )
        binary += data + b"\0" * (-len(data) % 4)
    tree = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 2]}],
        "nodes": [
            {"name": "root", "children": [1]},
            {"name": "tip", "translation": [0, 1, 0], "rotation": [0, 0, 0, 1]},
            {"mesh": 0, "skin": 0},
        ],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": 4}],
        "meshes": [
            {
                "primitives": [
                    {
                        "attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2},
                        "indices": 3,
                        "material": 0,
                    }
                ]
            }
        ],
        "materials": [{"name": "m", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1]}}],
        "animations": [
            {
                "samplers": [{"input": 5, "output": 6, "interpolation": "LINEAR"}],
                "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}],
            }
        ],
        "bufferViews": views,
        "accessors": accessors,
        "buffers": [{"byteLength": len(binary)}],
    }
    return tree, binary


def paths(value, above=()):
    """All paths of a JSON tree."""
    steps = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    found = []
    for step, below in steps:
        found.append((*above, step))
        found += paths(below, (*above, step))
    return found
