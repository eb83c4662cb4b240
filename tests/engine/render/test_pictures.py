"""Whole pictures: the stadium with its crowd from the preset cameras, against golden images."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from tifo.engine.behaviour import Goal
from tifo.engine.crowd.cameras import camera_presets
from tifo.engine.crowd.spec import CrowdSpec
from tifo.scripting.camera import FreeCamera
from tifo.systems.simulation import Simulation

pytestmark = pytest.mark.gl

SIZE = (320, 180)
SPECS = {
    "bowl": CrowdSpec(seats=3000, sides=2, streams=32, history=14, seed=7),
    "stand": CrowdSpec(layout="stand", rows=6, columns=10, streams=32, history=14, seed=7),
}


@pytest.fixture(scope="module", params=SPECS)
def simulation(request: pytest.FixtureRequest) -> Iterator[Simulation]:
    """A crowd a second and a half after a goal, so that poses of all kinds are shown."""
    made = Simulation(SPECS[request.param])
    made.run(seconds=0.5)
    made.send(Goal(0))
    made.run(seconds=1.5)
    yield made
    made.close()


@pytest.mark.parametrize("preset", ["tv", "close", "bowl"])
def test_preset_cameras(simulation: Simulation, preset: str, golden: Any) -> None:
    from tifo.engine.gl import check_errors
    from tifo.scripting.stage import Stage

    stage = Stage(simulation, SIZE)
    stage.draw(FreeCamera.looking(*camera_presets(simulation.plan)[preset]))
    picture = stage.pixels()
    triangles = stage.counts.triangles
    stage.close()
    check_errors("drawing a picture")
    assert picture.shape == (180, 320, 3)
    assert sum(len(agents) for agents in simulation.crowd.detail.agents) >= 5
    assert triangles > 100
    assert 30 < picture.mean() < 220
    assert picture.std() > 20
    black, white = (picture == 0).all(axis=2).mean(), (picture == 255).all(axis=2).mean()
    assert black < 0.02, "the background shows through, or something is unlit"
    assert white < 0.05, "clipped"
    # Red shirts of the home side are somewhere.
    red, green, blue = picture.astype(int).transpose(2, 0, 1)
    assert ((red > green + 50) & (red > blue + 50)).mean() > 0.002
    golden.check(f"{simulation.spec.layout}-{preset}", picture)


def test_pictures_of_the_same_moment_are_the_same(gl: Any, simulation: Simulation) -> None:
    from tifo.scripting.stage import Stage

    pictures = []
    for _ in range(2):
        stage = Stage(simulation, SIZE)
        stage.draw(FreeCamera.looking(*camera_presets(simulation.plan)["close"]))
        pictures.append(stage.pixels())
        stage.close()
    np.testing.assert_array_equal(pictures[0], pictures[1])
