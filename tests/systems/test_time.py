"""Offsets, histories, resting streams, ways and clip events of a whole crowd."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from tifo.components.motion import NEVER
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.behaviour import Goal
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]


@pytest.fixture
def spectators() -> Iterator[MakeSimulation]:
    """Make small simulations of the built-in spectator."""
    made: list[Simulation] = []

    def make(**fields: Any) -> Simulation:
        small = {"layout": "stand", "rows": 15, "columns": 20, "streams": 64, "neutrals": 0.0}
        simulation = Simulation(CrowdSpec(**{**small, **fields}), builtin_spectator())
        made.append(simulation)
        return simulation

    yield make
    for simulation in made:
        simulation.close()


def _shown(simulation: Simulation, name: str) -> np.ndarray:
    crowd = simulation.crowd
    return crowd.motion.shown == crowd.library.names.index(name)


def test_a_dilation_begins_at_the_next_pose_tick_and_ends(simulate: MakeSimulation) -> None:
    simulation = simulate(offsets=lambda rng, count: np.zeros(count, np.float32))
    crowd = simulation.crowd
    assert crowd.anim is not None
    simulation.run(seconds=0.1)
    crowd.behaviour.until[:] = NEVER
    crowd.dilate(np.array([3, 5]), np.array([6.0, 20.0], np.float32), 1.0)
    assert not crowd.anim.rate.any()
    simulation.run(seconds=2 / 60)
    assert crowd.anim.rate[0, [3, 4, 5]].tolist() == pytest.approx([0.2, 0.0, 0.25])
    assert (crowd.dilation.started, crowd.dilation.lengthened) == (2, 1)
    simulation.run(seconds=3.0)
    assert crowd.anim.start[0, [3, 5]].tolist() == [6.0, 20.0]
    assert crowd.dilation.arrived == 2


def test_a_wrong_dilation_is_refused_at_once(simulate: MakeSimulation) -> None:
    crowd = simulate().crowd
    one = np.array([0])
    for agents, targets, seconds, message in (
        (np.array([300]), np.ones(1, np.float32), 1.0, "agents are 300 to 300, expected 0 to 299"),
        (one, np.array([29], np.float32), 1.0, "0 to 28 poses"),
        (one, np.ones(2, np.float32), 1.0, "targets has shape"),
        (one, np.ones(1, np.float32), -1.0, "seconds is -1"),
    ):
        with pytest.raises(ValueError, match=message):
            crowd.dilate(agents, targets, seconds)
    assert crowd.dilation.waiting == []


def test_a_crowds_history_changes_under_way(simulate: MakeSimulation) -> None:
    simulation = simulate()
    crowd = simulation.crowd
    assert crowd.pool is not None
    assert crowd.anim is not None
    last = None
    for history in (12, 30, 20):
        crowd.set_history(history)
        crowd.dilate(np.array([0]), np.array([float(history - 2)], np.float32), 0.0)
        for _ in range(60 * 5):
            simulation.advance(1 / 60)
            shown = crowd.palettes(
                np.arange(300), simulation.clock.pose_tick, simulation.clock.alpha
            )
            # Four times the step of a quarter of a tick, a quarter faster, with blends.
            if last is not None:
                assert np.abs(shown - last).max() < 0.4
            last = shown
        assert (crowd.pool.history == history).all()
        assert (crowd.pool.valid == history).all()
        assert crowd.anim.target.max() <= history - 2 + 1e-4
    with pytest.raises(ValueError, match="history is 31, expected 2 to 30"):
        crowd.set_history(31)


def test_offsets_keep_their_spread_when_the_history_changes(simulate: MakeSimulation) -> None:
    simulation = simulate(offsets="uniform")
    crowd = simulation.crowd
    assert crowd.anim is not None
    crowd.behaviour.until[:] = NEVER
    simulation.run(seconds=0.1)
    before = crowd.anim.target[0].copy()
    crowd.set_history(16)
    simulation.run(seconds=6.0)
    np.testing.assert_allclose(crowd.anim.start[0], before / 2, atol=1e-3)


def test_streams_that_nobody_shows_rest_and_the_crowd_looks_alive_all_the_same(
    simulate: MakeSimulation,
) -> None:
    simulation = simulate(rest_idle=True, sides=1)
    crowd = simulation.crowd
    pool = crowd.pool
    assert pool is not None
    assert crowd.anim is not None
    simulation.run(seconds=4.0)
    calm = int(pool.running.sum())
    assert calm <= 20 < int(pool.alive.sum())
    simulation.send(Goal(0))
    last = None
    for _ in range(3 * 60):
        simulation.advance(1 / 60)
        shown = crowd.palettes(np.arange(300), simulation.clock.pose_tick, simulation.clock.alpha)
        assert last is None or np.abs(shown - last).max() < 0.4
        last = shown
    assert int(pool.running.sum()) > calm
    assert pool.running[np.unique(crowd.anim.row[0])].all()
    # Streams that woke are spread over again.
    assert crowd.anim.target[0].std() > 4.0


def test_seated_spectators_get_up_to_cheer_and_sit_down_again(spectators: MakeSimulation) -> None:
    simulation = spectators()
    crowd = simulation.crowd
    simulation.run(seconds=1.0)
    seated = np.array([name.startswith("sit_") for name in crowd.library.names])
    crowd.team.fervour[:] = 1.0  # no ultras, who don't sit down
    sat = seated[crowd.motion.shown] & ~_shown(simulation, "sit_down")
    simulation.send(Goal(0))
    got_up = np.zeros(len(crowd), bool)
    sat_down = np.zeros(len(crowd), bool)
    jumped = 0
    before = crowd.motion.shown.copy()
    stand_up, sit_down = (crowd.library.names.index(n) for n in ("stand_up", "sit_down"))
    for second in range(30 * 30):
        if second == 10 * 30:
            crowd.emotion.excitement[:] = crowd.emotion.rest_excitement
        simulation.run(seconds=2 / 60)
        now = crowd.motion.shown
        got_up |= _shown(simulation, "stand_up")
        sat_down |= _shown(simulation, "sit_down")
        ways = (before == stand_up) | (now == stand_up) | (before == sit_down) | (now == sit_down)
        jumped += int((seated[before] & ~seated[now] & ~ways).sum())
        before = now.copy()
    assert sat.mean() > 0.7
    assert got_up[sat].mean() > 0.9
    assert sat_down[sat].mean() > 0.85
    # Who is in the middle of a blend cross-fades.
    assert jumped <= 0.01 * len(crowd)


def test_a_way_is_played_from_its_beginning_to_its_end(spectators: MakeSimulation) -> None:
    simulation = spectators()
    crowd = simulation.crowd
    assert crowd.pool is not None
    assert crowd.anim is not None
    simulation.run(seconds=0.5)
    crowd.behaviour.until[:] = NEVER
    assert crowd.transition is not None
    resting = crowd.transition.duration[0] == 0
    sitting = np.flatnonzero(_shown(simulation, "sit_idle") & resting)
    crowd.motion.wanted[sitting] = crowd.library.names.index("cheer")
    simulation.run(seconds=2 / 60)
    assert _shown(simulation, "stand_up")[sitting].all()
    hips = crowd.character.skeleton.names.index("hips")
    bind = np.eye(4)
    bind[:3] = crowd.character.skeleton.inverse_bind[hips]
    joint = np.linalg.inv(bind)[:, 3]
    heights = []
    while _shown(simulation, "stand_up")[sitting].any():
        palettes = crowd.palettes(sitting, simulation.clock.pose_tick)[:, hips]
        heights.append((palettes @ joint)[:, 1])
        simulation.run(seconds=2 / 60)
    height = np.array(heights)
    # From the seat to standing, with no way back down: the loop's seam is never seen.
    assert (height[0] < 0.65).all()
    assert (height[-1] > 0.85).all()
    assert np.diff(height, axis=0).min() > -0.03
    # They begin within the jitter of each other, not all at once.
    assert len(np.unique(np.round(crowd.anim.start[0, sitting], 2))) > 10
    assert 30 <= len(heights) <= 50


def test_who_is_hit_does_not_get_up_first(spectators: MakeSimulation) -> None:
    simulation = spectators()
    crowd = simulation.crowd
    simulation.run(seconds=0.5)
    agent = int(np.flatnonzero(_shown(simulation, "sit_idle"))[0])
    crowd.motion.wanted[agent] = crowd.library.names.index("dismay")
    crowd.motion.blend[agent] = 6.0
    crowd.behaviour.until[:, agent] = NEVER
    simulation.run(seconds=2 / 60)
    assert _shown(simulation, "dismay")[agent]


def test_a_crowd_with_few_streams_has_no_ways(spectators: MakeSimulation) -> None:
    assert "stand_up" not in spectators(streams=16).crowd.library.names
    assert "stand_up" not in spectators(poses="baked").crowd.library.names


def test_claps_are_heard_at_the_rate_at_which_hands_meet(spectators: MakeSimulation) -> None:
    simulation = spectators(occupancy=0.5)
    crowd = simulation.crowd
    assert crowd.pool is not None
    assert crowd.anim is not None
    crowd.guide(motion="clap")
    simulation.run(seconds=6.0)
    heard = np.zeros(len(crowd))
    calls: list[int] = []

    def listen(agents: np.ndarray, weights: np.ndarray) -> None:
        assert (np.diff(agents) >= 0).all()
        np.add.at(heard, agents, weights)
        calls.append(simulation.clock.pose_tick)
        np.testing.assert_array_equal(crowd.clip_events("clap_contact")[0], agents)

    end = crowd.on_clip_event("clap_contact", listen)
    expected = np.zeros(len(crowd))
    for _ in range(300):
        simulation.run(seconds=2 / 60)
        expected += crowd.company.rhythm.speed / 30.0
    end()
    clappers = crowd.seat.occupied
    assert clappers.sum() > 100
    # Everybody claps at a beat of its own, whichever stream it is on: two or three times a second.
    assert np.ptp(expected[clappers]) > 8.0
    away = np.abs(heard - expected)[clappers]
    assert np.median(away) <= 0.8
    assert np.percentile(away, 95) <= 2.0
    assert heard[~crowd.seat.occupied].max() == 0.0
    assert calls == sorted(set(calls))
    count = heard.sum()
    simulation.run(seconds=1.0)
    assert heard.sum() == count


def test_unknown_events_and_baked_crowds_say_so(spectators: MakeSimulation) -> None:
    crowd = spectators().crowd
    with pytest.raises(ValueError, match="no clip event 'clap'; known: clap_contact, shout, apex"):
        crowd.on_clip_event("clap", lambda agents, weights: None)
    with pytest.raises(ValueError, match="no clip event"):
        crowd.clip_events("clap")
    baked = spectators(poses="baked").crowd
    for call in (
        lambda: baked.on_clip_event("clap_contact", lambda agents, weights: None),
        lambda: baked.clip_events("clap_contact"),
        lambda: baked.set_history(30),
        lambda: baked.dilate(np.zeros(0, np.int64), np.zeros(0, np.float32), 1.0),
    ):
        with pytest.raises(ValueError, match="poses are baked"):
            call()


def test_the_spectators_tags_are_where_hands_meet_and_hips_are_highest() -> None:
    from tifo.engine.animation import ClipBank, Kinematics

    character = builtin_spectator()
    skeleton = character.skeleton
    bank = ClipBank(skeleton, character.clips)
    hips, left, right = (skeleton.names.index(n) for n in ("hips", "hand_l", "hand_r"))
    joints = np.array([hips, left, right])
    for name in ("clap", "sit_clap", "jump"):
        clip = character.clip(name)
        workspace = Kinematics(skeleton, clip.frame_count)
        times = np.linspace(0.0, clip.duration, clip.frame_count)
        which = np.full(clip.frame_count, bank.index(name))
        pose = bank.sample(
            which, times, np.zeros(len(times), bool), workspace.mixed, workspace.scratch
        )
        palettes = np.empty((len(times), skeleton.joint_count, 3, 4), np.float32)
        workspace.evaluate(pose, palettes)
        place = workspace.joint_positions(joints)
        if name == "jump":
            apex = times[np.argmax(place[:, 0, 1])]
            assert clip.events[0].time == pytest.approx(apex, abs=1.5 / 60)
            continue
        apart = np.linalg.norm(place[:, 1] - place[:, 2], axis=1)
        assert len(clip.events) == 8
        for event in clip.events:
            key = round(event.time * 60)
            near = apart[np.arange(key - 3, key + 4) % (len(apart) - 1)]
            assert near.argmin() == 3, (name, event.time)
