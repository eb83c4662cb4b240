"""Crowds are cast: neighbours are no clones of each other."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import tifo
from tifo.systems.simulation import Simulation

SPEC = tifo.CrowdSpec(
    layout="stand", rows=30, columns=60, step=0.5, depth=0.8, rise=0.4, sides=2, seed=11
)


@pytest.fixture(scope="module")
def crowds() -> dict[bool, Simulation]:
    return {casting: Simulation(SPEC.replace(casting=casting)) for casting in (False, True)}


def test_neighbours_are_less_alike(crowds: dict[bool, Simulation]) -> None:
    before, after = (tifo.clone_report(crowds[casting].crowd) for casting in (False, True))
    assert before.pairs == after.pairs > 15_000
    assert after.score < before.score
    assert after.found <= before.found
    # The target of docs/variety.md.
    assert after.same_both == 0.0
    assert after.same_look <= 1e-4
    assert after.same_motion <= 2e-4 < before.same_motion


def test_shares_are_as_they_were_drawn(crowds: dict[bool, Simulation]) -> None:
    drawn, cast = crowds[False].crowd, crowds[True].crowd
    np.testing.assert_array_equal(drawn.team.side, cast.team.side)
    np.testing.assert_array_equal(drawn.body.kind, cast.body.kind)
    np.testing.assert_array_equal(drawn.motion.shown, cast.motion.shown)
    for side in (-1, 0, 1):
        for kind in (0, 1, 2):
            some = (drawn.team.side == side) & (drawn.body.kind == kind)
            for name in ("skin", "hair", "shirt", "trousers"):
                one, other = (getattr(c.appearance, name)[some] for c in (drawn, cast))
                assert sorted(map(tuple, one.tolist())) == sorted(map(tuple, other.tolist()))
            patterns = [np.bincount(c.appearance.pattern[some], minlength=5) for c in (drawn, cast)]
            np.testing.assert_array_equal(*patterns)
    assert drawn.anim is not None
    assert cast.anim is not None
    assert (drawn.anim.row[0] != cast.anim.row[0]).any()
    for motion in np.unique(drawn.motion.shown):
        some = drawn.motion.shown == motion
        rows = [np.sort(c.anim.row[0, some]) for c in (drawn, cast)]  # type: ignore[union-attr]
        np.testing.assert_array_equal(*rows)
    np.testing.assert_array_equal(cast.anim.start, cast.anim.target)


def test_the_same_seed_casts_alike() -> None:
    spec = SPEC.replace(rows=10)
    first, second = Simulation(spec), Simulation(spec)
    assert first.crowd.state_hash() == second.crowd.state_hash()
    np.testing.assert_array_equal(first.crowd.appearance.shirt, second.crowd.appearance.shirt)
    first.close()
    second.close()


def test_clones_that_somebody_made_are_reported(
    simulate: Callable[..., Simulation],
) -> None:
    crowd = simulate(rows=4, columns=10, occupancy=1.0, children=0.0, old=0.0).crowd
    report = tifo.clone_report(crowd)
    for name in ("skin", "hair", "shirt", "trousers", "second", "pattern"):
        column = getattr(crowd.appearance, name)
        column[:] = column[0]
    crowd.body.girth[:] = 0.0
    crowd.placement.scale[:] = 1.0
    assert crowd.anim is not None
    crowd.anim.row[0], crowd.anim.target[0] = 0, 5.0
    after = tifo.clone_report(crowd)
    assert report.same_both < 0.1
    assert after.same_both == 1.0
    assert after.score == pytest.approx(1 - np.exp(-13 / 6), rel=1e-5)


def test_baked_crowds_swap_looks_only(simulate: Callable[..., Simulation]) -> None:
    report = tifo.clone_report(simulate(poses="baked").crowd)
    assert report.same_motion == 0.0
