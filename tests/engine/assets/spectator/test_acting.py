"""Goals, springs, steps and mirrors: what performances are acted with."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.engine.assets.spectator import gestures
from tifo.engine.assets.spectator.acting import Acting
from tifo.engine.assets.spectator.poses import POSES, arms_up, seated, standing
from tifo.engine.assets.spectator.skeleton import spectator_skeleton
from tifo.engine.assets.spectator.springs import Pace, arrive, close, follow

TIMES = np.linspace(0.0, 4.0, 241)


def step_at(time: float) -> np.ndarray:
    return np.where(time <= TIMES, 1.0, 0.0)[:, None]


def test_a_spring_settles_on_its_goal_and_overshoots_as_its_damping_says() -> None:
    for damping in (0.4, 0.6, 1.0):
        way = follow(step_at(0.5), TIMES, [Pace(2.0, damping)], looping=False)[:, 0]
        assert way[TIMES < 0.5].max() == 0.0
        assert way[-1] == pytest.approx(1.0, abs=1e-3)
        # Overshoot of a second-order system: exp(-pi d / sqrt(1 - d^2)).
        known = np.exp(-np.pi * damping / np.sqrt(1 - damping**2)) if damping < 1 else 0.0
        assert way.max() - 1 == pytest.approx(known, abs=0.04)


def test_springs_do_not_depend_on_each_other_and_slow_ones_come_later() -> None:
    goals = np.repeat(step_at(0.5), 2, axis=1)
    both = follow(goals, TIMES, [Pace(4.0, 0.8), Pace(2.0, 0.8)], looping=False)
    for column, pace in enumerate((Pace(4.0, 0.8), Pace(2.0, 0.8))):
        alone = follow(step_at(0.5), TIMES, [pace], looping=False)
        np.testing.assert_allclose(both[:, column], alone[:, 0], atol=1e-12)
    half = [TIMES[np.argmax(both[:, k] > 0.5)] for k in (0, 1)]
    assert half[1] > half[0] + 0.05


def test_a_negative_lead_first_moves_the_other_way() -> None:
    eased = np.clip((TIMES - 0.5) / 0.4, 0, 1)[:, None]
    ahead = follow(eased, TIMES, [Pace(3.0, 0.7, -0.5)], looping=False)
    assert -0.2 < ahead.min() < -0.01
    assert follow(eased, TIMES, [Pace(3.0, 0.7)], looping=False).min() >= 0.0


def test_a_loop_ends_as_it_began() -> None:
    goal = np.sin(np.pi * TIMES)[:, None] ** 2
    way = follow(goal, TIMES, [Pace(2.0, 0.5)], looping=True)
    np.testing.assert_allclose(way[-1], way[0], atol=1e-3)
    closed = close(way, TIMES, np.array([0.25]), 0.3)
    assert closed[0, 0] == closed[-1, 0] == 0.25
    np.testing.assert_array_equal(closed[60:180], way[60:180])


def test_arriving_is_at_rest_at_the_end() -> None:
    way = arrive(np.stack([TIMES, TIMES**2], axis=1), TIMES, np.array([3.9, 15.5]), 0.5)
    np.testing.assert_allclose(way[-1], [3.9, 15.5], atol=1e-12)
    speed = (3 * way[-1] - 4 * way[-2] + way[-3]) / (2 * TIMES[1])
    np.testing.assert_allclose(speed, 0.0, atol=0.1)
    np.testing.assert_array_equal(way[TIMES <= 3.5][:, 0], TIMES[TIMES <= 3.5])


def test_goals_of_the_trunk_are_offsets_and_those_of_limbs_are_values() -> None:
    p = Acting("once", 2.0, standing(), looping=False)
    p.move(0.2, 0.8, head=(0.0, 0.5, 0.0), hand_r=(0.3, 0.1, 0.3))
    p.back(1.2, 1.7)
    p.mirrored().mirrored()
    head, hand = p._curves["head"], p._curves["hand_r"]
    middle = len(p.times) // 2
    np.testing.assert_allclose(head[middle] - standing()["head"], (0, 0.5, 0), atol=0.03)
    np.testing.assert_allclose(hand[middle], (0.3, 0.1, 0.3), atol=0.03)
    np.testing.assert_allclose(head[-1], standing()["head"], atol=1e-9)


def test_mirroring_exchanges_the_sides() -> None:
    def act() -> Acting:
        p = Acting("look", 1.6, standing())
        return p.move(0.1, 0.6, head=(0.1, 0.5, 0.2), hand_l=(0.3, 0.1, 0.3)).back(0.9, 1.3)

    plain, mirrored = act(), act().mirrored()
    plain._follow()
    head = plain._curves["head"] - plain.base["head"]
    np.testing.assert_allclose(
        mirrored._curves["head"] - mirrored.base["head"], head * (1, -1, -1), atol=1e-12
    )
    np.testing.assert_allclose(
        mirrored._curves["hand_r"] - mirrored.base["hand_r"],
        plain._curves["hand_l"] - plain.base["hand_l"],
        atol=1e-12,
    )


def test_a_step_lifts_the_foot_and_puts_it_down_where_it_says() -> None:
    p = Acting("step", 2.0, standing(), looping=False)
    p.step("_l", 0.2, 0.7, (0.10, -0.05), outward=0.5)
    ball, foot = p._curves["ball_l"], p._curves["foot_l"]
    start = standing()["ball_l"]
    after = p.times >= 0.7
    np.testing.assert_allclose(ball[after] - start, np.tile((0.10, 0, -0.05), (after.sum(), 1)))
    np.testing.assert_allclose(foot[after], np.tile((0.0, 0.5), (after.sum(), 1)), atol=1e-12)
    np.testing.assert_array_equal(
        ball[p.times <= 0.25], np.tile(start, ((p.times <= 0.25).sum(), 1))
    )
    assert 0.03 < (ball[:, 1] - start[1]).max() < 0.06
    p.step("_l", 1.0, 1.5)
    np.testing.assert_allclose(p._curves["ball_l"][-1], start, atol=1e-12)
    np.testing.assert_allclose(p._curves["foot_l"][-1], standing()["foot_l"], atol=1e-12)


def test_two_ways_at_once_are_refused() -> None:
    p = Acting("hurry", 2.0, seated()).move(0.2, 0.9, head=(0, 0.4, 0))
    with pytest.raises(ValueError, match=r"'hurry' sends head .* until 0\.5 s, but"):
        p.move(0.3, 0.5, head=(0, 0, 0))


def test_a_clip_from_pose_to_pose_ends_exactly_there() -> None:
    p = Acting("up", 0.5, standing(), looping=False, goal=arms_up(), snap=2.0)
    clip = p.back(0.0, 0.4).clip(spectator_skeleton())
    goal = Acting("stay", 0.5, arms_up()).clip(spectator_skeleton())
    np.testing.assert_allclose(clip.rotation[-1], goal.rotation[0], atol=1e-6)


@pytest.mark.parametrize("name", list(POSES))
def test_poses_have_every_channel(name: str) -> None:
    assert POSES[name]().keys() == standing().keys()


def test_gestures_are_within_an_arms_reach() -> None:
    """Of 0.53 m from the shoulder at (0.17, 0.19, 0) over the chest, or of the head's middle."""
    shapes = {k: v for k, v in vars(gestures).items() if k.isupper() and isinstance(v, dict)}
    assert len(shapes) > 30
    for name, shape in shapes.items():
        place = np.array(gestures.place(shape))
        if shape["clasp"]:
            assert 0.1 < np.linalg.norm(place - (0, 0.08, 0)) < 0.35, name
        else:
            assert np.linalg.norm(place - (0.172, 0.188, 0.0)) < 0.56, name
