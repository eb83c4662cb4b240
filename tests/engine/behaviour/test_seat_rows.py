"""Rows as rings: against looking at everybody."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.engine.behaviour.seat_rows import SeatRows
from tifo.engine.crowd.bowl import build_bowl
from tifo.engine.crowd.seating import SeatPlan
from tifo.engine.crowd.stand import build_stand

PLANS = {
    "bowl": lambda: build_bowl(20_000),
    "two stands": lambda: build_bowl(3000),
    "stand": lambda: build_stand(12, 60, step=0.5, rise=0.4, depth=0.8),
}


@pytest.mark.parametrize("name", PLANS)
@pytest.mark.parametrize("share", [1.0, 0.6])
def test_links_lead_to_the_nearest_person_of_the_next_row(
    name: str, share: float, rng: np.random.Generator
) -> None:
    plan = PLANS[name]()
    present = rng.random(plan.count) < share
    rows = SeatRows(plan, present, reach=2)
    x, _, z = plan.position
    for agent in rng.choice(np.flatnonzero(present), 150):
        for link, way in ((1, -1), (3, 1)):
            others = np.flatnonzero(present & (plan.row == plan.row[agent] + way))
            found = rows.links[link, agent]
            if len(others) == 0:
                assert found == -1
                continue
            away = np.hypot(x[others] - x[agent], z[others] - z[agent])
            if found < 0:
                assert away.min() > 11.9 * rows.pitch
            else:
                shown = np.hypot(x[found] - x[agent], z[found] - z[agent])
                assert present[found]
                assert shown == pytest.approx(away.min(), abs=1e-4)


def test_distances_along_a_row_have_gangways_and_gaps_in_them() -> None:
    plan = build_stand(1, 10, step=0.5)
    present = np.ones(10, bool)
    present[4:7] = False
    rows = SeatRows(plan, present)
    np.testing.assert_allclose(rows.along[present], [0, 1, 2, 3, 7, 8, 9], atol=1e-5)
    assert rows.length[0] == pytest.approx(18.0)  # nine there, nine straight back
    assert rows.pitch == pytest.approx(0.5)
    bowl = build_bowl(30_000)
    all_there = SeatRows(bowl)
    steps = np.diff(all_there.along[all_there.order])
    assert np.median(steps) == pytest.approx(1.0, abs=0.02)
    # A gangway of 1.2 m beside a seat's own width.
    assert np.percentile(steps[steps > 2], 50) == pytest.approx(1.7 / 0.514, abs=0.4)


def test_the_sweep_goes_round_once_in_every_row() -> None:
    plan = build_bowl(30_000)
    rows = SeatRows(plan)
    marks, ring = rows.sweep(plan)
    for row in (0, 5, 20, int(plan.row.max()) - 1):
        ids = rows.order[plan.row[rows.order] == row]
        swept = marks[ids]
        assert np.diff(swept).min() > -1.0
        assert swept[0] == pytest.approx(0.0, abs=1e-3)
        assert 0.97 * ring < swept[-1] < ring


def test_nobody_there(rng: np.random.Generator) -> None:
    plan = build_stand(2, 3)
    rows = SeatRows(plan, np.zeros(6, bool))
    assert len(rows.order) == 0
    assert (rows.links == -1).all()
    with pytest.raises(ValueError, match="present has shape"):
        SeatRows(plan, np.ones(5, bool))
    with pytest.raises(ValueError, match="reach"):
        SeatRows(plan, reach=0)


def test_one_seat() -> None:
    plan: SeatPlan = build_stand(1, 1)
    rows = SeatRows(plan)
    assert rows.links.tolist() == [[-1]] * 3 + [[0]] + [[-1]] * 3
