"""Ball, Player and Camera: movements and matrices by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tifo import Ball, Camera, FreeCamera, Node3D, Player, SceneTree, Stadium, Vector3


def test_a_ball_flies_where_it_is_kicked(tree: SceneTree) -> None:
    ball = tree.root.add_child(Ball(position=Vector3(0.0, 0.11, 0.0), bounce=0.0))
    bounced: list[Vector3] = []
    ball.bounced.connect(bounced.append)
    ball.kick_to((12.0, 4.0, -3.0), 1.5)
    tree.run(0.75)
    # Half-way in time: half of the way, and g t^2 / 8 above the chord.
    assert ball.position == pytest.approx((6.0, 2.055 + 9.81 * 1.5**2 / 8, -1.5), abs=1e-6)
    tree.run(0.75)
    assert ball.position == pytest.approx((12.0, 4.0, -3.0), abs=1e-6)
    tree.run(2.0)
    assert len(bounced) == 1
    assert ball.position.y == ball.radius
    with pytest.raises(ValueError, match="expected more than 0"):
        ball.kick_to((0, 0, 0), 0.0)


def test_a_ball_bounces_and_rolls_to_a_stop(tree: SceneTree) -> None:
    ball = tree.root.add_child(Ball(position=Vector3(0.0, 5.11, 0.0), bounce=0.5, friction=2.0))
    heights: list[float] = []
    stopped: list[Vector3] = []
    ball.stopped.connect(lambda: stopped.append(ball.position))
    for _ in range(600):
        tree.advance(1 / 60)
        heights.append(ball.position.y)
    first = int(np.argmin(heights[:70]))
    assert first / 60 == pytest.approx(math.sqrt(2 * 5 / 9.81), abs=0.05)
    assert max(heights[first:]) - 0.11 == pytest.approx(5 * 0.25, abs=0.15)
    assert len(stopped) == 1
    ball.kick((4.0, 0.0, 0.0))
    tree.run(4.0)
    assert ball.position.x == pytest.approx(4.0**2 / (2 * 2.0), abs=0.1), "v^2 / 2a"
    assert len(stopped) == 2


def test_a_player_runs_and_faces_where_it_runs(tree: SceneTree) -> None:
    player = tree.root.add_child(Player(speed=5.0))
    arrived: list[int] = []
    player.arrived.connect(lambda: arrived.append(tree.tick))
    player.go_to((3.0, 0.0, 4.0))
    assert player.velocity == pytest.approx((3.0, 0.0, 4.0))
    tree.run(0.5)
    assert player.position == pytest.approx((1.5, 0.0, 2.0))
    assert player.forward == pytest.approx((0.6, 0.0, 0.8))
    tree.run(1.0)
    assert arrived == [60]
    assert player.position == Vector3(3.0, 0.0, 4.0)
    assert (player.target, player.velocity) == (None, Vector3())


def test_a_camera_sees_what_a_free_camera_sees(tree: SceneTree) -> None:
    node = tree.root.add_child(Camera(fov=50.0))
    node.look_from((3.0, 4.0, 20.0), (1.0, 2.0, 0.0))
    free = FreeCamera.looking((3.0, 4.0, 20.0), (1.0, 2.0, 0.0))
    free.fov = math.radians(50.0)
    np.testing.assert_allclose(node.view(), free.view(), atol=1e-5)
    lens = node.projection((640, 360))
    np.testing.assert_allclose(lens[:2], free.projection((640, 360))[:2], atol=1e-6)
    for size, (x, y) in (((640, 360), (10, 300)), ((100, 200), (99, 0))):
        for own, other in zip(node.ray(x, y, size), free.ray(x, y, size), strict=True):
            np.testing.assert_allclose(own, other, atol=1e-6)
    for move, numbers in (
        ("drag", (30, -20)),
        ("pan", (10, 5)),
        ("zoom", (2,)),
        ("fly", (1, 2, 3)),
    ):
        getattr(node, move)(*numbers)
        getattr(free, move)(*numbers)
        np.testing.assert_allclose(node.view(), free.view(), atol=1e-4, err_msg=move)


def test_a_camera_below_a_moving_parent_sees_from_there(tree: SceneTree) -> None:
    crane = tree.root.add_child(Node3D(position=Vector3(0.0, 10.0, 0.0)))
    camera = crane.add_child(Camera())
    before = camera.view() @ (0.0, 10.0, 5.0, 1.0)
    np.testing.assert_allclose(before, (0.0, 0.0, -5.0, 1.0), atol=1e-6)
    crane.position = Vector3(1.0, 10.0, 0.0)
    # The picture's right is -X for a camera that looks along +Z.
    after = camera.view() @ (0.0, 10.0, 5.0, 1.0)
    np.testing.assert_allclose(after, (1.0, 0.0, -5.0, 1.0), atol=1e-6)


def test_a_camera_follows_a_node(tree: SceneTree) -> None:
    ball = tree.root.add_child(Node3D(position=Vector3(5.0, 1.0, 5.0)))
    camera = tree.root.add_child(Camera(position=Vector3(0.0, 1.0, 0.0), follows=ball))
    tree.advance(0.0)
    assert camera.forward == pytest.approx((math.sqrt(0.5), 0.0, math.sqrt(0.5)))
    ball.free()
    tree.advance(0.0)


def test_a_camera_goes_to_its_preset(tree: SceneTree, stadium: Stadium) -> None:
    import tifo

    eye, target = tifo.camera_presets(stadium.simulation.plan)["tv"]
    stadium.position = Vector3(10.0, 0.0, 0.0)
    camera = tree.root.add_child(Camera(preset="tv"))
    assert camera.global_position == pytest.approx((eye[0] + 10.0, *eye[1:]))
    way = Vector3.of(target) - Vector3.of(eye)
    assert camera.forward == pytest.approx(way.normalized(), abs=1e-6)
    camera.preset = "close"
    near = tifo.camera_presets(stadium.simulation.plan)["close"][0]
    assert camera.global_position == pytest.approx((near[0] + 10.0, *near[1:]))
    assert near != eye
