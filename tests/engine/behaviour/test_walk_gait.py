"""Gaits fit the speed of those who walk, are kept for a while, and short legs go quicker."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.components import Leg, Stage, Walk
from tifo.engine.behaviour.walk_gait import HOLD, Gaiting
from tifo.engine.crowd.gaits import SIDE_SPEEDS, SPEEDS, Gaits

WALK = np.arange(2, 9, dtype=np.int16)
LEFT, RIGHT = np.array([9, 10], np.int16), np.array([11, 12], np.int16)
SIDES = np.array(SIDE_SPEEDS, np.float32)
GAITS = Gaits(
    (WALK, np.array(SPEEDS, np.float32)), (LEFT, SIDES), (RIGHT, SIDES), np.zeros(0, np.int16)
)
CALM = np.array([0, 1], np.int16)
OWN = np.zeros(13)
OWN[2:9], OWN[9:11], OWN[11:13] = SPEEDS, SIDE_SPEEDS, SIDE_SPEEDS


def people(count: int, **columns: object) -> Walk:
    walk = Walk()
    for agent in range(count):
        walk.add(np.zeros((2, 23), np.float32), agent=agent, stage=Stage.WALK)
    for name, column in columns.items():
        getattr(walk, name)[:] = column
    return walk


def test_gait_changes_when_another_fits_better_by_two_centimetres_a_second() -> None:
    speeds = np.linspace(0.003, 1.603, 161, dtype=np.float32)
    for before in range(9):
        walk = people(161, speed=speeds, motion=before)
        gaiting = Gaiting(GAITS, CALM, 13, np.ones(161, np.float32))
        gaiting.choose(walk, HOLD)
        for agent, (speed, motion) in enumerate(zip(speeds, walk.motion, strict=True)):
            best = 2 + int(np.argmin(np.abs(np.array(SPEEDS) - speed)))
            gain = abs(OWN[before] - speed) - abs(OWN[best] - speed) - 0.02
            if speed < 0.12:
                assert motion == (before if before < 2 else CALM[agent % 2])
            elif abs(gain) > 1e-5 and abs(speed - 0.12) > 1e-4:
                assert motion == (best if gain > 0 else before), (before, speed)


def test_a_gait_lasts_a_while() -> None:
    walk = people(1, speed=0.6, motion=0)
    gaiting = Gaiting(GAITS, CALM, 13, np.ones(1, np.float32))
    assert gaiting.choose(walk, 100)
    assert walk.since[0] == 100
    walk.speed[:] = 1.3
    assert not gaiting.choose(walk, 100 + HOLD - 1)
    assert gaiting.choose(walk, 100 + HOLD)
    assert walk.motion[0] == WALK[-1]
    assert not gaiting.choose(walk, 100 + 9 * HOLD)


@pytest.mark.parametrize(("ahead", "table"), [(1.0, LEFT), (-1.0, RIGHT)])
def test_people_go_sideways_in_a_row(ahead: float, table: np.ndarray) -> None:
    # Who faces +Z has +X on the left.
    walk = people(2, speed=[0.27, 0.45], motion=WALK[1])
    walk.leg[Leg.IN_ROW], walk.leg[Leg.AHEAD_X] = 1.0, ahead
    Gaiting(GAITS, CALM, 13, np.ones(2, np.float32)).choose(walk, HOLD)
    assert walk.motion.tolist() == table.tolist()


def test_short_legs_show_a_quicker_walk() -> None:
    walk = people(3, speed=0.54, motion=0)
    size = np.array([1.0, 0.675, 0.54], np.float32)
    Gaiting(GAITS, CALM, 13, size).choose(walk, HOLD)
    assert OWN[walk.motion].tolist() == [0.54, 0.8, 1.0]
