"""Attendance and sides."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.engine.crowd.bowl import build_bowl
from tifo.engine.crowd.occupancy import assign_sides, away_block, occupancy_mask, select
from tifo.engine.crowd.seating import SeatPlan
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.crowd.stand import build_stand


@pytest.fixture(scope="module")
def bowl() -> SeatPlan:
    return build_bowl(65_000)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(7)


def test_select() -> None:
    plan = build_stand(4, 30)
    assert np.flatnonzero(select(plan, ["2|3"])).tolist() == [plan.find("2|3")]
    assert select(plan, ["rows 1-2"]).sum() == 60
    assert select(plan, ["columns 0"]).sum() == 4
    assert select(plan, ["rows 1-2 columns 5-7"]).sum() == 6
    assert select(plan, ["section 1"]).sum() == 60
    assert select(plan, ["rows 0", "columns 0"]).sum() == 33
    assert select(plan, ["rows 3-1000"]).sum() == 30
    assert not select(plan, []).any()


@pytest.mark.parametrize("text", ["rows 4", "columns 30-40", "section 2", "row 0 section 9"])
def test_a_selection_without_seats_is_an_error(text: str) -> None:
    with pytest.raises(ValueError, match="names no seat: rows are 0 to 3, columns 0 to 29"):
        select(build_stand(4, 30), [text])
    with pytest.raises(ValueError, match=r"no seat '9\|0'; rows are 0 to 3"):
        select(build_stand(4, 30), ["9|0"])


@pytest.mark.parametrize(
    ("share", "taken"), [(0.96, 62_400), (0.0, 0), (1.0, 65_000), (0.333, 21_645)]
)
def test_share(bowl: SeatPlan, rng: np.random.Generator, share: float, taken: int) -> None:
    assert occupancy_mask(bowl, CrowdSpec(occupancy=share), rng).sum() == taken


def test_empty_seats_are_spread(bowl: SeatPlan, rng: np.random.Generator) -> None:
    mask = occupancy_mask(bowl, CrowdSpec(occupancy=0.5), rng)
    held = np.array([mask[start:stop].mean() for _, start, stop in bowl.sections])
    assert held.min() > 0.4
    assert held.max() < 0.6


def test_order_share_then_empty_then_occupied(rng: np.random.Generator) -> None:
    plan = build_stand(10, 20)
    spec = CrowdSpec(occupancy=1.0, empty=("rows 2-4",), occupied=("3|5", "rows 4 columns 0-1"))
    mask = occupancy_mask(plan, spec, rng)
    assert mask.sum() == 200 - 60 + 3
    assert mask[plan.find("3|5")]
    assert not mask[plan.find("3|6")]
    nobody_else = CrowdSpec(occupancy=0.0, empty=("3|5",), occupied=("3|5",))
    assert np.flatnonzero(occupancy_mask(plan, nobody_else, rng)).tolist() == [plan.find("3|5")]
    with pytest.raises(ValueError, match="empty: there is no seat"):
        occupancy_mask(plan, CrowdSpec(empty=("99|0",)), rng)


def test_the_same_seed_gives_the_same_crowd(bowl: SeatPlan) -> None:
    spec = CrowdSpec(sides=2)
    masks = [occupancy_mask(bowl, spec, np.random.default_rng(s)) for s in (1, 1, 2)]
    assert (masks[0] == masks[1]).all()
    assert (masks[0] != masks[2]).any()
    sides = [assign_sides(bowl, spec, np.random.default_rng(s)) for s in (1, 1)]
    assert (sides[0] == sides[1]).all()


def test_one_side(bowl: SeatPlan, rng: np.random.Generator) -> None:
    sides = assign_sides(bowl, CrowdSpec(), rng)
    assert sides.dtype == np.int8
    assert np.unique(sides, return_counts=True)[1].tolist() == [1_950, 63_050]
    assert np.unique(sides).tolist() == [-1, 0]


def test_two_sides(bowl: SeatPlan, rng: np.random.Generator) -> None:
    sides = assign_sides(bowl, CrowdSpec(sides=2), rng)
    counts = dict(zip(*np.unique(sides, return_counts=True), strict=True))
    assert counts == {-1: 1_950, 0: 59_800, 1: 3_250}
    # Neighbouring sections, and at most one of them in part.
    held = np.array([(sides[start:stop] == 1).mean() for _, start, stop in bowl.sections])
    used = np.flatnonzero(held)
    assert used.tolist() == list(range(used[0], used[-1] + 1))
    assert ((held > 0) & (held < 1)).sum() <= 1
    # In the corner of +X and -Z, away from the main stand.
    x, _, z = bowl.position[:, sides == 1]
    assert x.min() > 40.0
    assert z.max() < 0.0


@pytest.mark.parametrize("count", [0, 1, 50, 3_250, 20_000])
def test_away_block_is_one_connected_piece(bowl: SeatPlan, count: int) -> None:
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    block = away_block(bowl, count)
    assert len(np.unique(block)) == count
    if count < 2:
        return
    tree = cKDTree(bowl.position[:, block].T)
    # Across a gangway it is less than 2.2 m, between two tiers less than 6 m.
    pairs = tree.query_pairs(6.0 if count > 3_000 else 2.2, output_type="ndarray")
    graph = csr_matrix((np.ones(len(pairs)), pairs.T), shape=(count, count))
    assert connected_components(graph, directed=False)[0] == 1


def test_everybody_neutral_or_away(rng: np.random.Generator) -> None:
    plan = build_bowl(10)
    assert (assign_sides(plan, CrowdSpec(neutrals=1.0), rng) == -1).all()
    spec = CrowdSpec(sides=2, away_share=1.0, neutrals=0.0)
    assert (assign_sides(plan, spec, rng) == 1).all()
    spec = CrowdSpec(sides=2, away_share=0.5, neutrals=0.5)
    assert sorted(assign_sides(plan, spec, rng).tolist()) == [-1] * 5 + [1] * 5


def test_a_stand_gives_its_right_end_away(rng: np.random.Generator) -> None:
    plan = build_stand(10, 20)
    sides = assign_sides(plan, CrowdSpec(sides=2, away_share=0.1, neutrals=0.0), rng)
    assert np.unique(plan.column[sides == 1]).tolist() == [18, 19]
    assert (sides == 1).sum() == 20
