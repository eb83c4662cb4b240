"""The free camera: matrices by hand, and what its movements keep."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tifo.scripting.camera import CameraMode, FreeCamera, look_at, perspective

SIZE = (640, 360)
COORDINATE = st.floats(-100, 100)
POINT = st.tuples(COORDINATE, COORDINATE, COORDINATE)
PIXELS = st.floats(-300, 300)


def _camera(**changes: Any) -> FreeCamera:
    """At (0, 2, 10), looking at (0, 2, 0)."""
    camera = FreeCamera.looking((0.0, 2.0, 10.0), (0.0, 2.0, 0.0))
    for name, value in changes.items():
        setattr(camera, name, value)
    return camera


def _pixel(camera: FreeCamera, point: Any) -> tuple[float, float]:
    """Where a point is in the picture, from the left and the bottom."""
    matrix = camera.projection(SIZE).astype(float) @ camera.view().astype(float)
    x, y, _, w = matrix @ [*point, 1.0]
    return (x / w + 1) / 2 * SIZE[0], (y / w + 1) / 2 * SIZE[1]


def test_look_at_by_hand() -> None:
    # From (10, 0, 0) to the origin: right is -Z, and the origin is 10 m down the camera's -Z.
    matrix = look_at(np.array([10.0, 0.0, 0.0]), np.zeros(3))
    expected = [[0, 0, -1, 0], [0, 1, 0, 0], [1, 0, 0, -10], [0, 0, 0, 1]]
    np.testing.assert_allclose(matrix, np.array(expected), atol=1e-7)
    assert matrix.dtype == np.float32


@given(POINT, POINT)
def test_look_at_is_rigid_and_puts_the_target_ahead(start: Any, end: Any) -> None:
    eye, target = np.array(start), np.array(end)
    matrix = look_at(eye, target).astype(float)
    rotation = matrix[:3, :3]
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-5)
    assert np.linalg.det(rotation) == pytest.approx(1.0, abs=1e-5)
    np.testing.assert_allclose(matrix @ np.append(eye, 1.0), [0, 0, 0, 1], atol=1e-3)
    distance = float(np.linalg.norm(target - eye))
    if distance > 1e-6:
        np.testing.assert_allclose(matrix @ np.append(target, 1.0), [0, 0, -distance, 1], atol=1e-3)


def test_perspective_by_hand() -> None:
    matrix = perspective(math.radians(90.0), 2.0, 1.0, 3.0)
    expected = [[0.5, 0, 0, 0], [0, 1, 0, 0], [0, 0, -2, -3], [0, 0, -1, 0]]
    np.testing.assert_allclose(matrix, np.array(expected), atol=1e-6)
    for z, depth in ((-1.0, -1.0), (-3.0, 1.0)):
        clip = matrix @ np.array([0, 0, z, 1])
        assert clip[2] / clip[3] == pytest.approx(depth)


@given(POINT, POINT)
def test_looking_looks_at_the_target(eye: Any, target: Any) -> None:
    camera = FreeCamera.looking(eye, target)
    if camera.distance > 0.01:
        np.testing.assert_allclose(camera.target, target, atol=1e-6)
    np.testing.assert_array_equal(camera.eye, eye)


def test_yaw_and_pitch_follow_the_conventions() -> None:
    np.testing.assert_allclose(_camera(yaw=0.0).forward, [0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(_camera(yaw=math.pi / 2).forward, [1, 0, 0], atol=1e-12)
    up = _camera(yaw=0.0, pitch=math.radians(30.0)).forward
    np.testing.assert_allclose(up, [0, 0.5, math.sqrt(0.75)], atol=1e-12)


@given(st.lists(st.tuples(PIXELS, PIXELS), max_size=8))
def test_orbiting_keeps_the_target_and_the_distance(drags: list[tuple[float, float]]) -> None:
    camera = _camera()
    for dx, dy in drags:
        camera.drag(dx, dy)
        np.testing.assert_allclose(camera.target, [0, 2, 0], atol=1e-9)
        assert np.linalg.norm(camera.eye - [0, 2, 0]) == pytest.approx(10.0)
        assert abs(camera.pitch) <= math.radians(89.0) + 1e-12
        assert abs(camera.yaw) <= math.pi + 1e-12


def test_flying_turns_on_the_spot() -> None:
    camera = _camera(mode=CameraMode.FLY)
    camera.drag(100.0, 50.0)
    np.testing.assert_array_equal(camera.eye, [0, 2, 10])
    assert camera.pitch == pytest.approx(0.2)
    # It looked along -Z (yaw pi); 0.4 rad to the right of that is towards +X.
    assert camera.forward[0] == pytest.approx(math.sin(0.4) * math.cos(0.2))


def test_dragging_right_while_orbiting_turns_the_scene_right() -> None:
    camera = _camera()
    before = _pixel(camera, (0.0, 2.0, 1.0))[0]
    camera.drag(20.0, 0.0)
    # A point before the target follows the hand: the camera goes the other way round.
    assert _pixel(camera, (0.0, 2.0, 1.0))[0] > before + 1.0
    assert _pixel(camera, (0.0, 2.0, 0.0)) == pytest.approx((320.0, 180.0), abs=1e-2)


def test_panning_moves_the_scene_with_the_hand() -> None:
    camera = _camera()
    camera.pan(100.0, -40.0)
    np.testing.assert_allclose(camera.eye, [-1.5, 2.6, 10.0], atol=1e-6)
    x, y = _pixel(camera, (0.0, 2.0, 0.0))
    assert x > 320.0
    assert y < 180.0


def test_zooming_goes_an_eighth_of_the_way() -> None:
    camera = _camera()
    camera.zoom(1)
    assert camera.distance == pytest.approx(8.75)
    np.testing.assert_allclose(camera.eye, [0, 2, 8.75], atol=1e-9)
    camera.zoom(-1)
    np.testing.assert_allclose(camera.eye, [0, 2, 10], atol=1e-9)
    np.testing.assert_allclose(camera.target, [0, 2, 0], atol=1e-9)


@pytest.mark.parametrize(("steps", "distance"), [(500, 0.5), (-500, 600.0)])
def test_zooming_has_limits(steps: float, distance: float) -> None:
    camera = _camera()
    camera.zoom(steps)
    assert camera.distance == distance
    np.testing.assert_allclose(camera.target, [0, 2, 0], atol=1e-9)


def test_flying_goes_along_its_own_axes() -> None:
    camera = _camera()
    camera.fly(1.0, 2.0, 3.0)
    np.testing.assert_allclose(camera.eye, [1, 4, 7], atol=1e-6)
    camera = _camera(pitch=math.radians(-30.0))
    camera.fly(0.0, 0.0, 2.0)
    np.testing.assert_allclose(camera.eye, [0, 1, 10 - math.sqrt(3)], atol=1e-6)


def test_it_stays_above_the_ground() -> None:
    camera = _camera()
    camera.keep_above(0.5)
    assert camera.eye[1] == 2.0
    camera.keep_above(2.5)
    assert camera.eye.tolist() == [0.0, 2.5, 10.0]


@given(POINT, POINT)
def test_the_ray_through_the_middle_is_the_way_it_looks(eye: Any, target: Any) -> None:
    camera = FreeCamera.looking(eye, target)
    origin, direction = camera.ray(319.5, 179.5, SIZE)
    np.testing.assert_array_equal(origin, camera.eye)
    np.testing.assert_allclose(direction, camera.forward, atol=1e-5)


@given(st.integers(0, SIZE[0] - 1), st.integers(0, SIZE[1] - 1), st.floats(1, 100))
def test_a_point_on_a_ray_is_drawn_at_its_pixel(x: int, y: int, metres: float) -> None:
    camera = FreeCamera.looking((3.0, 5.0, 20.0), (1.0, 0.0, -4.0))
    origin, direction = camera.ray(x, y, SIZE)
    assert np.linalg.norm(direction) == pytest.approx(1.0)
    found = _pixel(camera, origin + metres * direction)
    assert found == pytest.approx((x + 0.5, y + 0.5), abs=0.05)


def test_a_ray_does_not_hand_out_the_cameras_own_place() -> None:
    camera = _camera()
    origin, _ = camera.ray(0, 0, SIZE)
    origin += 5.0
    np.testing.assert_array_equal(camera.eye, [0, 2, 10])


def test_a_picture_without_pixels_still_has_a_projection() -> None:
    assert np.isfinite(_camera().projection((0, 0))).all()
