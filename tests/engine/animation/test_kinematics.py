"""Forward kinematics against one 4 x 4 matrix at a time in float64."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.engine.animation import Kinematics, Skeleton
from tifo.engine.animation.pose import pack_poses
from tifo.engine.animation.skeleton import breadth_first_order

Pose = tuple[NDArray[Any], NDArray[Any], NDArray[Any]]


@st.composite
def trees(draw: st.DrawFn, most_depth: int = 12) -> list[int]:
    """Parents of up to 24 joints, sorted by depth."""
    count = draw(st.integers(1, 24))
    parents: list[int] = []
    depth: list[int] = []
    for joint in range(count):
        allowed = [-1, *(k for k in range(joint) if depth[k] < most_depth - 1)]
        # Preferring the latest joint makes deep trees as likely as flat ones.
        pick = draw(st.one_of(st.just(allowed[-1]), st.sampled_from(allowed)))
        parents.append(pick)
        depth.append(0 if pick < 0 else depth[pick] + 1)
    order = breadth_first_order(parents)
    place = {int(old): new for new, old in enumerate(order)}
    return [-1 if parents[old] < 0 else place[parents[old]] for old in order]


def _quaternions(rng: np.random.Generator, *shape: int) -> NDArray[np.float64]:
    """Evenly spread rotations, unnormalised: lengths 0.3 to 3."""
    q = rng.normal(size=(*shape, 4))
    q /= np.linalg.norm(q, axis=-1, keepdims=True)
    return np.asarray(q * rng.uniform(0.3, 3.0, (*shape, 1)))


def _poses(rng: np.random.Generator, streams: int, joints: int) -> Pose:
    return (
        _quaternions(rng, streams, joints).astype(np.float32),
        rng.uniform(-1, 1, (streams, joints, 3)).astype(np.float32),
        rng.uniform(0.6, 1.5, (streams, joints, 3)).astype(np.float32),
    )


def _skeleton(
    factories: ModuleType, parents: list[int], rng: np.random.Generator, *, rotated: bool
) -> Skeleton:
    count = len(parents)
    made: Skeleton = factories.make_skeleton(
        parents,
        rng.uniform(-1, 1, (count, 3)),
        _quaternions(rng, count) if rotated else None,
        rng.uniform(0.8, 1.25, (count, 3)) if rotated else None,
    )
    return made


@settings(max_examples=60, deadline=None)
@given(trees(), st.integers(1, 5), st.booleans(), st.integers(0, 2**32))
def test_palettes_and_positions_are_those_of_single_matrices(
    factories: ModuleType, parents: list[int], streams: int, rotated: bool, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    skeleton = _skeleton(factories, parents, rng, rotated=rotated)
    pose = _poses(rng, streams, len(parents))
    work = Kinematics(skeleton, streams)
    palettes = np.full((streams, len(parents), 3, 4), np.nan, np.float32)
    work.evaluate(pack_poses(*pose), palettes)
    joints = rng.permutation(len(parents))[: max(1, len(parents) // 2)]
    positions = work.joint_positions(joints)
    assert positions.shape == (streams, len(joints), 3)
    for stream in range(streams):
        one = [part[stream] for part in pose]
        expected = factories.reference_palettes(skeleton, *one)
        size = max(1.0, float(np.abs(expected).max()))
        np.testing.assert_allclose(palettes[stream], expected, atol=3e-5 * size)
        models = factories.reference_models(parents, *one)
        np.testing.assert_allclose(positions[stream], models[joints, :3, 3], atol=3e-5 * size)


@settings(max_examples=20, deadline=None)
@given(st.data(), st.integers(1, 12), st.booleans(), st.integers(0, 2**32))
def test_rows_receive_their_pose_and_the_others_stay(
    factories: ModuleType, data: st.DataObject, total: int, rotated: bool, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    skeleton = _skeleton(factories, [-1, -1, 0, 0, 1, 4], rng, rotated=rotated)
    chosen = data.draw(st.lists(st.integers(0, total - 1), min_size=1, unique=True))
    rows = np.array(chosen, np.int64)
    pose = _poses(rng, len(rows), 6)
    work = Kinematics(skeleton, len(rows))
    palettes = np.full((total, 6, 3, 4), 7.0, np.float32)
    work.evaluate(pack_poses(*pose), palettes, rows)
    dense = np.empty((len(rows), 6, 3, 4), np.float32)
    work.evaluate(pack_poses(*pose), dense)
    np.testing.assert_array_equal(palettes[rows], dense)
    untouched = np.setdiff1d(np.arange(total), rows)
    assert (palettes[untouched] == 7.0).all()


def test_first_rows_of_a_larger_array_are_written_without_rows(factories: ModuleType) -> None:
    skeleton = factories.make_body()
    work = Kinematics(skeleton, 2)
    palettes = np.full((3, 7, 3, 4), 7.0, np.float32)
    clip = factories.make_still(skeleton, "rest")
    pose = pack_poses(clip.rotation, clip.translation, clip.scale)
    work.evaluate(np.repeat(pose, 2, axis=0), palettes)
    # The rest pose is the bind pose, so nothing is deformed.
    identity = np.broadcast_to(np.eye(3, 4), (2, 7, 3, 4))
    np.testing.assert_allclose(palettes[:2], identity, atol=1e-6)
    assert (palettes[2] == 7.0).all()


def test_a_bent_elbow_by_hand(factories: ModuleType) -> None:
    # A 1 m upper arm along +X and a 1 m forearm; the elbow turns 90 degrees about +Z.
    skeleton = factories.make_skeleton([-1, 0, 1], np.array([[0, 0, 0], [1, 0, 0], [1, 0, 0]]))
    rotation = np.tile(np.array([0, 0, 0, 1], np.float32), (1, 3, 1))
    rotation[0, 1] = 0, 0, 5, 5
    work = Kinematics(skeleton, 1)
    palettes = np.empty((1, 3, 3, 4), np.float32)
    pose = pack_poses(rotation, skeleton.rest_translation[None], np.ones((1, 3, 3), np.float32))
    work.evaluate(pose, palettes)
    np.testing.assert_allclose(
        work.joint_positions(np.array([2, 0]))[0], [[1, 1, 0], [0, 0, 0]], atol=1e-6
    )
    # What was at x = 2 (the wrist) in the bind pose is carried to (1, 1, 0).
    np.testing.assert_allclose(palettes[0, 2] @ [2, 0, 0, 1], [1, 1, 0], atol=1e-6)
    np.testing.assert_allclose(palettes[0, 0] @ [2, 0, 0, 1], [2, 0, 0], atol=1e-6)


def test_evaluating_again_forgets_the_poses_before(factories: ModuleType) -> None:
    rng = np.random.default_rng(5)
    skeleton = _skeleton(factories, [-1, 0, 0, 1, 3], rng, rotated=True)
    work, fresh = Kinematics(skeleton, 3), Kinematics(skeleton, 3)
    first, second = (pack_poses(*_poses(rng, 3, 5)) for _ in range(2))
    used, expected = (np.empty((3, 5, 3, 4), np.float32) for _ in range(2))
    work.evaluate(first, used)
    work.evaluate(second, used)
    fresh.evaluate(second, expected)
    np.testing.assert_array_equal(used, expected)


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_the_length_of_a_quaternion_does_not_matter(factories: ModuleType, factor: float) -> None:
    rng = np.random.default_rng(3)
    skeleton = _skeleton(factories, [-1, 0, 1], rng, rotated=True)
    q, t, s = _poses(rng, 1, 3)
    work = Kinematics(skeleton, 1)
    plain, scaled = (np.empty((1, 3, 3, 4), np.float32) for _ in range(2))
    work.evaluate(pack_poses(q, t, s), plain)
    work.evaluate(pack_poses(q * np.float32(factor), t, s), scaled)
    np.testing.assert_allclose(scaled, plain, atol=1e-5)
