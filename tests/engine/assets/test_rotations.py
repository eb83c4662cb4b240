from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

from tifo.engine.assets.rotations import angle_between, from_euler, multiply, slerp

ANGLES = arrays(np.float64, (3,), elements=st.floats(-720, 720))


def test_from_euler_of_one_axis_is_the_half_angle_quaternion() -> None:
    quarter = from_euler((1,), np.array([np.pi / 2]))
    np.testing.assert_allclose(quarter, [0, np.sqrt(0.5), 0, np.sqrt(0.5)], atol=1e-15)


def test_from_euler_with_no_axes_is_the_identity() -> None:
    np.testing.assert_array_equal(
        from_euler((), np.zeros((2, 0))), [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]]
    )


@pytest.mark.parametrize("order", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"])
@given(angles=ANGLES)
def test_from_euler_agrees_with_scipy(order: str, angles: np.ndarray) -> None:
    ours = from_euler(["XYZ".index(axis) for axis in order], np.radians(angles))
    theirs = Rotation.from_euler(order, angles, degrees=True).as_quat()
    assert angle_between(ours, theirs) < 1e-6


def test_multiply_applies_the_second_factor_first() -> None:
    # X to Z about Y, then Y to Z about X: X goes to -Z and from there to Y.
    about_y = from_euler((1,), np.array([np.pi / 2]))
    about_x = from_euler((0,), np.array([np.pi / 2]))
    both = multiply(about_x, about_y)
    conjugate = both * [-1, -1, -1, 1]
    turned = multiply(multiply(both, np.array([1.0, 0.0, 0.0, 0.0])), conjugate)
    np.testing.assert_allclose(turned[:3], [0, 1, 0], atol=1e-15)


def test_angle_between_ignores_the_sign_and_is_exact_for_tiny_turns() -> None:
    tiny = from_euler((2,), np.array([1e-9]))
    identity = np.array([0.0, 0.0, 0.0, 1.0])
    assert angle_between(identity, tiny) == pytest.approx(1e-9, rel=1e-6)
    assert angle_between(identity, -tiny) == pytest.approx(1e-9, rel=1e-6)
    half_turn = from_euler((0,), np.array([np.pi]))
    assert angle_between(identity, half_turn) == pytest.approx(np.pi)


def test_slerp_divides_the_shortest_arc_evenly() -> None:
    start = from_euler((1,), np.array([0.2]))
    stop = from_euler((1,), np.array([1.1]))
    third = from_euler((1,), np.array([0.5]))
    assert angle_between(slerp(start, stop, 1 / 3), third) < 1e-12
    assert angle_between(slerp(start, -stop, 1 / 3), third) < 1e-12
    np.testing.assert_array_equal(slerp(start, stop, 0.0), start)
    np.testing.assert_allclose(slerp(start, start, 0.3), start, atol=1e-15)
