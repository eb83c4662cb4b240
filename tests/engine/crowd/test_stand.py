"""The single stand on a grid."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.crowd.stadium import build_seats
from tifo.engine.crowd.stand import build_stand


def test_positions_are_the_formula() -> None:
    plan = build_stand(4, 60)
    assert plan.count == 240
    for label, place in (
        ("0|0", (0.0, 0.0, 0.0)),
        ("0|59", (88.5, 0.0, 0.0)),
        ("3|7", (10.5, 6.0, -6.0)),
    ):
        assert plan.position[:, plan.find(label)].tolist() == list(place)
    assert (plan.position[0] == plan.column * 1.5).all()
    assert (plan.position[1] == plan.row * 2.0).all()
    assert (plan.position[2] == plan.row * -2.0).all()
    assert (plan.yaw == 0.0).all()
    assert (plan.tier == 0).all()


def test_sections_are_runs_of_columns() -> None:
    plan = build_stand(4, 60)
    assert [(start, stop) for _, start, stop in plan.sections] == [(0, 80), (80, 160), (160, 240)]
    assert np.unique(plan.column[plan.section == 1]).tolist() == list(range(20, 40))
    assert (np.diff(plan.row[:80]) >= 0).all()


def test_own_steps_and_the_spec() -> None:
    plan = build_seats(CrowdSpec(layout="stand", rows=2, columns=2, step=0.5, rise=0.4, depth=0.8))
    wanted = [[0.0, 0.5, 0.0, 0.5], [0.0, 0.0, 0.4, 0.4], [0.0, 0.0, -0.8, -0.8]]
    assert plan.position == pytest.approx(np.array(wanted))
    assert build_seats(CrowdSpec(seats=77)).count == 77


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ((0, 5), "rows"),
        ((5, -1), "columns"),
        ((5, 2.5), "columns"),
        ((20_000, 1), "rows"),
        ((2_000, 2_000), "rows \\* columns"),
        ((2, 2, 0.0), "step"),
        ((2, 2, 1.0, -1.0), "rise"),
        ((2, 2, 1.0, 1.0, math.nan), "depth"),
    ],
)
def test_wrong_calls(arguments: tuple[int, int], name: str) -> None:
    with pytest.raises(ValueError, match=f"^{name} must be"):
        build_stand(*arguments)


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (1, 10_000), (10_000, 1)])
def test_extremes(rows: int, columns: int) -> None:
    plan = build_stand(rows, columns)
    assert plan.count == rows * columns
    assert plan.position[:, -1].tolist() == [
        1.5 * (columns - 1),
        2.0 * (rows - 1),
        -2.0 * (rows - 1),
    ]
