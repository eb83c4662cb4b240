"""Who has to answer an event in which pose tick."""

from __future__ import annotations

from tifo.engine.behaviour.answers import Answers
from tifo.engine.behaviour.events import BallHit, Goal


def test_a_small_crowd_answers_at_once() -> None:
    answers, goal = Answers(500), Goal(0)
    assert answers.ask([goal], 7) == [(goal, 7, slice(0, 500))]
    assert answers.ask([], 8) == []


def test_a_large_crowd_answers_in_the_three_ticks_that_follow() -> None:
    answers, goal, other = Answers(65_000), Goal(0), Goal(1)
    first, second, third = slice(0, 21_666), slice(21_666, 43_333), slice(43_333, 65_000)
    assert answers.ask([goal], 7) == []
    # What they do counts from the tick of the event; of two everybody sees the earlier one first.
    assert answers.ask([other], 8) == [(goal, 7, first)]
    assert answers.ask([], 9) == [(goal, 7, second), (other, 8, first)]
    assert answers.ask([], 10) == [(goal, 7, third), (other, 8, second)]
    assert answers.ask([], 11) == [(other, 8, third)]
    assert answers.ask([], 12) == []


def test_those_near_a_place_answer_at_once() -> None:
    answers, ball = Answers(65_000), BallHit((1.0, 2.0, 3.0))
    assert answers.ask([ball], 3) == [(ball, 3, slice(0, 65_000))]
    assert answers.ask([], 4) == []
