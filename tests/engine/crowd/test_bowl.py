"""Bowls of every size: exact numbers, order, spacing, labels, facing."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.engine.crowd.bowl import build_bowl
from tifo.engine.crowd.seating import SeatPlan

SIZES = [1, 2, 26, 27, 100, 1_000, 5_000, 10_600, 12_000, 20_000, 65_000]


@pytest.fixture(scope="module")
def plan() -> SeatPlan:
    return build_bowl(65_000)


def check(plan: SeatPlan) -> None:
    """What must hold for every plan."""
    n = plan.count
    assert plan.position.shape == (3, n)
    assert plan.position.dtype == np.float32
    assert plan.yaw.dtype == np.float32
    assert all(a.dtype == np.int32 for a in (plan.row, plan.column, plan.section))
    assert plan.tier.dtype == np.int8
    assert all(a.shape == (n,) for a in (plan.yaw, plan.row, plan.column, plan.section, plan.tier))
    assert np.isfinite(plan.position).all()
    assert np.isfinite(plan.yaw).all()
    # Sections are contiguous and cover everything; inside them row by row, left to right.
    edges = [0]
    for index, (name, start, stop) in enumerate(plan.sections):
        assert name == str(index)
        assert start == edges[-1]
        assert stop > start
        assert (plan.section[start:stop] == index).all()
        edges.append(stop)
    assert edges[-1] == n
    key = (plan.section.astype(np.int64) << 40) | (plan.row.astype(np.int64) << 20) | plan.column
    assert (np.diff(key) > 0).all()
    # Labels are unique; rows and columns count without holes.
    label = plan.row.astype(np.int64) << 20 | plan.column
    assert len(np.unique(label)) == n
    rows, counts = np.unique(plan.row, return_counts=True)
    assert rows.tolist() == list(range(len(rows)))
    assert plan.column.min() == 0
    assert (counts == [plan.column[plan.row == r].max() + 1 for r in rows]).all()
    # A row lies in one tier at one height, higher rows higher.
    height = np.array([plan.position[1, plan.row == r][0] for r in rows])
    assert (plan.position[1] == height[plan.row]).all()
    assert (np.diff(height) > 0).all()


@pytest.mark.parametrize("seats", SIZES)
def test_plan(seats: int) -> None:
    plan = build_bowl(seats)
    assert plan.count == seats
    check(plan)


@given(st.integers(1, 30_000))
@settings(max_examples=15, deadline=None)
def test_exactly_as_many_seats(seats: int) -> None:
    assert build_bowl(seats).count == seats


@pytest.mark.slow
def test_a_million() -> None:
    plan = build_bowl(1_000_000)
    assert plan.count == 1_000_000
    assert len(plan.structure.tiers) == 3


@pytest.mark.parametrize("seats", [0, -5, 1_000_001, 2.5, True, "9", float("nan")])
def test_wrong_number(seats: object) -> None:
    with pytest.raises(ValueError, match="seats must be a whole number from 1 to 1,000,000"):
        build_bowl(seats)  # type: ignore[arg-type]


def test_tiers() -> None:
    assert [len(build_bowl(n).structure.tiers) for n in (5_000, 65_000, 120_000)] == [1, 2, 3]


def test_fast(plan: SeatPlan) -> None:
    spent = []
    for _ in range(3):
        start = time.perf_counter()
        build_bowl(plan.count)
        spent.append(time.perf_counter() - start)
    assert min(spent) < 0.5


def test_nobody_sits_on_another_or_on_the_pitch(plan: SeatPlan) -> None:
    from scipy.spatial import cKDTree

    x, _, z = plan.position
    assert (np.maximum(np.abs(x) - 52.5, np.abs(z) - 34.0) > 5.0).all()
    near, _ = cKDTree(plan.position.T).query(plan.position.T, k=2)
    assert near[:, 1].min() > 0.49
    assert near[:, 1].max() < 0.95


def test_neighbours_and_gangways(plan: SeatPlan) -> None:
    order = np.lexsort((plan.column, plan.row))
    same_row = np.diff(plan.row[order]) == 0
    gap = np.linalg.norm(np.diff(plan.position[:, order].astype(np.float64), axis=1), axis=0)
    crosses = np.diff(plan.section[order]) != 0
    inside = gap[same_row & ~crosses]
    assert inside.min() > 0.49
    assert inside.max() < 0.56
    across = gap[same_row & crosses]
    # A gangway of 1.2 m and half a seat on both sides, along the chord of the row.
    assert across.min() > 1.6
    for row in (0, 40):
        runs = np.unique(plan.section[plan.row == row], return_counts=True)[1]
        assert runs.max() <= 28


def test_metres_of_row_for_each_seat(plan: SeatPlan) -> None:
    for tier in plan.structure.tiers:
        for b, block in enumerate(tier.blocks):
            if not block.is_arc and tier.counts[0, b] == tier.counts[:, b].max():
                assert 0.50 <= block.length(0.0) / tier.counts[0, b] <= 0.60


def test_everybody_faces_the_pitch(plan: SeatPlan) -> None:
    x, _, z = plan.position.astype(np.float64)
    ahead = np.stack([np.sin(plan.yaw), np.cos(plan.yaw)])
    # A straight line ahead crosses the pitch or its run-off, and nobody looks along the stand.
    to_centre = np.stack([-x, -z]) / np.hypot(x, z)
    assert (ahead * to_centre).sum(axis=0).min() > 0.6
    far = (z < -42.0) & (np.abs(x) < 50.0)
    main = (z > 42.0) & (np.abs(x) < 50.0)
    assert np.abs(plan.yaw[far]).max() < 1e-6
    assert np.abs(np.abs(plan.yaw[main]) - np.pi).max() < 1e-6
    right = (x > 61.0) & (np.abs(z) < 31.0)
    assert plan.yaw[right] == pytest.approx(-np.pi / 2)


def test_columns_run_from_left_to_right_seen_from_the_pitch(plan: SeatPlan) -> None:
    order = np.lexsort((plan.column, plan.row))
    step = np.diff(plan.position[:, order].astype(np.float64), axis=1)
    # Right of someone who looks at the stand is left of who sits in it: yaw turned by +90 degrees.
    yaw = plan.yaw[order][:-1]
    along = step[0] * np.cos(yaw) - step[2] * np.sin(yaw)
    same = (np.diff(plan.row[order]) == 0) & (np.diff(plan.column[order]) == 1)
    assert along[same].min() > 0.0


def test_mirror_symmetry() -> None:
    plan = build_bowl(3_000)
    x, y, z = plan.position
    rows = plan.row < plan.row.max()
    both = {(round(float(a), 3), float(b), round(float(c), 3)) for a, b, c in plan.position.T[rows]}
    mirrored = {
        (round(-float(a), 3), float(b), round(float(c), 3))
        for a, b, c in zip(x[rows], y[rows], z[rows], strict=True)
    }
    assert both == mirrored


def test_a_trimmed_last_row_is_shared_evenly() -> None:
    plan = build_bowl(64_321)
    tier = plan.structure.tiers[-1]
    last, before = tier.counts[-1], tier.counts[-2]
    assert 0 < last.sum() < before.sum()
    share = last / before
    assert share.max() - share.min() < 0.15


def test_labels(plan: SeatPlan) -> None:
    for index in (0, 12_345, 64_999):
        assert plan.find(plan.label(index)) == index
    assert plan.label(plan.find("12|345")) == "12|345"
    with pytest.raises(ValueError, match=r"no seat '0\|9999'; row 0 has columns 0 to"):
        plan.find("0|9999")
    with pytest.raises(ValueError, match="rows are 0 to"):
        plan.find("999|0")
    with pytest.raises(ValueError, match="seat label"):
        plan.find("front row")
    for index in (-1, 65_000):
        with pytest.raises(ValueError, match="from 0 to 64999"):
            plan.label(index)


def test_arrays_can_not_be_changed(plan: SeatPlan) -> None:
    with pytest.raises(ValueError, match="read-only"):
        plan.position[0, 0] = 1.0
