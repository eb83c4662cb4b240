"""What the crowd watches: there is no match yet, so the ball is a point that is passed about."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import tifo

GOAL_LINE, HALF_LENGTH, HALF_WIDTH = 52.5, 50.0, 31.0
"""From the middle to a goal, and of the part of the pitch in which the ball is played, metres."""
CORNER = (52.5, 34.0)
"""From the middle of the pitch to a corner flag."""
PASS_SPEED = 20.0
STAND_AHEAD = 25.0
"""Metres from a single stand's first row to the middle of play."""
STARE_SECONDS = 2.5

Point = NDArray[np.float64]


class Attention:
    """Turns heads to the ball, if the character has a neck and a head.

    Parameters
    ----------
    simulation
        Whose crowd it is.
    """

    def __init__(self, simulation: tifo.Simulation) -> None:
        crowd = simulation.crowd
        self._rng = np.random.default_rng(simulation.spec.seed)
        self._centre, self._along = _field(simulation)
        self._seats = simulation.plan.position
        self.ball = self._centre.copy()
        self._pass_to(self.ball, rest=0.5)
        self._look: tifo.LookAt | None = None
        if {"neck", "head"} <= set(crowd.character.skeleton.names):
            self._look = tifo.look_at()
            crowd.add_override(self._look)
            attention = self._look.draw_attention(len(crowd), self._rng)
            crowd.override_values(self._look.name, np.arange(len(crowd)), attention)
            self._look.aim(self.ball)

    def advance(self, seconds: float) -> None:
        """Let the ball roll on, and heads with it."""
        self._passed += seconds
        if self._passed > self._flight + self._rest:
            self._pass_to(self._somewhere(), rest=self._rng.uniform(0.2, 1.2))
        share = min(self._passed / self._flight, 1.0)
        way = self._goal - self._start
        lift = 0.16 * max(float(np.linalg.norm(way)) - 15.0, 0.0)
        self.ball = self._start + share * way
        self.ball[1] += 4.0 * share * (1.0 - share) * lift
        if self._look is not None:
            self._look.aim(self.ball, seconds)

    def stare(self, place: tuple[float, float, float]) -> None:
        """The ball goes somewhere, and stays there for a while."""
        self._pass_to(np.array(place), rest=STARE_SECONDS)

    def follow(self, event: tifo.Event) -> None:
        """The ball goes where an event happens, if it is one of the ball's."""
        if event.kind == "goal":
            self.goal(event.side or 0)
        elif event.place is not None and event.kind == "ball_in_crowd":
            self.stare(event.place)

    def goal(self, side: int) -> None:
        """The ball goes into the net: of the goal at +X, if the home side scores."""
        end = GOAL_LINE if side == 0 else -GOAL_LINE
        self._pass_to(self._centre + end * self._along, rest=STARE_SECONDS)

    def celebration(self, side: int) -> tuple[float, float, float]:
        """Where the scorer runs to: a corner beside the goal, up to those who sit there."""
        end = CORNER[0] if side == 0 else -CORNER[0]
        across = np.array([-self._along[2], 0.0, self._along[0]])
        corner = self._centre + end * self._along + self._rng.choice((-1, 1)) * CORNER[1] * across
        apart = np.linalg.norm(self._seats - corner[:, None], axis=0)
        x, y, z = (float(value) for value in self._seats[:, np.argmin(apart)])
        return x, y + 1.0, z

    def _pass_to(self, place: Point, rest: float) -> None:
        """Fly there, and rest there before the next pass."""
        self._start, self._goal, self._rest = self.ball.copy(), place, rest
        distance = float(np.linalg.norm(place - self.ball))
        self._passed, self._flight = 0.0, 0.4 + distance / PASS_SPEED

    def _somewhere(self) -> Point:
        """Near, more often than far."""
        across = np.array([-self._along[2], 0.0, self._along[0]])
        step = self._rng.normal(0.0, 1.0, 2) * (18.0, 12.0)
        off = self.ball - self._centre
        x = np.clip(off @ self._along + step[0], -HALF_LENGTH, HALF_LENGTH)
        z = np.clip(off @ across + step[1], -HALF_WIDTH, HALF_WIDTH)
        place: Point = self._centre + x * self._along + z * across
        return place


def _field(simulation: tifo.Simulation) -> tuple[Point, Point]:
    """The middle of the pitch on the ground, and the unit vector along it, towards +X."""
    placement = simulation.crowd.placement
    x, _, z = placement.position.astype(np.float64)
    ahead = np.array([np.sin(placement.yaw).mean(), np.cos(placement.yaw).mean()])
    if simulation.spec.layout == "bowl":
        return np.zeros(3), np.array([1.0, 0.0, 0.0])
    # A single stand looks at its own pitch.
    ahead /= np.linalg.norm(ahead)
    front = (x * ahead[0] + z * ahead[1]).max() - (x.mean() * ahead[0] + z.mean() * ahead[1])
    away = (front + STAND_AHEAD + HALF_WIDTH) * ahead
    middle = np.array([x.mean() + away[0], 0.0, z.mean() + away[1]])
    return middle, np.array([ahead[1], 0.0, -ahead[0]])
