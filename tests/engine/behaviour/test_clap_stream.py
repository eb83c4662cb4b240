"""Beats as offsets: what a stream shows at them is the beat."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.engine.behaviour.clap_stream import ClapOffsets, clap_offset, clap_slope
from tifo.engine.behaviour.hearing import Hearing
from tifo.engine.behaviour.rhythm import Rhythm

F32 = np.float32


def test_an_offset_counts_back_from_the_head() -> None:
    # Head at phase 0.25 of 8 poses: phase 0 was two poses ago, phase 0.5 six poses ago.
    np.testing.assert_allclose(clap_offset(np.array([0.0, 0.5, 0.25], F32), 0.25, 8.0), [2, 6, 0])


def test_the_slope_is_one_minus_the_rates_ratio() -> None:
    # At 30 poses a second a period of 10 poses is 3 claps a second.
    slope = clap_slope(np.array([3.0, 1.5, 3.3], F32), 10.0)
    np.testing.assert_allclose(slope, [0.0, 0.5, -0.1], atol=1e-6)


@pytest.mark.parametrize("slow", [False, True])
def test_people_show_the_beat_that_they_clap(slow: bool, rng: np.random.Generator) -> None:
    """Over 20 s of clapping, evaluated at each tick as the shader would."""
    count, period, longest = 300, 9.1, 58.0
    rhythm = Rhythm(Hearing(np.zeros(count, int)), rng)
    agents = np.arange(count)
    if slow:
        rhythm.rate[:] = 0.5 * rhythm.frequency
        rhythm.is_slow[:] = True
    offsets = ClapOffsets(count, longest)
    written = 0
    for tick in range(600):
        head = tick / period
        change = offsets.step(tick, agents, rhythm.phase, rhythm.speed, head % 1.0, period)
        written += len(change.agents)
        assert ((change.start >= 0) & (change.start <= longest)).all()
        assert (np.abs(change.slope) < 1.0).all()
        shown = head - offsets.offset(agents, tick) / period
        wrong = shown - rhythm.phase
        assert np.abs(wrong - np.rint(wrong)).max() < 0.035
        rhythm.step(agents, 1 / 30)
    assert written / count < 0.12 * 600  # most ticks need no write


def test_a_steady_beat_is_written_only_when_the_history_ends() -> None:
    agents = np.arange(1)
    offsets = ClapOffsets(1, 58.0)
    ticks = []
    for tick in range(300):
        beat = np.array([tick * 1.5 / 30 % 1.0], F32)  # half of the stream's 3 a second
        change = offsets.step(tick, agents, beat, np.array([1.5], F32), tick / 10 % 1.0, 10.0)
        ticks += [tick] * len(change.agents)
    # From offsets below 10 the history of 58 lasts about a hundred ticks at slope 1/2.
    assert ticks[0] == 0
    assert len(ticks) <= 4
    assert np.diff(ticks).min() > 90


def test_who_left_is_written_anew() -> None:
    offsets = ClapOffsets(3, 58.0)
    still = (np.zeros(3, F32), np.full(3, 3.0, F32), 0.0, 10.0)
    assert len(offsets.step(0, np.arange(3), *still).agents) == 3
    assert len(offsets.step(10, np.arange(3), *still).agents) == 0
    offsets.forget(np.array([1]))
    assert offsets.step(20, np.arange(3), *still).agents.tolist() == [1]


def test_periods_must_fit_twice_into_the_history() -> None:
    with pytest.raises(ValueError, match="period"):
        ClapOffsets(1, 15.0).step(0, np.arange(1), np.zeros(1, F32), np.ones(1, F32), 0.0, 8.0)
    with pytest.raises(ValueError, match="longest"):
        ClapOffsets(1, 0.0)
