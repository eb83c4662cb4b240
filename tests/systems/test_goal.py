"""A goal, seen from outside: who moves, when, and how it ends."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from tifo.components.motion import NEVER
from tifo.engine.behaviour import Goal
from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]


def _doing(simulation: Simulation, *states: str) -> np.ndarray:
    return np.any([simulation.crowd.in_state(state) for state in states], axis=0)


@pytest.mark.parametrize("poses", ["streams", "baked"])
def test_most_supporters_cheer_within_two_seconds_and_all_calm_down(
    simulate: MakeSimulation, poses: str
) -> None:
    simulation = simulate(poses=poses, sides=2, away_share=0.3, neutrals=0.0)
    crowd = simulation.crowd
    simulation.run(seconds=1.0)
    before = crowd.motion.shown.copy()
    simulation.send(Goal(0))
    simulation.run(seconds=2.0)
    present = crowd.seat.occupied
    home, away = present & (crowd.team.side == 0), present & (crowd.team.side == 1)
    changed = crowd.motion.shown != before
    assert changed[home].mean() > 0.9
    loud = _doing(simulation, "clap", "cheer", "jump")
    assert loud[home].mean() > 0.9
    assert loud[away].mean() < 0.1
    assert 0.3 < _doing(simulation, "dismay", "sit_dismay")[away].mean() < 0.9
    assert not crowd.behaviour.reacting[~present].any()
    simulation.run(seconds=28.0)
    assert not crowd.behaviour.reacting.any()
    # Those who are still excited are on their feet and break out now and then.
    assert _doing(simulation, "clap", "cheer", "jump")[home].mean() < 0.4
    crowd.emotion.excitement[:] = crowd.emotion.rest_excitement
    simulation.run(seconds=20.0)
    assert not _doing(simulation, "clap", "cheer", "jump", "dismay").any()
    ultras = crowd.team.fervour > 1.3
    assert _doing(simulation, "stand")[~ultras].mean() < 0.1
    # Nobody is left behind by what they want, but for those who are changing just now.
    behind = crowd.motion.shown != crowd.motion.wanted
    assert behind.mean() < 0.1


def test_what_is_drawn_follows_what_is_wanted(simulate: MakeSimulation) -> None:
    simulation = simulate(neutrals=0.0)
    crowd = simulation.crowd
    pool, anim = crowd.pool, crowd.anim
    assert pool is not None
    assert anim is not None
    for _ in range(20):
        simulation.run(seconds=0.2)
        if simulation.clock.tick == 48:
            simulation.send(Goal(0))
        np.testing.assert_array_equal(
            pool.clip[anim.row[0]], crowd.library.clips[crowd.motion.shown]
        )
        assert (anim.start[0] <= 28.0).all()


def test_a_goal_between_two_frames_takes_effect_at_the_next_pose_tick(
    simulate: MakeSimulation,
) -> None:
    simulation = simulate()
    behaviour = simulation.crowd.behaviour
    simulation.advance(2 / 60)
    simulation.send(Goal(0))
    simulation.advance(0.0)
    assert not behaviour.stirred_until.any()
    # Tick 3 is no pose tick.
    simulation.advance(1 / 60)
    assert simulation.clock.tick == 3
    assert not behaviour.stirred_until.any()
    simulation.advance(1 / 60)
    will_react = behaviour.stirred_until > simulation.clock.pose_tick
    assert will_react.mean() > 0.8
    # Nobody reacts faster than a tenth of a second.
    assert behaviour.stirred_from[will_react].min() >= simulation.clock.pose_tick + 4


def test_a_goal_may_be_announced_for_a_time(simulate: MakeSimulation) -> None:
    simulation = simulate()
    simulation.send(Goal(0, time=1.0))
    simulation.run(seconds=0.95)
    assert not simulation.crowd.behaviour.stirred_until.any()
    simulation.run(seconds=0.1)
    assert simulation.crowd.behaviour.stirred_until.any()


@pytest.mark.parametrize("slots", [0, 8])
def test_an_agent_may_change_its_mind_in_the_middle_of_a_blend(
    simulate: MakeSimulation, slots: int
) -> None:
    simulation = simulate(slots=slots)
    crowd = simulation.crowd
    transition, anim, pool = crowd.transition, crowd.anim, crowd.pool
    assert transition is not None
    assert anim is not None
    assert pool is not None
    crowd.behaviour.until[:] = NEVER  # nobody moves on
    simulation.run(seconds=0.1)
    crowd.motion.wanted[0] = 4
    simulation.run(seconds=2 / 60)
    assert (crowd.motion.shown[0], transition.duration[0, 0]) == (4, 12.0)
    before = simulation.clock.pose_tick
    assert transition.begin[0, 0] == before - 1
    simulation.run(seconds=6 / 60)
    crowd.motion.wanted[0] = 6
    simulation.run(seconds=2 / 60)
    assert crowd.motion.shown[0] == 6
    clip = crowd.library.clips[6]
    if slots:
        assert pool.clip[anim.row[0, 0]] == clip
        assert transition.begin[0, 0] == simulation.clock.pose_tick - 1
        assert transition.row[0, 0] >= pool.store.first_slot
        assert crowd.blend_counts.tick.snapshot == 1
        return
    assert pool.clip[anim.row[0, 0]] == crowd.library.clips[4]
    assert crowd.blend_counts.tick.deferred == 1
    # A third of 12 ticks are gone; what is left goes twice as fast.
    while pool.clip[anim.row[0, 0]] != clip:
        simulation.run(seconds=2 / 60)
    assert simulation.clock.pose_tick == before + 4 + 4


def test_a_baked_agent_changes_clip_at_once(simulate: MakeSimulation) -> None:
    simulation = simulate(poses="baked")
    crowd = simulation.crowd
    assert crowd.pool is None
    assert crowd.baked is not None
    poses, clips = crowd.baked
    crowd.motion.wanted[0] = 4
    crowd.behaviour.until[:, 0] = NEVER
    simulation.run(seconds=2 / 60)
    assert clips.clip[0] == crowd.library.clips[4]
    shown = crowd.palettes(np.array([0]), simulation.clock.pose_tick)[0]
    first, count = int(poses.start[clips.clip[0]]), int(poses.frames[clips.clip[0]])
    own = poses.palettes[first : first + count]
    assert (np.abs(own - shown).max(axis=(1, 2, 3)) == 0).any()


def test_a_character_without_clips_stands_still(
    simulate: MakeSimulation, factories: object
) -> None:
    spec = simulate(children=0.0, old=0.0).spec
    still = factories.make_character(())  # type: ignore[attr-defined]
    simulation = Simulation(spec, still)
    simulation.send(Goal(0))
    simulation.run(seconds=1.0)
    shown = simulation.crowd.palettes(np.arange(10), simulation.clock.pose_tick, 0.3)
    np.testing.assert_allclose(shown, np.broadcast_to(np.eye(3, 4), shown.shape), atol=1e-6)
    simulation.close()
