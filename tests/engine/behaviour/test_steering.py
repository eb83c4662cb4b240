"""The social force model against its potential, and pairs against all distances."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tifo.engine.behaviour.steering import (
    RANGE,
    SIGHT,
    STEP,
    STRENGTH,
    UNSEEN,
    pairs_within,
    repulsion,
)

COORDINATE = st.floats(-20, 20, width=32)


@given(st.lists(st.tuples(COORDINATE, COORDINATE), max_size=40), st.sampled_from([0.7, 2.0, 5.0]))
@settings(max_examples=80, deadline=None)
def test_pairs_are_those_within_reach(places: list[tuple[float, float]], reach: float) -> None:
    x, z = np.array(places, np.float32).reshape(-1, 2).T
    a, b, away = pairs_within(x, z, reach)
    np.testing.assert_array_equal(away, [x[a] - x[b], z[a] - z[b]])
    found = {frozenset(pair) for pair in zip(a.tolist(), b.tolist(), strict=True)}
    assert len(found) == len(a)
    apart = (x[:, None] - x) ** 2 + (z[:, None] - z) ** 2
    wanted = {
        frozenset((i, j))
        for i in range(len(x))
        for j in range(i)
        if apart[i, j] <= np.float32(reach * reach)
    }
    assert found == wanted


def potential(away: np.ndarray, stride: np.ndarray) -> float:
    """Helbing and Molnar's V(b), equations 3 and 4."""
    both = np.linalg.norm(away) + np.linalg.norm(away - stride)
    b = 0.5 * np.sqrt(both**2 - stride @ stride)
    return float(STRENGTH * np.exp(-b / RANGE))


def test_force_is_the_gradient_of_the_potential() -> None:
    rng = np.random.default_rng(4)
    for _ in range(30):
        x, z = rng.uniform(-1, 1, (2, 2)).astype(np.float32)
        velocity = rng.uniform(-0.7, 0.7, (2, 2)).astype(np.float32)
        away = np.array([x[0] - x[1], z[0] - z[1]], np.float64)
        if np.linalg.norm(away) < 0.3:
            continue
        stride = velocity[:, 1].astype(np.float64) * STEP
        step = 1e-5
        slope = [
            (potential(away + d, stride) - potential(away - d, stride)) / (2 * step)
            for d in np.eye(2) * step
        ]
        wanted = -np.array(slope)
        # Whoever looks straight against the force sees where it comes from.
        heading = np.zeros((2, 2), np.float32)
        heading[:, 0] = -wanted / np.linalg.norm(wanted)
        found = repulsion(pairs_within(x, z, 9.0), velocity, heading)[:, 0]
        np.testing.assert_allclose(found, wanted, rtol=2e-2, atol=1e-3)
        # The other way round it is the same, whichever of a pair comes first.
        pairs = pairs_within(x[::-1], z[::-1], 9.0)
        turned = repulsion(pairs, velocity[:, ::-1], heading[:, ::-1])[:, 1]
        np.testing.assert_allclose(turned, wanted, rtol=2e-2, atol=1e-3)


def test_what_is_behind_counts_half() -> None:
    x, z = np.zeros(2, np.float32), np.array([0.0, 0.8], np.float32)
    still = np.zeros((2, 2), np.float32)
    pairs = pairs_within(x, z, 2.0)

    def push(degrees: float) -> float:
        turn = np.deg2rad(degrees)
        heading = np.array([[np.sin(turn)] * 2, [np.cos(turn)] * 2], np.float32)
        return float(np.linalg.norm(repulsion(pairs, still, heading)[:, 0]))

    assert np.isclose(SIGHT, np.cos(np.deg2rad(100)))
    assert np.isclose(push(99.0), push(0.0))
    assert np.isclose(push(101.0), UNSEEN * push(0.0))
    # V0 / sigma exp(-b / sigma) at b = 0.8 m for somebody who stands.
    assert np.isclose(push(0.0), 2.1 / 0.3 * np.exp(-0.8 / 0.3), rtol=1e-2)


def test_forces_of_a_pair_that_stands_are_opposite() -> None:
    x, z = np.array([0.0, 0.5], np.float32), np.array([0.0, 0.3], np.float32)
    heading = np.array([[0.5, -0.5], [0.3, -0.3]], np.float32) / np.float32(np.hypot(0.5, 0.3))
    force = repulsion(pairs_within(x, z, 2.0), np.zeros((2, 2), np.float32), heading)
    np.testing.assert_allclose(force[:, 0], -force[:, 1], rtol=1e-5)
    assert force[0, 0] < 0
