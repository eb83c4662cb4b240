"""A crowd of four thousand with both sides, neutrals and empty seats, run without any system."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import Behaviour, Emotion, Placement, Team
from tifo.engine.behaviour import BehaviourTable, Event, draw_emotion, load_table
from tifo.engine.behaviour.compiled import CompiledTable, compile_table
from tifo.engine.behaviour.emotion import relax
from tifo.engine.behaviour.machine import begin, settle, step
from tifo.engine.behaviour.responses import respond
from tifo.engine.crowd.motions import MotionLibrary, sort_motions

COUNT = 4000


@dataclass
class Crowd:
    """Columns of a crowd, and how to ask it."""

    table: CompiledTable
    behaviour: Behaviour
    emotion: Emotion
    team: Team
    placement: Placement
    present: NDArray[np.bool_]
    library: MotionLibrary
    rng: np.random.Generator
    tick: int = 0

    @property
    def columns(self) -> dict[str, Any]:
        feelings = ("excitement", "embarrassment", "mood", "fatigue")
        found = {name: getattr(self.emotion, name) for name in feelings}
        return {**self.behaviour.signals, **found, "fervour": self.team.fervour}

    def answer(self, event: Event) -> NDArray[np.int64]:
        """Ids of the agents that will react."""
        return respond(
            event,
            self.table,
            self.behaviour,
            self.emotion,
            self.team,
            self.placement,
            self.present,
            self.tick,
            self.rng,
        )

    def run(self, ticks: int = 1, *, feelings: bool = False) -> NDArray[np.int64]:
        """Let pose ticks pass; ids of those who changed in the last."""
        changed = np.zeros(0, np.int64)
        for _ in range(ticks):
            self.tick += 1
            if feelings:
                relax(self.emotion, self.tick, self.behaviour.reacting)
            changed = step(self.table, self.behaviour, self.columns, self.tick, self.rng)
        return changed

    def doing(self, *names: str) -> NDArray[np.bool_]:
        """Who is in one of the states."""
        return np.isin(self.behaviour.state[0], [self.table.number(name) for name in names])

    def supporters(self, side: int) -> NDArray[np.int64]:
        """Ids of the present agents of a side (-1: of none)."""
        return np.flatnonzero(self.present & (self.team.side == side))


MakeCrowd = Callable[..., Crowd]


@pytest.fixture
def make_crowd(factories: ModuleType) -> MakeCrowd:
    """Make crowds: 2000 home, 1000 away, 1000 neutral; every fifth seat empty; rows 0.5 m apart."""

    def make(
        table: BehaviourTable | str = "sport",
        *,
        count: int = COUNT,
        embarrassment: float = 0.25,
        settled: bool = True,
        seed: int = 11,
        clips: list[str] | None = None,
    ) -> Crowd:
        library = sort_motions(factories.make_character(*([clips] if clips else [])).clips)
        rng = np.random.default_rng(seed)
        ids = np.arange(count)
        side = np.select([ids % 4 < 2, ids % 4 == 2], [0, 1], -1).astype(np.int8)
        fervour = np.where(side < 0, 0.4, 1.0).astype(np.float32)
        position = np.stack([0.5 * (ids % 80), 0.3 * (ids // 80), -0.8 * (ids // 80)])
        compiled = compile_table(load_table(table) if isinstance(table, str) else table, library)
        crowd = Crowd(
            table=compiled,
            behaviour=Behaviour.allocate(len(compiled.starts), count),
            emotion=draw_emotion(fervour, embarrassment, rng),
            team=Team(side, fervour),
            placement=Placement(
                position=position.astype(np.float32),
                yaw=np.zeros(count, np.float32),
                scale=np.ones(count, np.float32),
            ),
            present=ids % 5 != 0,
            library=library,
            rng=rng,
        )
        start = settle if settled else begin
        start(compiled, crowd.behaviour, crowd.columns, rng)
        return crowd

    return make


@pytest.fixture
def crowd(make_crowd: MakeCrowd) -> Crowd:
    """At a match, found in the middle of things."""
    return make_crowd()


@pytest.fixture
def rng() -> np.random.Generator:
    """Where a test's chances come from."""
    return np.random.default_rng(12)
