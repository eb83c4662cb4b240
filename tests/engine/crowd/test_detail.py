"""Culling and levels of detail against float64 and one agent at a time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.components import Detail, Level, Placement, View
from tifo.engine.crowd.detail import (
    MESH_PIXELS,
    Bounds,
    frustum_planes,
    pixel_heights,
    select_detail,
)

Array = NDArray[Any]
HEIGHT = 1.75


def _camera(eye: Array, yaw: float, pitch: float, fov: float, pixels: int = 720) -> View:
    """A camera written by hand: yaw about Y, then pitch about X; at rest it looks down -Z."""
    cy, sy, cp, sp = np.cos(yaw), np.sin(yaw), np.cos(pitch), np.sin(pitch)
    turn = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    tilt = np.array([[1, 0, 0], [0, cp, -sp], [0, sp, cp]])
    rotation = (turn @ tilt).T
    view = np.eye(4)
    view[:3, :3], view[:3, 3] = rotation, -rotation @ eye
    f = 1.0 / np.tan(fov / 2)
    near, far = 0.1, 500.0
    projection = np.zeros((4, 4))
    projection[0, 0], projection[1, 1] = f / (16 / 9), f
    projection[2, 2:] = (far + near) / (near - far), 2 * far * near / (near - far)
    projection[3, 2] = -1.0
    return View(view.astype(np.float32), projection.astype(np.float32), pixels)


def _placement(rng: np.random.Generator, count: int, reach: float) -> Placement:
    return Placement(
        position=rng.uniform(-reach, reach, (3, count)).astype(np.float32),
        yaw=np.zeros(count, np.float32),
        scale=rng.uniform(0.5, 2.0, count).astype(np.float32),
    )


def _margin(view: View, placement: Placement, height: float) -> Array:
    """(N,) metres by which each sphere reaches into the frustum, negative if outside, float64."""
    matrix = view.projection.astype(float) @ view.view.astype(float)
    rows = np.array([matrix[3] + matrix[0], matrix[3] - matrix[0], matrix[3] + matrix[1],
                     matrix[3] - matrix[1], matrix[3] + matrix[2]])  # fmt: skip
    margins = []
    for index in range(len(placement.scale)):
        size = height * float(placement.scale[index])
        middle = placement.position[:, index].astype(float)
        middle[1] += 0.5 * size
        inside = [(r[:3] @ middle + r[3]) / np.linalg.norm(r[:3]) for r in rows]
        margins.append(min(inside) + 0.75 * size)
    return np.array(margins)


ANGLES = st.floats(-np.pi, np.pi)


@settings(max_examples=60, deadline=None)
@given(
    yaw=ANGLES,
    pitch=st.floats(-1.5, 1.5),
    fov=st.floats(0.2, 2.0),
    height=st.sampled_from([1.75, 0.4, 175.0]),
    levels=st.booleans(),
    seed=st.integers(0, 2**32),
)
def test_agents_in_view_are_those_whose_sphere_touches_the_frustum(
    yaw: float, pitch: float, fov: float, height: float, levels: bool, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    placement = _placement(rng, 80, 40.0)
    placement.scale *= np.float32(HEIGHT / height)
    present = rng.random(80) < 0.8
    view = _camera(rng.uniform(-30, 30, 3), yaw, pitch, fov)
    detail = Detail()
    select_detail(detail, placement, present, height, view, levels=levels)
    margin = _margin(view, placement, height)
    found = np.zeros(80, int)
    for ids in detail.agents:
        assert ids.dtype == np.uint32
        assert (np.diff(ids.astype(int)) > 0).all()
        found[ids] += 1
    # Each in one level at most; float32 may differ within a millimetre of the border.
    assert found.max(initial=0) <= 1
    assert (found[present & (margin > 1e-3)] == 1).all()
    assert (found[margin < -1e-3] == 0).all()
    assert (found[~present] == 0).all()


@settings(max_examples=30, deadline=None)
@given(yaw=ANGLES, pitch=st.floats(-1.5, 1.5), fov=st.floats(0.2, 2.0), seed=st.integers(0, 2**32))
def test_groups_that_are_left_out_by_their_boxes_have_nobody_in_view(
    yaw: float, pitch: float, fov: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    placement = _placement(rng, 1100, 1.0)
    # Neighbours sit together, as in a section.
    placement.position += np.repeat(rng.uniform(-40, 40, (3, 22)), 50, axis=1).astype(np.float32)
    present = rng.random(1100) < 0.8
    view = _camera(rng.uniform(-30, 30, 3), yaw, pitch, fov)
    detail = Detail()
    bounds = Bounds.of(placement)
    select_detail(detail, placement, present, HEIGHT, view, levels=False, bounds=bounds)
    margin = _margin(view, placement, HEIGHT)
    found = np.zeros(1100, bool)
    found[detail.agents[0]] = True
    assert (np.diff(detail.agents[0].astype(int)) > 0).all()
    assert found[present & (margin > 1e-3)].all()
    assert not found[margin < -1e-3].any()
    assert not found[~present].any()


@settings(max_examples=30, deadline=None)
@given(yaw=ANGLES, fov=st.floats(0.2, 1.5), seed=st.integers(0, 2**32))
def test_levels_follow_from_pixel_heights(yaw: float, fov: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    placement = _placement(rng, 80, 60.0)
    view = _camera(np.zeros(3), yaw, 0.1, fov)
    detail = Detail()
    select_detail(detail, placement, np.ones(80, bool), HEIGHT, view, levels=True)
    for level, ids in zip(Level, detail.agents, strict=True):
        for agent in ids:
            place = np.append(placement.position[:, agent].astype(float), 1.0)
            depth = max(float(-(view.view[2].astype(float) @ place)), 0.1)
            pixels = HEIGHT * placement.scale[agent] / depth / np.tan(fov / 2) * 360.0
            expected = sum(pixels < limit for limit in MESH_PIXELS)
            near_limit = any(abs(pixels / limit - 1) < 1e-4 for limit in MESH_PIXELS)
            assert near_limit or expected == level


def test_the_worked_example_of_pixel_heights() -> None:
    view = _camera(np.zeros(3), 0.0, 0.0, np.pi / 3)
    pixels = pixel_heights(np.ones(1, np.float32), 1.75, view, np.array([20.0], np.float32))
    assert pixels[0] == pytest.approx(54.56, abs=0.01)
    assert pixels.dtype == np.float32


def _level(depth: float) -> int:
    """Level of an agent at some metres before a camera that makes 1 m at 1 m 1000 pixels tall."""
    view = _camera(np.array([0.0, 1.0, 0.0]), 0.0, 0.0, 2 * np.arctan(0.36), 720)
    placement = Placement(
        np.array([[0.0], [0.0], [-depth]], np.float32), np.zeros(1, np.float32), np.ones(1, "f4")
    )
    detail = Detail()
    select_detail(detail, placement, np.ones(1, bool), 1.0, view, levels=True)
    counts = [len(ids) for ids in detail.agents]
    assert sum(counts) == 1
    return counts.index(1)


def test_each_level_begins_at_its_height_in_pixels() -> None:
    assert MESH_PIXELS == (110.0, 42.0, 17.0)
    for level, limit in enumerate(MESH_PIXELS):
        assert _level(1000.0 / (limit * 1.01)) == level
        assert _level(1000.0 / (limit * 0.99)) == level + 1


def test_without_levels_everyone_in_view_is_near() -> None:
    view = _camera(np.array([0.0, 1.0, 0.0]), 0.0, 0.0, 1.0)
    placement = Placement(
        np.array([[0, 0, 0, 0], [0, 0, 0, 0], [-3, -200, -4000, 5]], np.float32),
        np.zeros(4, np.float32),
        np.ones(4, np.float32),
    )
    detail = Detail()
    select_detail(detail, placement, np.ones(4, bool), HEIGHT, view, levels=False)
    assert [ids.tolist() for ids in detail.agents] == [[0, 1, 2], [], [], []]
    select_detail(detail, placement, np.ones(4, bool), HEIGHT, view, levels=True)
    assert [ids.tolist() for ids in detail.agents] == [[0], [], [], [1, 2]]


def test_planes_are_unit_normals_that_point_inside() -> None:
    view = _camera(np.array([3.0, 2.0, 1.0]), 0.4, -0.2, 1.0)
    planes = frustum_planes(view.projection @ view.view)
    assert planes.shape == (5, 4)
    np.testing.assert_allclose(np.linalg.norm(planes[:, :3], axis=1), 1.0, atol=1e-6)
    ahead = view.eye - 10.0 * view.view[2, :3]
    assert (planes[:, :3] @ ahead + planes[:, 3] > 0).all()
    # The near plane is 0.1 m before the eye, the others go through it.
    distance = planes[:, :3] @ view.eye + planes[:, 3]
    np.testing.assert_allclose(distance, [0, 0, 0, 0, -0.1], atol=1e-5)


def test_a_small_character_in_large_units_is_culled_where_it_stands() -> None:
    # 175 units tall at scale 0.01: 1.75 m. Seen from above, its middle is at 0.875 m.
    view = _camera(np.array([0.0, 30.0, 0.0]), 0.0, -np.pi / 2, 0.4)
    placement = Placement(np.zeros((3, 1), "f4"), np.zeros(1, "f4"), np.full(1, 0.01, "f4"))
    detail = Detail()
    select_detail(detail, placement, np.ones(1, bool), 175.0, view, levels=True)
    assert sum(len(ids) for ids in detail.agents) == 1


def test_coarseness_draws_as_if_everyone_were_smaller() -> None:
    rng = np.random.default_rng(4)
    placement = _placement(rng, 300, 40.0)
    few, many = (_camera(np.zeros(3), 0.0, 0.0, 1.0, pixels) for pixels in (360, 720))
    coarse, small = Detail(), Detail()
    present = np.ones(300, bool)
    select_detail(coarse, placement, present, HEIGHT, many, levels=True, coarseness=2.0)
    # Half as many pixels high, everyone is half as tall.
    select_detail(small, placement, present, HEIGHT, few, levels=True)
    assert sum(len(ids) > 0 for ids in coarse.agents) >= 2
    for found, expected in zip(coarse.agents, small.agents, strict=True):
        np.testing.assert_array_equal(found, expected)
