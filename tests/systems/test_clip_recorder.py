"""Clip schedules: instances follow each other, and say where in their clips agents really are."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import esper
import numpy as np
import pytest

from tifo.engine.behaviour import Goal
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.errors import AssetError
from tifo.engine.export import ClipSchedule
from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]


@pytest.fixture(scope="module")
def goal() -> ClipSchedule:
    """Ten seconds of a stand of the built-in spectator; a goal falls in the second one."""
    simulation = Simulation(
        CrowdSpec(layout="stand", rows=5, columns=20, sides=2, fans="blocks", seed=3)
    )
    simulation.send(Goal(0, time=1.0))
    schedule = simulation.crowd.schedule(10.0)
    simulation.close()
    return schedule


def _check(schedule: ClipSchedule) -> None:
    """Every agent's instances follow each other from beginning to end, as long as they say."""
    for agent in schedule.agents:
        own = schedule.agent == agent
        start, end = schedule.start[own], schedule.end[own]
        assert start[0] == 0.0
        assert end[-1] == pytest.approx(schedule.seconds)
        np.testing.assert_array_equal(start[1:], end[:-1])
        assert (end > start).all()
    played = schedule.source_end - schedule.source_start
    moves = played > 0
    shown = schedule.cycles * played * schedule.scale
    np.testing.assert_allclose(shown[moves], (schedule.end - schedule.start)[moves], atol=1e-9)
    assert (schedule.cycles >= 1).all()
    several = schedule.cycles > 1
    assert schedule.looping[schedule.clip[several]].all(), "what plays once isn't repeated"
    np.testing.assert_allclose(
        played[several], schedule.durations[schedule.clip[several]], rtol=1e-6
    )
    assert schedule.relative.all()


def test_instances_fill_the_time_and_hold_together(goal: ClipSchedule) -> None:
    assert goal.seconds == 10.0
    _check(goal)
    names = set(goal.clips)
    assert {"stand_up", "sit_idle"} <= names
    assert any(name.startswith("clap") for name in names)
    up = goal.clip == goal.clips.index("stand_up")
    # From its beginning, though streams hold its first pose, until the next motion blends in.
    length = goal.durations[goal.clips.index("stand_up")]
    assert np.median(goal.source_start[up]) < 0.05
    assert np.median(goal.source_end[up]) == pytest.approx(length - 6 / 30 * 1.4, abs=0.06)
    np.testing.assert_allclose(goal.scale[up], 1 / 1.4, atol=0.02)
    assert (goal.blend[goal.start > 0] > 0).mean() > 0.9


def test_what_it_says_is_what_agents_show(simulate: MakeSimulation) -> None:
    simulation = simulate(columns=10)
    crowd = simulation.crowd
    recorder = crowd.watch_clips("rows 0-5")
    simulation.send(Goal(0, time=1.0))
    simulation.run(seconds=3.0)
    schedule = recorder.finish()
    _check(schedule)
    pool, anim = crowd.pool, crowd.anim
    assert pool is not None
    assert anim is not None
    tick = simulation.clock.pose_tick
    rests = anim.rate[0] == 0
    checked = 0
    for agent in schedule.agents:
        row = anim.row[0, agent]
        last = np.flatnonzero(schedule.agent == agent)[-1]
        assert schedule.clips[schedule.clip[last]] == pool.bank.clips[pool.clip[row]].name
        if not rests[agent] or pool.head[row] != tick:
            continue
        # The time at the head, less what the agent is behind: by the definition of a stream.
        duration = pool.bank.duration[pool.clip[row]]
        behind = anim.start[0, agent] / 30 * pool.speed[row]
        played = schedule.cycles[last] * (schedule.source_end[last] - schedule.source_start[last])
        ahead = schedule.source_start[last] + played - (pool.time[row] - behind)
        assert abs((ahead + duration / 2) % duration - duration / 2) < 1e-3
        checked += 1
    assert checked > 20


@pytest.mark.parametrize("poses", ["baked", "none"])
def test_other_crowds_have_schedules_too(simulate: MakeSimulation, poses: str) -> None:
    simulation = simulate(poses=poses)
    simulation.send(Goal(0, time=1.0))
    schedule = simulation.crowd.schedule(4.0)
    _check(schedule)
    assert len(schedule) > 1.5 * len(schedule.agents)
    if poses == "none":
        assert np.isclose(schedule.scale, 1.0).mean() > 0.98


def test_files(goal: ClipSchedule, tmp_path: Path) -> None:
    with goal.write(tmp_path / "clips.csv").open(newline="", encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    assert len(rows) == len(goal)
    assert rows[0]["agent"] == str(goal.agents[0])
    assert rows[0]["seat"] == goal.labels[0]
    assert rows[0]["relative"] == "true"
    assert float(rows[5]["source_start"]) == pytest.approx(goal.source_start[5], abs=1e-4)
    document = json.loads(goal.write(tmp_path / "clips.json").read_text("utf-8"))
    assert document["seconds"] == 10.0
    assert set(document["clips"]) == set(goal.clips)
    assert len(document["agents"]) == len(goal.agents)
    one = document["agents"][7]
    assert len(one["clips"]) == np.sum(goal.agent == one["agent"])
    np.testing.assert_allclose(one["position"], goal.position[7], atol=1e-4)
    assert [row["clip"] for row in goal.rows(one["agent"])] == [c["clip"] for c in one["clips"]]
    with pytest.raises(AssetError, match=r"must end in \.csv or \.json"):
        goal.write(tmp_path / "clips.xml")
    with pytest.raises(ValueError, match="agent is 12345"):
        next(goal.rows(12345))


def test_wrong_calls_are_named(simulate: MakeSimulation) -> None:
    simulation = simulate()
    crowd = simulation.crowd
    for seconds in (0.0, -1.0, float("nan"), 1e6):
        with pytest.raises(ValueError, match="expected more than 0, at most 86400"):
            crowd.schedule(seconds)
    with pytest.raises(ValueError, match="nobody is there"):
        crowd.watch_clips([])
    with pytest.raises(ValueError, match="no pose tick has passed"):
        crowd.watch_clips().finish()
    with simulation.active():
        esper.remove_processor(type(simulation.schedule))
    with pytest.raises(ValueError, match="no Schedule to let time pass; use watch_clips"):
        crowd.schedule(1.0)


def test_a_crowd_without_poses_behaves_and_says_what_it_lacks(simulate: MakeSimulation) -> None:
    simulation = simulate(poses="none")
    crowd = simulation.crowd
    simulation.run(seconds=1.0)
    assert (crowd.motion.shown == crowd.motion.wanted).all()
    simulation.send(Goal(0))
    simulation.run(seconds=2.0)
    assert crowd.behaviour.reacting.mean() > 0.8
    assert len(crowd.where(motion=crowd.library.names)) == crowd.seat.occupied.sum()
    for message, call in (
        ("has no poses to show", lambda: crowd.palettes(np.arange(3), 1)),
        ("has no poses and can't blend", lambda: crowd.uniques),
        ("poses are none; streams have offsets", lambda: crowd.set_history(20)),
        ("has no poses and has no overlays", lambda: crowd.clear_overlay(0)),
    ):
        with pytest.raises(ValueError, match=message):
            call()
