"""Events cue applause: for whom, and how good a reason they are.

What concerns a whole side waits for the next pose ticks, one relation after the other, so that the
tick of an event doesn't do all of its work; nobody claps before he has seen it anyway. What happens
at a place concerns few, at once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components.team import Team
from ..streams.pool import POSE_RATE
from .applause import Applause
from .compiled import CompiledTable
from .events import KINDS, PLACED, Event
from .responses import WITNESS_RADIUS, relations_of
from .table import Relation

SPREAD = 3
"""Pose ticks after an event in which its cues are given."""


class Cues:
    """The cues of one crowd.

    Parameters
    ----------
    applause
        Gets them.
    team
        Who is of which side, and how fervent.
    """

    __slots__ = ("_applause", "_team", "_waiting")

    def __init__(self, applause: Applause, team: Team) -> None:
        self._applause, self._team = applause, team
        # With the pose ticks from the event to its cue, and those that are left.
        self._waiting: list[tuple[Event, Relation, float, int, int]] = []

    def take(
        self, event: Event, compiled: CompiledTable, distance: NDArray[np.float32] | None
    ) -> None:
        """Take in what an event is a reason for, by the table's responses.

        Parameters
        ----------
        event, compiled
            What happened, and the table.
        distance
            (N,) metres to its place; None where it has none.
        """
        kind, weight, number = KINDS.index(event.kind), event.weight or 0.0, 0
        for relation in Relation:
            response = compiled.responses.get((kind, relation))
            if response is None or (response.applause == 0.0 and response.mood <= 0.0):
                continue  # what is good for people ends their refusal
            benefit = response.applause * weight
            if event.kind in PLACED:
                if relation == Relation.NEAR and distance is not None:
                    self._give(distance <= WITNESS_RADIUS, benefit, 0.0)
                continue
            after = 1 if benefit < 0 else 1 + number % SPREAD  # nobody refuses too late
            number += 1
            self._waiting.append((event, relation, benefit, after, after))

    def step(self) -> None:
        """Give those cues that are due; to be called in every pose tick, after `take`."""
        waiting, self._waiting = self._waiting, []
        for event, relation, benefit, after, left in waiting:
            if left:
                self._waiting.append((event, relation, benefit, after, left - 1))
            else:
                to_each = relations_of(event).take(self._team.side, mode="wrap")
                self._give(to_each == relation, benefit, after / POSE_RATE)

    def _give(self, who: NDArray[np.bool_], benefit: float, ago: float) -> None:
        reason = self._team.fervour * np.float32(benefit) if benefit > 0 else benefit
        self._applause.cue_crowd(who, reason, refuse=benefit < 0, ago=ago)
