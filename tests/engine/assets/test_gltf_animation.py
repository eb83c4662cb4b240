"""Evaluation of glTF channels and resampling, against hand-computed numbers and SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from tifo.engine.animation.skeleton import Skeleton
from tifo.engine.assets.gltf_animation import Track, key_rate, resample, slerp
from tifo.engine.assets.gltf_transforms import (
    Transforms,
    decompose,
    is_invertible,
    model_positions,
    quaternion_of,
    rotation_matrices,
)

HALF = np.sqrt(0.5)


def track(path, interpolation, times, values, joints=(0,)):
    return Track(
        path, interpolation, np.array(times, float), np.array(values, float), np.array(joints)
    )


def test_step_holds_until_the_next_key_and_at_both_ends():
    step = track("translation", "STEP", [1, 2], [[[1, 0, 0]], [[5, 0, 0]]])
    values = step.evaluate(np.array([0.0, 1.0, 1.999, 2.0, 9.0]))[:, 0, 0]
    assert values.tolist() == [1, 1, 1, 5, 5]


def test_linear_mixes_and_clamps():
    line = track("scale", "LINEAR", [1, 3, 4], [[[1, 0, 2]], [[5, 0, 2]], [[9, 0, 2]]])
    values = line.evaluate(np.array([0.0, 1.5, 3.0, 3.25, 7.0]))[:, 0, 0]
    assert values.tolist() == [1, 2, 5, 6, 9]


def test_linear_rotation_turns_at_constant_speed():
    quarter = [0, HALF, 0, HALF]
    turn = track("rotation", "LINEAR", [0, 1], [[[0, 0, 0, 1]], [quarter]])
    got = turn.evaluate(np.array([1 / 3]))[0, 0]
    assert got == pytest.approx([0, np.sin(np.pi / 12), 0, np.cos(np.pi / 12)], abs=1e-15)


def test_linear_rotation_takes_the_shorter_arc():
    turn = track("rotation", "LINEAR", [0, 1], [[[0, 0, 0, 1]], [[0, -HALF, 0, -HALF]]])
    got = turn.evaluate(np.array([0.5]))[0, 0]
    assert got == pytest.approx([0, np.sin(np.pi / 8), 0, np.cos(np.pi / 8)], abs=1e-15)


def test_cubic_spline_has_the_hand_computed_values():
    # In-tangent, value, out-tangent; from 0 leaving at 1 a second to 2 arriving at -1 a second.
    keys = [[[[9, 9, 9]], [[0, 0, 0]], [[1, 1, 1]]], [[[-1, -1, -1]], [[2, 2, 2]], [[9, 9, 9]]]]
    one = track("translation", "CUBICSPLINE", [0, 1], keys)
    two = track("translation", "CUBICSPLINE", [0, 2], keys)
    assert one.evaluate(np.array([0, 0.5, 1.0]))[:, 0, 0] == pytest.approx([0, 1.25, 2])
    assert two.evaluate(np.array([1.0]))[0, 0, 0] == pytest.approx(1.5)
    # u = 1/4: 0.140625 * 1 + 0.15625 * 2 + -0.046875 * -1
    assert one.evaluate(np.array([0.25]))[0, 0, 0] == pytest.approx(0.5)


def test_cubic_spline_rotation_is_normalised():
    keys = np.zeros((2, 3, 1, 4))
    keys[0, 1, 0] = (0, 0, 0, 1)
    keys[1, 1, 0] = (0, 1, 0, 0)
    spline = track("rotation", "CUBICSPLINE", [0, 1], keys)
    assert spline.evaluate(np.array([0.5]))[0, 0] == pytest.approx([0, HALF, 0, HALF])
    opposite = keys.copy()
    opposite[1, 1, 0] = (0, 0, 0, -1)
    through_zero = track("rotation", "CUBICSPLINE", [0, 1], opposite)
    assert through_zero.evaluate(np.array([0.5]))[0, 0].tolist() == [0, 0, 0, 1]


@pytest.mark.parametrize("interpolation", ["STEP", "LINEAR", "CUBICSPLINE"])
def test_a_single_key_holds(interpolation):
    shape = (1, 3, 2, 3) if interpolation == "CUBICSPLINE" else (1, 2, 3)
    one = track("translation", interpolation, [0.5], np.full(shape, 7.0), (0, 1))
    assert (one.evaluate(np.array([0.0, 0.5, 3.0])) == 7).all()


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), u=st.floats(0, 1), spread=st.sampled_from([1e-9, 1e-4, 1.0]))
def test_slerp_agrees_with_scipy(seed, u, spread):
    rng = np.random.default_rng(seed)
    start = Rotation.random(random_state=rng)
    stop = start * Rotation.from_rotvec(rng.normal(size=3) * spread)
    expected = Slerp([0, 1], Rotation.concatenate([start, stop]))(u)
    got = slerp(start.as_quat(), -stop.as_quat(), np.array([u]))
    assert np.linalg.norm(got) == pytest.approx(1, abs=1e-14)
    assert (Rotation.from_quat(got) * expected.inv()).magnitude() < 1e-12


@pytest.mark.parametrize(
    ("times", "rate"),
    [
        (np.arange(25) / 24, 72),
        (np.arange(31) / 30, 60),
        (np.arange(26) / 25, 75),
        (np.arange(101) / 100, 100),
        (np.arange(241) / 240, 60),
        ([0, 0.3, 1.0], 60),
        ([0, 2.0], 60),
        ([0.5], 60),
        (np.float32(np.arange(200) / np.float32(24)) + 1, 72),
    ],
)
def test_key_rate_meets_the_keys_of_the_file(times, rate):
    line = track("translation", "LINEAR", times, np.zeros((len(times), 1, 3)))
    assert key_rate([line]) == pytest.approx(rate, rel=1e-5)


def arm(count=2):
    """A chain of joints, each 1 m along x from the one before."""
    translation = np.tile((1.0, 0.0, 0.0), (count, 1))
    rest = Transforms(np.tile((0.0, 0, 0, 1), (count, 1)), translation, np.ones((count, 3)))
    skeleton = Skeleton(
        tuple(f"joint {k}" for k in range(count)),
        np.arange(-1, count - 1, dtype=np.int32),
        *(part.astype(np.float32) for part in rest),
        np.repeat(np.eye(3, 4, dtype=np.float32)[None], count, axis=0),
    )
    return skeleton, rest


def test_resampling_reports_what_it_cuts_off():
    skeleton, rest = arm()
    # A spike at 5 ms between two keys of 60 Hz; half way, at 1/120 s, the file is at 5/7 m.
    values = np.zeros((3, 1, 3))
    values[1, 0, 0] = 1.0
    spike = track("translation", "LINEAR", [0, 0.005, 1 / 60], values)
    clip = resample("spike", [spike], skeleton, rest)
    assert clip.frame_count == 2
    assert clip.resampling_error == pytest.approx(5 / 7, abs=1e-6)


def test_resampling_uniform_keys_changes_nothing():
    skeleton, rest = arm()
    times = 0.25 + np.arange(25) / 24
    values = np.random.default_rng(1).normal(size=(25, 1, 3))
    clip = resample("noise", [track("translation", "LINEAR", times, values, (1,))], skeleton, rest)
    assert clip.duration == pytest.approx(1.0)
    assert clip.frame_count == 73
    assert clip.resampling_error < 1e-6
    np.testing.assert_allclose(clip.translation[::3, 1], values[:, 0], atol=1e-6)
    assert (clip.translation[:, 0] == (1, 0, 0)).all()


def test_resampling_error_of_a_turning_arm_is_that_of_the_chord():
    skeleton, rest = arm(3)
    # 50 turns a second: nlerp between keys 1/60 s apart goes the short way round.
    turn = track(
        "rotation",
        "LINEAR",
        np.arange(31) / 30,
        [[Rotation.from_euler("z", 170 * k, degrees=True).as_quat()] for k in range(31)],
    )
    clip = resample("turn", [turn], skeleton, rest)
    # 85 degrees between keys; half way nlerp and slerp agree, so the joints 1 and 2 m out do too.
    assert clip.resampling_error < 1e-6
    dots = np.einsum("fjk,fjk->fj", clip.rotation[1:], clip.rotation[:-1])
    assert dots.min() > 0


def test_long_clips_are_evaluated_in_chunks_without_seams():
    skeleton, rest = arm()
    line = track("translation", "LINEAR", [0, 30], [[[0, 0, 0]], [[30, 0, 0]]])
    clip = resample("long", [line], skeleton, rest)
    assert clip.frame_count == 1801
    np.testing.assert_allclose(clip.translation[:, 0, 0], np.linspace(0, 30, 1801), atol=1e-5)
    assert clip.resampling_error < 1e-5
    # A spike of 1 m between the last key of the first chunk and the first of the second.
    times = np.array([0, 511.3, 511.5, 511.7, 900]) / 60
    spike = track("translation", "LINEAR", times, np.eye(5)[2][:, None, None] * np.ones(3))
    assert resample("spike", [spike], skeleton, rest).resampling_error > 1


@settings(max_examples=50, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), flips=st.integers(0, 7))
def test_decompose_undoes_matrices(seed, flips):
    rng = np.random.default_rng(seed)
    signs = [-1 if flips >> k & 1 else 1 for k in range(3)]
    local = Transforms(
        Rotation.random(random_state=rng).as_quat(),
        rng.normal(size=3),
        rng.uniform(0.01, 9, 3) * signs,
    )
    again, missed = decompose(local.matrices())
    assert missed < 1e-9
    np.testing.assert_allclose(again.matrices(), local.matrices(), atol=1e-9)


def test_decompose_says_when_a_matrix_has_shear_and_survives_zero_scale():
    sheared = np.eye(4)
    sheared[0, 1] = 0.5
    assert decompose(sheared)[1] > 0.05
    for zeros in ((0, 1, 1), (0, 0, 3), (0, 0, 0)):
        flat, missed = decompose(np.diag([*map(float, zeros), 1.0]))
        assert missed < 1e-12
        assert np.linalg.norm(flat.rotation) == pytest.approx(1)
        np.testing.assert_allclose(flat.matrices()[:3, :3], np.diag(zeros), atol=1e-12)
        assert not is_invertible(flat.matrices())


@settings(max_examples=50, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_quaternions_and_matrices_agree_with_scipy(seed):
    turn = Rotation.random(random_state=np.random.default_rng(seed))
    np.testing.assert_allclose(rotation_matrices(turn.as_quat()), turn.as_matrix(), atol=1e-13)
    assert (Rotation.from_quat(quaternion_of(turn.as_matrix())) * turn.inv()).magnitude() < 1e-12


def test_model_positions_of_a_bent_and_scaled_arm():
    skeleton, rest = arm(3)
    local = Transforms(*(part[None].copy() for part in rest))
    local.rotation[0, 0] = (0, 0, HALF, HALF)  # 90 degrees about z: x becomes y
    local.scale[0, 1] = (3, 1, 1)
    positions = model_positions(local, skeleton.parents, skeleton.levels)
    np.testing.assert_allclose(positions[0], [[1, 0, 0], [1, 1, 0], [1, 4, 0]], atol=1e-12)
