"""People who come late, leave, and look after the others: where they go and what others do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

import esper
import numpy as np
import pytest

from tifo.components import Errand, Stage
from tifo.engine.behaviour.making_room import ABACK
from tifo.engine.crowd.body_types import CHILD
from tifo.engine.crowd.detail import Bounds
from tifo.engine.crowd.gaits import SPEEDS
from tifo.engine.crowd.motions import MotionStreams
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation

Make = Callable[..., Simulation]
CLIPS = ("walk", "sit_idle", "stand_idle", "clap", "cheer", "dismay", "stand_up", "sit_down")
TALLEST_STEP = 1.3 * 1.3 / 60
"""Metres that the fastest walker goes in a tick: 1.1 m/s of a floor, times pace and haste."""


@pytest.fixture
def make(factories: ModuleType) -> Iterator[Make]:
    """Make small grounds of box people who can walk."""
    made: list[Simulation] = []

    def build(**fields: Any) -> Simulation:
        small = {"seats": 300, "streams": 8, "history": 30, "slots": 10, "casting": False}
        small |= {"children": 0.0, "old": 0.0, "ultras": 0.0, "seed": 4}
        made.append(Simulation(CrowdSpec(**{**small, **fields}), factories.make_character(CLIPS)))
        return made[-1]

    yield build
    for simulation in made:
        simulation.close()


def nearest_apart(simulation: Simulation) -> float:
    """Metres between the middles of the two walkers who are nearest to each other."""
    x, _, z = simulation.crowd.placement.position[:, simulation.crowd.walk.agent]
    if len(x) < 2:
        return np.inf
    apart = np.hypot(x[:, None] - x, z[:, None] - z)
    np.fill_diagonal(apart, np.inf)
    return float(apart.min())


def until_idle(simulation: Simulation, seconds: int) -> float:
    """Run until nobody is on the way; how near two walkers came to each other."""
    least = np.inf
    for _ in range(seconds):
        simulation.run(seconds=1.0)
        least = min(least, nearest_apart(simulation))
        if simulation.crowd.walkers.is_idle:
            return least
    raise AssertionError(f"somebody is still on the way after {seconds} s")


def test_latecomers_come_in_time_on_walkable_ground(make: Make) -> None:
    simulation = make(latecomers=0.08, poses="none")
    crowd = simulation.crowd
    walkers = crowd.walkers
    late = walkers.waiting.copy()
    assert len(late) == round(0.08 * (crowd.seat.occupied.sum() + len(late)))
    assert not crowd.seat.occupied[late[:, 0]].any()
    assert late[:, 2].max() <= 330 * 30
    # Bring the whole of it forward, so that the test is short and the gangways are full.
    walkers.waiting[:, 2] = 1 + walkers.waiting[:, 2] // 90
    before, least, seen = crowd.placement.position.copy(), np.inf, 0
    ground = {a: _filled(walkers.ways.to_seat(a).points) for a in late[:, 0].tolist()}
    for _ in range(90):
        simulation.run(seconds=1.0)
        ids = crowd.walk.agent
        seen = max(seen, len(ids))
        if len(ids):
            least = min(least, nearest_apart(simulation))
            places = crowd.placement.position[:, ids]
            for agent, place in zip(ids.tolist(), places[::2].T, strict=True):
                # A gangway of 1.2 m leaves the middle of a body 0.35 m to either side.
                assert np.hypot(*(ground[agent] - place).T).min() < 0.4
            moved = np.linalg.norm(places - before[:, ids], axis=0)
            new = np.linalg.norm(before[:, ids] - simulation.plan.position[:, ids], axis=0) < 1e-6
            assert (moved[~new] < TALLEST_STEP * 60 + 0.05).all()
        before = crowd.placement.position.copy()
        if walkers.is_idle:
            break
    assert walkers.is_idle
    assert seen > 6
    assert least > 0.35
    assert crowd.seat.occupied[late[:, 0]].all()
    assert not walkers.away[late[:, 0]].any()
    np.testing.assert_array_equal(crowd.placement.position, simulation.plan.position)
    assert not crowd.guidance.orders


def _filled(line: np.ndarray) -> np.ndarray:
    """Points of a polyline in plan, less than 10 cm apart."""
    parts = [
        a + np.linspace(0, 1, 2 + int(np.linalg.norm(b - a) * 10))[:, None] * (b - a)
        for a, b in zip(line[:-1, ::2], line[1:, ::2], strict=True)
    ]
    return np.concatenate(parts)


def test_row_stands_while_somebody_passes_and_sits_again(make: Make) -> None:
    simulation = make(walking=True, occupancy=1.0, poses="none")
    crowd, plan = simulation.crowd, simulation.plan
    row = np.flatnonzero((plan.section == 1) & (plan.row == 2))
    crowd.guide(row, motion="seated", channel="posture")
    simulation.run(seconds=4.0)
    seated = crowd.table.seated
    goer = int(row[len(row) // 2])
    assert crowd.leave(goer).tolist() == [goer]
    stood, back = set[int](), 0.0
    for _ in range(60):
        simulation.run(seconds=0.5)
        room = crowd.walkers.room.agents
        assert set(room.tolist()) <= set(row.tolist()) - {goer}
        here = row[~seated[crowd.motion.shown[row]] & (row != goer)]
        stood |= set(here.tolist())
        away = np.linalg.norm(crowd.placement.position[:, row] - plan.position[:, row], axis=0)
        back = max(back, float(away[row != goer].max()))
        for walker in np.flatnonzero(crowd.walk.stage == Stage.WALK):
            # Nobody is passed who sits.
            x, _, z = crowd.placement.position[:, crowd.walk.agent[walker]]
            near = row[np.hypot(plan.position[0, row] - x, plan.position[2, row] - z) < 0.3]
            near = near[near != goer]
            assert not seated[crowd.motion.shown[near]].any()
        if crowd.walkers.is_idle:
            break
    assert crowd.walkers.is_idle
    assert not crowd.seat.occupied[goer]
    passed = [a for a in row if (a > goer)] if max(stood) > goer else [a for a in row if a < goer]
    assert stood == {int(a) for a in passed}
    assert back == pytest.approx(ABACK, abs=1e-3)
    simulation.run(seconds=6.0)
    assert seated[crowd.motion.shown[row[row != goer]]].all()
    np.testing.assert_array_equal(crowd.placement.position[:, row], plan.position[:, row])


def test_leave_and_come_back(make: Make) -> None:
    simulation = make(walking=True, poses="none")
    crowd = simulation.crowd
    there = np.flatnonzero(crowd.seat.occupied)
    some = there[::43]
    empty = np.flatnonzero(~crowd.seat.occupied)[:3]
    gone = crowd.leave(np.concatenate([some, empty]), seconds=2.0)
    assert gone.tolist() == some.tolist()
    assert crowd.leave(some).tolist() == []  # they are about to
    assert until_idle(simulation, 90) > 0.3
    assert not crowd.seat.occupied[some].any()
    assert crowd.seat.occupied.sum() == len(there) - len(some)
    assert crowd.arrive(there[:99], seconds=1.0).tolist() == [a for a in some if a in there[:99]]
    assert crowd.arrive(some).tolist() == [a for a in some if a not in there[:99]]
    assert until_idle(simulation, 90) > 0.3
    assert crowd.seat.occupied[some].all()
    np.testing.assert_array_equal(crowd.placement.position, simulation.plan.position)


def test_those_who_come_out_go_first(make: Make) -> None:
    simulation = make(walking=True, occupancy=1.0, poses="none")
    crowd, plan = simulation.crowd, simulation.plan
    row = np.flatnonzero((plan.section == 1) & (plan.row == 1))
    crowd.leave(row[2])
    until_idle(simulation, 60)
    assert not crowd.seat.occupied[row[2]]
    # One comes to the seat at the row's end as another wants out of it, at the same end.
    crowd.arrive(row[2])
    crowd.leave(row[3])
    together = False
    for _ in range(80):
        simulation.run(seconds=1.0)
        walk = crowd.walk
        inside = (walk.mouth >= 0) & ((walk.vertex < walk.mouth) == (walk.errand == Errand.LEAVE))
        inside &= walk.stage == Stage.WALK
        together |= len(set(walk.step[inside].tolist())) > 1
        if crowd.walkers.is_idle:
            break
    assert crowd.walkers.is_idle
    assert not together
    assert crowd.seat.occupied[row[2]]
    assert not crowd.seat.occupied[row[3]]


def test_stewards(make: Make) -> None:
    simulation = make(stewards=3, occupancy=1.0)
    crowd = simulation.crowd
    ids = np.array(sorted(crowd.walkers.posts))
    assert len(ids) == 3
    assert (crowd.team.side[ids] == -1).all()
    assert len(np.unique(crowd.appearance.shirt[ids], axis=0)) == 1
    assert crowd.seat.occupied.all()
    assert not np.isin(ids, np.concatenate([crowd.leave("rows 0-99")])).any()
    fresh = make(stewards=3, poses="none")
    crowd = fresh.crowd
    heights = []
    for _ in range(12):
        fresh.run(seconds=2.0)
        heights.append(crowd.placement.position[1, sorted(crowd.walkers.posts)])
        assert len(crowd.walk) == 3
        # They don't stand for as long as they would.
        crowd.walk.until[:] = np.minimum(crowd.walk.until, fresh.clock.pose_tick + 60)
    climbed = np.ptp(np.array(heights), axis=0)
    assert (climbed > 0.2).any()


def test_steward_of_a_single_row_stays_at_its_foot(make: Make) -> None:
    simulation = make(seats=12, stewards=1, poses="none")
    crowd, ways = simulation.crowd, simulation.crowd.walkers.ways
    ((steward, gate),) = crowd.walkers.posts.items()
    assert ways.rows(gate) == 1
    foot = ways.stairs(gate, 0, 0).points[-1]
    for _ in range(4):
        simulation.run(seconds=2.0)
        crowd.walk.until[:] = 0
        off = crowd.placement.position[:, steward] - foot
        assert np.linalg.norm(off) < 0.3
        # It looks at the people, towards -Z on the far side.
        assert np.cos(crowd.placement.yaw[steward]) < 0.0


def test_same_seed_same_paths(make: Make) -> None:
    hashes = []
    for _ in range(2):
        simulation = make(latecomers=0.1, stewards=2)
        simulation.crowd.walkers.waiting[:, 2] //= 20
        simulation.run(seconds=8.0)
        hashes.append(simulation.crowd.state_hash())
        assert len(simulation.crowd.walk) > 2
    assert hashes[0] == hashes[1]


def test_orders_do_not_stop_walkers(make: Make) -> None:
    simulation = make(walking=True)
    crowd = simulation.crowd
    goers = np.flatnonzero(crowd.seat.occupied)[:2]
    crowd.leave(goers)
    simulation.run(seconds=3.0)
    crowd.guide(motion="cheer")
    simulation.run(seconds=1.5)
    cheering = crowd.library.roles[next(r for r in crowd.library.roles if r.value == "cheer")]
    walking = crowd.walk.agent
    assert len(walking)
    assert not np.isin(crowd.motion.wanted[walking], cheering).any()
    others = np.setdiff1d(np.flatnonzero(crowd.seat.occupied), walking)
    assert np.isin(crowd.motion.wanted[others], cheering).mean() > 0.9


def test_nobody_on_the_way_costs_nothing(make: Make) -> None:
    simulation = make(walking=True)
    simulation.run(seconds=1.0)
    assert simulation.crowd.placement.touches == 0
    assert not simulation.crowd.guidance.orders


def test_boxes_follow_walkers(make: Make) -> None:
    simulation = make(walking=True)
    crowd = simulation.crowd
    simulation.look(np.eye(4, dtype=np.float32), np.eye(4, dtype=np.float32), 720)
    simulation.advance(0.0)
    with simulation.active():
        before = esper.component_for_entity(crowd.entity, Bounds)
    assert before.fits(crowd.placement)
    crowd.leave(np.flatnonzero(crowd.seat.occupied)[5:200:50])
    simulation.run(seconds=12.0)
    assert not before.fits(crowd.placement)
    simulation.advance(0.0)
    with simulation.active():
        after = esper.component_for_entity(crowd.entity, Bounds)
    assert after.fits(crowd.placement)
    assert (after.low != before.low).any()
    np.testing.assert_array_equal(
        after.low[1],
        np.minimum.reduceat(crowd.placement.position[1], np.arange(0, len(crowd), 256)),
    )


def test_children_walk_on_their_own_bodies(make: Make) -> None:
    simulation = make(walking=True, children=0.2, old=0.1, streams=128)
    crowd = simulation.crowd
    twins = crowd.pool.twins
    gaits = [crowd.library.names.index(f"walk at {speed:g}") for speed in SPEEDS]
    with simulation.active():
        rows = esper.component_for_entity(crowd.entity, MotionStreams).first[gaits]
    assert (twins.table[1:, rows] >= 0).all()
    child = np.flatnonzero(crowd.body.kind == CHILD)
    assert len(child)
    shown = twins.resolve(rows[np.zeros(len(child), int)], crowd.body.kind[child])
    assert (twins.kind[shown] == CHILD).all()


@pytest.mark.parametrize(
    ("fields", "cause"),
    [
        ({"layout": "stand", "walking": True}, "no gangways"),
        ({"layout": "stand", "stewards": 1}, "no gangways"),
        ({"poses": "baked", "latecomers": 0.1}, "need 'streams'"),
        ({"stewards": 200}, "stewards is 200, expected at most"),
    ],
)
def test_crowds_that_cannot_walk(make: Make, fields: dict[str, Any], cause: str) -> None:
    with pytest.raises(ValueError, match=cause):
        make(**fields)


def test_wrong_calls(make: Make) -> None:
    crowd = make().crowd
    with pytest.raises(ValueError, match=r"walking=True"):
        crowd.leave(3)
    crowd = make(walking=True).crowd
    for seconds in (-1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="seconds"):
            crowd.leave(3, seconds=seconds)
    with pytest.raises(ValueError, match="no agent 400"):
        crowd.arrive(400)
    assert crowd.leave([]).tolist() == []


def test_character_without_a_walk(factories: ModuleType) -> None:
    character = factories.make_character(("sit_idle", "clap"))
    with pytest.raises(ValueError, match="no clip 'walk'"):
        Simulation(CrowdSpec(seats=200, walking=True, streams=8), character)
