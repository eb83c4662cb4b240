"""The sightline formula against numbers worked out by hand, and every seat of real bowls."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tifo.engine.crowd.bowl import build_bowl
from tifo.engine.crowd.seating import SeatPlan
from tifo.engine.crowd.sightline import (
    MAX_RAKE,
    c_value,
    c_values,
    climb,
    distance_to_pitch,
    riser_for,
    steepest,
)
from tifo.engine.crowd.stadium import build_stadium_mesh
from tifo.engine.crowd.stand import build_stand


def test_c_value_by_hand() -> None:
    # 10 (0.4 + 3) / 10.8 - 3 = 34 / 10.8 - 3
    assert c_value(10.0, 3.0, 0.4, 0.8) == pytest.approx(0.148148, abs=1e-6)
    # The line of sight grazes the eye in front where riser / tread = height / distance.
    assert c_value(20.0, 5.0, 0.2, 0.8) == pytest.approx(0.0, abs=1e-12)
    # A lower step than that is blocked.
    assert c_value(20.0, 5.0, 0.1, 0.8) == pytest.approx(20 * 5.1 / 20.8 - 5)
    assert c_value(20.0, 5.0, 0.1, 0.8) < 0.0


def test_riser_by_hand() -> None:
    # (3 + 0.09) 10.8 / 10 - 3 = 0.3372
    assert riser_for(0.09, 10.0, 3.0, 0.8) == pytest.approx(0.3372)


@given(st.floats(0.0, 0.2), st.floats(3.0, 200.0), st.floats(1.0, 60.0), st.floats(0.5, 2.0))
def test_riser_inverts_c_value(c: float, distance: float, height: float, tread: float) -> None:
    riser = riser_for(c, distance, height, tread)
    assert c_value(distance, height, riser, tread) == pytest.approx(c, abs=1e-9)


def test_climb_by_hand() -> None:
    tiers = [np.array([10.0, 10.8]), np.array([14.0])]
    lower, upper = climb(tiers, 0.09, first_height=1.8, raises=3.0, tread=0.8)
    # First riser for the eye at 3.0 m, 10 m away.
    assert lower.tolist() == pytest.approx([1.8, 2.1372])
    assert upper.tolist() == pytest.approx([5.1372])


def test_steepest() -> None:
    assert steepest([np.array([0.0, 0.3, 0.7]), np.array([5.0])], 0.8) == pytest.approx(
        np.arctan(0.5)
    )
    assert steepest([np.array([1.0])], 0.8) == 0.0


def test_distance_to_pitch() -> None:
    x = np.array([0.0, 0.0, 60.5, 55.5, -55.5])
    z = np.array([0.0, 42.0, 10.0, 38.0, -38.0])
    assert distance_to_pitch(x, z).tolist() == pytest.approx([0.0, 8.0, 8.0, 5.0, 5.0])


def clearance(plan: SeatPlan, seat: int) -> float:
    """Height of a seat's line of sight above the eye one row further down, by geometry alone."""
    (tier,) = [t for i, t in enumerate(plan.structure.tiers) if i == plan.tier[seat]]
    below = tier.heights[plan.row[seat] - tier.first_row - 1]
    ahead = np.array([np.sin(plan.yaw[seat]), 0.0, np.cos(plan.yaw[seat])])
    eye = plan.position[:, seat] + [0.0, 1.2, 0.0] - 0.35 * ahead
    front = eye + 0.8 * ahead
    front[1] = below + 1.2
    focus = np.array([np.clip(front[0], -52.5, 52.5), 0.0, np.clip(front[2], -34.0, 34.0)])
    reach = np.hypot(*(focus - front)[[0, 2]])
    return float(eye[1] * reach / (reach + 0.8) - front[1])


def test_c_values_are_the_clearance_of_the_line_of_sight() -> None:
    plan = build_bowl(30_000)
    c = c_values(plan)
    for seat in np.flatnonzero(np.isfinite(c))[::1999]:
        assert c[seat] == pytest.approx(clearance(plan, seat), abs=1e-5)


@pytest.mark.parametrize("seats", [100, 3_000, 12_000, 30_000, 65_000, 100_000, 200_000])
def test_everybody_sees_the_pitch(seats: int) -> None:
    plan = build_bowl(seats)
    c = c_values(plan)
    first_rows = {tier.first_row for tier in plan.structure.tiers}
    assert set(plan.row[np.isinf(c)].tolist()) <= first_rows
    assert c.min() >= 0.09
    heights = [tier.heights for tier in plan.structure.tiers]
    assert steepest(heights, plan.structure.tread) <= MAX_RAKE + 1e-9


@pytest.mark.slow
def test_the_largest_bowl_keeps_rake_and_sight() -> None:
    plan = build_bowl(1_000_000)
    assert c_values(plan).min() >= 0.06
    heights = [tier.heights for tier in plan.structure.tiers]
    assert steepest(heights, plan.structure.tread) <= MAX_RAKE + 1e-9


def test_first_row_sees_the_touchline_over_the_boards() -> None:
    tier = build_bowl(65_000).structure.tiers[0]
    eye = tier.heights[0] + 1.2
    # Boards 0.9 m high stand 3.5 m behind the touchline, the eye 8.48 m.
    assert eye * 3.5 / 8.48 >= 0.9


def is_hidden(corners: np.ndarray, eye: np.ndarray, point: np.ndarray) -> bool:
    """Whether a triangle, of (T, 3, 3) corners, lies between an eye and a point.

    Those that the line's plane does not meet are left out; the rest by Moeller and Trumbore.
    """
    way = point - eye
    across = (corners - eye) @ np.array([way[2], 0.0, -way[0]])
    a, b, c = corners[(across.min(axis=1) <= 0) & (across.max(axis=1) >= 0)].transpose(1, 0, 2)
    side = np.cross(way, c - a)
    volume = ((b - a) * side).sum(axis=1)
    some = np.abs(volume) > 1e-12
    a, b, c, side, volume = a[some], b[some], c[some], side[some], volume[some]
    u = ((eye - a) * side).sum(axis=1) / volume
    across = np.cross(eye - a, b - a)
    v = across @ way / volume
    t = ((c - a) * across).sum(axis=1) / volume
    hits = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-3) & (t < 0.995)
    return bool(hits.any())


@pytest.mark.parametrize("seats", [2000, pytest.param(65_000, marks=pytest.mark.slow)])
def test_nothing_that_is_built_hides_the_touchline(seats: int) -> None:
    """Rails, parapets, roofs and boards; the first rows of a tier look over its parapet."""
    plan = build_bowl(seats)
    mesh = build_stadium_mesh(plan)
    corners = mesh.positions[mesh.triangles].astype(np.float64)
    x, y, z = plan.position.astype(np.float64)
    eyes = np.stack([x - 0.35 * np.sin(plan.yaw), y + 1.2, z - 0.35 * np.cos(plan.yaw)], axis=1)
    points = np.stack([x.clip(-52.5, 52.5), np.full(len(x), 0.05), z.clip(-34.0, 34.0)], axis=1)
    rng = np.random.default_rng(0)
    fronts = np.flatnonzero(np.isin(plan.row, [tier.first_row for tier in plan.structure.tiers]))
    few = np.concatenate([rng.choice(fronts, 20), rng.integers(0, plan.count, 20)])
    assert not any(is_hidden(corners, eyes[seat], points[seat]) for seat in few)
    low = eyes - [0.0, 0.8, 0.0]  # from the ground of a row one sees the row in front
    assert sum(is_hidden(corners, low[seat], points[seat]) for seat in few) > 15


def test_stand() -> None:
    c = c_values(build_stand(3, 2))
    # Front eye of row 1: 6 + 0.35 m from the focus, 1.2 m up; riser and tread 2 m.
    assert np.isinf(c[:2]).all()
    assert c[2:4] == pytest.approx([6.35 * 3.2 / 8.35 - 1.2] * 2)
    assert c[4:] == pytest.approx([8.35 * 5.2 / 10.35 - 3.2] * 2)
