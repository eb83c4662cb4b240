"""Triangles against scipy's, on points in and out of general position."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull, Delaunay

from tifo.engine.animation.controllers.triangulation import hull_segments, triangulate


def area(points: np.ndarray, triangles: np.ndarray) -> float:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    twice = ux * vy - uy * vx
    assert (twice > 0).all()
    return float(twice.sum() / 2)


@pytest.mark.parametrize("count", [3, 4, 5, 8, 13, 40])
def test_points_in_general_position_have_the_one_delaunay_triangulation(count: int) -> None:
    points = np.random.default_rng(count).normal(size=(count, 2)) * [3, 0.01] + [5, -7]
    expected = {tuple(sorted(t)) for t in Delaunay(points / [3, 0.01]).simplices.tolist()}
    scaled = points / [3, 0.01]
    assert {tuple(sorted(t)) for t in triangulate(scaled).tolist()} == expected


@pytest.mark.parametrize("size", [2, 3, 4])
def test_a_grid_is_covered_once(size: int) -> None:
    points = np.array([(x, y) for x in range(size) for y in range(size)], float)
    triangles = triangulate(points)
    assert area(points, triangles) == pytest.approx((size - 1) ** 2)
    assert len(triangles) == 2 * (size - 1) ** 2
    assert set(triangles.ravel()) == set(range(size**2))
    hull = hull_segments(points, triangles)
    assert len(hull) == 4 * (size - 1)


def test_random_grid_points_are_covered_once() -> None:
    rng = np.random.default_rng(3)
    for _ in range(30):
        points = np.unique(rng.integers(0, 5, (rng.integers(4, 12), 2)), axis=0).astype(float)
        if np.linalg.matrix_rank(points - points[0]) < 2:
            continue
        assert area(points, triangulate(points)) == pytest.approx(ConvexHull(points).volume)


def test_points_on_a_line_have_segments_in_order() -> None:
    points = np.array([[0, 0], [3, 3], [1, 1], [2, 2]], float)
    assert len(triangulate(points)) == 0
    pairs = {frozenset(pair) for pair in hull_segments(points, triangulate(points)).tolist()}
    assert pairs == {frozenset((0, 2)), frozenset((2, 3)), frozenset((3, 1))}
    nearly = points + np.array([[0, 0], [0, 1e-14], [0, -1e-14], [0, 0]])
    assert len(triangulate(nearly)) == 0


def test_a_single_point() -> None:
    point = np.array([[2.0, 3.0]])
    assert hull_segments(point, triangulate(point)).tolist() == [[0, 0]]
