"""Pairs kept from tick to tick are those that are near now, while people walk, come and go."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.components import Errand, Leg, Walk
from tifo.engine.behaviour.nearby import MARGIN, Nearby
from tifo.engine.behaviour.steering import Pairs

REACH = 1.5


def crowd_of(count: int) -> Walk:
    """That many people on gangways."""
    walk = Walk()
    for agent in range(count):
        walk.add(np.zeros((2, 23), np.float32), agent=agent, mouth=-1, run=-1)
    return walk


def as_sets(pairs: Pairs, walk: Walk) -> set[frozenset[int]]:
    found = [frozenset(walk.agent[[a, b]].tolist()) for a, b in zip(*pairs[:2], strict=True)]
    assert len(set(found)) == len(found)
    return set(found)


def all_near(x: np.ndarray, z: np.ndarray, walk: Walk) -> set[frozenset[int]]:
    apart = (x[:, None] - x) ** 2 + (z[:, None] - z) ** 2 <= np.float32(REACH * REACH)
    first, second = np.nonzero(np.triu(apart, 1))
    return {
        frozenset(walk.agent[[a, b]].tolist())
        for a, b in zip(first.tolist(), second.tolist(), strict=True)
    }


@pytest.mark.parametrize("seed", range(4))
def test_pairs_are_found_while_people_walk_come_and_go(seed: int) -> None:
    rng = np.random.default_rng(seed)
    walk, nearby = crowd_of(60), Nearby(REACH)
    x, z = rng.uniform(-5, 5, (2, 60)).astype(np.float32)
    velocity = rng.normal(0.0, 0.04, (2, 60)).astype(np.float32)
    for tick in range(120):
        assert as_sets(nearby.pairs(walk, x, z), walk) == all_near(x, z, walk)
        x, z = x + velocity[0, : len(x)], z + velocity[1, : len(z)]
        if tick % 7 == 0:
            walk.add(np.zeros((2, 23), np.float32), agent=1000 + tick, mouth=-1, run=-1)
            place = rng.uniform(-5, 5, (2, 1)).astype(np.float32)
            x, z = np.append(x, place[0]), np.append(z, place[1])
            velocity = np.append(velocity, rng.normal(0, 0.04, (2, 1)).astype(np.float32), axis=1)
        if tick % 5 == 0:
            # Sometimes even before somebody new was seen.
            mask = rng.random(len(x)) > 0.05
            nearby.keep(mask)
            walk.keep(mask)
            x, z, velocity = x[mask], z[mask], velocity[:, mask]


def test_people_in_different_rows_do_not_meet_until_they_come_out() -> None:
    walk = Walk()
    for agent, run in enumerate((3, 3, 8)):
        way = np.zeros((6, 23), np.float32)
        way[:5, Leg.IN_ROW] = 1.0
        walk.add(way, agent=agent, errand=Errand.LEAVE, mouth=5, run=run)
    x, z = np.array([0.0, 0.5, 0.2], np.float32), np.array([0.0, 0.0, 0.8], np.float32)
    nearby = Nearby(REACH)
    assert as_sets(nearby.pairs(walk, x, z), walk) == {frozenset((0, 1))}
    # Three vertices before the way out of it lies no less than a seat, more than half the margin.
    walk.vertex[2] = 3
    x = x + np.float32(0.51 * MARGIN)
    assert len(nearby.pairs(walk, x, z).a) == 3
