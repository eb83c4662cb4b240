"""Neighbours who look or move alike, by hand, and casting that parts them."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from tifo.components import AgentAnimID, Appearance
from tifo.engine.crowd.casting import cast
from tifo.engine.crowd.clones import (
    Features,
    clone_features,
    clone_score,
    likenesses,
    report_clones,
)
from tifo.engine.crowd.neighbours import neighbour_pairs
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.crowd.stadium import build_seats


def row_of_five() -> Features:
    """0 and 1 are clones; 2 has 0's motion 3 poses later and a black shirt; 3, 4 differ."""
    looks = Appearance(*np.full((5, 5, 4), 100, np.uint8))
    looks.shirt[2:, :3] = 0
    looks.second = looks.shirt.copy()
    looks.pattern[4] = 2
    return clone_features(
        np.array([0, 0, 0, 1, 0], np.uint8),
        np.array([0.0, 0.0, 0.0, 0.0, 0.03], np.float32),
        np.array([1.0, 1.0, 1.05, 1.05, 1.05], np.float32),
        looks,
        np.array([7, 7, 7, 8, -1]),
        np.array([10.0, 10.0, 13.0, 13.0, 13.0], np.float32),
    )


@pytest.mark.parametrize(
    ("pair", "look", "motion"),
    [
        ((0, 1), 1.0, 1.0),
        # The shirt is off by 100 in each channel, counted once as shirt and half as its second
        # colour; the size by one clear difference.
        ((0, 2), np.exp(-0.5 * (1.5 * 3 * (100 / 30) ** 2 + 1.0)), np.exp(-0.5)),
        ((2, 3), np.exp(-3.0), 0.0),
        # Two girths of 15 mm, another pattern; nobody else's motion is shared with nobody.
        ((2, 4), np.exp(-0.5 * 4.0 - 1.5), 0.0),
        ((4, 4), 1.0, 0.0),
    ],
)
def test_pairs_of_a_row(pair: tuple[int, int], look: float, motion: float) -> None:
    found = likenesses(row_of_five(), np.array([pair], np.int32))
    np.testing.assert_allclose([found[0][0], found[1][0]], [look, motion], rtol=1e-5)


def test_looks_are_found_in_seconds_and_motions_in_a_minute() -> None:
    look, motion = np.array([1, 0, 1, 0], np.float32), np.array([0, 1, 1, 0], np.float32)
    expected = 1 - np.exp([-10 / 5, -10 / 60, -10 / 5 - 10 / 60, 0])
    np.testing.assert_allclose(clone_score(look, motion), expected, rtol=1e-6)


def test_the_report_of_a_row() -> None:
    pairs = np.array([(a, b) for a in range(5) for b in range(a + 1, min(a + 4, 5))], np.int32)
    report = report_clones(row_of_five(), pairs)
    assert report.pairs == 9
    assert report.found == 1
    assert report.worst == pytest.approx(1 - np.exp(-13 / 6), rel=1e-5)
    # 0 and 2, and 1 and 2 move alike by 0.607: 3 poses apart.
    assert report.same_look == pytest.approx(1 / 9)
    assert report.same_motion == pytest.approx(3 / 9)
    assert report.same_both == pytest.approx(1 / 9)


def test_plain_shirts_have_no_second_colour() -> None:
    looks = Appearance(*np.full((5, 2, 4), 100, np.uint8))
    looks.second[1] = 0
    zeros = np.zeros(2, np.float32)
    features = clone_features(zeros.astype(np.uint8), zeros, zeros, looks, zeros.astype(int), zeros)
    pair = np.array([[0, 1]], np.int32)
    assert features.look(pair)[0] == pytest.approx(1.0)


def test_neighbours_within_three_seats_of_a_stand() -> None:
    spec = CrowdSpec(layout="stand", rows=9, columns=11, step=0.6, rise=0.4, depth=0.8)
    plan = build_seats(spec)
    present = np.ones(plan.count, np.bool_)
    present[plan.find("4|6")] = False
    pairs = neighbour_pairs(plan, present)
    assert (pairs[:, 0] < pairs[:, 1]).all()
    assert len(np.unique(pairs, axis=0)) == len(pairs)
    # Brute force over the seats' numbers, which a stand's places agree with.
    row, column = plan.row.astype(int), plan.column.astype(int)
    near = (row[:, None] - row) ** 2 + (column[:, None] - column) ** 2 <= 9
    near &= present[:, None] & present
    expected = np.argwhere(np.triu(near, 1))
    np.testing.assert_array_equal(pairs, expected)
    middle = plan.find("4|5")
    assert (pairs == middle).any(axis=1).sum() == 28 - 1


def test_neighbours_in_a_bowl_are_near() -> None:
    plan = build_seats(CrowdSpec(seats=3000))
    pairs = neighbour_pairs(plan, np.ones(plan.count, np.bool_))
    away = np.linalg.norm(np.diff(plan.position[:, pairs], axis=2)[..., 0], axis=0)
    assert away.max() < 4.0
    assert 10 < 2 * len(pairs) / plan.count < 28.5
    assert len(neighbour_pairs(plan, np.zeros(plan.count, np.bool_))) == 0


def drawn(count: int, seed: int) -> tuple[Features, Appearance, AgentAnimID]:
    """A crowd of few colours and streams, so that many neighbours are alike."""
    rng = np.random.default_rng(seed)
    greys = rng.choice(np.array([20, 90, 200], np.uint8), (5, count, 1))
    looks = Appearance(*np.repeat(greys, 4, axis=2))
    looks.second = looks.shirt.copy()
    anim = AgentAnimID.allocate(1, count, 0)
    anim.row[0] = rng.integers(0, 12, count)
    anim.start[0] = anim.target[0] = rng.uniform(0, 58, count)
    kind = rng.integers(0, 2, count).astype(np.uint8)
    flat = np.zeros(count, np.float32)
    return features_of(kind, flat, looks, anim), looks, anim


def features_of(kind: object, flat: object, looks: Appearance, anim: AgentAnimID) -> Features:
    return clone_features(kind, flat, flat, looks, anim.row[0], anim.target[0])  # type: ignore[arg-type]


def test_casting_parts_clones_and_keeps_every_share() -> None:
    plan = build_seats(CrowdSpec(layout="stand", rows=12, columns=40))
    pairs = neighbour_pairs(plan, np.ones(plan.count, np.bool_))
    features, looks, anim = drawn(plan.count, 4)
    rng = np.random.default_rng(9)
    side = rng.integers(0, 3, plan.count) - 1
    before = report_clones(features, pairs)
    casting = cast(features, pairs, side, anim.row[0].astype(np.int64) % 3, rng)
    outfits = [Counter(looks.shirt[side == s, 0].tolist()) for s in (0, 1)]
    unmoved = looks.shirt[side == -1].copy()
    rows = Counter(zip(anim.row[0].tolist(), anim.target[0].tolist(), strict=True))
    classes = anim.row[0] % 3
    casting.dress(looks)
    casting.move(anim)
    after = report_clones(
        features_of(features.kinds[:, 0], np.zeros(plan.count, np.float32), looks, anim), pairs
    )
    assert after.score < 0.9 * before.score
    assert after.found < before.found
    assert after.same_motion < 0.5 * before.same_motion
    assert [Counter(looks.shirt[side == s, 0].tolist()) for s in (0, 1)] == outfits
    np.testing.assert_array_equal(looks.shirt[side == -1], unmoved)
    assert Counter(zip(anim.row[0].tolist(), anim.target[0].tolist(), strict=True)) == rows
    np.testing.assert_array_equal(anim.row[0] % 3, classes)
    np.testing.assert_array_equal(np.sort(casting.looks), np.arange(plan.count))


def test_every_round_of_casting_lowers_the_sum() -> None:
    plan = build_seats(CrowdSpec(layout="stand", rows=10, columns=20))
    pairs = neighbour_pairs(plan, np.ones(plan.count, np.bool_))
    features, _, _ = drawn(plan.count, 5)
    same = np.zeros(plan.count, np.int64)
    scores = []
    for passes in range(5):
        got = cast(features, pairs, same, same, np.random.default_rng(1), passes=passes)
        now = features.swapped(got.looks, looks=True).swapped(got.motions, looks=False)
        scores.append(float(clone_score(*likenesses(now, pairs)).sum()))
    assert all(later <= earlier + 1e-3 for earlier, later in pairwise(scores))
    assert scores[-1] < scores[0]


def test_casting_is_reproducible_and_copes_with_nobody() -> None:
    plan = build_seats(CrowdSpec(layout="stand", rows=6, columns=20))
    pairs = neighbour_pairs(plan, np.ones(plan.count, np.bool_))
    features, _, _ = drawn(plan.count, 6)
    same = np.zeros(plan.count, np.int64)
    first, second = (cast(features, pairs, same, same, np.random.default_rng(3)) for _ in range(2))
    np.testing.assert_array_equal(first.looks, second.looks)
    np.testing.assert_array_equal(first.motions, second.motions)
    alone = cast(features, np.zeros((0, 2), np.int32), same, same, np.random.default_rng(3))
    np.testing.assert_array_equal(alone.looks, np.arange(plan.count))
