"""Turning to a place for a while, and back exactly."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from tifo.engine.behaviour.events import Event
from tifo.engine.behaviour.facing import FARTHEST
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation


@pytest.fixture
def simulation() -> Iterator[Simulation]:
    spec = CrowdSpec(layout="stand", rows=6, columns=20, step=0.6, rise=0.4, depth=0.8,
                     occupancy=1.0, poses="none", seed=2)  # fmt: skip
    made = Simulation(spec)
    yield made
    made.close()


def _off(simulation: Simulation, place: tuple[float, float, float]) -> np.ndarray:
    """(N,) radians between where agents face and a place."""
    crowd = simulation.crowd
    x, _, z = crowd.placement.position
    to = np.arctan2(place[0] - x, place[2] - z)
    return np.abs(np.angle(np.exp(1j * (to - crowd.placement.yaw))))


def test_people_turn_to_a_place_and_back(simulation: Simulation) -> None:
    crowd = simulation.crowd
    x, _, z = (float(value) for value in crowd.plan.position.mean(axis=1))
    place = (x + 4.0, 0.0, z + 12.0)
    before = crowd.placement.yaw.copy()
    touches = crowd.placement.touches
    told = crowd.face("rows 0-2", place, seconds=3.0)
    assert set(crowd.seat.row[told]) == {0, 1, 2}
    seen = [before[told]]
    for _ in range(30):
        simulation.run(seconds=1 / 30)
        seen.append(crowd.placement.yaw[told].copy())
    assert _off(simulation, place)[told].max() < 1e-3
    assert np.abs(np.diff(seen, axis=0)).max() < 0.2, "nobody snaps round"
    assert crowd.placement.touches > touches, "whoever draws is told"
    others = np.setdiff1d(np.arange(len(crowd)), told)
    np.testing.assert_array_equal(crowd.placement.yaw[others], before[others])
    simulation.run(seconds=2.2)
    np.testing.assert_array_equal(crowd.placement.yaw, before)
    assert not crowd.facing.turning.any()


def test_nobody_turns_farther_than_seats_allow(simulation: Simulation) -> None:
    crowd = simulation.crowd
    x, y, z = (float(value) for value in crowd.plan.position.mean(axis=1))
    before = crowd.placement.yaw.copy()
    crowd.face(None, (x, y, z - 50.0))
    simulation.run(seconds=1.0)
    turned = np.abs(crowd.placement.yaw - before)
    np.testing.assert_allclose(turned, FARTHEST, atol=1e-5)


def test_told_again_they_turn_on_and_released_they_turn_back(simulation: Simulation) -> None:
    crowd = simulation.crowd
    x, y, z = (float(value) for value in crowd.plan.position.mean(axis=1))
    before = crowd.placement.yaw.copy()
    crowd.face(7, (x - 20.0, y, z + 20.0))
    simulation.run(seconds=0.3)
    crowd.face(7, (x + 20.0, y, z + 20.0))
    last = crowd.placement.yaw[7]
    for _ in range(30):
        simulation.run(seconds=1 / 30)
        assert abs(crowd.placement.yaw[7] - last) < 0.25
        last = crowd.placement.yaw[7]
    assert _off(simulation, (x + 20.0, y, z + 20.0))[7] < 1e-3
    simulation.run(seconds=20.0)
    assert crowd.facing.turning[7]
    crowd.face(7)
    simulation.run(seconds=1.0)
    np.testing.assert_array_equal(crowd.placement.yaw, before)


def test_they_clap_towards_somebody(simulation: Simulation) -> None:
    crowd = simulation.crowd
    x, y, z = (float(value) for value in crowd.plan.position.mean(axis=1))
    place = (x + 6.0, y, z + 15.0)
    crowd.guide("row 1", motion="clap", seconds=4.0)
    told = crowd.face("row 1", place, seconds=4.0)
    simulation.run(seconds=2.0)
    assert all(crowd.library.names[k].startswith("clap") for k in crowd.motion.wanted[told])
    assert _off(simulation, place)[told].max() < 1e-3


def test_those_near_a_player_turn_to_him(simulation: Simulation) -> None:
    crowd = simulation.crowd
    before = crowd.placement.yaw.copy()
    x, y, z = (float(value) for value in crowd.plan.position.mean(axis=1))
    place = (x + 3.0, y, z + 6.0)
    simulation.send(Event("player_close", place=place))
    simulation.run(seconds=1.5)
    x0, y0, z0 = crowd.placement.position
    apart = np.sqrt((x0 - place[0]) ** 2 + (y0 + 1.0 - place[1]) ** 2 + (z0 - place[2]) ** 2)
    near = apart < 9.0
    assert near.sum() > 20
    assert np.median(_off(simulation, place)[near]) < 1e-3
    simulation.run(seconds=10.0)
    np.testing.assert_array_equal(crowd.placement.yaw, before)


@pytest.mark.parametrize(
    ("place", "seconds", "told"),
    [
        ((1.0, 2.0), None, "place is"),
        ((1.0, np.nan, 2.0), None, "place is"),
        ((1.0, 2.0, 3.0), 0.0, "seconds is"),
        ((1.0, 2.0, 3.0), np.nan, "seconds is"),
    ],
)
def test_nonsense_is_refused(
    simulation: Simulation, place: tuple[float, ...], seconds: float | None, told: str
) -> None:
    with pytest.raises(ValueError, match=told):
        simulation.crowd.face(0, place, seconds=seconds)  # type: ignore[arg-type]


def test_an_empty_selection_is_nobody(simulation: Simulation) -> None:
    crowd = simulation.crowd
    assert not len(crowd.face(np.zeros(0, np.int64), (0.0, 0.0, 9.0)))
