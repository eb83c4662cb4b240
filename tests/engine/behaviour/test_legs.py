"""Stretches of ways: places, facings and distances along them, against the route's own vertices."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.components import Errand, Leg, Walk
from tifo.components.walk import RATES
from tifo.engine.behaviour.gangways import Gangways
from tifo.engine.behaviour.legs import FAR, legs_of, passed
from tifo.engine.behaviour.walk_now import advance, look
from tifo.engine.crowd.bowl import build_bowl

PLAN = build_bowl(3000)
WAYS = Gangways(PLAN)


@pytest.mark.parametrize("errand", [Errand.ARRIVE, Errand.LEAVE])
@pytest.mark.parametrize("agent", [0, 1000, 1001, 2222])
def test_stretches_tell_of_the_way(errand: Errand, agent: int) -> None:
    route = WAYS.to_seat(agent)
    seats = len(route.points) - route.seat0
    if errand is Errand.LEAVE:
        route = route.reversed(seats)
    legs = legs_of(route, errand, PLAN.yaw)
    length = np.linalg.norm(np.diff(route.points, axis=0), axis=1)
    np.testing.assert_allclose(legs[:-1, Leg.LENGTH], length, rtol=1e-5)
    # Its beginning, and what its metres add, lead to where the next one begins.
    ends = legs[:-1, :3] + legs[:-1, RATES][:, :3] * length[:, None]
    np.testing.assert_allclose(ends, route.points[1:], atol=1e-4)
    np.testing.assert_allclose(legs[:, Leg.REST], np.append(length[::-1].cumsum()[::-1], 0), 1e-4)
    inside = legs[:, Leg.IN_ROW] > 0
    assert inside.sum() == (seats if errand is Errand.LEAVE else seats + 1)
    own = np.flatnonzero(np.abs(route.points - PLAN.position[:, agent]).max(axis=1) < 1e-6)
    assert legs[own, Leg.YAW] == pytest.approx(PLAN.yaw[agent], abs=1e-6)
    # Whoever is next in the row has to get up: all that are passed, and not oneself.
    others = seats - 1
    next_ones = np.flatnonzero(inside & (legs[:, Leg.TO_SEAT] < FAR))
    assert len(next_ones) == others
    np.testing.assert_allclose(legs[next_ones, Leg.TO_SEAT], length[next_ones], rtol=1e-5)
    ids = route.first + route.step * (legs[next_ones, Leg.SEAT].astype(int) + 1)
    assert agent not in ids
    np.testing.assert_allclose(
        route.points[next_ones + 1, ::2], PLAN.position[::2, ids].T, atol=0.12
    )
    coming = legs[:, Leg.TO_MOUTH] < FAR
    if errand is Errand.ARRIVE:
        assert coming.sum() == route.mouth
        assert legs[0, Leg.TO_MOUTH] == pytest.approx(length[: route.mouth].sum(), rel=1e-5)
        assert passed(route, errand) == others
    else:
        assert not coming.any()


def test_yaw_turns_the_short_way_behind_the_pitch() -> None:
    # On the main side people look to -Z, where yaw jumps from pi to -pi.
    agent = int(np.argmax(np.abs(PLAN.yaw)))
    row = np.flatnonzero((PLAN.section == PLAN.section[agent]) & (PLAN.row == PLAN.row[agent]))
    route = WAYS.to_seat(int(row[len(row) // 2]))
    legs = legs_of(route, Errand.ARRIVE, PLAN.yaw)
    turns = legs[:-1, RATES][:, Leg.YAW] * legs[:-1, Leg.LENGTH]
    assert np.abs(turns).max() < 0.2


def test_walking_a_way_ends_at_its_end() -> None:
    walk, route = Walk(), WAYS.to_seat(1500)
    walk.add(legs_of(route, Errand.ARRIVE, PLAN.yaw), agent=1500, pace=0.6, mouth=route.mouth)
    walk.speed[:] = 0.9
    seconds = float(walk.leg[Leg.REST, 0]) / 0.9
    passes = sum(len(advance(walk, 1 / 60)) for _ in range(round(0.5 * seconds * 60)))
    assert 0 < passes < walk.last[0]
    assert float(walk.leg[Leg.REST, 0] - walk.along[0]) == pytest.approx(0.45 * seconds, rel=0.02)
    for _ in range(round(0.6 * seconds * 60)):
        advance(walk, 1 / 60)
    assert walk.vertex[0] == walk.last[0]
    np.testing.assert_allclose(look(walk).place[:, 0], route.points[-1], atol=1e-5)
    # One big step passes several vertices.
    other = Walk()
    other.add(walk.ways[0], agent=3)
    other.speed[:] = 0.9
    advance(other, 0.5 * seconds)
    assert float(other.leg[Leg.REST, 0] - other.along[0]) == pytest.approx(0.45 * seconds, rel=1e-3)


def test_columns_grow_and_shrink_in_order() -> None:
    walk = Walk()
    for agent in range(200):
        walk.add(np.full((3, 23), agent, np.float32), agent=agent, speed=0.1 * agent)
    assert walk.agent.tolist() == list(range(200))
    assert (walk.last == 2).all()
    walk.keep(np.arange(200) % 3 == 1)
    assert walk.agent.tolist() == list(range(1, 200, 3))
    np.testing.assert_allclose(walk.speed, 0.1 * walk.agent)
    assert (walk.leg == walk.agent).all()
    walk.add(np.full((2, 23), 7.0, np.float32), agent=999)
    assert walk.speed[-1] == 0.0
    assert walk.ways[-1].shape == (2, 23)
    walk.vertex[-1] = 1
    walk.ways[-1][1] = 5.0
    walk.enter(np.array([len(walk) - 1]))
    assert (walk.leg[:, -1] == 5.0).all()
