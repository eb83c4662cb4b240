"""Whom events give a reason to clap, how good a one, and when."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import Team
from tifo.engine.behaviour import KINDS, BallHit, Event, Goal, load_table
from tifo.engine.behaviour.applause import Applause
from tifo.engine.behaviour.compiled import CompiledTable, compile_table
from tifo.engine.behaviour.cueing import SPREAD, Cues
from tifo.engine.behaviour.hearing import Hearing
from tifo.engine.behaviour.table import Relation
from tifo.engine.crowd.motions import sort_motions

SIDE = np.array([0, 0, 1, -1, 1, -1], np.int8)
FERVOUR = np.array([1.0, 1.5, 1.0, 0.4, 2.0, 0.5], np.float32)
STEP = 1 / 30


@pytest.fixture
def table(factories: object) -> CompiledTable:
    clips = factories.make_character().clips  # type: ignore[attr-defined]
    return compile_table(load_table("sport"), sort_motions(clips))


@pytest.fixture
def applause(rng: np.random.Generator) -> Applause:
    return Applause(Hearing(np.zeros(len(SIDE), int)), rng)


def gives(table: CompiledTable, kind: str, relation: Relation) -> float:
    return table.responses[KINDS.index(kind), relation].applause


def reasons(applause: Applause) -> NDArray[np.float32]:
    """What is left of cues once they have been seen: almost all."""
    return applause.benefit(np.arange(len(SIDE)))


def let_pass(cues: Cues, applause: Applause, ticks: int) -> None:
    for _ in range(ticks):
        cues.step()
        applause.step(STEP)


def test_what_concerns_sides_waits_a_tick_or_three_and_counts_from_the_event(
    table: CompiledTable, applause: Applause
) -> None:
    cues, rates = Cues(applause, Team(SIDE, FERVOUR)), applause.rates
    event = Event("substitution", side=1, weight=0.6)
    expected = {
        Relation.OWN: gives(table, "substitution", Relation.OWN),
        Relation.NEUTRAL: gives(table, "substitution", Relation.NEUTRAL),
    }
    assert expected[Relation.OWN] > 0
    cues.take(event, table, None)
    cues.step()
    assert (applause._benefit == 0).all(), "not in the tick of the event"
    let_pass(cues, applause, 1 + SPREAD)
    assert not cues._waiting
    own, neutral = np.flatnonzero(SIDE == 1), np.flatnonzero(SIDE == -1)
    np.testing.assert_allclose(
        applause._benefit[own], FERVOUR[own] * 0.6 * expected[Relation.OWN], rtol=1e-6
    )
    np.testing.assert_allclose(
        applause._benefit[neutral],
        np.maximum(FERVOUR[neutral] * 0.6 * expected[Relation.NEUTRAL], 0.0),
        rtol=1e-6,
    )
    # All have seen it at the same time after the event, however late their cue was given.
    cued = applause._benefit > 0
    np.testing.assert_allclose(applause._since[cued], rates.reaction, atol=STEP + 1e-6)


def test_goals_make_the_other_side_refuse_first(table: CompiledTable, applause: Applause) -> None:
    cues = Cues(applause, Team(SIDE, FERVOUR))
    cues.take(Goal(0), table, None)
    cues.step()
    cues.step()
    assert gives(table, "goal", Relation.OTHER) < 0
    assert (reasons(applause)[SIDE == 1] < 0).all()
    assert (reasons(applause)[SIDE != 1] >= 0).all()


def test_what_happens_at_a_place_is_for_those_near_it_at_once(
    table: CompiledTable, applause: Applause
) -> None:
    cues = Cues(applause, Team(SIDE, FERVOUR))
    distance = np.array([1.0, 30.0, 2.0, 3.0, 40.0, 50.0], np.float32)
    near = gives(table, "player_close", Relation.NEAR)
    assert near > 0
    cues.take(Event("player_close", place=(0.0, 0.0, 0.0)), table, distance)
    assert (applause._benefit > 0).tolist() == [True, False, True, True, False, False]
    assert not cues._waiting
    before = applause._benefit.copy()
    cues.take(BallHit((0.0, 0.0, 0.0)), table, distance)
    assert (applause._benefit[distance > 10] == before[distance > 10]).all()
