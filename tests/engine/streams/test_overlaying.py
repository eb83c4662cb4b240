"""Requests for overlays: who shows what when, and that nothing jumps or is held for nothing."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

from tifo.components import AgentAnimID, Overlays, Placement, Transition
from tifo.engine.animation import ClipBank
from tifo.engine.streams import BlendLadder, SlotPool, StreamPool, UniquePool
from tifo.engine.streams.blending import agent_palettes
from tifo.engine.streams.mask_table import MaskTable
from tifo.engine.streams.overlaying import OverlayStage, layer_weights

AGENTS = 40
EVERYBODY = np.arange(AGENTS)


class Crew:
    """A crowd of seven joints with two layers."""

    def __init__(self, factories: ModuleType, slots: int = 8) -> None:
        character = factories.make_character()
        bank = ClipBank(character.skeleton, character.clips)
        self.pool = StreamPool(character.skeleton, bank, capacity=6, history=14, slots=slots)
        self.streams = [self.pool.add(clip, time=0.1 * clip) for clip in range(6)]
        self.rng = np.random.default_rng(3)
        self.anim = AgentAnimID.allocate(3, AGENTS, self.pool.store.bind_row)
        self.anim.row[0] = EVERYBODY % 3
        self.transition = Transition.allocate(3, AGENTS)
        zeros = np.zeros(AGENTS, np.float32)
        placement = Placement(np.zeros((3, AGENTS), np.float32), zeros, zeros + np.float32(1))
        pool, store = self.pool, self.pool.store
        self.ladder = BlendLadder(
            pool, UniquePool(pool), SlotPool(store), self.anim, self.transition, placement
        )
        masks = MaskTable(character.skeleton)
        masks.add("arms", {"hand_l": 1.0, "hand_r": 1.0})
        masks.add("upper", {"chest": 1.0})
        self.columns = Overlays.allocate(2, AGENTS)
        self.stage = OverlayStage(self.ladder, self.columns, masks)
        self.now = 0
        for _ in range(14):
            self.tick()

    def tick(self) -> None:
        self.now += 1
        self.stage.step(self.now, self.rng)
        self.ladder.step(self.now, self.rng)
        self.pool.evaluate(self.now)
        self.pool.commit(self.now)

    def shown(self, alpha: float = 1.0) -> np.ndarray:
        body = self.body(alpha)
        return self.stage.lay(body, EVERYBODY, self.now, alpha)

    def body(self, alpha: float = 1.0) -> np.ndarray:
        now = (EVERYBODY, self.now, alpha)
        return agent_palettes(self.pool, self.anim, self.transition, 0, *now)

    def weight(self, agent: int = 0, layer: int = 0) -> float:
        return float(layer_weights(self.columns, layer, np.array([agent]), self.now)[0])

    def ask(
        self, agents: np.ndarray, mask: int = 0, row: int = 4, ticks: float = 8.0, layer: int = 0
    ) -> None:
        self.stage.ask(layer, agents, mask, row, np.nan, 1.0, ticks)


@pytest.fixture
def crew(factories: ModuleType) -> Crew:
    return Crew(factories)


def test_an_overlay_fades_in_stays_and_fades_out(crew: Crew) -> None:
    some = np.array([3, 5])
    crew.ask(some)
    weights = []
    for _ in range(12):
        crew.tick()
        weights.append(crew.weight(3))
    # A smooth step over 8 ticks that begins in the picture before the first of them.
    steps = np.clip(np.arange(1, 13) / 8, 0, 1)
    np.testing.assert_allclose(weights, steps**2 * (3 - 2 * steps), atol=1e-6)
    hands = [crew.pool.skeleton.index(name) for name in ("hand_l", "hand_r")]
    apart = np.abs(crew.shown() - crew.body()).max(axis=(2, 3))
    assert (apart[:, hands].max(axis=1) > 0.01).nonzero()[0].tolist() == [3, 5]
    others = [j for j in range(7) if j not in hands]
    np.testing.assert_array_equal(apart[:, others], 0)
    crew.stage.ask(0, some, -1, 0, 0.0, 0.0, 4.0)
    for _ in range(6):
        crew.tick()
    assert (crew.columns.mask == -1).all()
    assert (crew.anim.row[1:] == crew.pool.store.bind_row).all()
    np.testing.assert_array_equal(crew.shown(), crew.body())


def test_the_same_mask_again_blends_and_another_one_waits_for_its_turn(crew: Crew) -> None:
    crew.ask(EVERYBODY, row=3)
    for _ in range(10):
        crew.tick()
    crew.ask(EVERYBODY[:20], row=4)
    crew.ask(EVERYBODY[20:], mask=1, row=5)
    crew.tick()
    assert (crew.anim.row[1, :20] == 4).all()
    assert (crew.transition.row[1, :20] == 3).all()
    assert (crew.weight(0), crew.columns.mask[0, 25]) == (1.0, 0)
    lowest = 1.0
    for _ in range(20):
        crew.tick()
        lowest = min(lowest, crew.weight(25))
    assert lowest < 0.05
    assert (crew.columns.mask[0, 20:] == 1).all()
    assert (crew.anim.row[1, 20:] == 5).all()
    assert crew.weight(25) == 1.0


def test_storms_of_requests_never_jump_and_end_on_the_last_one(crew: Crew) -> None:
    still = crew.shown()
    own = 0.0
    for _ in range(20):
        crew.tick()
        now = crew.body()
        own = max(own, float(np.abs(now - still).max()))
        still = now
    rng = np.random.default_rng(5)
    last = crew.shown()
    largest = 0.0
    asked = np.zeros((2, AGENTS), int)
    for _ in range(90):
        for layer in (0, 1):
            agents = np.flatnonzero(rng.random(AGENTS) < 0.08)
            mask, row = int(rng.integers(-1, 2)), int(rng.integers(0, 6))
            crew.ask(agents, mask, row, ticks=float(rng.uniform(6, 14)), layer=layer)
            asked[layer, agents] = 100 * (mask + 1) + (row if mask >= 0 else 0)
        crew.tick()
        now = crew.shown()
        largest = max(largest, float(np.abs(now - last).max()))
        last = now
    for _ in range(40):
        crew.tick()
    # Poses are up to 2.5 apart, and a weight's steepest step in 6 ticks is a quarter.
    assert largest < 3 * own + 2.5 * 0.25
    for layer in (0, 1):
        shows = crew.columns.mask[layer] >= 0
        ended = np.where(shows, 100 * (crew.columns.mask[layer] + 1) + crew.anim.row[1 + layer], 0)
        np.testing.assert_array_equal(ended, asked[layer])


def test_a_motion_that_is_removed_fades_out_and_is_not_begun(factories: ModuleType) -> None:
    crew = Crew(factories, slots=64)
    crew.ask(EVERYBODY[:30], row=4)
    for _ in range(10):
        crew.tick()
    before = crew.shown()
    crew.ask(EVERYBODY[30:], row=4)
    crew.pool.remove(crew.streams[4])
    jumps = []
    for _ in range(16):
        crew.tick()
        now = crew.shown()
        jumps.append(float(np.abs(now - before).max()))
        before = now
    assert max(jumps) < 0.5
    assert (crew.columns.mask == -1).all()
    np.testing.assert_array_equal(crew.shown(), crew.body())
