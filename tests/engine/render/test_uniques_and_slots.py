"""Uniques, slots and the blends between them, on the GPU against the CPU, joint by joint."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tifo.components import AgentAnimID, Placement, Transition
from tifo.engine.animation import ClipBank
from tifo.engine.streams import BlendLadder, SlotPool, Stream, StreamPool, UniquePool
from tifo.engine.streams.blending import agent_palettes

pytestmark = pytest.mark.gl

AGENTS = 300
SLOTS = 90
UNIQUES = 7


class Storm:
    """Agents that are asked for something else all the time, and streams that are cut."""

    def __init__(self, factories: ModuleType, seed: int, first: int) -> None:
        self.rng = np.random.default_rng(seed)
        character = factories.make_character()
        bank = ClipBank(character.skeleton, character.clips)
        self.pool = StreamPool(
            character.skeleton,
            bank,
            capacity=9,
            history=14,
            uniques=UNIQUES,
            slots=SLOTS,
            markers=np.arange(3),
        )
        for row in range(9):
            self.pool.add(row % len(bank.clips), time=float(self.rng.uniform(0, 1)))
        self.uniques = UniquePool(self.pool)
        self.live = [self.uniques.add() for _ in range(4)]
        self.playing = self.uniques.add("cheer", speed=1.3)
        self.anim = AgentAnimID.allocate(1, AGENTS, self.pool.store.bind_row)
        self.transition = Transition.allocate(1, AGENTS)
        zeros = np.zeros(AGENTS, np.float32)
        placement = Placement(np.zeros((3, AGENTS), np.float32), zeros, zeros + np.float32(1))
        self.ladder = BlendLadder(
            self.pool,
            self.uniques,
            SlotPool(self.pool.store),
            self.anim,
            self.transition,
            placement,
        )
        self.now = first

    def tick(self) -> None:
        rng, bank = self.rng, self.pool.bank
        self.now += 1
        for unique in self.live:
            if rng.random() < 0.8:
                self.uniques.write(unique, bank.sample_one(int(rng.integers(6)), rng.random())[0])
        if rng.random() < 0.15:
            self.uniques.seek(self.playing, rng.random())
        if rng.random() < 0.15:
            row = int(rng.integers(9))
            self.pool.seek(Stream(row, int(self.pool.generation[row])), rng.random())
        agents = np.flatnonzero(rng.random(AGENTS) < 0.15)
        # Uniques, the bind pose and streams alike.
        rows = rng.integers(0, 9, len(agents))
        chosen = rng.random(len(agents)) < 0.4
        first = self.pool.store.first_unique
        rows[chosen] = first + 2 * rng.integers(0, UNIQUES, int(chosen.sum()))
        rows[rng.random(len(agents)) < 0.05] = self.pool.store.bind_row
        offset = rng.uniform(0, 12, len(agents)).astype(np.float32)
        duration = rng.uniform(0.5, 16, len(agents)).astype(np.float32)
        self.ladder.ask(0, agents, rows.astype(np.int32), offset, duration)
        self.ladder.step(self.now, rng)
        for part in (self.pool, self.uniques):
            part.evaluate(self.now)
        for part in (self.pool, self.uniques):
            part.commit(self.now)

    def expected(self, alpha: float) -> Any:
        agents = np.arange(AGENTS)
        return agent_palettes(self.pool, self.anim, self.transition, 0, agents, self.now, alpha)


@pytest.mark.parametrize(
    ("seed", "first"), [(1, 0), (2, 2**14 - 20), (3, 10**6), (4, 10**6 + 2**14 - 15)]
)
def test_storms_look_the_same_on_both_sides(
    seed: int, first: int, factories: ModuleType, shader_crowd: Any
) -> None:
    storm = Storm(factories, seed, first)
    crowd = shader_crowd((storm.pool, storm.anim, storm.transition))
    agents = np.arange(AGENTS)
    uniques = slots = 0
    for _ in range(30):
        storm.tick()
        crowd.update(storm.now)
        alpha = float(storm.rng.choice([0.0, 1.0, storm.rng.random()]))
        shown = crowd.palettes(agents, storm.now, alpha)
        np.testing.assert_allclose(shown, storm.expected(alpha), rtol=0, atol=1e-4)
        store = storm.pool.store
        rows = storm.anim.row[0]
        uniques += int(((rows >= store.first_unique) & (rows < store.first_slot)).sum())
        slots += int(storm.ladder.slots.used.sum())
    assert uniques > 1000
    assert slots > 500
    assert storm.ladder.counts.total.deferred > 0


def test_a_tick_copies_what_changed_of_uniques_and_slots(
    factories: ModuleType, shader_crowd: Any
) -> None:
    storm = Storm(factories, 9, 0)
    storm.tick()
    crowd = shader_crowd((storm.pool, storm.anim, storm.transition))
    crowd.update(storm.now)
    store = storm.pool.store
    storm.now += 1
    storm.uniques.write(storm.live[1], storm.pool.bank.sample_one(2, 0.3)[0])
    for unique in (storm.uniques, storm.pool):
        unique.evaluate(storm.now)
        unique.commit(storm.now)
    copied = crowd.update(storm.now)
    row = store.static[0].nbytes + store.static_markers[0].nbytes
    slice_bytes = store.ring[0].nbytes + store.ring_markers[0].nbytes
    # The written unique, the one that plays a clip, one slice, and the table of heads.
    assert copied == 2 * row + slice_bytes + 16 * (9 + UNIQUES)


def test_a_moving_unique_is_smooth_between_ticks(factories: ModuleType, shader_crowd: Any) -> None:
    skeleton, clip = factories.make_slide()
    pool = StreamPool(skeleton, ClipBank(skeleton, [clip]), capacity=1, history=4, uniques=2)
    uniques = UniquePool(pool)
    uniques.add()
    unique = uniques.add()
    anim = AgentAnimID.allocate(1, 1, uniques.row(unique))
    crowd = shader_crowd((pool, anim, Transition.allocate(1, 1)))
    for tick in range(1, 9):
        pose = np.zeros((10, 1), np.float32)
        pose[3], pose[4], pose[7:] = 1.0, tick * tick, 1.0
        uniques.write(unique, pose)
        for part in (pool, uniques):
            part.evaluate(tick)
            part.commit(tick)
        crowd.update(tick)
        for alpha in (0.0, 0.25, 1.0):
            before = tick - 1 if tick > 1 else 1
            expected = (1 - alpha) * before**2 + alpha * tick**2
            x = crowd.palettes([0], tick, alpha)[0, 0, 0, 3]
            assert x == pytest.approx(expected, abs=1e-4)
