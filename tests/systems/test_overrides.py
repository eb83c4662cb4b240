"""Overrides by way of a crowd's handle, in pictures and on the CPU."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import tifo
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.errors import GraphicsError
from tifo.engine.overrides import JointOverride, look_at
from tifo.scripting.camera import FreeCamera
from tifo.systems.simulation import Simulation

STAND = CrowdSpec(layout="stand", rows=3, columns=8, streams=8, history=14, seed=4, occupancy=1.0)


@pytest.fixture(params=["streams", "baked"])
def simulation(request: pytest.FixtureRequest) -> Iterator[Simulation]:
    made = Simulation(STAND.replace(poses=request.param))
    made.run(seconds=0.2)
    yield made
    made.close()


class Camera:
    """Takes pictures of spectators from near by."""

    def __init__(self, simulation: Simulation) -> None:
        from tifo.scripting.stage import Stage

        self.stage = Stage(simulation, (240, 180))
        x, y, z = simulation.plan.position[:, 4].tolist()
        self.look = FreeCamera.looking((x, y + 1.6, z + 2.5), (x, y + 1.2, z))

    def take(self) -> NDArray[np.int64]:
        self.stage.draw(self.look)
        return self.stage.pixels().astype(np.int64)


@pytest.fixture
def camera(gl: Any, simulation: Simulation) -> Iterator[Camera]:
    made = Camera(simulation)
    yield made
    made.stage.close()


@pytest.mark.gl
def test_overrides_come_and_go_at_runtime(simulation: Simulation, camera: Camera) -> None:
    crowd = simulation.crowd
    before = camera.take()
    look = look_at()
    crowd.add_override(look)
    look.aim((-40.0, 1.0, 20.0))
    aside = camera.take()
    assert (np.abs(aside - before).max(axis=2) > 30).mean() > 0.005
    look.aim((60.0, 1.0, 20.0), seconds=9.0)
    other = camera.take()
    assert (np.abs(other - aside).max(axis=2) > 30).mean() > 0.005
    # Nobody cares: what is drawn in two parts has no seam.
    crowd.override_values("look_at", np.arange(len(crowd)), (0, 0, 0, 0))
    assert (np.abs(camera.take() - before).max(axis=2) > 2).mean() < 1e-3
    crowd.remove_override("look_at")
    np.testing.assert_array_equal(camera.take(), before)


@pytest.mark.gl
def test_what_does_not_compile_can_be_taken_back(simulation: Simulation, camera: Camera) -> None:
    crowd = simulation.crowd
    before = camera.take()
    text = "\nmat4 slip(OverriddenJoint joint)\n{\n    return joint.pose * missing;\n}\n"
    crowd.add_override(JointOverride("slip", ["head"], text))
    for _ in range(2):
        with pytest.raises(GraphicsError, match=r"^override 'slip', line 4: .*missing"):
            camera.take()
    crowd.remove_override("slip")
    np.testing.assert_array_equal(camera.take(), before)


@pytest.mark.gl
def test_nothing_is_left_on_the_gpu(gl: Any, simulation: Simulation) -> None:
    from tifo.engine.gl import collect, live_objects

    before = live_objects()
    camera = Camera(simulation)
    for name in ("one", "two"):
        simulation.crowd.add_override(look_at(name=name))
        camera.take()
    simulation.crowd.remove_override("one")
    camera.take()
    camera.stage.close()
    collect()
    assert live_objects() == before


def test_the_cpu_gives_what_is_shown(simulation: Simulation) -> None:
    crowd = simulation.crowd
    ids = np.array([5, 3])
    tick = simulation.clock.pose_tick
    before = crowd.palettes(ids, tick, 0.5)
    look = look_at()
    crowd.add_override(look)
    crowd.override_values("look_at", 3, (0, 0, 0, 0))
    place = crowd.placement.position[:, 5] + np.array([1.0, 1.2, 4.0])
    look.aim(place)
    after = crowd.palettes(ids, tick, 0.5)
    np.testing.assert_allclose(after[1], before[1], atol=1e-6)
    head = crowd.character.skeleton.index("head")
    changed = np.abs(after[0] - before[0]).max(axis=(1, 2)) > 1e-6
    names = np.array(crowd.character.skeleton.names)
    assert set(names[changed]) == {"neck", "head"}
    # The head looks from where it is to the point.
    skull = after[0, head] @ np.array([0.0, 1.54, 0.0, 1.0])
    yaw = crowd.placement.yaw[5]
    turn = np.array([[np.cos(yaw), 0, np.sin(yaw)], [0, 1, 0], [-np.sin(yaw), 0, np.cos(yaw)]])
    at = crowd.placement.position[:, 5] + crowd.placement.scale[5] * turn @ skull
    way = (place - at) / np.linalg.norm(place - at)
    assert float(way @ turn @ after[0, head, :, 2]) > np.cos(np.radians(2.0))


def test_the_state_of_the_simulation_knows_no_overrides(simulation: Simulation) -> None:
    before = simulation.crowd.state_hash()
    simulation.crowd.add_override(look_at())
    assert simulation.crowd.state_hash() == before


def test_without_a_python_form_the_cpu_says_so(simulation: Simulation) -> None:
    text = "mat4 stay(OverriddenJoint joint) { return joint.pose; }"
    simulation.crowd.add_override(JointOverride("stay", ["head"], text))
    with pytest.raises(ValueError, match="override 'stay' has no Python form"):
        simulation.crowd.palettes(np.array([1]), simulation.clock.pose_tick)
    with pytest.raises(ValueError, match="there is no agent 999"):
        simulation.crowd.override_values("stay", 999, (0, 0, 0, 0))


def test_the_examples_of_the_page_run() -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "overrides.md").read_text("utf-8")
    simulation = Simulation(STAND)
    names = {"tifo": tifo, "np": np, "crowd": simulation.crowd}
    blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    assert len(blocks) == 2
    for block in blocks:
        exec(block, names)
    assert [override.name for override in simulation.crowd.overrides.overrides] == ["look_at"]
    simulation.close()
