from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from overrides import turn

from tifo.components import Placement
from tifo.engine.animation import Skeleton
from tifo.engine.overrides import JointOverride, OverrideSet

QUARTER = np.pi / 2 - 0.25
IDS = np.array([2, 0])
NAMES = ("root", "side", "arm", "hand")


@pytest.fixture
def skeleton(factories: ModuleType) -> Skeleton:
    """An arm along +X: root at the origin, arm at 1, hand at 2; the side is above the root."""
    places = np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 0, 0]], float)
    made: Skeleton = factories.make_skeleton([-1, 0, 0, 2], places, names=NAMES)
    return made


def applied(overrides: OverrideSet) -> NDArray[np.float32]:
    """Palettes of two agents in the bind pose."""
    palettes = np.tile(np.eye(3, 4, dtype=np.float32), (2, 4, 1, 1))
    agents = len(overrides.values)
    zeros = np.zeros(agents, np.float32)
    placement = Placement(np.zeros((3, agents), np.float32), zeros, zeros + np.float32(1))
    overrides.apply(palettes, IDS, placement)
    return palettes


def moved(palettes: NDArray[np.float32], joint: str, point: tuple[float, ...]) -> list[float]:
    """Where a point of the bind pose is for the first agent, in thousandths."""
    matrix = palettes[0, NAMES.index(joint)]
    return [round(float(x), 3) + 0.0 for x in matrix @ (*point, 1.0)]


def test_descendants_follow_and_others_do_not(skeleton: Skeleton) -> None:
    overrides = OverrideSet(skeleton, 3)
    overrides.add(turn("turn", ["arm"], QUARTER, values=(1.0, 0.0, 0.0, 0.0)))
    palettes = applied(overrides)
    # A quarter turn about +Z at (1, 0, 0).
    assert moved(palettes, "arm", (1, 0, 0)) == [1, 0, 0]
    assert moved(palettes, "arm", (2, 0, 0)) == [1, 1, 0]
    assert moved(palettes, "hand", (2, 0, 0)) == [1, 1, 0]
    assert moved(palettes, "hand", (3, 0, 0)) == [1, 2, 0]
    for joint in ("root", "side"):
        np.testing.assert_array_equal(
            palettes[:, NAMES.index(joint)], np.tile(np.eye(3, 4), (2, 1, 1))
        )


def test_two_on_one_chain_begin_at_the_top(skeleton: Skeleton) -> None:
    overrides = OverrideSet(skeleton, 3)
    ones = (1.0, 0.0, 0.0, 0.0)
    overrides.add(turn("low", ["arm"], QUARTER, values=ones))
    overrides.add(turn("high", ["root"], QUARTER, values=ones))
    palettes = applied(overrides)
    # The root's turn takes the arm to (0, 1, 0) and the hand to (0, 2, 0); the arm's goes on there.
    assert moved(palettes, "arm", (1, 0, 0)) == [0, 1, 0]
    assert moved(palettes, "hand", (2, 0, 0)) == [-1, 1, 0]
    assert moved(palettes, "side", (0, 1, 0)) == [-1, 0, 0]


def test_several_at_one_joint_go_in_order(skeleton: Skeleton) -> None:
    widen = JointOverride(
        "widen",
        ["arm"],
        """
        const mat3 WIDER = mat3(2, 0, 0, 0, 1, 0, 0, 0, 1);
        mat4 widen(OverriddenJoint joint) { return mat4(WIDER) * joint.pose; }
        """,
        python=lambda joints, _: np.diag([2.0, 1.0, 1.0, 1.0]) @ joints.pose,
    )
    rotate = turn("rotate", ["arm"], QUARTER, values=(1.0, 0.0, 0.0, 0.0))
    places = []
    for order in ((widen, rotate), (rotate, widen)):
        overrides = OverrideSet(skeleton, 3)
        for override in order:
            overrides.add(override)
        places.append(moved(applied(overrides), "hand", (2, 0, 0)))
    # Widened to (4, 0, 0) and turned about (2, 0, 0); turned to (1, 1, 0) and then widened.
    assert places == [[2, 2, 0], [2, 1, 0]]
    # The second of one override's joints turns by one radian more, after its own parent's turn.
    overrides = OverrideSet(skeleton, 3)
    overrides.add(turn("both", ["root", "arm"], -0.25, values=(1.0, 0.0, 0.0, 0.0)))
    expected = [1 + np.cos(1.0), np.sin(1.0), 0.0]
    assert moved(applied(overrides), "hand", (2, 0, 0)) == [round(float(x), 3) for x in expected]


def test_values_are_each_agents_own(skeleton: Skeleton) -> None:
    overrides = OverrideSet(skeleton, 3)
    overrides.add(turn("turn", ["arm"], 1.0))
    overrides.set_values("turn", np.array([2]), (QUARTER, 0, 0, 0))
    overrides.set_values("turn", np.array([0, 1]), [[-0.25, 0, 0, 0], [5, 0, 0, 0]])
    palettes = applied(overrides)  # of agents 2 and 0
    np.testing.assert_allclose(palettes[0, 2, :3, 0], [0, 1, 0], atol=1e-6)
    np.testing.assert_allclose(palettes[1, 2], np.eye(3, 4), atol=1e-6)


def test_values_stay_with_their_override_when_another_goes(skeleton: Skeleton) -> None:
    overrides = OverrideSet(skeleton, 3)
    for name in ("first", "second"):
        overrides.add(turn(name, ["arm"]))
    overrides.set_values("second", np.array([1]), (1, 2, 3, 4))
    overrides.remove("first")
    np.testing.assert_array_equal(overrides.values[:, 0], [[0] * 4, [1, 2, 3, 4], [0] * 4])
    overrides.remove("second")
    assert overrides.steps == ()
    np.testing.assert_array_equal(applied(overrides), np.tile(np.eye(3, 4), (2, 4, 1, 1)))


def test_a_joint_that_is_squeezed_flat_is_left_alone(skeleton: Skeleton) -> None:
    overrides = OverrideSet(skeleton, 2)
    overrides.add(turn("turn", ["root"], QUARTER, values=(1.0, 0.0, 0.0, 0.0)))
    palettes = np.tile(np.eye(3, 4, dtype=np.float32), (2, 4, 1, 1))
    palettes[0, :, :3, :3] = np.diag([1.0, 1.0, 0.0])
    before = palettes.copy()
    zeros = np.zeros(2, np.float32)
    placement = Placement(np.zeros((3, 2), np.float32), zeros, zeros + np.float32(1))
    overrides.apply(palettes, np.array([0, 1]), placement)
    np.testing.assert_array_equal(palettes[0], before[0])
    assert np.abs(palettes[1] - before[1]).max() > 0.9


def test_wrong_calls_are_refused(skeleton: Skeleton) -> None:
    overrides = OverrideSet(skeleton, 3)
    overrides.add(turn("turn", ["arm"]))
    with pytest.raises(ValueError, match="'turn' is there already"):
        overrides.add(turn("turn", ["hand"]))
    with pytest.raises(ValueError, match="override 'other': no joint 'hnad'; near: hand"):
        overrides.add(turn("other", ["hnad"]))
    assert len(overrides.overrides) == 1, "what was refused leaves nothing behind"
    with pytest.raises(ValueError, match="no override 'trun'; near: turn"):
        overrides.remove("trun")
    with pytest.raises(ValueError, match=r"expected finite numbers \(4,\) or \(2, 4\)"):
        overrides.set_values("turn", IDS, np.zeros((3, 4)))
    overrides.add(turn("lame", ["hand"], python=None))
    with pytest.raises(ValueError, match="override 'lame' has no Python form"):
        applied(overrides)
    overrides.remove("lame")
    overrides.add(turn("short", ["hand"], python=lambda joints, _: joints.pose[:, :3]))
    with pytest.raises(ValueError, match=r"'short': python returned float32 of shape \(2, 3, 4\)"):
        applied(overrides)
    overrides.remove("short")
    for number in range(15):
        overrides.add(turn(f"turn{number}", ["arm"]))
    with pytest.raises(ValueError, match="one too many"):
        overrides.add(turn("last", ["arm"]))
