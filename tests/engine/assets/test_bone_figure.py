"""The figure of bones: where its bones lie, what they are bound to, and that it is closed."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from tifo.engine.animation.clip import Clip
from tifo.engine.animation.skeleton import Skeleton
from tifo.engine.assets.bone_figure import BALL_COLOR, BONE_COLOR, bone_figure
from tifo.engine.assets.bvh_hierarchy import EndSite


def skeleton(offsets: list[list[float]], parents: list[int]) -> Skeleton:
    count = len(parents)
    rest = np.array(offsets, dtype=np.float32)
    world = rest.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            world[joint] += world[parent]
    inverse = np.zeros((count, 3, 4), dtype=np.float32)
    inverse[:, :, :3] = np.eye(3)
    inverse[:, :, 3] = -world
    return Skeleton(
        names=tuple(f"j{joint}" for joint in range(count)),
        parents=np.array(parents, dtype=np.int32),
        rest_rotation=np.tile(np.float32([0, 0, 0, 1]), (count, 1)),
        rest_translation=rest,
        rest_scale=np.ones((count, 3), dtype=np.float32),
        inverse_bind=inverse,
    )


LEG = skeleton([[0, 1, 0], [0.1, 0, 0], [0, -0.5, 0]], [-1, 0, 1])
FOOT = EndSite(2, (0.0, 0.0, 0.2))


def parts(mesh: object) -> list[np.ndarray]:
    """Vertex indices of each connected part."""
    import trimesh

    whole = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
    labels = trimesh.graph.connected_component_labels(whole.edges, node_count=len(mesh.positions))
    return [np.flatnonzero(labels == label) for label in np.unique(labels)]


def test_a_bone_runs_from_each_joint_to_its_child_and_is_bound_to_the_joint() -> None:
    (mesh,) = bone_figure(LEG, "leg", end_sites=(FOOT,)).meshes
    bones = [part for part in parts(mesh) if (mesh.colors[part[0]] == np.float32(BONE_COLOR)).all()]
    assert len(bones) == 3
    spans = {0: ([0, 1, 0], [0.1, 1, 0]), 1: ([0.1, 1, 0], [0.1, 0.5, 0])}
    spans[2] = ([0.1, 0.5, 0], [0.1, 0.5, 0.2])
    for bone in bones:
        (joint,) = np.unique(mesh.joints[bone, 0])
        start, stop = np.array(spans.pop(int(joint)))
        along = (stop - start) / np.linalg.norm(stop - start)
        places = (mesh.positions[bone] - start) @ along
        assert places.min() == pytest.approx(0, abs=1e-6)
        assert places.max() == pytest.approx(np.linalg.norm(stop - start), rel=1e-5)
        aside = mesh.positions[bone] - start - places[:, None] * along
        assert 0.005 < np.linalg.norm(aside, axis=1).max() < 0.06
    assert not spans


def test_a_ball_sits_at_every_joint() -> None:
    (mesh,) = bone_figure(LEG, "leg", end_sites=(FOOT,)).meshes
    balls = [part for part in parts(mesh) if (mesh.colors[part[0]] == np.float32(BALL_COLOR)).all()]
    centres = {int(mesh.joints[ball[0], 0]): mesh.positions[ball].mean(axis=0) for ball in balls}
    np.testing.assert_allclose(
        [centres[joint] for joint in range(3)], [[0, 1, 0], [0.1, 1, 0], [0.1, 0.5, 0]], atol=1e-6
    )


def test_the_mesh_is_whole() -> None:
    import trimesh

    character = bone_figure(LEG, "leg", end_sites=(FOOT,), notes=("a note",))
    (mesh,) = character.meshes
    vertices = len(mesh.positions)
    assert character.name == "leg"
    assert character.notes == ("a note",)
    assert character.triangle_count == 3 * 48 + 3 * 80
    for values, width, kind in (
        (mesh.positions, 3, np.float32),
        (mesh.normals, 3, np.float32),
        (mesh.uvs, 2, np.float32),
        (mesh.colors, 4, np.float32),
        (mesh.joints, 4, np.uint16),
        (mesh.weights, 4, np.float32),
    ):
        assert values.shape == (vertices, width)
        assert values.dtype == kind
    assert mesh.triangles.dtype == np.uint32
    assert mesh.triangles.max() == vertices - 1
    np.testing.assert_array_equal(mesh.weights.sum(axis=1), 1)
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, rtol=1e-5)
    whole = trimesh.Trimesh(mesh.positions, mesh.triangles, process=False)
    assert whole.is_watertight
    # Counter-clockwise faces look outwards, and so do the normals.
    assert whole.volume > 0
    for part in parts(mesh):
        out = mesh.positions[part] - mesh.positions[part].mean(axis=0)
        assert (np.sum(out * mesh.normals[part], axis=1) > 0).mean() > 0.9


@pytest.mark.parametrize(
    "bare",
    [
        skeleton([[0, 0, 0]], [-1]),
        skeleton([[0, 0, 0], [0, 0, 0]], [-1, 0]),
        skeleton([[1, 2, 3], [0, 1e-20, 0]], [-1, 0]),
    ],
    ids=["one joint", "no length", "hardly a length"],
)
def test_a_skeleton_without_bones_is_still_seen(bare: Skeleton) -> None:
    (mesh,) = bone_figure(bare, "dot").meshes
    assert np.isfinite(mesh.positions).all()
    assert np.isfinite(mesh.normals).all()
    assert len(mesh.triangles) >= 80 * bare.joint_count


def test_zero_length_joints_get_no_bone() -> None:
    double = skeleton([[0, 1, 0], [0, 0, 0], [0, 0.5, 0]], [-1, 0, 1])
    assert bone_figure(double, "double").triangle_count == 48 + 3 * 80


def test_size_does_not_matter() -> None:
    large = skeleton((1000 * LEG.rest_translation).tolist(), [-1, 0, 1])
    small_mesh, large_mesh = bone_figure(LEG, "a").meshes[0], bone_figure(large, "b").meshes[0]
    np.testing.assert_allclose(large_mesh.positions, 1000 * small_mesh.positions, atol=1e-2)


def test_parts_of_another_skeleton_are_refused() -> None:
    clip = Clip(
        "wave", 0.0, np.ones((1, 2, 4), np.float32), np.ones((1, 2, 3), np.float32),
        np.ones((1, 2, 3), np.float32),
    )  # fmt: skip
    with pytest.raises(ValueError, match="clips: 'wave' has 2 joints, expected 3"):
        bone_figure(LEG, "leg", (clip,))
    with pytest.raises(ValueError, match="end_sites: joint 3 of a skeleton of 3 joints"):
        bone_figure(LEG, "leg", end_sites=(EndSite(3, (0, 1, 0)),))


def test_it_needs_no_more_than_numpy_and_trimesh() -> None:
    code = (
        "import sys\n"
        "for name in ('scipy', 'skimage', 'PIL', 'pyglet', 'shapely', 'networkx'):\n"
        "    sys.modules[name] = None\n"
        "import numpy as np\n"
        "from tifo.engine.animation.skeleton import Skeleton\n"
        "from tifo.engine.assets.bone_figure import bone_figure\n"
        "assert 'trimesh' not in sys.modules\n"
        "f = np.float32\n"
        "s = Skeleton(('a', 'b'), np.array([-1, 0], np.int32), np.tile(f([0, 0, 0, 1]), (2, 1)),\n"
        "    np.ones((2, 3), f), np.ones((2, 3), f), np.tile(np.eye(3, 4, dtype=f), (2, 1, 1)))\n"
        "print(bone_figure(s, 'x').triangle_count)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout == f"{48 + 160}\n", done.stderr
    assert done.stderr == ""
