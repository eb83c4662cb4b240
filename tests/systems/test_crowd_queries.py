"""Finding agents: by party, and by what a rectangle of a picture shows."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from tifo import FreeCamera
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation

SIZE = (640, 360)


@pytest.fixture(scope="module")
def simulation() -> Iterator[Simulation]:
    spec = CrowdSpec(layout="stand", rows=8, columns=16, step=0.6, rise=0.4, depth=0.8,
                     occupancy=0.9, poses="none", seed=2)  # fmt: skip
    made = Simulation(spec)
    yield made
    made.close()


def test_a_party_is_found_by_its_number(simulation: Simulation) -> None:
    crowd = simulation.crowd
    one = int(np.flatnonzero(crowd.party.nearest >= 0)[0])
    friends = crowd.where(party=crowd.party.party[one])
    assert one in friends
    assert crowd.party.nearest[one] in friends
    assert set(crowd.party.party[friends]) == {crowd.party.party[one]}
    assert not len(crowd.where(party=999_999))


def test_a_rectangle_of_the_picture_finds_whom_it_shows(simulation: Simulation) -> None:
    crowd = simulation.crowd
    x, y, z = (float(value) for value in crowd.plan.position.mean(axis=1))
    camera = FreeCamera.looking((x, y + 3.0, z + 14.0), (x, y + 1.0, z))
    first, second = (400.0, 300.0), (150.0, 100.0)
    found = crowd.where(framed=camera.rectangle(first, second, SIZE))
    assert 0 < len(found) < len(crowd)
    # Another way round: rays through the corners bound the same people.
    matrix = camera.projection(SIZE).astype(float) @ camera.view()
    inside = []
    for agent in np.flatnonzero(crowd.seat.occupied):
        clip = matrix @ np.append(crowd.placement.position[:, agent] + (0.0, 1.0, 0.0), 1.0)
        pixel = (clip[:2] / clip[3] + 1.0) / 2.0 * SIZE
        if clip[3] > 0 and (pixel >= (150, 100)).all() and (pixel <= (400, 300)).all():
            inside.append(agent)
    assert found.tolist() == inside
    everybody = crowd.where(framed=camera.rectangle((0, 0), SIZE, SIZE))
    assert set(found) <= set(everybody)
    # Behind the camera nobody is seen.
    away = FreeCamera.looking((x, y + 3.0, z + 14.0), (x, y + 1.0, z + 40.0))
    assert not len(crowd.where(framed=away.rectangle((0, 0), SIZE, SIZE)))


@pytest.mark.parametrize(
    "wrong", [((1, 2), (0, 0, 1, 1)), (np.eye(4), (0, 0, 1)), (np.eye(4) * np.nan, (0, 0, 1, 1)), 3]
)
def test_a_wrong_rectangle_is_refused(simulation: Simulation, wrong: object) -> None:
    with pytest.raises(ValueError, match="framed is"):
        simulation.crowd.where(framed=wrong)


def test_orders_go_to_whom_a_rectangle_shows(simulation: Simulation) -> None:
    crowd = simulation.crowd
    x, y, z = (float(value) for value in crowd.plan.position.mean(axis=1))
    camera = FreeCamera.looking((x, y + 3.0, z + 14.0), (x, y + 1.0, z))
    told = crowd.where(framed=camera.rectangle((0, 0), (320, 360), SIZE))
    crowd.guide(told, motion="clap")
    simulation.run(seconds=0.2)
    assert all(crowd.library.names[k].startswith("clap") for k in crowd.motion.wanted[told])
