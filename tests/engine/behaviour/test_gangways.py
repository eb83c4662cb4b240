"""Ways to seats: they begin at a door, keep to stairs, walkways and rows, and are short."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.engine.behaviour.gangways import IN_FRONT, STUB, Gangways
from tifo.engine.crowd.bowl import build_bowl
from tifo.engine.crowd.seating import FEET
from tifo.engine.crowd.stand import build_stand


def to_line(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """(n,) distances in plan from points (n, 3) to a polyline (p, 3)."""
    a, b = line[:-1, None, ::2], line[1:, None, ::2]
    p = points[None, :, ::2]
    t = ((p - a) * (b - a)).sum(-1) / np.maximum(((b - a) ** 2).sum(-1), 1e-12)
    near = a + t.clip(0, 1)[..., None] * (b - a)
    return np.linalg.norm(p - near, axis=-1).min(axis=0)


def test_way_ends_at_the_seat_past_the_seats_before_it() -> None:
    plan = build_bowl(3000)
    ways = Gangways(plan)
    for agent in np.random.default_rng(2).integers(0, 3000, 60):
        way = ways.to_seat(int(agent))
        np.testing.assert_array_equal(way.points[-1], plan.position[:, agent])
        seats = way.first + way.step * np.arange(len(way.points) - way.seat0)
        assert seats[-1] == agent
        assert way.mouth == way.seat0 - 1
        assert (plan.row[seats] == plan.row[agent]).all()
        assert (plan.section[seats] == plan.section[agent]).all()
        # The first one is the row's end, and people are passed before their feet.
        last = agent + way.step * -len(seats)
        outside = not 0 <= last < 3000
        assert (
            outside
            or plan.row[last] != plan.row[agent]
            or (plan.section[last] != plan.section[agent])
        )
        ahead = np.stack([np.sin(plan.yaw[seats]), np.cos(plan.yaw[seats])], axis=1)
        moved = way.points[way.seat0 :, ::2] - plan.position[::2, seats].T
        np.testing.assert_allclose(moved[:-1], IN_FRONT * ahead[:-1], atol=1e-4)


def test_way_stays_on_gangways_and_rows() -> None:
    plan = build_bowl(20_000)
    ways = Gangways(plan)
    lines = ways.lines()
    doors = ways.doors
    for agent in np.random.default_rng(1).integers(0, 20_000, 12):
        way = ways.to_seat(int(agent))
        assert np.linalg.norm(doors - way.points[0], axis=1).min() < 1e-4
        off = np.min([to_line(way.points[: way.mouth + 1], line) for line in lines], axis=0)
        assert off.max() < 0.02
        # Down the stairs by the rows' rises, never up again.
        assert (np.diff(way.points[: way.mouth + 1, 1]) <= 1e-5).all()


def test_row_is_entered_at_its_nearer_gangway() -> None:
    plan = build_bowl(3000)
    ways = Gangways(plan)
    row = np.flatnonzero((plan.section == 2) & (plan.row == 6))
    steps = [ways.to_seat(int(agent)).step for agent in row]
    middle = len(row) // 2
    assert steps[: middle - 1] == [1] * (middle - 1)
    assert steps[middle + 1 :] == [-1] * (len(row) - middle - 1)


def test_walkway_leads_to_the_nearest_door() -> None:
    plan = build_bowl(20_000)
    ways = Gangways(plan)
    tier = plan.structure.tiers[0]
    gates = [ways.to_seat(int(np.flatnonzero(plan.section == s)[0])) for s in tier.sections]
    # A door at every third gangway: at most one block of walkway, which is level.
    longest = max(float(block.length(tier.offsets[-1] + 3.0)) for block in tier.blocks)
    for way in gates:
        level = np.flatnonzero(np.abs(way.points[:, 1] - tier.heights[-1]) < 1e-4)
        length = np.linalg.norm(np.diff(way.points[level], axis=0), axis=1).sum()
        assert length < longest + STUB + 4.0


def test_stairs_follow_the_treads() -> None:
    plan = build_bowl(3000)
    ways, tier = Gangways(plan), plan.structure.tiers[0]
    up = ways.stairs(3, 0, 5).points
    np.testing.assert_allclose(up[:, 1], tier.heights[:6], atol=1e-4)
    run = np.linalg.norm(np.diff(up[:, ::2], axis=0), axis=1)
    np.testing.assert_allclose(run, 0.8, atol=1e-4)
    np.testing.assert_array_equal(ways.stairs(3, 5, 0).points, up[::-1])
    stay = ways.stairs(3, 2, 2).points
    np.testing.assert_array_equal(stay[1], up[2])
    assert np.linalg.norm(stay[0] - stay[1]) == pytest.approx(0.05, abs=1e-4)
    # It begins on the side of the landing, behind.
    assert (stay[0] - stay[1]) @ (up[3] - up[2]) > 0
    assert FEET - IN_FRONT > 0.0  # rows are walked on their own tread


def test_plan_without_gangways() -> None:
    with pytest.raises(ValueError, match="no gangways"):
        Gangways(build_stand(5, 20))


def test_reversed_way() -> None:
    plan = build_bowl(3000)
    way = Gangways(plan).to_seat(1000)
    seats = len(way.points) - way.seat0
    back = way.reversed(seats)
    np.testing.assert_array_equal(back.points[::-1], way.points)
    assert back.first == 1000
    assert back.first + back.step * (seats - 1) == way.first
    np.testing.assert_array_equal(back.points[back.mouth], way.points[way.mouth])
    np.testing.assert_allclose(back.normal, -way.normal[::-1], atol=1e-6)
