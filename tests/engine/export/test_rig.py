from __future__ import annotations

import numpy as np
import pytest
from characters import make_box, make_skeleton, reference_models
from scipy.spatial.transform import Rotation

from tifo.engine.export.local_motion import LocalMotion, in_halves, local_motion
from tifo.engine.export.rig import Rig, factors, levers, make_rig, reach

PARENTS = (-1, 0, 1, 1)
OFFSETS = np.array([[0.0, 1.0, 0.0], [0.1, 0.5, 0.0], [0.4, 0.0, 0.2], [-0.4, 0.0, 0.1]])


def chain():
    rng = np.random.default_rng(4)
    turns = Rotation.random(4, random_state=rng).as_quat()
    return make_skeleton(PARENTS, OFFSETS, turns, names=("hips", "spine", "arm", "arm_stretch"))


def models(rig: Rig, motion: LocalMotion, frame: int, agent: int):
    """What the file's joints do in model space, by SciPy."""
    at = (frame, agent)
    parents = [int(parent) for parent in rig.parents]
    return reference_models(parents, motion.rotation[at], motion.translation[at], motion.scale[at])


def palettes_of(skeleton, linear, place):
    """(T, K, J, 3, 4) float32 palettes of model matrices."""
    matrices = np.concatenate([linear, place[..., None]], axis=-1)
    inverse = np.zeros((skeleton.joint_count, 4, 4))
    inverse[:, :3], inverse[:, 3, 3] = skeleton.inverse_bind, 1.0
    return (matrices @ inverse).astype(np.float32)


def test_half_of_two_opposite_turns_is_a_stretch() -> None:
    skeleton = make_skeleton([-1], [[0.0, 1.0, 0.0]])
    mixed = sum(Rotation.from_euler("x", a, degrees=True).as_matrix() for a in (30, 90)) / 2
    found = factors(
        skeleton, palettes_of(skeleton, mixed[None, None, None], np.zeros((1, 1, 1, 3)))
    )
    # Half way it is the turn by 60 degrees, and all across the axis is cos(30 degrees) as long.
    turn = Rotation.from_matrix(found.turn[0, 0, 0])
    np.testing.assert_allclose(turn.as_euler("xyz", degrees=True), [60, 0, 0], atol=1e-4)
    assert found.size[0, 0] == 1.0
    np.testing.assert_allclose(
        sorted(found.stretch[0, 0, 0]), [0.8660254, 0.8660254, 1.0], atol=1e-6
    )
    # A vertex that lies half a metre away is 0.067 m nearer.
    np.testing.assert_allclose(found.deviation(np.array([0.5])), [[0.0669873]], atol=1e-6)


def test_names_of_further_joints_are_new_and_parents_come_first() -> None:
    rig = make_rig(chain(), np.array([False, True, True, False]))
    assert rig.names[:4] == ("hips", "spine", "arm", "arm_stretch")
    assert rig.names[4:] == ("spine_stretch", "spine_skin", "arm_stretch_", "arm_skin")
    assert rig.parents.tolist() == [-1, 0, 1, 1, 1, 4, 2, 6]
    assert rig.skin.tolist() == [0, 5, 7, 3]


def test_a_rig_in_which_less_can_stretch_is_a_part_of_another() -> None:
    skeleton = chain()
    whole = make_rig(skeleton, np.array([True, True, False, True]))
    for mask in ([True, False, False, True], [False, True, False, False], [False] * 4):
        less = make_rig(skeleton, np.array(mask))
        part = whole.part(less)
        assert [whole.names[joint] for joint in part] == list(less.names)
        np.testing.assert_array_equal(part[less.parents[1:]], whole.parents[part[1:]])


def test_reach_is_the_farthest_vertex_times_its_weight() -> None:
    skeleton = make_skeleton([-1, 0], [[0.0, 1.0, 0.0], [0.0, 0.7, 0.0]])
    mesh = make_box(skeleton, np.array([0.0, 1.0, 0.0]), np.array([0.3, 1.0, 0.4]))
    mesh.weights[:] = [0.5, 0.5, 0.0, 0.0]
    mesh.joints[:, 1] = 1
    far = reach(skeleton, (mesh,))
    np.testing.assert_allclose(far, [0.25, 0.5 * np.sqrt(0.25 + 0.49)], atol=1e-6)
    np.testing.assert_allclose(levers(skeleton, far), [0.7, far[1]], atol=1e-6)


@pytest.mark.parametrize(
    ("scales", "short", "off"),
    [(np.float32, False, 2e-5), (np.float32, True, 1e-3), (np.float16, False, 1e-3)],
)
def test_any_matrices_are_made_of_turns_and_scales(scales, short: bool, off: float) -> None:
    """Sheared, shrunk and mirrored joints, in chains, as exactly as numbers are held."""
    skeleton = chain()
    rng = np.random.default_rng(1)
    turns = Rotation.random(5 * 2 * 4, random_state=rng).as_matrix().reshape(5, 2, 4, 3, 3)
    linear = turns @ (np.eye(3) + 0.3 * rng.normal(size=(5, 2, 4, 3, 3)))
    linear *= np.array([1.0, 0.7, 1.3, 0.9])[:, None, None]
    linear[2, 1, 3] = 0.0  # A joint that vanishes for a moment,
    linear[:, 0, 1, :, 0] *= -1.0  # and one that is a mirror image.
    place = rng.normal(size=(5, 2, 4, 3))
    found = factors(skeleton, palettes_of(skeleton, linear, place), scales)
    rig = make_rig(skeleton, np.ones(4, np.bool_))
    lever = np.full(4, 0.5)
    motion = local_motion(skeleton, rig, found, lever, 1e-7, scales, short=short)
    for frame in range(5):
        for agent in range(2):
            shown = models(rig, motion, frame, agent)[rig.skin]
            np.testing.assert_allclose(shown[:, :3, :3], linear[frame, agent], atol=off)
            np.testing.assert_allclose(shown[:, :3, 3], place[frame, agent], atol=off)
    np.testing.assert_allclose(np.linalg.norm(motion.rotation, axis=-1), 1.0, atol=1e-4)
    # Bones are rigid: one factor, the same in all directions and at all times.
    assert (motion.scale[:, :, :4] == motion.scale[:1, :, :4, :1]).all()


def test_flesh_that_is_larger_is_the_bones_scale_and_no_stretch() -> None:
    skeleton = make_skeleton([-1, 0], [[0.0, 1.0, 0.0], [0.0, 0.5, 0.0]])
    linear = np.array([0.91, 1.24])[:, None, None] * np.eye(3)
    place = np.array([[0.0, 0.9, 0.0], [0.0, 1.3, 0.0]])
    found = factors(skeleton, palettes_of(skeleton, linear[None, None], place[None, None]))
    assert found.deviation(np.ones(2)).max() < 1e-5
    rig = make_rig(skeleton, np.zeros(2, np.bool_))
    motion = local_motion(skeleton, rig, found, np.ones(2), 1e-6)
    np.testing.assert_allclose(motion.scale[0, 0, :, 0], [0.91, 1.24 / 0.91], rtol=1e-5)
    # The child's place is in units of its parent's, which is smaller.
    np.testing.assert_allclose(motion.translation[0, 0, 1], [0.0, 0.4 / 0.91, 0.0], atol=1e-6)


def test_what_hardly_moves_stays_and_what_hangs_below_is_still_in_its_place() -> None:
    skeleton = make_skeleton([-1, 0], [[0.0, 1.0, 0.0], [0.0, 0.5, 0.0]])
    frames = 9
    place = np.tile(np.array([[0.0, 1.0, 0.0], [0.0, 1.5, 0.0]]), (frames, 1, 1, 1))
    place[:, 0, 0, 0] += 8e-6 * np.sin(np.arange(frames))
    place[:, 0, 1, 2] += 0.01 * np.arange(frames)
    linear = np.broadcast_to(np.eye(3), (frames, 1, 2, 3, 3))
    found = factors(skeleton, palettes_of(skeleton, linear, place))
    rig = make_rig(skeleton, np.zeros(2, np.bool_))
    motion = local_motion(skeleton, rig, found, np.ones(2), 1e-5)
    assert (motion.translation[:, :, 0] == motion.translation[0, :, 0]).all()
    assert (motion.rotation == motion.rotation[0]).all()
    for frame in range(frames):
        shown = models(rig, motion, frame, 0)[:, :3, 3]
        np.testing.assert_allclose(shown[1], place[frame, 0, 1], atol=1e-6)


def test_two_half_precision_factors_are_more_exact_than_one() -> None:
    stretch = np.random.default_rng(2).uniform(0.8, 1.2, (2000, 3))
    scale, common = in_halves(stretch)
    assert (scale == scale.astype(np.float16)).all()
    assert (common == common.astype(np.float16)).all()
    off, once = (
        np.abs(shown - stretch).max(axis=1)
        for shown in (scale * common, stretch.astype(np.float16))
    )
    assert off.max() < 2.5e-4
    assert once.mean() > 4 * off.mean()
