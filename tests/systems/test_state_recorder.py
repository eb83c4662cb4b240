"""Time series of a crowd, against its columns counted one by one."""

from __future__ import annotations

from collections.abc import Callable

import esper
import numpy as np
import pytest

from tifo.engine.behaviour import Goal
from tifo.engine.clock import Clock
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.crowd.stadium import build_seats
from tifo.systems.schedule import add_systems
from tifo.systems.simulation import Simulation
from tifo.systems.spawn import spawn_crowd

MakeSimulation = Callable[..., Simulation]
BOWL = {"layout": "bowl", "seats": 900, "sides": 2, "fans": "mixed", "neutrals": 0.2}


def test_counts_are_those_of_the_columns(simulate: MakeSimulation) -> None:
    simulation = simulate(**BOWL, occupancy=0.8)
    crowd = simulation.crowd
    watch = crowd.watch(every=0.5)
    simulation.send(Goal(0))
    simulation.run(seconds=2.0)
    # Samples are taken half a second apart, from the first tick on.
    np.testing.assert_allclose(watch.times, [1 / 30, 16 / 30, 31 / 30, 46 / 30])
    late = crowd.watch(every=10.0)
    simulation.run(seconds=1 / 30)
    there = crowd.seat.occupied
    section = np.array([name for name, _, _ in crowd.plan.sections])[crowd.seat.section]
    assert late.groups("section") == [name for name, _, _ in crowd.plan.sections]
    assert late.groups("team") == [-1, 0, 1]
    channels = crowd.channels()
    for channel in ("posture", "arms", "head"):
        for by, of in (("team", crowd.team.side), ("section", section)):
            counts = late.counts(channel, by)[0]
            for g, group in enumerate(late.groups(by)):
                inside = there & (of == group)
                for v, value in enumerate(late.names(channel)):
                    assert counts[g, v] == np.sum(inside & (np.array(channels[channel]) == value))
    for v, name in enumerate(late.names()):
        assert late.counts()[0, 0, v] == np.sum(crowd.in_state(name) & there)
        expected = np.mean(crowd.in_state(name)[there & (crowd.team.side == 0)])
        assert late.share(name, "team")[0, 1] == pytest.approx(expected)
    for g, side in enumerate((-1, 0, 1)):
        inside = there & (crowd.team.side == side)
        for feeling in ("excitement", "embarrassment", "mood", "fatigue"):
            mean = getattr(crowd.emotion, feeling)[inside].mean()
            assert late.mean(feeling, "team")[0, g] == pytest.approx(mean, abs=1e-6)
        assert late.count("reacting", "team")[0, g] == crowd.behaviour.reacting[inside].sum()
    assert late.people()[0, 0] == there.sum()
    # Machines are beside each other: everybody is in one state of each.
    np.testing.assert_allclose(late.shares().sum(axis=2), len(crowd.behaviour.state))


def test_a_goal_is_seen_in_the_series_of_its_side(simulate: MakeSimulation) -> None:
    simulation = simulate(**BOWL)
    watch = simulation.crowd.watch(every=0.1, by=["team"])
    simulation.run(seconds=2.0)
    simulation.send(Goal(1))
    simulation.run(seconds=4.0)
    standing = watch.share("standing", "team", channel="posture")
    before, after = watch.times <= 2.0, watch.times > 5.0
    away = watch.groups("team").index(1)
    assert standing[before, away].max() < 0.3
    assert standing[after, away].min() > 0.9
    assert watch.mean("excitement", "team")[-1, away] > 0.5
    assert len(watch) == 60
    watch.stop()
    simulation.run(seconds=1.0)
    assert len(watch) == 60
    with pytest.raises(ValueError, match="by is 'section', recorded was 'all', 'team'"):
        watch.shares("state", "section")


def test_sections_where_nobody_is_have_no_shares(simulate: MakeSimulation) -> None:
    simulation = simulate(**BOWL, empty=("section 2",))
    watch = simulation.crowd.watch(by=("section",))
    simulation.run(seconds=0.1)
    assert watch.people("section")[0, 2] == 0
    assert np.isnan(watch.shares("posture", "section")[0, 2]).all()
    assert np.isnan(watch.mean("mood", "section")[0, 2])
    assert np.isfinite(watch.shares("posture", "section")[0, 1]).all()


def test_watching_changes_nothing_and_works_in_a_world_of_ones_own() -> None:
    spec = CrowdSpec(seats=200, streams=16, history=8, props=0.0)
    hashes, samples = [], 0
    for watched in (False, True):
        esper.switch_world("watched")
        try:
            crowd = spawn_crowd(spec, build_seats(spec), Simulation(spec).crowd.character)
            add_systems(spec.seed)
            watch = crowd.watch(every=0) if watched else None
            clock = Clock()
            for _ in range(60):
                clock.advance()
                esper.process(clock)
            hashes.append(crowd.state_hash())
            samples = 0 if watch is None else len(watch)
        finally:
            esper.switch_world("default")
            esper.delete_world("watched")
    assert hashes[0] == hashes[1]
    assert samples == 30


def test_wrong_questions_are_named(simulate: MakeSimulation) -> None:
    crowd = simulate().crowd
    for message, call in (
        ("every is nan, expected seconds", lambda: crowd.watch(every=np.nan)),
        ("every is -1", lambda: crowd.watch(every=-1)),
        ("by names 'row', expected some of 'all', 'team'", lambda: crowd.watch(by=["row"])),
    ):
        with pytest.raises(ValueError, match=message):
            call()
    watch = crowd.watch()
    assert watch.shares("arms", "team").shape == (0, 2, len(watch.names("arms")))
    for message, call in (
        ("state has no value 'fly'; there are start, sit", lambda: watch.share("fly")),
        ("channel is 'feet'", lambda: watch.shares("feet")),
        ("feeling is 'joy', expected one of excitement", lambda: watch.mean("joy")),
        ("flag is 'flying'", lambda: watch.count("flying")),
    ):
        with pytest.raises(ValueError, match=message):
            call()
    watch.take(5)
    with pytest.raises(ValueError, match="tick is 5, expected one after 5"):
        watch.take(5)
