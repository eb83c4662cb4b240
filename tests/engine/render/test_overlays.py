"""Overlays on the GPU against the CPU, joint by joint, under storms of requests."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tifo.components import AgentAnimID, Overlays, Placement, Transition
from tifo.engine.animation import ClipBank
from tifo.engine.streams import BlendLadder, SlotPool, StreamPool, UniquePool
from tifo.engine.streams.blending import agent_palettes
from tifo.engine.streams.mask_table import MaskTable
from tifo.engine.streams.overlaying import OverlayStage

pytestmark = pytest.mark.gl

AGENTS = 300
JOINTS = 12


@pytest.mark.parametrize(
    ("seed", "first", "history"), [(1, 0, 14), (2, 2**14 - 20, 5), (3, 10**6, 200), (4, 77, 254)]
)
def test_storms_look_the_same_on_both_sides(
    seed: int, first: int, history: int, factories: ModuleType, shader_crowd: Any
) -> None:
    rng = np.random.default_rng(seed)
    drawn = np.maximum.accumulate([rng.integers(max(0, j - 4), j) for j in range(1, JOINTS)])
    parents = [-1, *(int(parent) for parent in drawn)]
    skeleton = factories.make_skeleton(parents, rng.normal(0, 0.4, (JOINTS, 3)))
    clips = [factories.make_clip(skeleton, f"c{k}", 1.0 + 0.3 * k) for k in range(4)]
    bank = ClipBank(skeleton, clips)
    pool = StreamPool(skeleton, bank, capacity=8, history=history, uniques=2, slots=50)
    for row in range(8):
        pool.add(row % 4, time=float(rng.uniform(0, 1)))
    uniques = UniquePool(pool)
    uniques.add(1, speed=1.3)
    anim = AgentAnimID.allocate(3, AGENTS, pool.store.bind_row)
    transition = Transition.allocate(3, AGENTS)
    zeros = np.zeros(AGENTS, np.float32)
    placement = Placement(np.zeros((3, AGENTS), np.float32), zeros, zeros + np.float32(1))
    ladder = BlendLadder(pool, uniques, SlotPool(pool.store), anim, transition, placement)
    masks = MaskTable(skeleton)
    for number in range(5):
        chosen = rng.choice(JOINTS, 3, replace=False)
        masks.add(f"m{number}", {skeleton.names[j]: float(rng.uniform(0.2, 1)) for j in chosen})
    columns = Overlays.allocate(2, AGENTS)
    stage = OverlayStage(ladder, columns, masks)
    crowd = shader_crowd((pool, anim, transition), overlays=stage)
    agents = np.arange(AGENTS)
    now, laid, both = first, 0, 0
    for _ in range(30):
        now += 1
        some = np.flatnonzero(rng.random(AGENTS) < 0.2)
        rows = rng.integers(0, 8, len(some)).astype(np.int32)
        rows[rng.random(len(some)) < 0.2] = pool.store.first_unique
        offsets = rng.uniform(0, min(history, 14) - 2, len(some)).astype(np.float32)
        ladder.ask(0, some, rows, offsets, rng.uniform(0.5, 16, len(some)).astype(np.float32))
        for layer in (0, 1):
            some = np.flatnonzero(rng.random(AGENTS) < 0.15)
            mask, weight = int(rng.integers(-1, 5)), rng.uniform(0.2, 1, len(some))
            stage.ask(layer, some, mask, int(rng.integers(8)), np.nan, weight, 5 * rng.random())
        stage.step(now, rng)
        ladder.step(now, rng)
        for part in (pool, uniques):
            part.evaluate(now)
        for part in (pool, uniques):
            part.commit(now)
        crowd.update(now)
        alpha = float(rng.choice([0.0, 1.0, rng.random()]))
        body = agent_palettes(pool, anim, transition, 0, agents, now, alpha)
        expected = stage.lay(body.copy(), agents, now, alpha)
        shown = crowd.palettes(agents, now, alpha)
        np.testing.assert_allclose(shown, expected, rtol=0, atol=1e-4)
        changed = np.abs(expected - body).max(axis=(1, 2, 3)) > 1e-2
        laid += int(changed.sum())
        both += int(((columns.mask >= 0).all(axis=0) & changed).sum())
    assert laid > 2000
    assert both > 500
