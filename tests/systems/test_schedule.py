"""Ticks inside frames, and the systems one by one in a world of the user's own."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import esper
import numpy as np
import pytest

from tifo.components import View
from tifo.engine.behaviour import Goal
from tifo.engine.clock import Clock
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.crowd.stadium import build_seats
from tifo.scripting.camera import FreeCamera
from tifo.systems.crowd import Crowd
from tifo.systems.phases import Phase
from tifo.systems.schedule import Schedule, add_systems
from tifo.systems.simulation import Simulation
from tifo.systems.spawn import spawn_crowd

MakeSimulation = Callable[..., Simulation]


class Recorder(esper.Processor):
    """Writes down when it ran."""

    def __init__(self, name: str, log: list[tuple[str, int]]) -> None:
        self.name = name
        self.log = log

    def process(self, clock: Clock) -> None:
        self.log.append((self.name, clock.tick))


def test_a_frame_runs_the_ticks_that_are_due_and_then_the_frame_systems_once() -> None:
    log: list[tuple[str, int]] = []
    schedule = Schedule(Clock(), [Recorder("a", log), Recorder("b", log)], [Recorder("frame", log)])
    schedule.process(2 / 60)
    assert log == [("a", 1), ("b", 1), ("a", 2), ("b", 2), ("frame", 2)]
    log.clear()
    schedule.process(0.001)
    assert log == [("frame", 2)]
    log.clear()
    schedule.process(5.0)
    assert [name for name, _ in log] == ["a", "b"] * 4 + ["frame"]


def test_times_are_kept_only_when_asked_for() -> None:
    schedule = Schedule(Clock(), [Recorder("a", [])])
    schedule.process(1 / 60)
    assert not schedule.times
    schedule.keep_times = True
    schedule.process(3 / 60)
    assert [len(times) for times in schedule.times.values()] == [3]
    assert list(schedule.times) == ["Recorder"]
    assert all(0 <= seconds < 1 for seconds in schedule.times["Recorder"])


def test_a_wrong_delta_runs_nothing() -> None:
    log: list[tuple[str, int]] = []
    schedule = Schedule(Clock(), [Recorder("a", log)], [Recorder("frame", log)])
    with pytest.raises(ValueError, match="delta is -1"):
        schedule.process(-1.0)
    assert log == []


def _own_world(factories: ModuleType, **fields: Any) -> Crowd:
    """A crowd and the systems in the current world, without a simulation."""
    spec = CrowdSpec(layout="stand", rows=15, columns=20, streams=24, history=30, **fields)
    crowd = spawn_crowd(spec, build_seats(spec), factories.make_character())
    add_systems(spec.seed)
    return crowd


@pytest.mark.parametrize("poses", ["streams", "baked"])
def test_systems_one_by_one_do_what_a_simulation_does(
    simulate: MakeSimulation, factories: ModuleType, esper_world: str, poses: str
) -> None:
    simulation = simulate(poses=poses)
    crowd = _own_world(factories, poses=poses)
    camera = FreeCamera.looking((14.0, 10.0, 40.0), (14.0, 10.0, -10.0))
    view, projection = camera.view(), camera.projection((640, 360))
    esper.create_entity(View(view, projection, 360))
    simulation.look(view, projection, 360)
    clock = Clock()
    for second in range(3):
        if second == 1:
            crowd.send(Goal(0))
            simulation.send(Goal(0))
        for _ in range(60):
            clock.advance()
            esper.process(clock)
            simulation.advance(1 / 60)
        assert simulation.clock.tick == clock.tick
        assert crowd.state_hash() == simulation.crowd.state_hash()
        for mine, theirs in zip(crowd.detail.agents, simulation.crowd.detail.agents, strict=True):
            np.testing.assert_array_equal(mine, theirs)
    agents = np.arange(len(crowd))
    np.testing.assert_array_equal(
        crowd.palettes(agents, clock.pose_tick, 0.5),
        simulation.crowd.palettes(agents, clock.pose_tick, 0.5),
    )


def test_a_users_own_system_runs_between_phases(factories: ModuleType, esper_world: str) -> None:
    crowd = _own_world(factories)
    seen: list[int] = []

    class Everyone(esper.Processor):
        """A scripted wish, after behaviour and before transitions."""

        def process(self, clock: Clock) -> None:
            crowd.motion.wanted[:] = 4
            assert crowd.pool is not None
            seen.append(int(crowd.pool.head.max()))

    esper.add_processor(Everyone(), Phase.BEHAVIOUR - 1)
    clock = Clock()
    for _ in range(4):
        clock.advance()
        esper.process(clock)
    assert (crowd.motion.shown == 4).all()
    # Heads move in a later phase of the same tick.
    assert seen == [0, 0, 1, 1]


def test_phases_are_in_the_order_of_a_frame() -> None:
    assert [phase.name for phase in sorted(Phase, reverse=True)] == [
        "WALKING", "BEHAVIOUR", "TRANSITIONS", "DILATION", "CLAPS", "CONTROLLERS", "HISTORY",
        "CLIP_EVENTS", "RECORD", "DETAIL", "RENDER",
    ]  # fmt: skip


def test_several_crowds_share_the_systems(factories: ModuleType, esper_world: str) -> None:
    first = _own_world(factories)
    spec = CrowdSpec(layout="stand", rows=3, columns=4, streams=8, poses="baked")
    second = spawn_crowd(spec, build_seats(spec), factories.make_character(["clap", "jump"]))
    first.send(Goal(0))
    clock = Clock()
    for _ in range(90):
        clock.advance()
        esper.process(clock)
    assert first.behaviour.reacting.mean() > 0.5
    assert not second.behaviour.reacting.any()
