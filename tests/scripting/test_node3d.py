"""Places in space, against matrices and rotations made in other ways."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tifo import Node, Node3D, Quaternion, SceneTree, Vector3

number = st.floats(-5.0, 5.0)
vector = st.tuples(number, number, number)
angle = st.floats(-3.1, 3.1)
angles = st.tuples(angle, angle, angle)
scales = st.tuples(*[st.floats(0.2, 3.0)] * 3)


def close(a: object, b: object) -> bool:
    return bool(np.allclose(np.asarray(a), np.asarray(b), atol=1e-9))


def same(a: Quaternion, b: Quaternion) -> bool:
    """The same rotation, whatever the sign."""
    return abs(abs(float(np.dot(a, b))) - 1.0) < 1e-9


def test_vectors_by_hand() -> None:
    a, b = Vector3(1, 2, 3), Vector3(4, 5, 6)
    assert a + b == (5, 7, 9)
    assert b - a == (3, 3, 3)
    assert a * 2 == 2 * a == (2, 4, 6)
    assert a * b == (4, 10, 18)
    assert b / 2 == (2, 2.5, 3)
    assert -a == (-1, -2, -3)
    assert sum([a, b], Vector3()) == (5, 7, 9)
    assert (a.dot(b), a.cross(b)) == (32, (-3, 6, -3))
    assert Vector3(3, 4, 0).length() == 5.0
    assert Vector3(0, 0, 9).normalized() == (0, 0, 1)
    assert Vector3().normalized() == (0, 0, 0)
    assert a.lerp(b, 0.5) == (2.5, 3.5, 4.5)
    assert Vector3(1, 1, 1).distance_to(Vector3(1, 1, 3)) == 2.0
    with pytest.raises(AttributeError):
        a.x = 3  # type: ignore[misc]
    for wrong in ((1, 2), "abc", None, (1, 2, float("nan"))):
        with pytest.raises(ValueError, match="expected 3 finite numbers"):
            Vector3.of(wrong)


@given(angles, angles, vector)
def test_rotations_are_those_of_scipy(
    a: tuple[float, ...], b: tuple[float, ...], v: object
) -> None:
    def other(euler: tuple[float, ...]) -> Rotation:
        x, y, z = euler
        return Rotation.from_euler("YXZ", (y, x, z))

    p, q = Quaternion.from_euler(a), Quaternion.from_euler(b)
    assert same(p, Quaternion.of(other(a).as_quat()))
    assert same(p * q, Quaternion.of((other(a) * other(b)).as_quat()))
    assert close(p * Vector3.of(v), other(a).apply(v))
    assert same(p * p.inverse(), Quaternion())
    assert same(Quaternion.from_euler(p.to_euler()), p)


@given(angles, angles, st.floats(0.0, 1.0))
def test_slerp_turns_at_constant_speed(a: object, b: object, weight: float) -> None:
    p, q = Quaternion.from_euler(a), Quaternion.from_euler(b)
    whole = (p.inverse() * q).w
    part = (p.inverse() * p.slerp(q, weight)).w
    # Near half turns and none the arc cosine loses half its digits.
    assert math.acos(min(abs(part), 1.0)) == pytest.approx(
        weight * math.acos(min(abs(whole), 1.0)), abs=1e-6
    )


def test_looking_straight_up() -> None:
    for sign in (-1, 1):
        q = Quaternion.from_euler((sign * math.pi / 2, 0.3, 0.2))
        assert same(Quaternion.from_euler(q.to_euler()), q)


@settings(max_examples=30)
@given(st.lists(st.tuples(vector, angles, scales), min_size=1, max_size=4), vector)
def test_global_transforms_are_products(parts: list[tuple[object, ...]], point: object) -> None:
    matrix = np.eye(4)
    node: Node = Node()
    for place, turn, scale in parts:
        rotation = Quaternion.from_euler(turn)
        local = np.eye(4)
        local[:3, :3] = Rotation.from_quat(rotation).as_matrix() @ np.diag(scale)
        local[:3, 3] = place
        matrix = matrix @ local
        made = Node3D(position=Vector3.of(place), rotation=rotation, scale=Vector3.of(scale))
        node = node.add_child(made)
    assert isinstance(node, Node3D)
    assert close(node.global_transform, matrix)
    assert close(node.to_global(point), (matrix @ (*point, 1.0))[:3])  # type: ignore[misc]
    assert np.allclose(node.to_local(node.to_global(point)), point, atol=1e-6)  # type: ignore[arg-type]
    node.global_position = Vector3(1, 2, 3)
    assert np.allclose(node.global_transform[:3, 3], (1, 2, 3), atol=1e-6)


def test_changes_above_are_seen_below() -> None:
    a, b, c = Node3D(), Node3D(), Node3D()
    a.add_child(b).add_child(c)
    c.position = Vector3(0, 0, 1)
    assert c.global_position == (0, 0, 1)
    a.position += Vector3(5, 0, 0)
    assert c.global_position == (5, 0, 1)
    b.rotate((0, 1, 0), math.pi / 2)
    assert close(c.global_position, (6, 0, 0))
    a.scale = Vector3(2, 2, 2)
    assert close(c.global_position, (7, 0, 0))
    b.top_level = True
    assert close(c.global_position, (1, 0, 0))
    b.top_level = False
    a.remove_child(b)
    assert close(c.global_position, (1, 0, 0))
    b.add_child(Node()).add_child(d := Node3D(position=Vector3(1, 1, 1)))
    assert d.global_position == (1, 1, 1)  # the plain node between interrupts the chain


def test_reparenting_keeps_the_place(tree: SceneTree) -> None:
    a = tree.root.add_child(Node3D(name="a", position=Vector3(1, 2, 3), scale=Vector3(2, 2, 2)))
    b = tree.root.add_child(Node3D(name="b", rotation=Quaternion.from_euler((0.1, 0.7, 0.2))))
    child = a.add_child(
        Node3D(position=Vector3(0, 1, 0), rotation=Quaternion.from_euler((1, 2, 3)))
    )
    before = child.global_transform
    child.reparent(b)
    assert close(child.global_transform, before)
    child.reparent(a, keep_global_transform=False)
    assert not close(child.global_transform, before)


def test_look_at_turns_plus_z_there() -> None:
    parent = Node3D(position=Vector3(1, 0, 0), rotation=Quaternion.from_euler((0.3, 0.2, 0.1)))
    node = parent.add_child(Node3D(position=Vector3(0, 1, 2), scale=Vector3(2, 3, 4)))
    target = Vector3(5, 6, 7)
    node.look_at(target)
    assert close(node.forward, (target - node.global_position).normalized())
    assert node.global_transform[1, 1] > 0
    assert abs(node.global_transform[1, 0]) < 1e-9  # its +X stays level
    assert close(node.scale, (2, 3, 4))
    for wrong in (node.global_position, node.global_position + Vector3(0, 4, 0)):
        with pytest.raises(ValueError, match="lies here or along up"):
            node.look_at(wrong)


def test_translate_goes_along_its_own_axes() -> None:
    node = Node3D(rotation=Quaternion.from_axis_angle((0, 1, 0), math.pi / 2))
    node.translate((0, 0, 2))
    assert close(node.position, (2, 0, 0))
    with pytest.raises(ValueError, match="expected \\(4, 4\\)"):
        node.global_transform = np.eye(3)
    with pytest.raises(ValueError, match="squeezes an axis"):
        node.global_transform = np.diag([1.0, 0.0, 1.0, 1.0])


def test_mirrored_transforms_are_taken_apart() -> None:
    node = Node3D()
    matrix = np.diag([1.0, 1.0, -2.0, 1.0])
    node.global_transform = matrix
    assert close(node.global_transform, matrix)
