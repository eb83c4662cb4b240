"""What drawing leaves behind: no objects, no errors, no trace in the simulation; what it costs."""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tifo.components.motion import NEVER
from tifo.engine.behaviour import Goal
from tifo.engine.crowd.cameras import camera_presets
from tifo.engine.crowd.spec import CrowdSpec
from tifo.scripting.camera import FreeCamera
from tifo.systems.simulation import Simulation

pytestmark = pytest.mark.gl

STAND = CrowdSpec(layout="stand", rows=5, columns=12, streams=16, history=14, seed=4)
SIZE = (160, 90)


@pytest.fixture
def simulation() -> Iterator[Simulation]:
    made = Simulation(STAND)
    yield made
    made.close()


def camera(simulation: Simulation, name: str = "tv") -> FreeCamera:
    return FreeCamera.looking(*camera_presets(simulation.plan)[name])


def test_closing_a_stage_leaves_no_object(gl: Any, simulation: Simulation) -> None:
    from tifo.engine.gl import check_errors, live_objects
    from tifo.scripting.stage import Stage

    before = live_objects()
    stage = Stage(simulation, SIZE)
    for name in ("tv", "close", "bowl"):
        stage.draw(camera(simulation, name), 1 / 60)
        stage.pixels()
    stage.resize((96, 64))
    stage.draw(camera(simulation), 1 / 60)
    assert sum(live_objects().values()) > sum(before.values()) + 10
    stage.close()
    assert live_objects() == before
    check_errors("drawing and closing")
    # The simulation goes on without a picture.
    simulation.run(seconds=0.1)


@pytest.mark.parametrize("poses", ["streams", "baked"])
def test_a_render_system_can_be_deleted_and_used_again(
    gl: Any, poses: str, factories: ModuleType
) -> None:
    from tifo.engine.gl import Framebuffer, live_objects
    from tifo.systems.render import RenderSystem

    simulation = Simulation(STAND.replace(poses=poses), factories.make_character())
    simulation.build_mesh()
    target = Framebuffer(SIZE)
    system = RenderSystem(SIZE)
    before = live_objects()
    simulation.schedule.frame_systems.append(system)
    look = camera(simulation)
    simulation.look(look.view(), look.projection(SIZE), SIZE[1])
    pictures = []
    for _ in range(2):
        with target:
            target.clear()
            simulation.advance(0.0)
        pictures.append(target.read_pixels())
        assert system.counts.triangles > 0
        system.delete()
        assert live_objects() == before
    np.testing.assert_array_equal(pictures[0], pictures[1])
    target.delete()
    simulation.close()


def test_resizing_draws_the_same_view_in_the_new_size(gl: Any, simulation: Simulation) -> None:
    from tifo.scripting.stage import Stage

    stage = Stage(simulation, (160, 90))
    stage.draw(camera(simulation))
    small = stage.pixels()
    stage.resize((320, 180))
    assert stage.size == (320, 180)
    stage.draw(camera(simulation))
    large = stage.pixels()
    assert large.shape == (180, 320, 3)
    halved = large.reshape(90, 2, 160, 2, 3).mean(axis=(1, 3))
    assert np.abs(halved - small).mean() < 6.0
    stage.resize((160, 90))
    stage.draw(camera(simulation))
    np.testing.assert_array_equal(stage.pixels(), small)
    stage.close()


def test_the_simulation_is_the_same_with_and_without_drawing(gl: Any) -> None:
    from tifo.scripting.stage import Stage

    hashes = []
    for drawn in (True, False):
        simulation = Simulation(STAND)
        stage = Stage(simulation, SIZE) if drawn else None
        views = [camera(simulation, name) for name in ("close", "bowl", "tv")]
        for frame in range(45):
            if frame == 10:
                simulation.send(Goal(0))
            if stage is None:
                simulation.advance(1 / 60)
            elif frame % 7:
                stage.draw(views[frame % 3], 1 / 60)
            else:
                simulation.advance(1 / 60)
        hashes.append(simulation.crowd.state_hash())
        if stage is not None:
            stage.close()
        simulation.close()
    assert hashes[0] == hashes[1]


def test_a_quiet_tick_copies_one_slice_the_stream_table_and_the_lists(
    gl: Any, simulation: Simulation
) -> None:
    from tifo.scripting.stage import Stage

    crowd = simulation.crowd
    assert crowd.pool is not None
    assert crowd.anim is not None
    store = crowd.pool.store
    # Nobody may change motion of their own accord.
    crowd.behaviour.until[:] = NEVER
    stage = Stage(simulation, SIZE)
    look = camera(simulation)
    stage.draw(look, 1 / 30)
    assert stage.counts.uploaded > store.ring.nbytes, "the first picture copies everything"
    slice_bytes = store.ring[0].nbytes + store.ring_markers[0].nbytes
    table = 16 * (store.stream_rows + store.uniques)
    quiet = 0
    for _ in range(12):
        version = crowd.anim.version
        stage.draw(look, 1 / 30)
        lists = 4 * sum(len(agents) for agents in crowd.detail.agents)
        expected = slice_bytes + table + lists
        if crowd.anim.version != version:
            expected += 256 * 48  # 60 agents lie in one row of the table
        else:
            quiet += 1
        assert stage.counts.uploaded == expected
    assert quiet >= 3
    # No tick between two frames: the heads are where they were, and so are the poses.
    stage.draw(look, 0.0)
    assert stage.counts.uploaded == table + lists
    stage.close()


def test_a_new_stage_shows_what_the_old_one_did(gl: Any, simulation: Simulation) -> None:
    """What is only copied when it changes is copied whole for a new picture."""
    from tifo.scripting.stage import Stage

    first = Stage(simulation, SIZE)
    look = camera(simulation, "close")
    first.draw(look, 0.1)
    first.close()
    second = Stage(simulation, SIZE)
    for _ in range(3):
        second.draw(look, 1 / 30)
    later = second.pixels()
    second.close()
    fresh = Stage(simulation, SIZE)
    fresh.draw(look, 0.0)
    np.testing.assert_array_equal(fresh.pixels(), later)
    fresh.close()


def test_state_that_others_do_not_expect_is_put_back(gl: Any, simulation: Simulation) -> None:
    from tifo.engine.gl.api import gl as api
    from tifo.scripting.stage import Stage

    stage = Stage(simulation, SIZE)
    for name in ("bowl", "close"):
        stage.draw(camera(simulation, name))
        for switch in ("GL_SAMPLE_ALPHA_TO_COVERAGE", "GL_PROGRAM_POINT_SIZE", "GL_BLEND"):
            assert not api.glIsEnabled(getattr(api, switch)), switch
        written = api.GLboolean(0)
        api.glGetBooleanv(api.GL_DEPTH_WRITEMASK, written)
        assert written.value
    stage.close()
