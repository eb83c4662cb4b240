"""The glTF reader on real files, against an evaluation straight from pygltflib's objects.

The oracle decodes accessors, interpolates with SciPy, walks the node tree and skins with all
influences by the equation of the specification; it shares no code with the reader.
"""

from __future__ import annotations

import base64
import json
import struct
import time
from functools import cache
from pathlib import Path

import numpy as np
import pygltflib
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation, Slerp

from tifo.engine.assets.gltf import load_gltf
from tifo.engine.assets.gltf_accessor import read_floats
from tifo.engine.assets.gltf_document import GltfDocument
from tifo.engine.errors import AssetError

DATA = Path(__file__).resolve().parents[4] / "shared" / "data" / "gltf"

pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason="the folder of test characters is absent")

SKINNED = {
    "CesiumMan.gltf": [0],
    "RiggedSimple.gltf": [0],
    "phoenix_bird.glb": [0],
    "RobotExpressive.glb": [0, 6, 13],
    "SkinType_u8/Animation_SkinType_01.gltf": [0],
    "03_skinned_cylinder/03_skinned_cylinder.gltf": [0],
    "KayKit_Knight.glb": [2],
}
"""Files with the animations that are compared."""

RIGID = {"01_cs_rotate/01_cs_rotate.gltf": [0], "07_nla-anim/07_nla-anim.gltf": [0, 1, 2]}

DTYPES = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@pytest.mark.parametrize(("name", "animations"), (SKINNED | RIGID).items())
def test_skinned_positions_agree_with_the_oracle(name, animations, tmp_path):
    character = load(name)
    oracle = Oracle(thin(DATA / name, animations, tmp_path))
    assert character.triangle_count == oracle.triangle_count()
    for number, animation in enumerate(animations):
        clip = character.clips[animation]
        start, stop = oracle.span(number)
        assert clip.duration == pytest.approx(stop - start, abs=1e-6)
        keys = sorted({0, clip.frame_count // 3, clip.frame_count // 2, clip.frame_count - 1})
        times = start + clip.duration * np.array(keys) / max(clip.frame_count - 1, 1)
        expected = [oracle.corners(number, time) for time in times]
        got = [corners(character, clip, key) for key in keys]
        height = np.ptp(expected[0], axis=0).max()
        same_paths(np.hstack(got), np.hstack(expected), 1e-4 * height)


@pytest.mark.parametrize("name", [*SKINNED, *RIGID])
def test_what_the_reader_promises_of_every_character(name):
    character = load(name)
    skeleton = character.skeleton
    names = [mesh.name for mesh in character.meshes], [clip.name for clip in character.clips]
    assert all(len(set(group)) == len(group) for group in names)
    palettes = palette(
        skeleton, skeleton.rest_rotation, skeleton.rest_translation, skeleton.rest_scale
    )
    for mesh in character.meshes:
        assert mesh.joints.max() < skeleton.joint_count
        np.testing.assert_allclose(mesh.weights.sum(axis=1), 1, atol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-5)
        assert mesh.triangles.max() == len(mesh.positions) - 1
        assert 0 <= mesh.material < len(character.materials)
        corner = mesh.positions[mesh.triangles]
        faces = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        facing = np.einsum("tk,tk->t", faces, mesh.normals[mesh.triangles].sum(axis=1))
        assert (facing[np.abs(facing) > 1e-9] > 0).mean() > 0.95
    for clip in character.clips:
        assert clip.frame_count > clip.duration * 59.99
        assert clip.joint_count == skeleton.joint_count
        np.testing.assert_allclose(np.linalg.norm(clip.rotation, axis=2), 1, atol=1e-6)
    if name != "SkinType_u8/Animation_SkinType_01.gltf":
        used = np.unique(np.concatenate([mesh.joints.ravel() for mesh in character.meshes]))
        assert np.median(np.linalg.det(palettes[used])) == pytest.approx(1, abs=1e-3)


def test_resampling_errors_of_real_clips_are_small():
    for name in SKINNED | RIGID:
        character = load(name)
        height = max(np.ptp(mesh.positions, axis=0).max() for mesh in character.meshes)
        for clip in character.clips:
            assert 0 <= clip.resampling_error < 2e-4 * height + 2e-5, (name, clip.name)


def test_knight_loads_fast_and_whole():
    load_gltf(DATA / "RiggedSimple.gltf")
    start = time.process_time()
    knight = load_gltf(DATA / "KayKit_Knight.glb")
    assert time.process_time() - start < 4.0
    assert len(knight.clips) == 76
    assert knight.clip("Cheer").duration > 0.5
    assert [mesh.name for mesh in knight.meshes][-2:] == ["1H_Sword", "2H_Sword"]
    sword = next(mesh for mesh in knight.meshes if mesh.name == "1H_Sword")
    held = knight.skeleton.index("1H_Sword")
    assert (sword.joints[:, 0] == held).all()
    assert knight.skeleton.names[knight.skeleton.parents[held]] == "handslot.r"
    assert len(knight.materials) == 1
    image = knight.materials[0].image
    assert image is not None
    assert image.dtype == np.uint8
    assert image.ndim == 3
    assert image.shape[2] == 4


def test_root_matrices_reach_model_space():
    man = load_gltf(DATA / "CesiumMan.gltf")
    low, high = man.meshes[0].positions.min(axis=0), man.meshes[0].positions.max(axis=0)
    assert high[1] == pytest.approx(1.507, abs=0.01)  # stands along +Y, though the file's is +Z
    assert low[1] == pytest.approx(0, abs=0.01)
    assert man.clips[0].name == "clip 0"


def test_robot_has_one_bind_pose_for_its_four_skins():
    robot = load_gltf(DATA / "RobotExpressive.glb")
    assert "HandR_1" in [mesh.name for mesh in robot.meshes]
    assert any("morph target weights" in note for note in robot.notes)
    low = min(mesh.positions[:, 1].min() for mesh in robot.meshes)
    high = max(mesh.positions[:, 1].max() for mesh in robot.meshes)
    assert 4 < high - low < 5.5


@pytest.mark.parametrize(
    "name", ["MorphStressTest.gltf", "AnimatedMorphCube/AnimatedMorphCube.gltf", "box_sparse.glb"]
)
def test_files_that_only_morph_are_refused(name):
    with pytest.raises(AssetError, match="no skin and no animation"):
        load_gltf(DATA / name)


def test_sparse_accessor_of_a_real_file():
    document = GltfDocument(DATA / "box_sparse.glb")
    sparse = [k for k, fields in enumerate(document.items("accessors")) if "sparse" in fields]
    oracle = Oracle(DATA / "box_sparse.glb")
    for index in sparse:
        kind = document.items("accessors")[index].text("type")
        np.testing.assert_array_equal(
            read_floats(document, index, kind), oracle.accessor(index).reshape(-1, SIZES[kind])
        )
    assert sparse


@cache
def load(name):
    return load_gltf(DATA / name)


def same_paths(got, expected, tolerance):
    """Every row of one has a row of the other within the tolerance."""
    for first, second in ((got, expected), (expected, got)):
        distance, _ = cKDTree(first).query(second)
        assert distance.max() < tolerance


def palette(skeleton, rotation, translation, scale):
    """Palettes (J, 4, 4) of one pose, joint by joint in float64."""
    result = np.repeat(np.eye(4)[None], skeleton.joint_count, axis=0)
    model = result.copy()
    for joint, parent in enumerate(skeleton.parents):
        local = np.eye(4)
        local[:3, :3] = Rotation.from_quat(rotation[joint]).as_matrix() * scale[joint]
        local[:3, 3] = translation[joint]
        model[joint] = local if parent < 0 else model[parent] @ local
        result[joint, :3] = skeleton.inverse_bind[joint]
        result[joint] = model[joint] @ result[joint]
    return result


def corners(character, clip, key):
    """Skinned corners (3 T, 3) of all meshes at a key of a clip."""
    palettes = palette(
        character.skeleton, clip.rotation[key], clip.translation[key], clip.scale[key]
    )
    found = []
    for mesh in character.meshes:
        points = np.column_stack([mesh.positions, np.ones(len(mesh.positions))])
        moved = np.einsum("vk,vkab,vb->va", mesh.weights, palettes[mesh.joints], points)
        found.append(moved[mesh.triangles.ravel(), :3])
    return np.concatenate(found)


def thin(path, animations, folder):
    """Copy a GLB without the animations that are not compared: pygltflib is slow on them."""
    if path.suffix != ".glb":
        return path
    data = path.read_bytes()
    size = struct.unpack_from("<I", data, 12)[0]
    tree = json.loads(data[20 : 20 + size])
    tree["animations"] = [tree["animations"][k] for k in animations]
    row: dict[int, int] = {}

    def move(holder, key):
        if key in holder:
            holder[key] = row.setdefault(holder[key], len(row))

    for animation in tree["animations"]:
        for sampler in animation["samplers"]:
            move(sampler, "input")
            move(sampler, "output")
    for skin in tree.get("skins", []):
        move(skin, "inverseBindMatrices")
    for mesh in tree["meshes"]:
        for primitive in mesh["primitives"]:
            primitive.pop("targets", None)
            move(primitive, "indices")
            for name in primitive["attributes"]:
                move(primitive["attributes"], name)
    tree["accessors"] = [tree["accessors"][k] for k in row]
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + size :]
    target = folder / path.name
    header = struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A)
    target.write_bytes(header + text + rest)
    return target


class Oracle:
    """A glTF file as pygltflib sees it, evaluated by the book."""

    def __init__(self, path):
        self.gltf = pygltflib.GLTF2().load(str(path))
        self.folder = Path(path).parent
        self.decoded = {}
        self.parent = {
            child: k for k, node in enumerate(self.gltf.nodes) for child in node.children or []
        }

    def buffer(self, index):
        uri = self.gltf.buffers[index].uri
        if uri is None:
            return self.gltf.binary_blob()
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        return (self.folder / uri).read_bytes()

    def accessor(self, index):
        if index not in self.decoded:
            self.decoded[index] = self.decode(index)
        return self.decoded[index]

    def decode(self, index):
        accessor = self.gltf.accessors[index]
        dtype, width = np.dtype(DTYPES[accessor.componentType]), SIZES[accessor.type]
        rows = np.zeros((accessor.count, width))
        if accessor.bufferView is not None:
            view = self.gltf.bufferViews[accessor.bufferView]
            data = self.buffer(view.buffer)
            stride = view.byteStride or dtype.itemsize * width
            for k in range(accessor.count):
                start = (view.byteOffset or 0) + (accessor.byteOffset or 0) + k * stride
                rows[k] = np.frombuffer(data, dtype, width, start)
        if accessor.sparse is not None:
            sparse = accessor.sparse
            views = self.gltf.bufferViews
            at, values = views[sparse.indices.bufferView], views[sparse.values.bufferView]
            where = np.frombuffer(
                self.buffer(at.buffer),
                DTYPES[sparse.indices.componentType],
                sparse.count,
                (at.byteOffset or 0) + (sparse.indices.byteOffset or 0),
            )
            rows[where] = np.frombuffer(
                self.buffer(values.buffer),
                dtype,
                sparse.count * width,
                (values.byteOffset or 0) + (sparse.values.byteOffset or 0),
            ).reshape(-1, width)
        if accessor.normalized:
            rows = np.maximum(rows / np.iinfo(dtype).max, -1)
        return rows

    def channels(self, animation):
        for channel in self.gltf.animations[animation].channels:
            if channel.target.path != "weights":
                sampler = self.gltf.animations[animation].samplers[channel.sampler]
                yield channel.target.node, channel.target.path, sampler

    def span(self, animation):
        inputs = [self.accessor(s.input) for _, _, s in self.channels(animation)]
        return min(t.min() for t in inputs), max(t.max() for t in inputs)

    def local(self, animation, time):
        """Local matrices of all nodes."""
        changed = {
            (node, path): self.value(path, sampler, time)
            for node, path, sampler in self.channels(animation)
        }
        result = []
        for k, node in enumerate(self.gltf.nodes):
            if node.matrix is not None:
                matrix = np.array(node.matrix, float).reshape(4, 4).T
            if node.matrix is None or any(key[0] == k for key in changed):
                turn = changed.get((k, "rotation"), node.rotation or [0, 0, 0, 1])
                matrix = np.eye(4)
                matrix[:3, :3] = Rotation.from_quat(turn).as_matrix()
                matrix[:3, :3] *= changed.get((k, "scale"), node.scale or [1, 1, 1])
                matrix[:3, 3] = changed.get((k, "translation"), node.translation or [0, 0, 0])
            result.append(matrix)
        return result

    def value(self, path, sampler, time):
        times, values = self.accessor(sampler.input)[:, 0], self.accessor(sampler.output)
        time = float(np.clip(time, times[0], times[-1]))
        kind = sampler.interpolation or "LINEAR"
        if kind == "CUBICSPLINE":
            values = values.reshape(len(times), 3, -1)
            k = min(int(np.searchsorted(times, time, "right")) - 1, len(times) - 2)
            d = times[k + 1] - times[k]
            u = (time - times[k]) / d
            return (
                (2 * u**3 - 3 * u**2 + 1) * values[k, 1]
                + d * (u**3 - 2 * u**2 + u) * values[k, 2]
                + (3 * u**2 - 2 * u**3) * values[k + 1, 1]
                + d * (u**3 - u**2) * values[k + 1, 0]
            )
        if kind == "STEP" or len(times) == 1:
            return values[int(np.searchsorted(times, time, "right")) - 1]
        if path == "rotation":
            return Slerp(times, Rotation.from_quat(values))(time).as_quat()
        return np.array([np.interp(time, times, column) for column in values.T])

    def shown(self):
        gltf = self.gltf
        todo = list(gltf.scenes[gltf.scene or 0].nodes)
        while todo:
            node = todo.pop()
            todo += gltf.nodes[node].children or []
            if gltf.nodes[node].mesh is not None:
                yield node, gltf.nodes[node]

    def indices(self, primitive):
        return self.accessor(primitive.indices)[:, 0].astype(int)

    def triangle_count(self):
        return sum(
            len(self.indices(primitive)) // 3
            for _, node in self.shown()
            for primitive in self.gltf.meshes[node.mesh].primitives
        )

    def corners(self, animation, time):
        """Skinned corners of all shown triangles in scene space."""
        local = self.local(animation, time)
        world: dict[int, np.ndarray] = {}

        def model(k):
            if k not in world:
                world[k] = model(self.parent[k]) @ local[k] if k in self.parent else local[k]
            return world[k]

        found = []
        for index, node in self.shown():
            for primitive in self.gltf.meshes[node.mesh].primitives:
                points = self.accessor(primitive.attributes.POSITION)
                points = np.column_stack([points, np.ones(len(points))])
                if node.skin is None:
                    moved = points @ model(index).T
                else:
                    moved = self.skin(points, primitive, self.gltf.skins[node.skin], model)
                found.append(moved[self.indices(primitive), :3])
        return np.concatenate(found)

    def skin(self, points, primitive, skin, model):
        binds = self.accessor(skin.inverseBindMatrices).reshape(-1, 4, 4).transpose(0, 2, 1)
        matrices = np.array([model(k) @ bind for k, bind in zip(skin.joints, binds, strict=True)])
        joints = self.accessor(primitive.attributes.JOINTS_0).astype(int)
        weights = self.accessor(primitive.attributes.WEIGHTS_0)
        weights = weights / weights.sum(axis=1, keepdims=True)
        return np.einsum("vk,vkab,vb->va", weights, matrices[joints], points)
