"""The parts of the builder: solids, cutting, reduction, limbs and curves."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.assets.spectator.borders import cut
from tifo.engine.assets.spectator.build import surfaces_apart
from tifo.engine.assets.spectator.curves import Performance, keyed
from tifo.engine.assets.spectator.decimation import reduce_surface, stretched
from tifo.engine.assets.spectator.limbs import bend_limb
from tifo.engine.assets.spectator.meshing import mirrored, rim_vertices, signed_volume
from tifo.engine.assets.spectator.poses import standing
from tifo.engine.assets.spectator.rig import channels
from tifo.engine.assets.spectator.rotations import between_frames, from_matrix, rotate, twist_angle
from tifo.engine.assets.spectator.shapes import ellipsoid, round_cone, smooth_min
from tifo.engine.assets.spectator.skeleton import spectator_skeleton

Array = NDArray[np.float64]


def sphere(rings: int = 14, around: int = 20) -> tuple[Array, NDArray[np.int64]]:
    """A closed unit sphere."""
    polar = np.pi * np.arange(1, rings) / rings
    turn = 2 * np.pi * np.arange(around) / around
    grid = np.stack(
        [
            np.outer(np.sin(polar), np.cos(turn)),
            np.outer(np.cos(polar), np.ones(around)),
            np.outer(np.sin(polar), np.sin(turn)),
        ],
        axis=-1,
    ).reshape(-1, 3)
    points = np.concatenate([[[0.0, 1.0, 0.0]], grid, [[0.0, -1.0, 0.0]]])
    faces: list[tuple[int, int, int]] = []
    for k in range(around):
        n = (k + 1) % around
        faces += [
            (0, 1 + n, 1 + k),
            (len(points) - 1, len(points) - 1 - around + k, len(points) - 1 - around + n),
        ]
        for ring in range(rings - 2):
            a, b = 1 + ring * around + k, 1 + ring * around + n
            faces += [(a, b, b + around), (a, b + around, a + around)]
    return points, np.array(faces, dtype=np.int64)


def is_closed(faces: NDArray[np.int64]) -> bool:
    return len(rim_vertices(faces)) == 0


def test_round_cone_and_ellipsoid_distances() -> None:
    points = np.array([[2, 0, 0], [0, 3, 0], [0, -1, 0]], dtype=np.float32)
    rod = round_cone(points, (0, 0, 0), (0, 2, 0), 0.5, 0.25)
    np.testing.assert_allclose(rod, [1.5, 0.75, 0.5], atol=1e-6)
    ball = ellipsoid(points, (0, 0, 0), (1, 1, 1))
    np.testing.assert_allclose(ball, [1.0, 2.0, 0.0], atol=1e-5)
    stretched_ball = ellipsoid(points, (0, 0, 0), (2, 3, 1))
    np.testing.assert_allclose(stretched_ball[:2], 0.0, atol=1e-5)


def test_smooth_union_adds_a_quarter_of_the_radius_in_the_seam() -> None:
    same = np.zeros(1, dtype=np.float32)
    np.testing.assert_allclose(smooth_min(same, same, 0.04), -0.01, atol=1e-7)
    far = np.array([0.5], dtype=np.float32)
    np.testing.assert_allclose(smooth_min(same, far, 0.04), 0.0, atol=1e-7)


@pytest.mark.parametrize("snap", [0.0, 0.3])
def test_cut_splits_exactly_on_the_line_and_keeps_the_surface_closed(snap: float) -> None:
    points, faces = sphere()
    height = points[:, 1] - 0.21
    cut_points, cut_faces, inside, source = cut(points, faces, height, snap)
    assert is_closed(cut_faces)
    assert len(source) == len(cut_faces) > len(faces) - 1
    corners = cut_points[cut_faces][:, :, 1] - 0.21
    assert (corners[inside] < 1e-9).all()
    assert (corners[~inside] > -1e-9).all()
    assert signed_volume(cut_points, cut_faces) == pytest.approx(
        signed_volume(points, faces), rel=0.02 if snap else 1e-12
    )


def test_half_of_a_sphere_mirrors_to_a_closed_one() -> None:
    points, faces = sphere()
    points, faces, inside, _ = cut(points, faces, -points[:, 0], 0.1)
    used, half = np.unique(faces[inside], return_inverse=True)
    points, half = points[used], half.reshape(-1, 3)
    points[rim_vertices(half), 0] = 0.0
    whole, all_faces = mirrored(points, half)
    assert is_closed(all_faces)
    assert signed_volume(whole, all_faces) == pytest.approx(2 * signed_volume(points, half))


def test_reduction_keeps_shape_and_topology() -> None:
    points, faces = sphere(18, 26)
    levels = reduce_surface(points * 0.1, points * 0.1, faces, (400, 100))
    for (reduced, left), count in zip(levels, (400, 100), strict=True):
        assert count - 1 <= len(left) <= count
        assert is_closed(left)
        assert len(reduced) == len(left) // 2 + 2  # Euler's formula for a closed sphere
        np.testing.assert_allclose(np.linalg.norm(reduced, axis=1), 0.1, atol=0.008)
        assert signed_volume(reduced, left) > 0.85 * 4 / 3 * np.pi * 1e-3


def test_reduction_keeps_what_bends_in_the_other_pose() -> None:
    """A straight rod may lose its middle ring, unless it is folded there in the second pose."""
    points, faces = sphere(20, 10)
    rod = points * (0.05, 1.0, 0.05)
    fold = np.where(rod[:, 1:2] > 0, rod, rod[:, [0, 2, 1]] * (1, 1, 1))
    straight = reduce_surface(rod, rod, faces, (40,))[0][0]
    bendable = reduce_surface(rod, fold, faces, (40,))[0][0]
    near = 0.12

    def middle(vertices: Array) -> int:
        return int((np.abs(vertices[:, 1]) < near).sum())

    assert middle(bendable) > middle(straight)


def test_stretching_is_undone() -> None:
    points = np.random.default_rng(3).uniform((-0.7, 0, -0.15), (0.7, 1.75, 0.2), (500, 3))
    np.testing.assert_allclose(stretched(stretched(points), inverse=True), points, atol=1e-9)
    assert stretched(np.array([[0.0, 1.7, 0.1]]))[0, 2] > 0.15


unit_number = st.floats(-1, 1)


@given(st.tuples(unit_number, unit_number, unit_number), st.tuples(unit_number, unit_number))
def test_limb_reaches_its_target(
    target: tuple[float, float, float], pole: tuple[float, float]
) -> None:
    goal = np.array([target]) * 0.35 + (0.0, -0.45, 0.0)
    start = np.zeros((1, 3))
    bind = (np.zeros(3), np.array([0.0, -0.4, 0.0]), np.array([0.0, -0.8, 0.0]))
    way = np.array([pole[0], 0.0, 1.2 + pole[1]])
    upper, lower, end = bend_limb(start, goal, way, bind, np.array([0.0, 0.0, 1.0]), ease=0.0)
    reach = float(np.linalg.norm(goal))
    middle = rotate(upper, bind[1][None])
    found = middle + rotate(lower, (bind[2] - bind[1])[None])
    np.testing.assert_allclose(found, end, atol=1e-9)
    if 0.01 < reach < 0.79:
        np.testing.assert_allclose(found, goal, atol=1e-9)
        # The middle joint sticks out the way that the pole says.
        line = goal[0] / reach
        aside = way - (way @ line) * line
        assert (middle[0] - (middle[0] @ line) * line) @ aside > 0


def test_an_eased_limb_never_snaps_straight() -> None:
    bind = (np.zeros(3), np.array([0.0, -0.4, 0.0]), np.array([0.0, -0.8, 0.0]))
    way = np.array([0.0, 0.0, 1.0])
    goal = np.stack([np.zeros(200), -np.linspace(0.5, 1.2, 200), np.zeros(200)], axis=1)
    start = np.zeros((200, 3))

    def speed(ease: float) -> float:
        upper, _, _ = bend_limb(start, goal, way, bind, way, ease=ease)
        knee = rotate(upper, bind[1][None].repeat(200, axis=0))
        return float(np.abs(np.diff(knee, n=2, axis=0)).max())

    assert speed(0.06) < 0.25 * speed(0.0)


def test_rotation_helpers_by_hand() -> None:
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(from_matrix(quarter), [0, 0, 0.5**0.5, 0.5**0.5], atol=1e-12)
    x, y, z = np.eye(3)
    turn = between_frames(x, y, y, z)
    np.testing.assert_allclose(rotate(turn, z), x, atol=1e-12)
    assert twist_angle(np.array([0, 0, np.sin(0.3), np.cos(0.3)]), z) == pytest.approx(0.6)


def test_keyed_curve_hits_its_keys_and_does_not_overshoot() -> None:
    times = np.array([0.0, 1.0, 1.5, 3.0])
    values = np.array([[0.0], [2.0], [2.0], [-1.0]])
    np.testing.assert_allclose(keyed(times, values, times), values, atol=1e-12)
    fine = keyed(times, values, np.linspace(-1, 4, 501))
    assert fine.max() <= 2.0 + 1e-12
    assert fine.min() >= -1.0 - 1e-12
    np.testing.assert_array_equal(keyed(times, values, np.array([-1.0, 9.0])), [[0.0], [-1.0]])
    # Half way between two level ends a cubic ease is half way.
    assert keyed(times, values, np.array([2.25]))[0, 0] == pytest.approx(0.5)


def test_a_loop_that_does_not_close_is_refused() -> None:
    broken = Performance("broken", 1.0, standing()).key("head", (0, 0.0), (1, (0.4, 0.0, 0.0)))
    with pytest.raises(ValueError, match="'broken' loops with a jump"):
        broken.clip(spectator_skeleton())


def test_an_ending_that_misses_its_goal_is_refused() -> None:
    with pytest.raises(ValueError, match="'late' ends with hips"):
        Performance("late", 1.0, standing(), looping=False).settle(
            {**standing(), "hips": np.zeros(3)}
        )


def test_channels_have_two_sides_where_the_body_has() -> None:
    names = channels()
    assert {"hips", "head", "hand_l", "hand_r", "knee_l"} <= names.keys()
    assert "hand" not in names


def test_surfaces_are_compared_by_distance() -> None:
    kept = builtin_spectator()
    assert surfaces_apart(kept, kept) < 1e-7
    body, *others = kept.meshes
    positions = body.positions.copy()
    top = int(positions[:, 1].argmax())
    positions[top, 1] += 0.05
    moved = replace(kept, meshes=(replace(body, positions=positions), *others))
    assert 0.03 < surfaces_apart(moved, kept) <= 0.0501
    assert surfaces_apart(replace(kept, meshes=(body,)), kept) == np.inf


@pytest.mark.slow
def test_rebuilding_gives_the_shipped_meshes(tmp_path: Path) -> None:
    pytest.importorskip("skimage")
    from tifo.cli import main

    assert main(["assets", "build", "--out", str(tmp_path / "again.glb")]) == 0
