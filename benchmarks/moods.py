"""Mood and excitement of both sides over a match of ninety minutes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..engine.behaviour.events import Event
from ..engine.clock import Clock
from ..engine.crowd.spec import CrowdSpec
from ..engine.streams.pool import POSE_RATE
from ..systems.behaviour import BehaviourSystem
from ..systems.simulation import Simulation

MATCH = (
    (1.0, "kick_off", None),
    (8.0, "near_miss", 0),
    (17.0, "goal", 0),
    (26.0, "foul", 1),
    (27.0, "card", 1),
    (34.0, "near_miss", 1),
    (46.0, "half_time", None),
    (53.0, "corner", 1),
    (58.0, "goal", 1),
    (65.0, "substitution", 0),
    (74.0, "near_miss", 0),
    (83.0, "goal", 0),
    (91.0, "final_whistle", 0),
)
"""Minute, kind and side of what happens; the home side wins by 2:1."""
MINUTES = 95.0
EVERY = 6.0
"""Seconds from sample to sample."""


class Moods(NamedTuple):
    """Means of the two sides, (T, 2) each, and the (T,) minutes at which they were taken."""

    minutes: NDArray[np.float64]
    mood: NDArray[np.float64]
    excitement: NDArray[np.float64]


def moods(people: int, minutes: float, seed: int) -> Moods:
    """Let a crowd see `MATCH`, up to some minute.

    Parameters
    ----------
    people
        Seats, all of them taken; a third are supporters of the away side.
    minutes
        Length.
    seed
        Of the crowd.
    """
    simulation = Simulation(
        CrowdSpec(
            seats=people,
            occupancy=1.0,
            sides=2,
            away_share=1 / 3,
            fans="blocks",
            neutrals=0.0,
            poses="none",
            walking=False,
            seed=seed,
        )
    )
    crowd, clock = simulation.crowd, Clock()
    system = BehaviourSystem(np.random.default_rng(seed))
    for minute, kind, side in MATCH:
        crowd.send(Event(kind, side, time=60.0 * minute))
    sides = [crowd.team.side == side for side in (0, 1)]
    emotion, every = crowd.emotion, round(EVERY * POSE_RATE)
    taken: list[list[float]] = []
    with simulation.active():
        while clock.pose_tick < round(60.0 * minutes * POSE_RATE):
            clock.advance()
            system.process(clock)
            if clock.is_pose_tick and clock.pose_tick % every == 0:
                taken.append(
                    [
                        float(c[own].mean())
                        for c in (emotion.mood, emotion.excitement)
                        for own in sides
                    ]
                )
    simulation.close()
    columns = np.array(taken, np.float64)
    seconds = EVERY * np.arange(1.0, 1.0 + len(columns))
    return Moods(seconds / 60.0, columns[:, :2], columns[:, 2:])
