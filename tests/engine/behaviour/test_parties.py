"""Who came with whom."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.components import Party, PartyKind
from tifo.engine.behaviour.parties import (
    FOOTBALL,
    GENERAL_PUBLIC,
    PartyMix,
    form_parties,
    seat_parties,
    turn_towards,
)
from tifo.engine.crowd.bowl import build_bowl
from tifo.engine.crowd.seating import SeatPlan
from tifo.engine.crowd.stand import build_stand


def sizes_of(party: Party, taken: np.ndarray) -> np.ndarray:
    return np.bincount(party.party[taken])


@pytest.mark.parametrize("whole", [True, False])
def test_the_general_public_comes_in_pairs(whole: bool, rng: np.random.Generator) -> None:
    plan = build_bowl(30_000)
    taken = rng.random(plan.count) < 0.96
    if whole:
        taken, party = seat_parties(plan, 28_800, GENERAL_PUBLIC, rng)
    else:
        party = form_parties(plan, taken, GENERAL_PUBLIC, rng)
    sizes = sizes_of(party, taken)
    groups = sizes[sizes > 1]
    shares = [np.mean(groups == k) for k in (2, 3, 4)] + [np.mean(groups >= 5)]
    np.testing.assert_allclose(shares, [0.71, 0.21, 0.06, 0.02], atol=0.015)


def test_at_football_a_quarter_comes_alone(rng: np.random.Generator) -> None:
    plan = build_bowl(30_000)
    taken, party = seat_parties(plan, 28_500, FOOTBALL, rng)
    sizes = sizes_of(party, taken)
    assert (sizes == 1).sum() / taken.sum() == pytest.approx(0.25, abs=0.015)
    assert sizes[sizes > 1].mean() == pytest.approx(4.0, abs=0.12)


def check(plan: SeatPlan, taken: np.ndarray, party: Party) -> None:
    """What holds for all parties."""
    assert ((party.party >= 0) == taken).all()
    sizes = np.bincount(party.party[taken]) if taken.any() else np.zeros(0, int)
    assert (sizes > 0).all()
    own = party.party
    for column in (party.leader, party.nearest, party.partner):
        some = np.flatnonzero(column >= 0)
        assert (own[column[some]] == own[some]).all()
    hugging = np.flatnonzero(party.partner >= 0)
    assert (party.partner[party.partner[hugging]] == hugging).all()
    assert (party.partner[hugging] != hugging).all()
    assert (plan.row[party.partner[hugging]] == plan.row[hugging]).all()
    alone = taken & (np.bincount(own[taken], minlength=1)[np.maximum(own, 0)] == 1)
    assert (party.nearest[taken & ~alone] >= 0).all()
    assert (party.nearest[alone] == -1).all()
    assert (party.kind[alone] == PartyKind.ALONE).all()
    if len(sizes):
        adults = np.bincount(own[taken & ~party.is_child], minlength=len(sizes))
        assert (adults >= 1).all()
        children = sizes - adults
        assert (children <= 2 * adults).all()
    assert (party.kind[party.is_child] == PartyKind.FAMILY).all()
    leaders = party.leader[party.leader >= 0]
    assert not party.is_child[leaders].any()


@settings(max_examples=60, deadline=None)
@given(
    rows=st.integers(1, 9),
    columns=st.integers(1, 40),
    share=st.floats(0, 1),
    alone=st.floats(0, 1),
    children=st.floats(0, 0.5),
    seed=st.integers(0, 999),
)
def test_parties_are_sound_in_any_crowd(
    rows: int, columns: int, share: float, alone: float, children: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    plan = build_stand(rows, columns, step=0.5, depth=0.8)
    mix = PartyMix(alone=alone, sizes=(3, 2, 1, 0, 1), children=children)
    taken = rng.random(plan.count) < share
    check(plan, taken, form_parties(plan, taken, mix, rng))
    people = round(share * plan.count)
    mask, party = seat_parties(plan, people, mix, rng)
    assert mask.sum() == people
    check(plan, mask, party)


def test_people_who_came_together_sit_together(rng: np.random.Generator) -> None:
    plan = build_bowl(12_000)
    taken, party = seat_parties(plan, 9000, FOOTBALL, rng)
    check(plan, taken, party)
    order = np.lexsort((plan.column, plan.row, party.party))
    order = order[party.party[order] >= 0]
    same = np.diff(party.party[order]) == 0
    a, b = order[:-1][same], order[1:][same]
    beside = (plan.row[a] == plan.row[b]) & (plan.column[b] - plan.column[a] == 1)
    # Hardly a party had to be parted over two rows, and then its rows are neighbours.
    assert beside.mean() > 0.99
    assert (np.abs(plan.row[b] - plan.row[a]) <= 1).mean() > 0.999
    to_nearest = np.flatnonzero(party.nearest >= 0)
    away = plan.position[:, to_nearest] - plan.position[:, party.nearest[to_nearest]]
    assert np.percentile(np.linalg.norm(away, axis=0), 98) < 0.6


def test_hand_made_rows() -> None:
    """Four seats, two pairs: partners are beside each other, not across the pairs."""
    plan = build_stand(1, 4, step=0.5)
    mix = PartyMix(alone=0.0, sizes=(1.0,), children=0.0, couples=1.0)
    party = form_parties(plan, np.ones(4, bool), mix, np.random.default_rng(0))
    assert party.party.tolist() == [0, 0, 1, 1]
    assert party.partner.tolist() == [1, 0, 3, 2]
    assert party.nearest.tolist() == [1, 0, 3, 2]
    assert (party.kind == PartyKind.COUPLE).all()
    assert (party.leader == -1).all()


def test_five_friends_make_two_hugging_pairs_and_one_looks_on() -> None:
    plan = build_stand(1, 5, step=0.5)
    mix = PartyMix(alone=0.0, sizes=(0, 0, 0, 1.0), children=0.0, led=1.0)
    party = form_parties(plan, np.ones(5, bool), mix, np.random.default_rng(0))
    assert party.partner.tolist() == [1, 0, 3, 2, -1]
    assert party.nearest[4] == 3
    assert len(np.unique(party.leader)) == 1


def test_children_come_with_adults(rng: np.random.Generator) -> None:
    plan = build_bowl(12_000)
    mix = PartyMix(alone=0.1, sizes=(0.5, 0.3, 0.2), children=0.2)
    taken, party = seat_parties(plan, 11_000, mix, rng)
    check(plan, taken, party)
    assert party.is_child.mean() * 12_000 / 11_000 == pytest.approx(0.2, abs=0.01)
    families = party.kind == PartyKind.FAMILY
    assert (party.leader[families] >= 0).all()


def test_people_turn_to_each_other() -> None:
    plan = build_stand(2, 3, step=1.0, depth=1.0)  # all face +Z
    turns = turn_towards(plan, np.array([0, 1, 0, 3, 0]), np.array([1, 0, 3, 0, -1]))
    np.testing.assert_allclose(turns[[0, 1, 3, 4]], [np.pi / 2, -np.pi / 2, 0, 0], atol=1e-6)
    assert abs(turns[2]) == pytest.approx(np.pi)


@pytest.mark.parametrize(
    "values",
    [
        {"alone": -0.1, "sizes": (1.0,)},
        {"alone": np.nan, "sizes": (1.0,)},
        {"alone": 0.1, "sizes": ()},
        {"alone": 0.1, "sizes": (0.0, 0.0)},
        {"alone": 0.1, "sizes": (-1.0, 2.0)},
        {"alone": 0.1, "sizes": (1.0,), "children": 0.9},
    ],
)
def test_impossible_mixes_are_refused(values: dict) -> None:
    with pytest.raises(ValueError, match="expected"):
        PartyMix(**values)


def test_wrong_arguments_are_named(rng: np.random.Generator) -> None:
    plan = build_stand(2, 3)
    with pytest.raises(ValueError, match="people"):
        seat_parties(plan, 7, FOOTBALL, rng)
    with pytest.raises(ValueError, match="occupied"):
        form_parties(plan, np.ones(5, bool), FOOTBALL, rng)
