"""A crowd of four thousand with both sides, neutrals and empty seats."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import MotionState, Placement, Team
from tifo.engine.behaviour import Event, answer_event
from tifo.engine.crowd.motions import MotionLibrary, Role, sort_motions

COUNT = 4000


@dataclass
class Crowd:
    """Columns of a crowd, and how to ask it."""

    state: MotionState
    team: Team
    placement: Placement
    present: NDArray[np.bool_]
    library: MotionLibrary
    rng: np.random.Generator

    def answer(self, event: Event, tick: int) -> NDArray[np.int64]:
        """Ids of the agents that react."""
        return answer_event(
            event,
            self.state,
            self.team,
            self.placement,
            self.present,
            self.library,
            tick,
            self.rng,
        )

    def supporters(self, side: int) -> NDArray[np.int64]:
        """Ids of the present agents of a side (-1: of none)."""
        return np.flatnonzero(self.present & (self.team.side == side))

    def has_role(self, motion: NDArray[np.int16], role: Role) -> NDArray[np.bool_]:
        """Whether each motion is one of a role."""
        return np.isin(motion, self.library.roles[role])


@pytest.fixture
def crowd(factories: ModuleType) -> Crowd:
    """2000 home, 1000 away, 1000 neutral; every fifth seat is empty; in rows 0.5 m apart."""
    library = sort_motions(factories.make_character().clips)
    rng = np.random.default_rng(11)
    ids = np.arange(COUNT)
    side = np.select([ids % 4 < 2, ids % 4 == 2], [0, 1], -1).astype(np.int8)
    position = np.stack([0.5 * (ids % 80), 0.3 * (ids // 80), -0.8 * (ids // 80)])
    return Crowd(
        state=MotionState.allocate(library.draw_innate(COUNT, rng)),
        team=Team(side),
        placement=Placement(
            position=position.astype(np.float32),
            yaw=np.zeros(COUNT, np.float32),
            scale=np.ones(COUNT, np.float32),
        ),
        present=ids % 5 != 0,
        library=library,
        rng=rng,
    )


@pytest.fixture
def rng() -> np.random.Generator:
    """Where a test's chances come from."""
    return np.random.default_rng(12)
