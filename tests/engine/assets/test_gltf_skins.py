"""Skins, bind poses and rigid parts of small glTF files, with results computed by hand."""

from __future__ import annotations

import numpy as np
import pygltflib as pg
import pytest
from gltf_files import CORNERS, HALF, File, skinned, two_joints
from scipy.spatial.transform import Rotation

from tifo.engine.assets.gltf_mesh import vertex_normals
from tifo.engine.errors import AssetError


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
