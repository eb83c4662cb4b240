"""Clapping together: against the theory of coupled oscillators, and by itself."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from tifo.benchmarks.experiments import REFERENCE_RHYTHM, TICK, ovation, synchronise
from tifo.engine.behaviour.hearing import Hearing
from tifo.engine.behaviour.rhythm import Rhythm, RhythmRates


def order_in_theory(coupling: float, deviation: float) -> float:
    """r of ``1 = K int cos^2(t) g(K r sin t) dt`` for Gaussian rates: Kuramoto's own equation."""
    angle = np.linspace(-pi / 2, pi / 2, 4001)

    def excess(r: float) -> float:
        density = np.exp(-0.5 * (coupling * r * np.sin(angle) / deviation) ** 2)
        density /= deviation * sqrt(2 * pi)
        return float(coupling * (np.cos(angle) ** 2 * density).mean() * pi - 1.0)

    low, high = 1e-6, 1.0
    if excess(low) <= 0:
        return 0.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) > 0 else (low, middle)
    return low


def test_the_theory_has_its_critical_coupling() -> None:
    deviation = 2 * pi / 6.9
    critical = sqrt(8 / pi) * deviation
    assert order_in_theory(0.99 * critical, deviation) == 0.0
    assert order_in_theory(1.02 * critical, deviation) > 0.1


def test_alone_people_clap_at_their_own_rate(rng: np.random.Generator) -> None:
    rhythm = Rhythm(Hearing(np.arange(200)), rng, RhythmRates(patience=1e9))
    claps = np.zeros(200)
    for _ in range(300):
        claps[rhythm.step(np.arange(200), TICK)] += 1
    np.testing.assert_allclose(claps, 10.0 * rhythm.frequency, atol=1.01)
    assert rhythm.frequency.std() / rhythm.frequency.mean() == pytest.approx(0.08, abs=0.015)
    assert rhythm.frequency.mean() == pytest.approx(3.3, abs=0.1)


def test_two_people_lock_at_the_angle_of_theory(rng: np.random.Generator) -> None:
    rhythm = Rhythm(Hearing(np.zeros(2, int)), rng, RhythmRates(coupling=2.0, patience=1e9))
    rhythm.frequency[:] = rhythm.rate[:] = (3.0, 3.2)
    for _ in range(600):
        rhythm.step(np.arange(2), TICK)
    # d(delta)/dt = dw - K sin(delta): sin(delta) = 2 pi 0.2 / 2.
    ahead = 2 * pi * float(rhythm.phase[1] - rhythm.phase[0])
    assert np.sin(ahead) == pytest.approx(2 * pi * 0.2 / 2.0, abs=0.03)
    np.testing.assert_allclose(rhythm.speed, 3.1, atol=0.01)


def test_few_and_many_clappers_are_advanced_alike() -> None:
    """The picked rows and the whole columns are one rule."""
    group = np.repeat(np.arange(3), 40)
    loudness = np.array([[1, 0.5, 0.2], [0.5, 1, 0.5], [0.2, 0.5, 1]])
    rates = RhythmRates(patience=1e9)
    runs = []
    for extra in (0, 400):  # with 400 more agents who never clap, the clappers are few
        hearing = Hearing(np.concatenate([group, np.full(extra, 2)]), None, loudness)
        rhythm = Rhythm(hearing, np.random.default_rng(0), rates)
        rhythm.frequency[:120] = rhythm.rate[:120] = np.linspace(2.8, 3.8, 120)
        rhythm.phase[:120] = np.linspace(0, 1, 120, endpoint=False) ** 2
        met = [set(rhythm.step(np.arange(120), TICK).tolist()) for _ in range(40)]
        runs.append((rhythm.phase[:120], rhythm.order, met))
    np.testing.assert_allclose(runs[0][0], runs[1][0], atol=1e-4)
    np.testing.assert_allclose(runs[0][1], runs[1][1], atol=1e-5)
    assert runs[0][2] == runs[1][2]


def test_the_reference_run(rng: np.random.Generator) -> None:
    # Neda et al. 2000: no order at K = 0.8 < K_c = 1.45; every rate halved, it grows over a minute.
    order = synchronise(5000, 130.0, 40.0, rng, REFERENCE_RHYTHM)
    second = round(1 / TICK)
    assert order[5 * second : 40 * second].mean() < 0.06
    assert order[45 * second] < 0.25
    assert order[100 * second] > 0.3
    theory = order_in_theory(0.8, pi / 6.9)
    assert order[-20 * second :].mean() == pytest.approx(theory, abs=0.08)


@pytest.mark.slow
def test_order_appears_at_the_critical_coupling(rng: np.random.Generator) -> None:
    deviation = 2 * pi * 0.1
    critical = sqrt(8 / pi) * deviation
    for ratio in (0.6, 0.85, 1.2, 1.5, 2.0):
        rates = RhythmRates(rate=1.0, variation=0.1, coupling=ratio * critical, patience=1e9)
        order = synchronise(8000, 120.0, 1e9, rng, rates)[-900:].mean()
        theory = order_in_theory(ratio * critical, deviation)
        assert order == pytest.approx(theory, abs=0.08), ratio


def test_rhythm_comes_and_goes_by_itself(rng: np.random.Generator) -> None:
    order, slow = ovation(Hearing(np.zeros(1500, int)), 60.0, rng)
    second = round(1 / TICK)
    assert slow[: 3 * second].max() < 0.05
    assert order[5 * second : 8 * second].mean() < 0.3
    best = int(order.argmax())
    assert order[best] > 0.75
    assert slow[best] > 0.9
    after = order[best:]
    assert after.min() < 0.2  # and back to free applause
    assert slow[best + int(after.argmin())] < 0.5


def test_who_begins_has_its_own_rate_again(rng: np.random.Generator) -> None:
    rhythm = Rhythm(Hearing(np.zeros(10, int)), rng)
    rhythm.is_slow[:] = True
    rhythm.rate[:] = 0.5 * rhythm.frequency
    rhythm.begin([3, 4])
    assert rhythm.is_slow.sum() == 8
    np.testing.assert_array_equal(rhythm.rate[3:5], rhythm.frequency[3:5])


def test_silence_and_wrong_steps(rng: np.random.Generator) -> None:
    rhythm = Rhythm(Hearing(np.zeros(10, int)), rng)
    assert len(rhythm.step(np.zeros(0, np.int64), TICK)) == 0
    assert rhythm.order[0] == 0
    with pytest.raises(ValueError, match="dt is"):
        rhythm.step(np.arange(10), 0.2)
