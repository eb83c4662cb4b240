"""Ticks from real time."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tifo.engine.clock import Clock


def _pass(clock: Clock, delta: float) -> int:
    due = clock.due(delta)
    for _ in range(due):
        clock.advance()
    return due


def _shown(clock: Clock) -> float:
    """The time that pictures show, in pose ticks."""
    return clock.pose_tick - 1 + clock.alpha


@pytest.mark.parametrize(
    ("delta", "ticks"), [(0.0, 0), (0.016, 0), (1 / 60, 1), (0.05, 3), (10, 4)]
)
def test_ticks_that_are_due(delta: float, ticks: int) -> None:
    assert Clock().due(delta) == ticks


def test_what_is_left_over_counts_next_time() -> None:
    clock = Clock()
    assert [clock.due(0.01) for _ in range(10)] == [0, 1, 0, 1, 1, 0, 1, 0, 1, 1]


def test_a_long_pause_is_dropped_and_not_caught_up_later() -> None:
    clock = Clock()
    assert _pass(clock, 10.0) == 4
    assert _pass(clock, 0.0) == 0
    assert _pass(clock, 1 / 60) == 1
    # Exactly four is no overrun: the rest is kept.
    assert _pass(clock, 4.5 / 60) == 4
    assert _pass(clock, 0.5 / 60) == 1


@pytest.mark.parametrize("rate", [24, 30, 50, 60, 75, 144, 240, 1000])
def test_a_minute_of_even_frames_loses_no_tick(rate: int) -> None:
    clock = Clock()
    seconds = 60
    for _ in range(rate * seconds):
        _pass(clock, 1.0 / rate)
    assert abs(clock.tick - 60 * seconds) <= 1
    assert clock.seconds == pytest.approx(seconds, abs=0.02)


def test_every_second_tick_is_a_pose_tick() -> None:
    clock = Clock()
    seen = []
    for _ in range(5):
        seen.append((clock.tick, clock.pose_tick, clock.is_pose_tick))
        clock.advance()
    assert seen == [(0, 0, True), (1, 0, False), (2, 1, True), (3, 1, False), (4, 2, True)]


def test_alpha_by_hand() -> None:
    clock = Clock()
    assert clock.alpha == 0.0
    _pass(clock, 0.5 / 60)
    assert clock.alpha == pytest.approx(0.25)
    _pass(clock, 1.0 / 60)
    assert clock.tick == 1
    assert clock.alpha == pytest.approx(0.75)
    _pass(clock, 0.5 / 60)
    assert clock.tick == 2
    assert clock.alpha == pytest.approx(0.0, abs=1e-6)


@given(st.lists(st.floats(0.0, 4 / 60), max_size=60))
def test_shown_time_follows_real_time_without_a_jump(deltas: list[float]) -> None:
    clock = Clock()
    for delta in deltas:
        before = _shown(clock)
        _pass(clock, delta)
        assert _shown(clock) - before == pytest.approx(30.0 * delta, abs=1e-6)
        assert 0.0 <= clock.alpha <= 1.0
    assert _shown(clock) == pytest.approx(30.0 * sum(deltas) - 1.0, abs=1e-5)


@given(st.lists(st.floats(0.0, 1e6), max_size=30))
def test_shown_time_never_runs_back(deltas: list[float]) -> None:
    clock = Clock()
    for delta in deltas:
        before = _shown(clock)
        assert _pass(clock, delta) <= 4
        assert _shown(clock) >= before - 1e-9
        assert 0.0 <= clock.alpha <= 1.0


@pytest.mark.parametrize("delta", [-1e-9, -1.0, np.nan, np.inf, -np.inf])
def test_other_deltas_are_refused(delta: float) -> None:
    clock = Clock()
    with pytest.raises(ValueError, match=r"delta is .*, expected seconds >= 0"):
        clock.due(delta)
    assert clock.due(0.0) == 0
