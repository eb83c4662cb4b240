"""Spectators at rest do something else now and then."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tifo.components import MotionState
from tifo.engine.behaviour import Goal, wander
from tifo.engine.behaviour.reactions import settle


def test_the_innate_shares_stay(crowd: Any) -> None:
    state, library = crowd.state, crowd.library
    state.innate[:] = state.wanted[:] = 0
    # After six mean times 0.25 % have never changed.
    for _ in range(150 * 30):
        wander(state, library, crowd.rng)
    shares = np.bincount(state.innate, minlength=len(library.names)) / len(state.innate)
    np.testing.assert_allclose(shares, library.innate, atol=0.03)
    np.testing.assert_array_equal(state.wanted, state.innate)


def test_everyone_changes_every_25_seconds_in_the_mean(crowd: Any) -> None:
    ticks = 900
    changed = sum(len(wander(crowd.state, crowd.library, crowd.rng)) for _ in range(ticks))
    assert changed == pytest.approx(len(crowd.present) * ticks / 30 / 25, rel=0.06)


def test_agents_that_react_or_will_react_are_not_disturbed(crowd: Any) -> None:
    reacting = crowd.answer(Goal(0), 0)
    settle(crowd.state, 20)
    before = crowd.state.wanted[reacting].copy()
    for _ in range(300):
        resting = wander(crowd.state, crowd.library, crowd.rng)
        assert not np.isin(resting, reacting).any()
    np.testing.assert_array_equal(crowd.state.wanted[reacting], before)


def test_a_crowd_of_one_wanders_too(crowd: Any) -> None:
    alone = MotionState.allocate(np.zeros(1, np.int16))
    seen = set()
    for _ in range(20_000):
        wander(alone, crowd.library, crowd.rng)
        seen.add(int(alone.wanted[0]))
    assert len(seen) > 1
