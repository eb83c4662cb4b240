"""Moods over a match: who scores is glad, the others are not, and both forget."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.benchmarks.moods import MATCH, moods


@pytest.mark.slow
def test_a_goal_lifts_one_side_and_both_forget_it() -> None:
    assert MATCH[2] == (17.0, "goal", 0)
    minutes, mood, excitement = moods(300, 25.0, 1)
    assert len(minutes) == 250
    assert minutes[-1] == pytest.approx(25.0)

    def at(minute: float) -> int:
        return int(np.searchsorted(minutes, minute))

    home, away = mood[at(17.2)]
    assert home > 0.4
    assert away < -0.4
    assert excitement[at(17.2), 0] > excitement[at(17.2), 1] + 0.2
    assert np.abs(mood[at(16.9)]).max() < 0.02
    # Two minutes halve it, so eight leave a sixteenth.
    assert np.abs(mood[-1]).max() < 0.1
    assert (np.abs(mood[-1]) > 0.01).all()
