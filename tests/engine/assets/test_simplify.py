"""Coarser meshes: what is kept of shape, materials, colours and skin weights, and what is left."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.engine.animation.skeleton import Skeleton
from tifo.engine.assets.character import Character, Material, SkinnedMesh
from tifo.engine.assets.edge_collapse import collapse_edges
from tifo.engine.assets.load import load_character
from tifo.engine.assets.simplify import with_lower_levels
from tifo.engine.assets.spectator import builtin_spectator

RED, BLUE = (200, 0, 0, 255), (0, 0, 200, 255)


def skeleton(joints: int) -> Skeleton:
    inverse = np.zeros((joints, 3, 4), np.float32)
    inverse[:, :, :3] = np.eye(3)
    return Skeleton(
        names=tuple(f"j{joint}" for joint in range(joints)),
        parents=np.arange(-1, joints - 1, dtype=np.int32),
        rest_rotation=np.tile(np.array([0, 0, 0, 1], np.float32), (joints, 1)),
        rest_translation=np.zeros((joints, 3), np.float32),
        rest_scale=np.ones((joints, 3), np.float32),
        inverse_bind=inverse,
    )


def ball(
    centre: tuple[float, float, float] = (0, 0, 0),
    radius: float = 1.0,
    *,
    subdivisions: int = 3,
    joint: int = 0,
    material: int = 0,
    name: str = "ball",
    split: bool = False,
) -> SkinnedMesh:
    """A closed ball; `split` gives every triangle vertices of its own, as flat shading does."""
    from trimesh.creation import icosphere

    sphere = icosphere(subdivisions=subdivisions)
    triangles = np.asarray(sphere.faces, np.int64)
    unit = np.asarray(sphere.vertices)
    if split:
        unit = unit[triangles.ravel()]
        triangles = np.arange(len(unit)).reshape(-1, 3)
    count = len(unit)
    joints = np.zeros((count, 4), np.uint16)
    joints[:, 0] = joint
    weights = np.zeros((count, 4), np.float32)
    weights[:, 0] = 1.0
    return SkinnedMesh(
        name=name,
        positions=(unit * radius + centre).astype(np.float32),
        normals=unit.astype(np.float32),
        uvs=np.zeros((count, 2), np.float32),
        colors=np.ones((count, 4), np.float32),
        joints=joints,
        weights=weights,
        triangles=triangles.astype(np.uint32),
        material=material,
    )


def character(
    *meshes: SkinnedMesh, materials: tuple[Material, ...] = (Material("m"),)
) -> Character:
    joints = 1 + max(int(mesh.joints.max()) for mesh in meshes)
    return Character("test", skeleton(joints), meshes, materials, ())


def triangle_count(level: tuple[SkinnedMesh, ...]) -> int:
    return sum(len(mesh.triangles) for mesh in level)


def volume(level: tuple[SkinnedMesh, ...]) -> float:
    total = 0.0
    for mesh in level:
        a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(float) for k in range(3))
        total += float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum()) / 6.0
    return total


@pytest.mark.parametrize("split", [False, True])
def test_a_ball_keeps_its_size_and_its_normals_with_fewer_triangles(split: bool) -> None:
    made = with_lower_levels(character(ball(split=split)), (400, 100))
    assert [triangle_count(level) for level in made.lower_levels] == [400, 100]
    for level, error in zip(made.lower_levels, (0.03, 0.1), strict=True):
        (mesh,) = level
        # A closed surface of T triangles without seams has T / 2 + 2 vertices.
        assert len(mesh.positions) == len(mesh.triangles) // 2 + 2
        assert volume(level) == pytest.approx(4.0 / 3.0 * np.pi, rel=error)
        outwards = mesh.positions / np.linalg.norm(mesh.positions, axis=1, keepdims=True)
        assert np.einsum("ij,ij->i", mesh.normals, outwards).min() > 0.95
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-5)


def test_names_materials_and_the_finest_level_follow_the_conventions() -> None:
    before = character(
        ball(name="body"),
        ball((3, 0, 0), name="hat", material=1),
        materials=(Material("skin"), Material("hair", double_sided=True)),
    )
    made = with_lower_levels(before, (400, 100))
    assert made.meshes is before.meshes
    assert made.materials == before.materials
    for number, level in enumerate(made.lower_levels, start=1):
        assert [mesh.name for mesh in level] == [f"body_LOD{number}", f"hat_LOD{number}"]
        assert [mesh.material for mesh in level] == [0, 1]
        for mesh, centre in zip(level, (0.0, 3.0), strict=True):
            assert np.abs(mesh.positions[:, 0] - centre).max() < 1.2


def test_limbs_that_touch_keep_their_own_joints() -> None:
    # The balls touch in the plane x = 1: what is nearest there belongs to the other one half the
    # time, so only following the collapses can be right.
    made = with_lower_levels(character(ball(), ball((2, 0, 0), joint=1)), (200,))
    ((mesh,),) = made.lower_levels
    side = mesh.positions[mesh.triangles].mean(axis=1)[:, 0] > 1.0
    owner = mesh.joints[mesh.triangles, 0]
    assert (owner == owner[:, :1]).all(), "no triangle spans both limbs"
    np.testing.assert_array_equal(owner[:, 0], side.astype(int))


def test_weights_that_change_along_a_body_still_do() -> None:
    mesh = ball(subdivisions=4)
    share = (0.5 + 0.5 * mesh.positions[:, 1]).astype(np.float32)
    weights = np.stack([1.0 - share, share, 0 * share, 0 * share], axis=1)
    joints = np.tile(np.array([0, 1, 0, 0], np.uint16), (len(share), 1))
    mesh = replace(mesh, weights=weights, joints=joints)
    ((made,),) = with_lower_levels(character(mesh), (300,)).lower_levels
    np.testing.assert_allclose(made.weights.sum(axis=1), 1.0, atol=1e-6)
    np.testing.assert_allclose(made.weights[:, 1], 0.5 + 0.5 * made.positions[:, 1], atol=0.1)


def test_a_picture_becomes_vertex_colours_in_linear_light() -> None:
    picture = np.array([[RED, BLUE]], np.uint8)
    mesh = ball(subdivisions=4)
    right = mesh.positions[:, 0] > 0
    uvs = np.stack([np.where(right, 0.75, 0.25), np.full(len(right), 0.5)], axis=1)
    before = character(
        replace(mesh, uvs=uvs.astype(np.float32)),
        materials=(Material("cloth", (0.5, 0.5, 0.5, 1.0), picture, double_sided=True),),
    )
    made = with_lower_levels(before, (600,))
    textured, plain = made.materials
    assert textured is before.materials[0]
    assert plain.image is None
    assert (plain.name, plain.base_color, plain.double_sided) == (
        "cloth",
        (0.5, 0.5, 0.5, 1.0),
        True,
    )
    ((level,),) = made.lower_levels
    assert level.material == 1
    bright = ((200 / 255 + 0.055) / 1.055) ** 2.4
    left, right = level.positions[:, 0] < -0.3, level.positions[:, 0] > 0.3
    np.testing.assert_allclose(level.colors[left], [[bright, 0, 0, 1]] * left.sum(), atol=1e-6)
    np.testing.assert_allclose(level.colors[right], [[0, 0, bright, 1]] * right.sum(), atol=1e-6)


def test_patches_of_colour_that_meet_at_a_seam_stay_crisp() -> None:
    # Halves with vertices of their own along the seam, as a palette picture gives them.
    mesh = ball(subdivisions=4, split=True)
    face_right = mesh.positions[mesh.triangles].mean(axis=1)[:, 0] > 0
    right = np.repeat(face_right, 3)
    colors = np.where(
        right[:, None], np.array([0, 0, 1, 1], np.float32), np.array([1, 0, 0, 1], np.float32)
    )
    before = character(replace(mesh, colors=colors))
    ((level,),) = with_lower_levels(before, (300,)).lower_levels
    assert set(map(tuple, level.colors.round(6).tolist())) == {(1, 0, 0, 1), (0, 0, 1, 1)}
    side = level.positions[level.triangles].mean(axis=1)[:, 0] > 0
    blue = level.colors[level.triangles[:, 0], 2] > 0.5
    assert (blue == side).mean() > 0.9


def test_see_through_texels_do_not_colour_what_is_left() -> None:
    picture = np.array([[(0, 255, 0, 0), RED]], np.uint8)
    mesh = ball(subdivisions=4)
    rng = np.random.default_rng(3)
    uvs = np.stack(
        [rng.choice([0.25, 0.75], len(mesh.positions)), np.zeros(len(mesh.positions))], 1
    )
    made = with_lower_levels(
        character(
            replace(mesh, uvs=uvs.astype(np.float32)), materials=(Material("m", image=picture),)
        ),
        (100,),
    )
    ((level,),) = made.lower_levels
    assert (level.colors[:, 3] == 1.0).all()
    assert np.median(level.colors[:, 1]) < 0.01


def band(segments: int = 32) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """An open band of height 1 about the Y axis."""
    angle = np.arange(segments) * 2 * np.pi / segments
    ring = np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    low = np.arange(segments)
    right = np.roll(low, -1)
    up = low + segments
    triangles = np.concatenate(
        [np.stack([low, up, right], 1), np.stack([right, up, np.roll(up, -1)], 1)]
    )
    return np.concatenate([ring, ring + np.array([0.0, 1.0, 0.0])]), triangles


def test_an_open_band_is_not_collapsed_across() -> None:
    points, triangles = band()
    into, places = collapse_edges(points, triangles, 12)
    moved = into[triangles]
    left = moved[[len(set(corners)) == 3 for corners in moved.tolist()]]
    assert 8 <= len(left) <= 12
    reach = np.ptp(places[np.unique(left)], axis=0)
    np.testing.assert_allclose(reach[1], 1.0, atol=0.02)
    assert reach[[0, 2]].min() > 1.5


def test_thin_parts_do_not_vanish_before_broad_ones_lose_their_shape() -> None:
    thin = ball(name="leg")
    thin = replace(
        thin,
        positions=thin.positions * np.array([0.02, 1.0, 0.02], np.float32)
        - np.array([0, 2, 0], np.float32),
    )
    ((*_, last),) = with_lower_levels(character(ball(subdivisions=4), thin), (100,)).lower_levels
    part = last.positions[last.triangles].reshape(-1, 3)
    leg = part[part[:, 1] < -1.05]
    assert len(leg) >= 3 * 4
    assert np.ptp(leg[:, 1]) > 1.7
    assert np.ptp(leg[:, 0]) > 0.02


def test_characters_that_need_no_coarser_meshes_come_back_as_they_are() -> None:
    small = character(ball(subdivisions=1))
    assert with_lower_levels(small) is small
    spectator = builtin_spectator()
    assert with_lower_levels(spectator) is spectator
    assert with_lower_levels(small, ()) is small


def test_a_level_that_the_finest_satisfies_is_the_finest() -> None:
    mesh = ball(subdivisions=2)  # 320 triangles
    made = with_lower_levels(character(mesh), (800, 200))
    assert made.lower_levels[0] is made.meshes
    assert triangle_count(made.lower_levels[1]) == 200


def test_what_collapses_to_nothing_falls_back_to_the_finer_level() -> None:
    # Loose triangles, nothing to collapse along without losing them.
    rng = np.random.default_rng(5)
    corner = rng.uniform(-1, 1, (300, 1, 3))
    points = (corner + 1e-3 * rng.uniform(-1, 1, (300, 3, 3))).reshape(-1, 3)
    count = len(points)
    dust = replace(
        ball(split=True, subdivisions=1),
        positions=points.astype(np.float32),
        normals=np.tile(np.array([0, 1, 0], np.float32), (count, 1)),
        uvs=np.zeros((count, 2), np.float32),
        colors=np.ones((count, 4), np.float32),
        joints=np.zeros((count, 4), np.uint16),
        weights=np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1)),
        triangles=np.arange(count, dtype=np.uint32).reshape(-1, 3),
    )
    made = with_lower_levels(character(dust), (200, 4))
    finer = triangle_count(made.meshes)
    for level in made.lower_levels:
        assert 0 < triangle_count(level) <= finer
        reach = np.ptp(np.concatenate([mesh.positions for mesh in level]), axis=0)
        assert reach[1] > 0.6 * np.ptp(points[:, 1])
        finer = triangle_count(level)


def test_folded_and_doubled_triangles_do_no_harm() -> None:
    mesh = ball()
    extra = np.concatenate([mesh.triangles, mesh.triangles[:50], mesh.triangles[:50, [0, 0, 1]]])
    made = with_lower_levels(character(replace(mesh, triangles=extra)), (100,))
    ((level,),) = made.lower_levels
    assert np.isfinite(level.positions).all()
    assert 0 < len(level.triangles) <= 110
    assert level.triangles.max() < len(level.positions)


@pytest.mark.parametrize("targets", [(3,), (200, 200), (100, 200)])
def test_targets_must_fall_and_make_a_body(targets: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="targets is"):
        with_lower_levels(character(ball()), targets)


SAMPLES = [
    "gltf/KayKit_Knight.glb",
    "gltf/RobotExpressive.glb",
    "gltf/CesiumMan.gltf",
    "gltf/phoenix_bird.glb",
    "bvh/cmu_02_01.bvh",
]


@pytest.mark.parametrize("name", SAMPLES)
def test_sample_characters_get_small_sound_levels_fast(name: str, shared_data: Path) -> None:
    before = load_character(shared_data / name)
    started = time.perf_counter()
    made = with_lower_levels(before)
    assert time.perf_counter() - started < 2.0
    again = with_lower_levels(before)
    finer = made.meshes
    points = np.concatenate([mesh.positions for mesh in finer])
    for level, twin, most in zip(made.lower_levels, again.lower_levels, (900, 400), strict=True):
        assert triangle_count(level) < min(triangle_count(finer), most)
        reached = np.concatenate([mesh.positions for mesh in level])
        lost = np.maximum(reached.min(0) - points.min(0), points.max(0) - reached.max(0))
        assert (lost < 0.25 * np.ptp(points, axis=0).max()).all()
        for mesh, same in zip(level, twin, strict=True):
            assert made.materials[mesh.material].image is None
            assert np.isfinite(mesh.positions).all()
            assert np.isfinite(mesh.normals).all()
            assert mesh.triangles.max() < len(mesh.positions)
            assert len(np.unique(mesh.triangles)) == len(mesh.positions)
            assert (mesh.colors >= 0).all()
            np.testing.assert_allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-5)
            for field in ("positions", "normals", "colors", "joints", "weights", "triangles"):
                np.testing.assert_array_equal(getattr(mesh, field), getattr(same, field))
        finer = level
