"""Applause, rhythm, waves, parties and the ball's neighbours in a crowd that runs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from tifo.components.overlays import NO_MASK
from tifo.engine.behaviour.events import BallHit, Event, Goal
from tifo.engine.crowd.spec import CrowdSpec
from tifo.systems.crowd import Crowd
from tifo.systems.simulation import Simulation

TICK = 2 / 60
Make = Callable[..., Simulation]


@pytest.fixture
def spectators() -> Iterator[Make]:
    """Built-in spectators in a stand, closed after the test."""
    made: list[Simulation] = []

    def make(**fields: Any) -> Simulation:
        stand = {"layout": "stand", "rows": 20, "columns": 40, "step": 0.6, "rise": 0.4,
                 "depth": 0.8, "occupancy": 1.0, "neutrals": 0.0, "props": 0.0}  # fmt: skip
        made.append(Simulation(CrowdSpec(**{**stand, **fields})))
        return made[-1]

    yield make
    for simulation in made:
        simulation.close()


def _clapping(crowd: Crowd) -> np.ndarray:
    return crowd.in_state("sit_clap") | crowd.in_state("clap")


def test_nothing_that_a_shipped_table_asks_for_is_missing(spectators: Make) -> None:
    crowd = spectators(rows=4, columns=6).crowd
    assert crowd.table.notes == ()
    assert {"talk_2", "sit_talk_2", "mexican_wave", "sit_mexican_wave", "duck", "sit_reach",
            "sit_disappointed", "sit_turn_left"} <= set(crowd.library.names)  # fmt: skip
    assert crowd.pool is not None
    assert len(crowd.pool.twins.types) == 2
    # Whatever motion an agent wants, its body type has a stream for it.
    for base in range(len(crowd.library.names)):
        clip = crowd.library.clips[base]
        kinds = set(crowd.pool.twins.kind[crowd.pool.alive & (crowd.pool.clip == clip)].tolist())
        assert kinds == {0, 1, 2}, crowd.library.names[base]


@pytest.mark.parametrize("table", ["rock_concert", "classical_concert", "speech"])
def test_other_tables_lack_nothing_either(spectators: Make, table: str) -> None:
    notes = spectators(rows=4, columns=6, behaviour=table).crowd.table.notes
    assert all(note.startswith("sway") for note in notes)


def test_an_event_is_applauded_and_the_applause_ends_by_itself(spectators: Make) -> None:
    simulation = spectators(sides=2, fans="blocks")
    crowd = simulation.crowd
    simulation.run(seconds=2.0)
    assert _clapping(crowd).mean() < 0.02
    simulation.send(Event("substitution", side=0))
    shares = []
    for _ in range(50):
        simulation.run(seconds=0.5)
        shares.append(_clapping(crowd)[crowd.team.side == 0].mean())
    rise = int(np.argmax(np.array(shares) > 0.8))
    fall = len(shares) - int(np.argmax(np.array(shares[::-1]) > 0.8))
    assert max(shares) > 0.9
    assert rise <= 8, "within four seconds"
    assert shares[-1] < 0.05
    assert fall - rise >= 4, "it lasts for some seconds"


def test_the_less_impressive_the_fewer_clap(spectators: Make) -> None:
    peaks = []
    for weight in (0.02, 0.1, 0.4):
        simulation = spectators()
        simulation.send(Event("substitution", side=0, weight=weight))
        share = 0.0
        for _ in range(12):
            simulation.run(seconds=0.5)
            share = max(share, float(_clapping(simulation.crowd).mean()))
        peaks.append(share)
    assert peaks[0] < 0.15
    assert peaks[2] > 0.9
    assert peaks == sorted(peaks)


def test_opponents_refuse(spectators: Make) -> None:
    simulation = spectators(sides=2, fans="blocks")
    crowd = simulation.crowd
    simulation.send(Event("referee_decision", side=0, weight=1.0))
    simulation.run(seconds=3.0)
    clapping, side = _clapping(crowd), crowd.team.side
    assert clapping[side == 0].mean() > 0.8
    assert clapping[side == 1].mean() < 0.05


def test_hands_meet_when_the_rhythm_says_so(spectators: Make) -> None:
    simulation = spectators()
    crowd = simulation.crowd
    crowd.guide(motion="clap")
    simulation.run(seconds=3.0)
    phases: list[np.ndarray] = []

    def listen(agents: np.ndarray, weights: np.ndarray) -> None:
        phases.append(crowd.company.rhythm.phase[agents[weights == 1.0]].copy())

    crowd.on_clip_event("clap_contact", listen)
    simulation.run(seconds=3.0)
    met = np.concatenate(phases)
    assert len(met) > 800 * 3
    # A clap is about ten pose ticks; when it is heard, the phase passed 0 within the last.
    away = (met + 0.5) % 1.0 - 0.5
    assert 0.0 < np.median(away) < 0.13
    assert np.ptp(np.percentile(away, [5, 95])) < 0.2


def test_a_common_beat_is_heard_in_the_claps(spectators: Make) -> None:
    simulation = spectators()
    crowd = simulation.crowd
    crowd.guide(motion="clap")
    simulation.run(seconds=3.0)
    rhythm = crowd.company.rhythm
    claps: list[int] = []
    crowd.on_clip_event("clap_contact", lambda agents, _: claps.append(len(agents)))

    def unevenness() -> float:
        heard = []
        for _ in range(60):
            claps.clear()
            simulation.run(seconds=TICK)
            heard.append(sum(claps))
        return float(np.std(heard) / max(np.mean(heard), 1e-6))

    free = unevenness()
    rhythm.phase[:] = 0.0
    rhythm.rate[:] = 1.65
    rhythm.is_slow[:] = True
    rhythm._felt[:] = 0.0
    common = unevenness()
    assert free < 0.4
    assert common > 1.8


def test_a_wave_runs_along_the_stand_at_the_speed_of_waves(spectators: Make) -> None:
    simulation = spectators(rows=30, columns=300, sides=1, ultras=0.0, seed=3)
    crowd = simulation.crowd
    simulation.run(seconds=1.0)
    up = np.flatnonzero((crowd.plan.column < 6) & (crowd.plan.row >= 8) & (crowd.plan.row < 20))
    assert len(crowd.start_wave(up)) == len(up)
    seen = np.full(len(crowd), np.nan)
    for tick in range(400):
        simulation.run(seconds=TICK)
        new = crowd.in_state("sit_mexican_wave") | crowd.in_state("mexican_wave")
        seen[new & np.isnan(seen)] = tick / 30.0
    reached = [np.nanmedian(seen[crowd.plan.column == column]) for column in range(60, 200)]
    took_part = [np.isfinite(seen[crowd.plan.column == column]).mean() for column in (60, 130, 199)]
    assert min(took_part) > 0.8
    speed = 1.0 / np.polyfit(np.arange(60, 200), reached, 1)[0]
    assert 19.0 < speed < 25.0
    # What they show is the wave, on the seat or standing.
    last = np.flatnonzero(crowd.in_state("sit_mexican_wave"))
    names = {crowd.library.names[k] for k in crowd.motion.shown[last]}
    assert "sit_mexican_wave" in names or not len(last)


def test_a_wave_begins_where_an_event_says_and_a_goal_ends_it(spectators: Make) -> None:
    simulation = spectators(columns=80)
    crowd = simulation.crowd
    place = tuple(float(v) for v in crowd.plan.position[:, crowd.plan.find("10|2")])
    simulation.send(Event("mexican_wave", place=place))
    simulation.run(seconds=1.0)
    assert (crowd.in_state("sit_mexican_wave") | crowd.in_state("mexican_wave")).sum() > 40
    simulation.send(Goal(0))
    simulation.run(seconds=TICK)
    assert crowd.company.wave.is_quiet
    simulation.run(seconds=3.0)
    assert not crowd.in_state("sit_mexican_wave").any()


def test_waves_of_bored_people_die(spectators: Make) -> None:
    simulation = spectators(rows=4, columns=5)
    crowd = simulation.crowd
    before = crowd.company.wave.threshold.copy()
    crowd.start_wave(np.arange(20))
    simulation.run(seconds=0.5)
    raised = crowd.company.wave.threshold - before
    assert raised.min() > 0.015
    simulation.run(seconds=60.0)
    later = crowd.company.wave.threshold - before
    np.testing.assert_allclose(later / raised, np.exp(-60 / 240), atol=0.03)


def test_those_near_the_ball_duck_reach_point_and_laugh(spectators: Make) -> None:
    simulation = spectators(ultras=0.0)
    crowd = simulation.crowd
    simulation.run(seconds=1.0)
    seat = crowd.plan.find("10|20")
    place = crowd.plan.position[:, seat] + np.array([0.0, 1.0, 0.0])
    apart = np.linalg.norm(crowd.plan.position - crowd.plan.position[:, [seat]], axis=0)
    simulation.send(BallHit(tuple(float(v) for v in place)))
    done = np.zeros((5, len(crowd)), np.bool_)
    states = ("struck", "duck", "reach", "point", "laugh")
    for _ in range(120):
        simulation.run(seconds=TICK)
        done |= [crowd.in_state(name) for name in states]
    struck, duck, reach, point, laugh = done
    assert struck[seat]
    assert 3 <= duck.sum() <= 60
    assert duck[~struck & (apart < 1.5)].mean() > 0.4
    assert not duck[apart > 2.7].any()
    assert reach.any()
    assert (apart[reach] <= 4.1).all()
    assert point[(apart > 3) & (apart < 6.5)].mean() > 0.3
    assert laugh.sum() > 20
    assert not done[:, apart > 7.2].any()
    simulation.run(seconds=8.0)
    assert not np.any([crowd.in_state(name) for name in states])


def test_who_ducks_does_it_from_the_beginning_and_as_he_sits(spectators: Make) -> None:
    simulation = spectators()
    crowd = simulation.crowd
    simulation.run(seconds=1.0)
    seat = crowd.plan.find("10|20")
    assert crowd.pool is not None
    assert crowd.anim is not None
    place = crowd.plan.position[:, seat] + np.array([0.0, 1.0, 0.0])
    simulation.send(BallHit(tuple(float(v) for v in place)))
    for _ in range(12):
        simulation.run(seconds=TICK)
        ids = np.flatnonzero(crowd.in_state("struck"))
        shown = [crowd.library.names[k] for k in crowd.motion.shown[ids]]
        fresh = np.flatnonzero(crowd.anim.t0[0, ids] == simulation.clock.pose_tick)
        for k in fresh:
            if "hit_by_ball" in shown[k]:
                row, offset = crowd.anim.row[0, ids[k]], crowd.anim.start[0, ids[k]]
                late = (crowd.pool.phase(np.array([row]))[0] * 84 / 1.3 - offset) % (84 / 1.3)
                assert min(late, 84 / 1.3 - late) < 3.0
    sits = np.array(crowd.channels(ids)["posture"]) == "seated"
    assert [name.startswith("sit_") for name in shown] == sits.tolist()


def test_people_talk_to_the_member_of_their_party_beside_them(spectators: Make) -> None:
    simulation = spectators(parties="general")
    crowd = simulation.crowd
    simulation.run(seconds=20.0)
    party, columns = crowd.party, crowd.plan.column
    talks = {side: crowd.in_state(f"talk_{side}") for side in ("left", "right")}
    both = talks["left"] | talks["right"]
    assert 0.05 < both.mean() < 0.6
    other = party.nearest
    assert (other[both] >= 0).all()
    assert (party.party[other[both]] == party.party[both]).all()
    assert (crowd.plan.row[other[both]] == crowd.plan.row[both]).all()
    # The two talk to each other: far oftener than chance would have it.
    mutual = both[other[both]].mean()
    assert mutual > 3.0 * both.mean()
    # Facing +Z, the left is at +X; so one's left neighbour turns to the right.
    left = np.flatnonzero(talks["left"])
    facing = np.cos(crowd.placement.yaw[left])
    x = crowd.plan.position[0]
    assert (np.sign(x[other[left]] - x[left]) == np.sign(facing)).all()
    assert columns[other[left]] == pytest.approx(columns[left], abs=2)


def test_people_talk_on_while_they_clap(spectators: Make) -> None:
    simulation = spectators(parties="general")
    crowd = simulation.crowd
    assert crowd.overlays is not None
    simulation.run(seconds=5.0)
    laid = crowd.overlays.columns.mask[1] >= 0
    assert not laid.any()
    simulation.send(Event("substitution", side=0, weight=0.5))
    simulation.run(seconds=3.0)
    talks = crowd.in_state("talk_left") | crowd.in_state("talk_right")
    both = talks & _clapping(crowd)
    laid = crowd.overlays.columns.target[1] == 1.0
    assert both.sum() > 20
    assert laid[both].mean() > 0.95
    assert not laid[~talks].any()
    # Their heads are turned, their hands go on clapping.
    agents = np.flatnonzero(both & laid)[:1]
    before = crowd.palettes(agents, simulation.clock.pose_tick)
    crowd.overlays.columns.target[1, agents] = crowd.overlays.columns.start[1, agents] = 0.0
    plain = crowd.palettes(agents, simulation.clock.pose_tick)
    moved = np.abs(before - plain).max(axis=(0, 2, 3))
    names = crowd.character.skeleton.names
    assert moved[names.index("head")] > 0.02
    assert moved[[k for k, name in enumerate(names) if "hand" in name]].max() < 1e-5
    simulation.run(seconds=15.0)
    assert not (crowd.overlays.columns.target[1] > 0).any()


def test_children_come_with_adults(spectators: Make) -> None:
    crowd = spectators(children=0.15, occupancy=0.8).crowd
    child = (crowd.body.kind == 1) & crowd.seat.occupied
    assert child.sum() == pytest.approx(0.15 * crowd.seat.occupied.sum(), rel=0.15)
    adults = set(crowd.party.party[crowd.seat.occupied & ~child].tolist())
    assert set(crowd.party.party[child].tolist()) <= adults


def test_moods_pass_between_neighbours(spectators: Make) -> None:
    simulation = spectators()
    crowd = simulation.crowd
    some = (crowd.plan.column >= 10) & (crowd.plan.column < 30)
    crowd.emotion.mood[some] = 0.8
    simulation.run(seconds=20.0)
    edge = (crowd.plan.column == 30) | (crowd.plan.column == 9)
    far = (crowd.plan.column > 36) | (crowd.plan.column < 3)
    assert crowd.emotion.mood[edge].mean() > 0.05
    assert abs(crowd.emotion.mood[far].mean()) < 0.02


def test_equal_seeds_and_events_give_equal_crowds(spectators: Make) -> None:
    digests = []
    for seed in (5, 5, 6):
        simulation = spectators(seed=seed, rows=12, columns=30)
        simulation.send(Event("substitution", side=0, time=0.5))
        simulation.send(Event("mexican_wave", place=(0.0, 3.0, 0.0), time=2.0))
        simulation.run(seconds=4.0)
        digests.append(simulation.crowd.state_hash())
    assert digests[0] == digests[1] != digests[2]


def test_those_near_the_scorer_wave_whatever_they_do(spectators: Make) -> None:
    simulation = spectators(seed=3)
    crowd = simulation.crowd
    assert crowd.overlays is not None
    x = float(crowd.plan.position[0].mean())
    front = float(crowd.plan.position[2, crowd.plan.row == 0].mean())
    place = (x, 1.0, front + 2.0)
    distance = np.hypot(crowd.plan.position[0] - x, crowd.plan.position[2] - place[2])
    near, far = distance < 4.0, distance > 16.0
    simulation.run(seconds=1.0)
    layers = crowd.overlays.columns.mask[0]
    assert (layers == NO_MASK).all()
    simulation.send(Goal(side=0, place=place))
    simulation.run(seconds=2.5)
    arms = crowd.overlays.masks.index("arms")
    assert (layers[near] == arms).mean() > 0.6
    assert (layers[near] == arms).mean() > (layers == arms).mean()
    assert (layers[far] == NO_MASK).all()
    # The body goes its own way below: some sit still, get up, jump or cheer.
    waving = layers == arms
    assert len(np.unique(crowd.behaviour.state[0, waving])) >= 3
    simulation.run(seconds=14.0)
    assert (layers == NO_MASK).all(), "the player has gone"


def test_only_the_own_side_waves_to_a_scorer_and_everybody_to_a_player(spectators: Make) -> None:
    simulation = spectators(sides=2, fans="mixed", seed=3)
    crowd = simulation.crowd
    assert crowd.overlays is not None
    x, y, z = (float(value) for value in crowd.plan.position[:, len(crowd) // 2])
    simulation.send(Goal(side=1, place=(x, y + 1.0, z)))
    simulation.run(seconds=2.5)
    waving = crowd.overlays.columns.mask[0] != NO_MASK
    assert set(crowd.team.side[waving]) == {1}
    simulation.run(seconds=12.0)
    simulation.send(Event("player_close", place=(x, y + 1.0, z)))
    simulation.run(seconds=2.5)
    waving = crowd.overlays.columns.mask[0] != NO_MASK
    assert set(crowd.team.side[waving]) == {0, 1}


def test_a_users_overlay_is_left_alone(spectators: Make) -> None:
    simulation = spectators(rows=6, columns=10)
    crowd = simulation.crowd
    assert crowd.overlays is not None
    assert crowd.pool is not None
    crowd.overlay(np.arange(60), crowd.pool.stream(0), "arm_l", duration=0.0)
    simulation.run(seconds=0.2)
    x, y, z = (float(value) for value in crowd.plan.position.mean(axis=1))
    simulation.send(Event("player_close", place=(x, y, z)))
    simulation.run(seconds=3.0)
    assert (crowd.overlays.columns.mask[0] == crowd.overlays.masks.index("arm_l")).all()


def test_a_goal_without_a_place_has_no_scorer_to_wave_to(spectators: Make) -> None:
    simulation = spectators(rows=6, columns=10)
    crowd = simulation.crowd
    assert crowd.overlays is not None
    simulation.send(BallHit(place=tuple(float(v) for v in crowd.plan.position.mean(axis=1))))
    simulation.run(seconds=0.5)
    simulation.send(Goal(side=0))
    simulation.run(seconds=2.0)
    assert np.isinf(crowd.behaviour.signals["distance"]).all()
    assert (crowd.overlays.columns.mask[0] == NO_MASK).all()


def test_nobody_talks_alone_or_waves_to_nobody_however_long_it_is_quiet(spectators: Make) -> None:
    simulation = spectators(rows=8, columns=20, poses="none")
    crowd = simulation.crowd
    signals = crowd.behaviour.signals
    able = signals["neighbour_left"].astype(bool) | signals["neighbour_right"].astype(bool)
    for _ in range(30):
        simulation.run(seconds=10.0)
        assert not (crowd.in_state("wave_hello") | crowd.in_state("reach_out")).any()
        talks = crowd.in_state("talk_left") | crowd.in_state("talk_right")
        assert not talks[~able].any()
        assert not (crowd.in_state("mexican_wave") | crowd.in_state("sit_mexican_wave")).any()
