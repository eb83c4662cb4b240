"""A whole stadium without a picture: seeds, frames, worlds and time."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import esper
import numpy as np
import pytest

from tifo.components import Detail, MotionState, Seat, Section, View
from tifo.engine.behaviour import BallHit, Goal
from tifo.scripting.camera import FreeCamera
from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]


def _look(simulation: Simulation, *, eye: tuple[float, float, float] = (14.0, 10.0, 40.0)) -> None:
    camera = FreeCamera.looking(eye, (14.0, 10.0, -10.0))
    simulation.look(camera.view(), camera.projection((640, 360)), 360)


def test_equal_seeds_and_inputs_give_equal_states(simulate: MakeSimulation) -> None:
    hashes = []
    for _ in range(2):
        simulation = simulate(sides=2, away_share=0.2)
        simulation.run(seconds=1.0)
        simulation.send(Goal(0))
        simulation.send(BallHit((10.0, 5.0, -4.0)))
        simulation.run(seconds=3.0)
        hashes.append(simulation.crowd.state_hash())
    assert hashes[0] == hashes[1]


@pytest.mark.parametrize("poses", ["streams", "baked"])
def test_frames_and_looks_in_between_change_nothing(simulate: MakeSimulation, poses: str) -> None:
    plain, drawn = simulate(poses=poses), simulate(poses=poses)
    rng = np.random.default_rng(3)
    for simulation in (plain, drawn):
        simulation.send(Goal(0))
    plain.run(seconds=2.0)
    while drawn.clock.tick < 120:
        if rng.random() < 0.3:
            _look(drawn, eye=(float(rng.uniform(-30, 60)), 12.0, 30.0))
        drawn.crowd.palettes(np.arange(20), drawn.clock.pose_tick, drawn.clock.alpha)
        # Never beyond tick 120: at most what is left.
        left = (120 - drawn.clock.tick) / 60
        drawn.advance(min(float(rng.uniform(0.0, 0.05)), left))
    assert drawn.clock.tick == 120
    assert drawn.crowd.state_hash() == plain.crowd.state_hash()


def test_other_seeds_and_other_inputs_give_other_states(simulate: MakeSimulation) -> None:
    first, second, third = simulate(seed=1), simulate(seed=2), simulate(seed=1)
    assert first.crowd.state_hash() != second.crowd.state_hash()
    assert first.crowd.state_hash() == third.crowd.state_hash()
    third.send(Goal(0))
    for simulation in (first, third):
        simulation.run(seconds=0.1)
    assert first.crowd.state_hash() != third.crowd.state_hash()


def test_two_simulations_in_one_process_do_not_disturb_each_other(
    simulate: MakeSimulation,
) -> None:
    alone = simulate()
    alone.run(seconds=1.0)
    one, other = simulate(), simulate(seed=7)
    other.send(Goal(0))
    for _ in range(10):
        one.run(seconds=0.1)
        other.run(seconds=0.1)
    assert one.crowd.state_hash() == alone.crowd.state_hash()
    assert one.clock.tick == other.clock.tick == 60


def test_the_current_world_stays_as_it_was(simulate: MakeSimulation, esper_world: str) -> None:
    mine = esper.create_entity("my component")
    simulation = simulate()
    simulation.send(Goal(0))
    simulation.run(seconds=0.1)
    _look(simulation)
    simulation.advance(1 / 60)
    assert esper.current_world == esper_world
    assert esper.get_component(str) == [(mine, "my component")]
    assert esper.get_component(MotionState) == []
    with simulation.active():
        assert esper.current_world == simulation.world
    with pytest.raises(ValueError, match="delta is -1"):
        simulation.advance(-1.0)
    assert esper.current_world == esper_world


def test_closing_deletes_the_world(simulate: MakeSimulation, factories: object) -> None:
    world = simulate().world
    simulation = Simulation(simulate().spec, factories.make_character())  # type: ignore[attr-defined]
    assert {world, simulation.world} <= set(esper.list_worlds())
    esper.switch_world(simulation.world)
    simulation.close()
    assert esper.current_world == "default"
    assert simulation.world not in esper.list_worlds()
    assert world in esper.list_worlds()


def test_a_crowd_is_one_entity_and_each_section_another(simulate: MakeSimulation) -> None:
    simulation = simulate(columns=60)
    with simulation.active():
        assert [entity for entity, _ in esper.get_component(MotionState)] == [
            simulation.crowd.entity
        ]
        sections = sorted((s for _, s in esper.get_component(Section)), key=lambda s: s.start)
    assert len(sections) == 3
    assert sections[0].start == 0
    assert all(a.stop == b.start for a, b in pairwise(sections))
    assert sections[-1].stop == len(simulation.crowd) == 900
    assert {section.crowd for section in sections} == {simulation.crowd.entity}


def test_culling_follows_the_camera(simulate: MakeSimulation) -> None:
    simulation = simulate(occupancy=0.7)
    simulation.advance(1 / 60)
    assert all(len(ids) == 0 for ids in simulation.crowd.detail.agents)
    _look(simulation)
    simulation.advance(0.0)
    seen = np.concatenate(simulation.crowd.detail.agents)
    occupied = simulation.crowd.seat.occupied
    assert len(seen) > 100
    assert occupied[seen].all()
    camera = FreeCamera.looking((14.0, 10.0, 40.0), (14.0, 10.0, 90.0))
    simulation.look(camera.view(), camera.projection((640, 360)), 360)
    simulation.advance(0.0)
    assert all(len(ids) == 0 for ids in simulation.crowd.detail.agents)
    with simulation.active():
        assert len(esper.get_component(View)) == 1
        assert len(esper.get_components(Detail, Seat)) == 1


def test_agents_that_were_moved_are_in_view_where_they_are_now(simulate: MakeSimulation) -> None:
    simulation = simulate(occupancy=1.0)
    crowd = simulation.crowd
    eye = crowd.placement.position.mean(axis=1) + np.array([0.0, 2.0, 30.0])
    view, projection = np.eye(4, dtype=np.float32), np.zeros((4, 4), np.float32)
    view[:3, 3] = -eye
    projection[[0, 1, 2, 3], [0, 1, 2, 2]] = 1.0, 1.0, -1.0, -1.0
    projection[2, 3] = -0.2
    simulation.look(view, projection, 720)
    simulation.advance(1 / 60)
    assert sum(map(len, crowd.detail.agents)) > 200
    seats = crowd.placement.position
    crowd.placement.position = seats + np.array([[0.0], [0.0], [100.0]], np.float32)
    crowd.placement.version += 1
    simulation.advance(1 / 60)
    assert sum(map(len, crowd.detail.agents)) == 0
    crowd.placement.position = seats
    crowd.placement.version += 1
    simulation.advance(1 / 60)
    assert sum(map(len, crowd.detail.agents)) > 200


def test_without_levels_of_detail_everyone_in_view_is_near(simulate: MakeSimulation) -> None:
    near = simulate(lod=False)
    _look(near, eye=(14.0, 10.0, 200.0))
    near.advance(0.0)
    assert len(near.crowd.detail.agents[0]) > 200
    assert not any(len(ids) for ids in near.crowd.detail.agents[1:])


def test_what_is_shown_moves_on_without_a_jump(simulate: MakeSimulation) -> None:
    simulation = simulate()
    agents = np.arange(300)
    simulation.send(Goal(0))
    last = None
    for _ in range(4 * 60):
        simulation.advance(1 / 240)
        clock = simulation.clock
        shown = simulation.crowd.palettes(agents, clock.pose_tick, clock.alpha)
        assert np.isfinite(shown).all()
        if last is not None:
            # A joint turns by a radian in a quarter of its second-long clip, and blends of 12 pose
            # ticks add at most 2 * 1.5 / 12 / 8 to an entry of a matrix.
            assert np.abs(shown - last).max() < 0.09
        last = shown


def test_first_offsets_may_be_the_users(simulate: MakeSimulation) -> None:
    simulation = simulate(offsets=lambda rng, count: np.linspace(0.0, 28.0, count, dtype="f4"))
    assert simulation.crowd.anim is not None
    np.testing.assert_allclose(simulation.crowd.anim.start[0], np.linspace(0.0, 28.0, 300))
    with pytest.raises(ValueError, match="outside 0 to 28 poses"):
        simulate(offsets=lambda rng, count: np.full(count, 29.0, np.float32))


def test_streams_have_a_past_at_the_first_tick(simulate: MakeSimulation) -> None:
    pool = simulate().crowd.pool
    assert pool is not None
    assert (pool.valid == 30).all()
    assert (pool.head == 0).all()
