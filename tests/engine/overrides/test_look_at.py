from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import Placement
from tifo.engine.animation import Skeleton
from tifo.engine.overrides import LookAt, OverrideSet, look_at
from tifo.engine.overrides.look_at import LONGEST_LAG, SPACING, TRAIL

HEAD = np.array([0.0, 1.6, 0.0])


@pytest.fixture
def skeleton(factories: ModuleType) -> Skeleton:
    """Neck and head at one place, so that directions are the same from both."""
    places = np.array([[0, 1, 0], [0, 0.6, 0], [0, 0, 0]], float)
    made: Skeleton = factories.make_skeleton([-1, 0, 1], places, names=("chest", "neck", "head"))
    return made


def gaze(
    skeleton: Skeleton, look: LookAt, turns: NDArray[np.float64], yaw: float = 0.0
) -> NDArray[np.float32]:
    """(K, 3) where heads look, model space, for (K, 2) yaws and pitches of points far away."""
    overrides = OverrideSet(skeleton, 1)
    overrides.add(look)
    out = []
    for sideways, up in turns:
        way = [np.sin(sideways) * np.cos(up), np.sin(up), np.cos(sideways) * np.cos(up)]
        look.aim(np.array([3.0, 0.0, -2.0]) + HEAD + 1e3 * np.array(way), 100.0)
        palettes = np.tile(np.eye(3, 4, dtype=np.float32), (1, 3, 1, 1))
        placement = Placement(
            np.array([[3.0], [0.0], [-2.0]], np.float32),
            np.full(1, yaw, np.float32),
            np.ones(1, np.float32),
        )
        overrides.apply(palettes, np.zeros(1, np.int64), placement)
        np.testing.assert_array_equal(palettes[0, 0], np.eye(3, 4))
        out.append(palettes[0, 2, :, 2])
    return np.array(out)


def angles(ways: NDArray[np.float32]) -> NDArray[np.float64]:
    """(K, 2) yaw and pitch."""
    x, y, z = ways.astype(np.float64).T
    return np.stack([np.arctan2(x, z), np.arcsin(np.clip(y, -1, 1))], axis=1)


def test_heads_look_at_what_is_within_easy_reach(skeleton: Skeleton) -> None:
    turns = np.radians([[0, 0], [20, 0], [-30, -5], [10, 8], [-5, -12]])
    found = angles(gaze(skeleton, look_at(), turns))
    np.testing.assert_allclose(found, turns, atol=np.radians(1.0))


def test_the_agents_own_turn_counts(skeleton: Skeleton) -> None:
    # An agent that faces +X sees what is at +X straight ahead.
    (way,) = gaze(skeleton, look_at(), np.array([[np.pi / 2, 0.0]]), yaw=np.pi / 2)
    np.testing.assert_allclose(way, [0, 0, 1], atol=1e-3)


def test_turns_stay_below_the_limits_and_change_smoothly(skeleton: Skeleton) -> None:
    sideways = np.linspace(-np.pi, np.pi, 721)
    found = angles(gaze(skeleton, look_at(limit=(1.0, 0.5)), np.stack([sideways, 0 * sideways], 1)))
    yaw = found[:, 0]
    assert 0.9 < yaw.max() < 1.0
    np.testing.assert_allclose(yaw, -yaw[::-1], atol=1e-4)
    # Half a degree further round never turns the head by more than one and a half, also behind.
    assert np.abs(np.diff(yaw)).max() < np.radians(1.5)
    np.testing.assert_allclose(yaw[[0, 360, 720]], 0.0, atol=1e-3)
    up = np.linspace(-1.5, 1.5, 301)
    pitch = angles(gaze(skeleton, look_at(limit=(1.0, 0.5)), np.stack([0 * up, up], 1)))[:, 1]
    assert 0.4 < pitch.max() < 0.5


def test_joints_share_the_turn(skeleton: Skeleton) -> None:
    look = look_at({"neck": 0.25, "head": 0.5})
    overrides = OverrideSet(skeleton, 1)
    overrides.add(look)
    look.aim(HEAD + 1e3 * np.array([np.sin(0.4), 0.0, np.cos(0.4)]))
    palettes = np.tile(np.eye(3, 4, dtype=np.float32), (1, 3, 1, 1))
    zero = np.zeros(1, np.float32)
    placement = Placement(np.zeros((3, 1), np.float32), zero, zero + np.float32(1))
    overrides.apply(palettes, np.zeros(1, np.int64), placement)
    yaw = angles(palettes[0, :, :, 2])[:, 0]
    np.testing.assert_allclose(yaw, [0.0, 0.1, 0.3], atol=5e-3)


def test_who_does_not_care_does_not_look(skeleton: Skeleton) -> None:
    look = look_at()
    look.values[:] = 0.0
    (way,) = gaze(skeleton, look, np.array([[0.8, 0.2]]))
    np.testing.assert_allclose(way, [0, 0, 1], atol=1e-6)


def test_a_point_on_the_joint_itself_is_no_direction(skeleton: Skeleton) -> None:
    overrides = OverrideSet(skeleton, 1)
    look = look_at()
    overrides.add(look)
    look.aim(HEAD)
    palettes = np.tile(np.eye(3, 4, dtype=np.float32), (1, 3, 1, 1))
    zero = np.zeros(1, np.float32)
    placement = Placement(np.zeros((3, 1), np.float32), zero, zero + np.float32(1))
    overrides.apply(palettes, np.zeros(1, np.int64), placement)
    np.testing.assert_allclose(palettes[0, 2], np.eye(3, 4), atol=1e-5)


def test_the_trail_remembers_where_the_point_was() -> None:
    look = look_at()
    for tick in range(200):  # 2 m/s along X
        look.aim((2.0 * tick / 100, 0.0, 1.0), 0.01 if tick else 0.0)
    trail = look.uniforms["trail"]
    assert trail.shape == (TRAIL, 3)
    np.testing.assert_allclose(np.diff(trail[:, 0]), -2.0 * SPACING, atol=1e-3)
    assert 3.98 - 2.0 * 0.25 < trail[0, 0] < 3.98 - 2.0 * 0.1, "the filters lag a little"
    np.testing.assert_array_equal(trail[:, 2], 1.0)


def test_a_point_that_jumps_is_followed_smoothly() -> None:
    look = look_at()
    look.aim((0.0, 0.0, 0.0))
    places = []
    for _ in range(60):
        look.aim((10.0, 0.0, 0.0), 1 / 60)
        places.append(float(look.uniforms["trail"][0, 0]))
    steps = np.diff([0.0, *places])
    assert steps.max() < 10.0 / 8
    assert places[29] > 9.0
    assert places[-1] == pytest.approx(10.0, abs=0.01)


def test_drawn_attention_differs() -> None:
    values = look_at().draw_attention(4000, np.random.default_rng(1), share=0.75)
    assert values.shape == (4000, 4)
    follows = values[:, 0] > 0
    assert follows.mean() == pytest.approx(0.75, abs=0.03)
    assert values[follows, 0].min() >= 0.7
    assert 0.05 <= values[:, 1].min() < 0.1
    assert values[:, 1].max() <= LONGEST_LAG


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"joints": {}}, "has 0 joints"),
        ({"joints": {"neck": 0.6, "head": 0.6}}, "1 at most in all"),
        ({"joints": {"neck": -0.5, "head": 0.6}}, "more than 0"),
        ({"limit": 4.0}, "limit is 4.0"),
        ({"limit": (1.0, 0.5, 0.2)}, "one or two angles"),
    ],
)
def test_wrong_ones_are_refused(options: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        look_at(**options)  # type: ignore[arg-type]


def test_wrong_aims_are_refused() -> None:
    look = look_at()
    with pytest.raises(ValueError, match="three finite numbers"):
        look.aim((0.0, np.inf, 1.0))
    with pytest.raises(ValueError, match="seconds is -1"):
        look.aim((0.0, 0.0, 1.0), -1.0)
