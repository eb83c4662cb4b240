"""Who follows somebody: seven people, of whom some follow the first and one another side's man."""

from __future__ import annotations

import numpy as np
import pytest

from tifo.components import Behaviour, Party, Team
from tifo.engine.behaviour.events import KINDS
from tifo.engine.behaviour.following import Following
from tifo.engine.behaviour.table import PIECE, POSTURES, SEATED, Relation

STANDING = POSTURES.index("standing")
GOAL, MISS = KINDS.index("goal"), KINDS.index("near_miss")
LEADER = np.array([0, 0, 0, -1, 4, 4, 0], np.int32)
SIDE = np.array([0, 0, 0, 0, 0, 1, 0], np.int8)
NOW = 100


def moved_by(
    b: Behaviour, agent: int, event: int, *, begin: int, end: int, strength: float = 0.5
) -> None:
    b.event[agent], b.relation[agent] = event, Relation.OWN
    b.impact[agent], b.strength[agent] = 0.6, strength
    b.stirred_from[agent], b.stirred_until[agent] = begin, end
    b.reacting[agent] = begin <= NOW < end


@pytest.fixture
def people() -> tuple[Following, Behaviour]:
    count = len(LEADER)
    nobody = np.full(count, -1, np.int32)
    party = Party(
        party=np.zeros(count, np.int32),
        leader=LEADER,
        kind=np.zeros(count, np.int8),
        is_child=np.zeros(count, bool),
        nearest=nobody,
        partner=nobody,
    )
    behaviour = Behaviour.allocate(2, count)
    behaviour.posture[:] = SEATED
    behaviour.until[:] = NOW + 205
    return Following(party, Team(SIDE, np.ones(count, np.float32))), behaviour


def look(following: Following, behaviour: Behaviour, away: list[int] | None = None) -> None:
    """Let everyone look once, without time passing in between."""
    absent = np.zeros(len(LEADER), bool)
    absent[away or []] = True
    for turn in range(PIECE):
        following.step(NOW - NOW % PIECE + turn, behaviour, absent)


def test_nobody_follows_himself_and_who_follows_whom(
    people: tuple[Following, Behaviour],
) -> None:
    following, _ = people
    assert following.of(np.array([0])).tolist() == [1, 2, 6]
    assert following.of(np.array([0, 3, 4])).tolist() == [1, 2, 5, 6]
    assert following.leader_of(np.array([2, 5])).tolist() == [0, 4]


def test_who_follows_is_woken_when_the_leader_gets_up_and_when_he_sits_down(
    people: tuple[Following, Behaviour],
) -> None:
    following, b = people
    b.posture[[0, 2]] = STANDING
    look(following, b)
    assert following.stands.tolist() == [False, True, True, False, False, False, True]
    # Stays end at ticks 305 - 10 k, and who looks after 104 is late for 105. Who stands goes on.
    assert b.until[0].tolist() == [305, 105, 305, 305, 305, 305, 115]
    assert (b.until[1] == 305).all()
    b.posture[0] = SEATED
    look(following, b)
    assert not following.stands.any()
    assert b.until[0, 2] == 105


def test_who_is_moved_by_an_event_does_not_get_up_for_the_leader(
    people: tuple[Following, Behaviour],
) -> None:
    following, b = people
    b.posture[0] = STANDING
    moved_by(b, 1, GOAL, begin=90, end=150)
    look(following, b)
    assert b.until[0, [1, 6]].tolist() == [305, 115]
    assert following.stands[1]


def test_leaders_pull_along_who_was_not_moved(people: tuple[Following, Behaviour]) -> None:
    following, b = people
    moved_by(b, 0, GOAL, begin=95, end=180, strength=0.7)
    moved_by(b, 4, GOAL, begin=95, end=180)
    look(following, b)
    for agent in (1, 2, 6):
        assert (b.event[agent], b.relation[agent]) == (GOAL, Relation.OWN)
        assert (b.impact[agent], b.strength[agent]) == pytest.approx((0.6, 0.7))
        assert NOW < b.stirred_from[agent] <= NOW + PIECE
        assert b.stirred_until[agent] == 180
        assert b.until[0, agent] < 120
    assert (b.event[[3, 5]] == -1).all(), "alone, and of the other side"
    assert (b.until[0, [3, 5]] == 305).all()


def test_a_leader_who_has_not_begun_moves_nobody(people: tuple[Following, Behaviour]) -> None:
    following, b = people
    moved_by(b, 0, GOAL, begin=NOW + 20, end=180)
    look(following, b)
    assert (b.event[1:] == -1).all()


@pytest.mark.parametrize(("own", "leaders"), [(150, 180), (180, 150)])
def test_both_moved_by_the_same_stop_together(
    people: tuple[Following, Behaviour], own: int, leaders: int
) -> None:
    following, b = people
    moved_by(b, 0, GOAL, begin=95, end=leaders)
    moved_by(b, 1, GOAL, begin=92, end=own)
    look(following, b)
    assert (b.stirred_from[1], b.stirred_until[1]) == (92, leaders)
    assert b.until[0, 1] == 305, "nobody is woken for it"


def test_who_goes_on_after_the_leader_stops_now(people: tuple[Following, Behaviour]) -> None:
    following, b = people
    moved_by(b, 0, GOAL, begin=50, end=98)
    moved_by(b, 1, GOAL, begin=52, end=180)
    moved_by(b, 2, GOAL, begin=99, end=180)  # another goal, which left the leader cold
    look(following, b)
    assert NOW <= b.stirred_until[1] < NOW + PIECE
    assert b.stirred_until[2] == 180


def test_something_bigger_is_not_interrupted(people: tuple[Following, Behaviour]) -> None:
    following, b = people
    moved_by(b, 0, MISS, begin=95, end=180, strength=0.3)
    moved_by(b, 1, GOAL, begin=90, end=250, strength=0.9)
    moved_by(b, 2, GOAL, begin=20, end=110, strength=0.9)  # nearly over
    look(following, b)
    assert b.event[[1, 2]].tolist() == [GOAL, MISS]


def test_what_hits_the_leader_alone_moves_nobody_else(
    people: tuple[Following, Behaviour],
) -> None:
    following, b = people
    moved_by(b, 0, KINDS.index("ball_in_crowd"), begin=95, end=180)
    b.relation[0] = Relation.HIT
    look(following, b)
    assert (b.event[1:] == -1).all()


@pytest.mark.parametrize("away", [[0], [1, 2, 6]])
def test_nobody_follows_on_the_way(people: tuple[Following, Behaviour], away: list[int]) -> None:
    following, b = people
    b.posture[0] = STANDING
    moved_by(b, 0, GOAL, begin=95, end=180)
    look(following, b, away)
    assert not following.stands.any()
    assert (b.event[1:] == -1).all()
    assert (b.until[0] == 305).all()
