"""The glTF reader on small files written with pygltflib, with results computed by hand."""

from __future__ import annotations

import base64
import io
import json

import numpy as np
import pygltflib as pg
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation

from tifo.engine.assets.gltf import load_gltf
from tifo.engine.assets.gltf_accessor import read_floats
from tifo.engine.assets.gltf_clips import unique_names
from tifo.engine.assets.gltf_document import GltfDocument
from tifo.engine.assets.gltf_mesh import vertex_normals
from tifo.engine.errors import AssetError

CORNERS = [[0, 0, 0], [2, 0, 0], [0, 2, 0]]
HALF = np.sqrt(0.5)
COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}


def test_influences_of_every_type(tmp_path):
    for joint_type, weight_type in (("u1", "u1"), ("u2", "u2"), ("u1", "f4")):
        file = File()
        a, b = file.node(), file.node(children=[], translation=[0, 1, 0])
        top = {"u1": 255, "u2": 65535, "f4": 1.0}[weight_type]
        mesh = file.mesh(
            POSITION=file.put(CORNERS),
            JOINTS_0=file.put([[0, 1, 0, 0]] * 3, joint_type),
            WEIGHTS_0=file.put(
                np.outer([1, 1, 1], [top * 0.2, top * 0.8, 0, 0]),
                weight_type,
                normalized=weight_type != "f4",
            ),
        )
        file.skin([a, b])
        file.node(mesh=mesh, skin=0)
        character = file.load(tmp_path)
        (mesh,) = character.meshes
        names = np.array(character.skeleton.names)
        assert names[mesh.joints[0, :2]].tolist() == ["node 1", "node 0"]
        np.testing.assert_allclose(mesh.weights[0], [0.8, 0.2, 0, 0], atol=1e-6)


def test_eight_influences_keep_the_four_largest(tmp_path):
    file = File()
    joints = [file.node() for _ in range(8)]
    weights = np.array([[0.05, 0.3, 0.02, 0.2, 0.1, 0.03, 0.25, 0.05]] * 3)
    mesh = file.mesh(
        POSITION=file.put(CORNERS),
        JOINTS_0=file.put([[0, 1, 2, 3]] * 3, "u1"),
        WEIGHTS_0=file.put(weights[:, :4]),
        JOINTS_1=file.put([[4, 5, 6, 7]] * 3, "u1"),
        WEIGHTS_1=file.put(weights[:, 4:]),
    )
    file.skin(joints)
    file.node(mesh=mesh, skin=0)
    character = file.load(tmp_path)
    assert character.meshes[0].joints[0].tolist() == [1, 6, 3, 4]
    np.testing.assert_allclose(
        character.meshes[0].weights[0], np.array([0.3, 0.25, 0.2, 0.1]) / 0.85, atol=1e-6
    )
    assert any("3 vertices have more than 4 influences" in note for note in character.notes)


def test_weights_are_renormalised_and_none_means_the_first_joint(tmp_path):
    file = two_joints([[2, 6, 0, 0], [0, 0, 0, 0], [0.5, 0.5, 0, 0]], joints=[1, 0, 9, 9])
    character = file.load(tmp_path)
    mesh = character.meshes[0]
    np.testing.assert_allclose(mesh.weights[0], [0.75, 0.25, 0, 0])
    np.testing.assert_allclose(mesh.weights[1], [1, 0, 0, 0])
    assert mesh.joints[0].tolist() == [0, 1, 0, 0]
    assert mesh.joints[1].tolist() == [1, 1, 1, 1]
    assert any("have no weight" in note for note in character.notes)


@pytest.mark.parametrize(
    ("weights", "joints", "cause"),
    [
        ([[1, 0, 0, 0]] * 3, [2, 0, 0, 0], "follows joint 2, but its skin has 2 joints"),
        ([[1, -1, 0, 0]] * 3, [0, 1, 0, 0], "negative weight"),
        ([[1, float("inf"), 0, 0]] * 3, [0, 1, 0, 0], "not finite"),
        ([[1, 0, 0, 0]] * 2, [0, 1, 0, 0], "POSITION has 3 elements"),
    ],
)
def test_broken_influences(tmp_path, weights, joints, cause):
    with pytest.raises(AssetError, match=cause):
        two_joints(weights, joints).load(tmp_path)


def test_unpaired_influences_are_refused(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    file.gltf.meshes[0].primitives[0].attributes.JOINTS_1 = 1
    with pytest.raises(AssetError, match="not in pairs"):
        file.load(tmp_path)


def test_root_transform_and_inverse_bind_reach_model_space(tmp_path):
    file = File()
    bind = np.eye(4)
    bind[:3, 3] = (0, -1, 0)  # the joint was bound 1 cm up in a mesh that is made in centimetres
    joint = file.node(name="joint", translation=[0, 1, 0], root=False)
    file.node(name="armature", scale=[0.01] * 3, rotation=[HALF, 0, 0, HALF], children=[joint])
    mesh = file.mesh(
        POSITION=file.put(CORNERS),
        JOINTS_0=file.put([[0] * 4] * 3, "u1"),
        WEIGHTS_0=file.put([[1, 0, 0, 0]] * 3),
    )
    file.skin([joint], [bind])
    file.node(mesh=mesh, skin=0, translation=[50, 50, 50])  # of no consequence for a skinned mesh
    character = file.load(tmp_path)
    # 90 degrees about x turns y to z.
    np.testing.assert_allclose(
        character.meshes[0].positions, [[0, 0, 0], [0.02, 0, 0], [0, 0, 0.02]], atol=1e-7
    )
    assert character.skeleton.names == ("armature", "joint")
    assert character.skeleton.parents.tolist() == [-1, 0]
    np.testing.assert_allclose(skinned(character), character.meshes[0].positions, atol=1e-6)
    np.testing.assert_allclose(character.skeleton.inverse_bind[0], np.eye(3, 4))


def test_the_bind_pose_lies_where_most_joints_of_the_rest_pose_say(tmp_path):
    file = File()
    turned = Rotation.from_euler("z", 90, degrees=True).as_quat().tolist()
    nodes = [
        file.node(translation=[k, 0, 0], rotation=turned if k == 0 else None) for k in range(5)
    ]
    binds = [np.eye(4) for _ in nodes]
    for k, bind in enumerate(binds):
        bind[0, 3] = -k
    points = [[0, 0, 0], [0, 1, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0]]
    mesh = file.mesh(
        POSITION=file.put(points),
        JOINTS_0=file.put([[max(k - 1, 0), 0, 0, 0] for k in range(6)], "u1"),
        WEIGHTS_0=file.put([[1, 0, 0, 0]] * 6),
    )
    file.skin(nodes, binds)
    file.node(mesh=mesh, skin=0)
    character = file.load(tmp_path)
    # Joint 0 holds most vertices but is turned in the rest pose; the mesh lies as the others say.
    np.testing.assert_allclose(character.meshes[0].positions, points, atol=1e-6)


def test_matrix_nodes_are_column_by_column(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler("x", 90, degrees=True).as_matrix() * 3
    matrix[:3, 3] = (1, 2, 3)
    held = file.node(
        mesh=file.mesh(POSITION=file.put(CORNERS)), matrix=matrix.T.ravel().tolist(), root=False
    )
    file.gltf.nodes[0].children = [held]
    character = file.load(tmp_path)
    expected = [[1, 2, 3], [7, 2, 3], [1, 2, 9]]
    np.testing.assert_allclose(character.meshes[1].positions, expected, atol=1e-5)
    matrix[0, 1] = 2
    file.gltf.nodes[held].matrix = matrix.T.ravel().tolist()
    assert "The matrix of node 3 has shear, which is not kept." in file.load(tmp_path).notes


def test_two_skins_of_one_bind_pose_share_their_joints(tmp_path):
    file = File()
    nodes = [file.node(translation=[0, 0, 0]), file.node(translation=[0, 3, 0])]
    shift = np.eye(4)
    shift[:3, 3] = (5, 6, 7)
    first = [np.eye(4), np.eye(4)]
    first[1][1, 3] = -3
    for binds in (first, [bind @ shift for bind in first]):
        offset = np.zeros(3) if binds is first else shift[:3, 3]
        mesh = file.mesh(
            POSITION=file.put(np.array(CORNERS) - offset),
            JOINTS_0=file.put([[0, 1, 0, 0]] * 3, "u1"),
            WEIGHTS_0=file.put([[0.5, 0.5, 0, 0]] * 3),
        )
        file.node(mesh=mesh, skin=file.skin(nodes, binds))
    character = file.load(tmp_path)
    assert character.skeleton.joint_count == 2
    for mesh in character.meshes:
        np.testing.assert_allclose(mesh.positions, CORNERS, atol=1e-5)


def test_skins_that_disagree_get_copies_of_the_joint(tmp_path):
    file = File()
    nodes = [file.node(name="a"), file.node(name="b", translation=[0, 3, 0])]
    other = [np.eye(4), np.diag([2.0, 2, 2, 1])]
    for binds in ([np.eye(4), np.eye(4)], other):
        mesh = file.mesh(
            POSITION=file.put(CORNERS),
            JOINTS_0=file.put([[0, 1, 0, 0]] * 3, "u1"),
            WEIGHTS_0=file.put([[0.75, 0.25, 0, 0]] * 3),
        )
        file.node(mesh=mesh, skin=file.skin(nodes, binds))
    times = file.put([0.0, 0.5], kind="SCALAR")
    file.animation(None, [(nodes[1], "translation", times, file.put([[0, 3, 0], [4, 3, 0]]))])
    character = file.load(tmp_path)
    assert character.skeleton.names == ("a", "b", "b 2")
    assert character.skeleton.parents.tolist() == [-1, -1, 1]
    points = np.array(CORNERS, float)
    for x, key in ((0, 0), (4, -1)):
        b = np.array([x, 3, 0])
        np.testing.assert_allclose(
            skinned(character, key),
            np.concatenate(
                [0.75 * points + 0.25 * (points + b), 0.75 * points + 0.25 * (2 * points + b)]
            ),
            atol=1e-5,
        )


def test_only_the_joints_that_disagree_are_copied(tmp_path):
    file = File()
    nodes = [file.node(name=name, translation=[0, 0, k]) for k, name in enumerate("abc")]
    binds = [np.eye(4) for _ in nodes]
    for k, bind in enumerate(binds):
        bind[2, 3] = -k
    other = [np.diag([2.0, 2, 2, 1]), *binds[1:]]
    for matrices in (binds, other):
        mesh = file.mesh(
            POSITION=file.put(CORNERS),
            JOINTS_0=file.put([[0, 1, 2, 0]] * 3, "u1"),
            WEIGHTS_0=file.put([[0.4, 0.3, 0.3, 0]] * 3),
        )
        file.node(mesh=mesh, skin=file.skin(nodes, matrices))
    character = file.load(tmp_path)
    assert character.skeleton.names == ("a", "b", "c", "a 2")
    points = np.array(CORNERS, float)
    np.testing.assert_allclose(skinned(character), [*points, *(1.4 * points)], atol=1e-6)


def test_rigid_meshes_follow_their_node_and_stages_are_dropped(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    blade = file.mesh(POSITION=file.put(CORNERS))
    sword = file.node(name="sword", mesh=blade, translation=[0, 0, 5], root=False)
    file.gltf.nodes[1].children = [sword]
    file.node(name="ground", mesh=blade)
    character = file.load(tmp_path)
    assert [mesh.name for mesh in character.meshes] == ["mesh 0", "sword"]
    held = character.meshes[1]
    index = character.skeleton.index("sword")
    assert (held.joints == index).all()
    np.testing.assert_allclose(held.positions, np.add(CORNERS, (0, 1, 5)))
    np.testing.assert_allclose(skinned(character)[3:], held.positions, atol=1e-6)
    assert character.notes == (
        "Mesh 'ground' is neither skinned nor below a joint and is left out.",
    )


def test_rigid_files_keep_all_that_is_shown(tmp_path):
    file = File()
    mesh = file.mesh(POSITION=file.put(CORNERS))
    mill = file.node(name="mill", mesh=mesh)
    wings = file.node(name="wings", mesh=mesh)
    times = file.put([0.0, 1.0], kind="SCALAR")
    file.animation("turn", [(wings, "translation", times, file.put([[0, 0, 0], [0, 0, 6]]))])
    character = file.load(tmp_path)
    assert [mesh.name for mesh in character.meshes] == ["mill", "wings"]
    assert mill == 0
    np.testing.assert_allclose(skinned(character, -1)[3:], np.add(CORNERS, (0, 0, 6)), atol=1e-6)


def test_files_in_which_nothing_moves_are_refused(tmp_path):
    file = File()
    file.node(mesh=file.mesh(POSITION=file.put(CORNERS)))
    camera = file.node()
    with pytest.raises(AssetError, match="no skin and no animation"):
        file.load(tmp_path)
    times = file.put([0.0, 1.0], kind="SCALAR")
    file.animation("pan", [(camera, "translation", times, file.put([[0, 0, 0], [0, 0, 6]]))])
    with pytest.raises(AssetError, match="no skin and no animation"):
        file.load(tmp_path)
    with pytest.raises(AssetError, match="no triangles"):
        File().load(tmp_path)


def test_files_without_animation_load(tmp_path):
    assert two_joints([[1, 0, 0, 0]] * 3).load(tmp_path).clips == ()


def test_mirrored_nodes_keep_their_front(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    mesh = file.mesh(POSITION=file.put(CORNERS))
    mirrored = file.node(mesh=mesh, scale=[-1, 2, 1], root=False)
    file.gltf.nodes[0].children = [mirrored]
    held = file.load(tmp_path).meshes[1]
    corners = held.positions[held.triangles[0]]
    face = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    assert face[2] > 0
    np.testing.assert_allclose(held.normals, [[0, 0, 1]] * 3)
    np.testing.assert_allclose(sorted(held.positions[:, 0]), [-2, 0, 0])


def test_normals_follow_scaled_nodes(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    slope = np.array([[1, 1, 0]] * 3) / np.sqrt(2)
    mesh = file.mesh(POSITION=file.put(CORNERS), NORMAL=file.put(slope))
    file.gltf.nodes[0].children = [file.node(mesh=mesh, scale=[2, 1, 1], root=False)]
    held = file.load(tmp_path).meshes[1]
    np.testing.assert_allclose(held.normals[0], np.array([0.5, 1, 0]) / np.sqrt(1.25), atol=1e-6)


def test_absent_normals_are_weighted_by_area():
    # Two faces at a right angle that share an edge; one has three times the area of the other.
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 3, 0], [0, 0, 1.0]])
    normals = vertex_normals(positions, np.array([[0, 1, 2], [0, 3, 1]]))
    np.testing.assert_allclose(normals[0], np.array([0, 1, 3]) / np.sqrt(10))
    np.testing.assert_allclose(normals[2], [0, 0, 1])
    assert vertex_normals(np.zeros((3, 3)), np.array([[0, 1, 2]])).tolist() == [[0, 1, 0]] * 3


def test_strips_fans_and_points(tmp_path):
    file = two_joints([[1, 0, 0, 0]] * 3)
    square = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    ring = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    parts = [
        (file.put(square), pg.TRIANGLE_STRIP),
        (file.put(ring), pg.TRIANGLE_FAN),
        (file.put(ring), pg.POINTS),
    ]
    primitives = [
        pg.Primitive(attributes=pg.Attributes(POSITION=points), mode=mode, material=None)
        for points, mode in parts
    ]
    file.gltf.meshes.append(pg.Mesh(primitives=primitives))
    held = file.node(mesh=1, root=False)
    file.gltf.nodes[0].children = [held]
    character = file.load(tmp_path)
    mesh = character.meshes[1]
    assert len(mesh.triangles) == 4
    corners = mesh.positions[mesh.triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    np.testing.assert_allclose(faces, [[0, 0, 1]] * 4)
    assert any("points or lines" in note for note in character.notes)


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


def skinned(character, key=None):
    """Skinned vertices of all meshes at rest or at a key of the first clip."""
    skeleton = character.skeleton
    pose = (skeleton.rest_rotation, skeleton.rest_translation, skeleton.rest_scale)
    if key is not None:
        clip = character.clips[0]
        pose = (clip.rotation[key], clip.translation[key], clip.scale[key])
    model = np.zeros((skeleton.joint_count, 4, 4))
    for joint, parent in enumerate(skeleton.parents):
        local = np.eye(4)
        local[:3, :3] = Rotation.from_quat(pose[0][joint]).as_matrix() * pose[2][joint]
        local[:3, 3] = pose[1][joint]
        model[joint] = local if parent < 0 else model[parent] @ local
    binds = np.tile(np.eye(4), (skeleton.joint_count, 1, 1))
    binds[:, :3] = skeleton.inverse_bind
    found = []
    for mesh in character.meshes:
        points = np.column_stack([mesh.positions, np.ones(len(mesh.positions))])
        palettes = (model @ binds)[mesh.joints]
        found.append(np.einsum("vk,vkab,vb->va", mesh.weights, palettes, points)[:, :3])
    return np.concatenate(found)


def two_joints(weights, joints=(0, 1, 0, 0)):
    """A triangle on two joints, nodes 0 and 1, the second 1 m up."""
    file = File()
    nodes = [file.node(), file.node(translation=[0, 1, 0])]
    up = np.eye(4)
    up[1, 3] = -1
    mesh = file.mesh(
        POSITION=file.put(CORNERS),
        JOINTS_0=file.put([list(joints)] * len(weights), "u2"),
        WEIGHTS_0=file.put(weights),
    )
    file.node(mesh=mesh, skin=file.skin(nodes, [np.eye(4), up]))
    return file


class File:
    """A glTF file in the making."""

    def __init__(self):
        self.gltf = pg.GLTF2(scene=0, scenes=[pg.Scene(nodes=[])])
        self.blob = bytearray()

    def view(self, array, stride=None):
        self.blob += b"\0" * (-len(self.blob) % 4)
        data = array.tobytes()
        self.gltf.bufferViews.append(
            pg.BufferView(
                buffer=0, byteOffset=len(self.blob), byteLength=len(data), byteStride=stride
            )
        )
        self.blob += data
        return len(self.gltf.bufferViews) - 1

    def put(self, values, dtype="f4", kind=None, normalized=False):
        array = np.ascontiguousarray(np.round(values) if dtype != "f4" else values, dtype)
        self.gltf.accessors.append(
            pg.Accessor(
                bufferView=self.view(array),
                componentType=COMPONENTS[dtype],
                count=len(array),
                type=kind or ("MAT4" if array.ndim == 3 else f"VEC{array.shape[1]}"),
                normalized=normalized,
            )
        )
        return len(self.gltf.accessors) - 1

    def node(self, root=True, **fields):
        self.gltf.nodes.append(pg.Node(**fields))
        if root:
            self.gltf.scenes[0].nodes.append(len(self.gltf.nodes) - 1)
        return len(self.gltf.nodes) - 1

    def mesh(self, indices=None, material=None, **attributes):
        primitive = pg.Primitive(
            attributes=pg.Attributes(**attributes), indices=indices, material=material
        )
        self.gltf.meshes.append(pg.Mesh(primitives=[primitive]))
        return len(self.gltf.meshes) - 1

    def skin(self, joints, inverse_binds=None):
        binds = None
        if inverse_binds is not None:
            binds = self.put(np.array(inverse_binds).transpose(0, 2, 1))
        self.gltf.skins.append(pg.Skin(joints=joints, inverseBindMatrices=binds))
        return len(self.gltf.skins) - 1

    def animation(self, name, channels):
        animation = pg.Animation(name=name, samplers=[], channels=[])
        for node, path, times, values, *interpolation in channels:
            target = pg.AnimationChannelTarget(node=node, path=path)
            animation.channels.append(
                pg.AnimationChannel(sampler=len(animation.samplers), target=target)
            )
            animation.samplers.append(
                pg.AnimationSampler(
                    input=times, output=values, interpolation=(*interpolation, "LINEAR")[0]
                )
            )
        self.gltf.animations.append(animation)

    def finish(self):
        self.blob += b"\0" * (-len(self.blob) % 4)
        if self.blob:
            self.gltf.buffers = [pg.Buffer(byteLength=len(self.blob))]
            self.gltf.set_binary_blob(bytes(self.blob))

    def save(self, folder):
        self.finish()
        path = folder / "file.glb"
        self.gltf.save(str(path))
        return path

    def load(self, folder):
        return load_gltf(self.save(folder))
