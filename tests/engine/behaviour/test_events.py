"""Events check themselves, and wait in order."""

from __future__ import annotations

from typing import Any

import pytest

from tifo.engine.behaviour import KINDS, BallHit, Event, EventQueue, Goal
from tifo.engine.behaviour.events import PLACED, SIDED, WEIGHTS


@pytest.mark.parametrize("side", [-1, 8, None, "home", 0.5, True])
def test_goals_are_for_a_side(side: Any) -> None:
    with pytest.raises(ValueError, match=r"side is .*, expected 0 \(home\) or 1 \(away\)"):
        Goal(side)


@pytest.mark.parametrize(
    "place",
    [None, (0.0, 1.0), (0.0, 1.0, 2.0, 3.0), (0.0, float("nan"), 1.0), (float("inf"), 0.0, 0.0)],
)
def test_balls_land_somewhere(place: Any) -> None:
    with pytest.raises(ValueError, match=r"place is .*, expected three finite coordinates"):
        BallHit(place)


def test_every_kind_has_a_usual_weight() -> None:
    assert set(WEIGHTS) == set(KINDS)
    for kind in KINDS:
        side = 1 if kind in SIDED else None
        place = (0.0, 0.0, 0.0) if kind in PLACED else None
        event = Event(kind, side, place=place)
        assert event.weight == WEIGHTS[kind]
        assert Event(kind, side, weight=0.0, place=place).weight == 0.0
    assert Goal(1) == Goal(1, weight=1.0)
    assert Goal(0).kind == "goal"
    assert BallHit((0, 1, 2)).kind == "ball_in_crowd"


def test_unknown_kinds_offer_what_is_near() -> None:
    with pytest.raises(ValueError, match="kind is 'gaol'; did you mean goal"):
        Event("gaol", 0)
    with pytest.raises(ValueError, match="kind is 'xyz'; known: goal, near_miss"):
        Event("xyz")
    with pytest.raises(ValueError, match="kind is 7"):
        Event(7)  # type: ignore[arg-type]


@pytest.mark.parametrize("weight", [-0.1, 1.1, float("nan"), float("inf"), "much", True])
def test_weights_are_from_0_to_1(weight: Any) -> None:
    with pytest.raises(ValueError, match=r"weight is .*, expected a number from 0 to 1"):
        Event("goal", 0, weight=weight)


@pytest.mark.parametrize("time", [-1.0, float("nan"), "now"])
def test_times_are_seconds(time: Any) -> None:
    with pytest.raises(ValueError, match=r"time is .*, expected seconds from 0 on"):
        Event("anthem", time=time)


def test_a_queue_keeps_the_order_and_is_empty_after_taking() -> None:
    queue = EventQueue()
    first, second = Goal(1), BallHit((1.0, 2.0, 3.0))
    queue.send(first)
    queue.send(second)
    taken = queue.take()
    assert taken == [first, second]
    assert queue.take() == []
    queue.send(second)
    # What was taken is the taker's own.
    assert taken == [first, second]
    assert queue.take() == [second]
    with pytest.raises(ValueError, match="event is 'goal', expected an Event"):
        queue.send("goal")  # type: ignore[arg-type]


def test_events_wait_for_their_time() -> None:
    queue = EventQueue()
    late, soon, at_once = Goal(0, time=9.0), Goal(1, time=3.0), Goal(1)
    same = Goal(0, time=9.0)
    for event in (late, soon, at_once, same):
        queue.send(event)
    assert queue.take(2.9) == [at_once]
    assert len(queue) == 3
    assert queue.take(3.0) == [soon]
    taken = queue.take(10.0)
    assert taken[0] is late
    assert taken[1] is same
    assert len(queue) == 0
