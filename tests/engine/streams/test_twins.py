"""Twins: the same motion on bones of another length, in step with their stream in everything."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tifo.components import AgentAnimID
from tifo.engine.animation import ClipBank
from tifo.engine.animation.body_type import BodyType
from tifo.engine.animation.clip import ClipEvent
from tifo.engine.animation.controllers import Blend2, ClipNode
from tifo.engine.streams import Stream, StreamPool, UniquePool
from tifo.engine.streams.displayed import read_palettes, shown_poses


@pytest.fixture
def types(factories: ModuleType) -> tuple[BodyType, ...]:
    rng = np.random.default_rng(4)
    count = factories.make_body().joint_count
    return tuple(
        BodyType(name, *rng.uniform(0.6, 1.4, (2, count)).astype(np.float32))
        for name in ("child", "old")
    )


@pytest.fixture
def pool(factories: ModuleType, types: tuple[BodyType, ...]) -> StreamPool:
    character = factories.make_character()
    bank = ClipBank(character.skeleton, character.clips)
    return StreamPool(
        character.skeleton,
        bank,
        capacity=8,
        history=10,
        bodies=types,
        markers=np.arange(7),
    )


def run(pool: StreamPool, first: int, last: int) -> None:
    for tick in range(first, last + 1):
        pool.evaluate(tick)
        pool.commit(tick)


def row_palettes(pool: StreamPool, stream: Stream, tick: int) -> Any:
    anim = AgentAnimID.allocate(1, 1, stream.row)
    shown = shown_poses(
        pool, anim.row[0].astype(np.int64), anim.start[0], anim.target[0], anim.t0[0], anim.rate[0],
        tick, 1.0,
    )  # fmt: skip
    return read_palettes(pool, shown)[0]


def test_a_twin_has_its_types_bones_and_flesh(
    pool: StreamPool, types: tuple[BodyType, ...], factories: ModuleType
) -> None:
    stream = pool.add("cheer", time=0.3, speed=1.1)
    twin = pool.add_twin(stream, "old")
    run(pool, 1, 6)
    skeleton, kind = pool.skeleton, types[1]
    pose = pool.bank.sample_one(pool.bank.index("cheer"), 0.3 + 5 * 1.1 / 30.0)[0].astype(float)
    parents = [int(p) for p in skeleton.parents]
    bones = kind.bones.astype(float)[:, None]
    models = factories.reference_models(parents, pose[:4].T, pose[4:7].T * bones, pose[7:].T)
    bind = np.tile(np.eye(4), (7, 1, 1))
    bind[:, :3] = skeleton.inverse_bind
    flesh = np.tile(np.eye(4), (7, 1, 1))
    flesh[:, [0, 1, 2], [0, 1, 2]] = kind.flesh[:, None]
    # Scale about the joint, in the joint's own frame: model, flesh, inverse bind.
    expected = (models @ flesh @ bind)[:, :3]
    np.testing.assert_allclose(row_palettes(pool, twin, 6), expected, atol=2e-5)
    places = pool.store.ring_markers[pool.store.slice_of(6), twin.row, :, :3]
    np.testing.assert_allclose(places, models[:, :3, 3], atol=2e-5)
    plain = factories.reference_palettes(skeleton, pose[:4].T, pose[4:7].T, pose[7:].T)
    np.testing.assert_allclose(row_palettes(pool, stream, 6), plain, atol=2e-5)


def test_a_twin_follows_its_stream_through_everything(pool: StreamPool) -> None:
    stream = pool.add("cheer")
    tree = pool.add(Blend2(ClipNode("walk"), ClipNode("clap"), amount=0.5))
    twins = [pool.add_twin(stream, "child"), pool.add_twin(tree, "child")]
    run(pool, 1, 5)
    for own, twin in ((stream, twins[0]), (tree, twins[1])):
        assert pool.valid[twin.row] == pool.valid[own.row] == 5
        kept = pool.store.ring_phase[pool.store.slice_of(5), twin.row]
        assert pool.phase([own.row])[0] == pytest.approx(kept, abs=1e-6)
    pool.seek(twins[0], 0.5)
    pool.stop(tree)
    run(pool, 6, 7)
    assert pool.valid[[stream.row, twins[0].row]].tolist() == [2, 2]
    assert pool.head[[tree.row, twins[1].row]].tolist() == [5, 5]
    pool.run(twins[1])
    run(pool, 8, 8)
    assert pool.head[[tree.row, twins[1].row]].tolist() == [8, 8]
    before = row_palettes(pool, twins[1], 8)
    pool.set(tree, "amount", 1.0)
    run(pool, 9, 9)
    assert np.abs(row_palettes(pool, twins[1], 9) - before).max() > 1e-2
    told: list[tuple[int, bool]] = []
    pool.before_cut.append(lambda row, removed: told.append((row, removed)))
    pool.remove(tree)
    assert [row for row, removed in told if removed] == [twins[1].row, tree.row]
    assert pool.alive.sum() == 2
    other = pool.add("walk")
    assert pool.twins.resolve(other.row, np.array([1, 2], np.uint8)).tolist() == [other.row] * 2
    kinds = np.array([0, 1, 2], np.uint8)
    assert pool.twins.resolve(stream.row, kinds).tolist() == [
        stream.row,
        twins[0].row,
        stream.row,
    ]
    still = pool.store.bind_row
    assert pool.twins.resolve(still, kinds).tolist() == [still] * 3


def test_twins_that_cannot_be(pool: StreamPool) -> None:
    stream = pool.add("cheer")
    with pytest.raises(ValueError, match="no body type 'giant'; known: child, old"):
        pool.add_twin(stream, "giant")
    pool.add_twin(stream, "child")
    with pytest.raises(ValueError, match="on body type 'child' already"):
        pool.add_twin(stream, "child")
    for _ in range(6):
        pool.add("walk")
    with pytest.raises(ValueError, match="all 8 stream rows are in use"):
        pool.add_twin(stream, "old")
    with pytest.raises(ValueError, match="finite and above 0"):
        BodyType("x", np.array([1.0, 0.0], np.float32), np.ones(2, np.float32))
    with pytest.raises(ValueError, match="2 bones"):
        BodyType("x", np.ones(2, np.float32), np.ones(2, np.float32)).refit(pool.skeleton)


def test_a_twin_passes_the_events_of_its_streams_tree(factories: ModuleType) -> None:
    from dataclasses import replace

    character = factories.make_character()
    tags = (ClipEvent(0.1, "step"), ClipEvent(0.3, "step"), ClipEvent(0.2, "clap"))
    clips = tuple(replace(clip, events=tags) for clip in character.clips[:3])
    kinds = (BodyType("child", *np.ones((2, 7), np.float32)),)
    pool = StreamPool(
        character.skeleton, ClipBank(character.skeleton, clips), capacity=6, history=8, bodies=kinds
    )
    trees = [pool.add(Blend2(ClipNode("walk"), ClipNode("sit_idle"), amount=0.3)) for _ in range(2)]
    plain = pool.add("sit_idle_2")
    twins = [pool.add_twin(stream, "child") for stream in (trees[1], plain, trees[0])]
    events = pool.clip_events
    passed = 0
    for tick in range(1, 15):
        run(pool, tick, tick)
        for own, twin in zip((trees[1], plain, trees[0]), twins, strict=True):
            slot = tick % events.planes.shape[1]
            np.testing.assert_array_equal(
                events.planes[:, slot, own.row], events.planes[:, slot, twin.row]
            )
            found = [
                events.shares.find(events.shares.pose(tick, np.array([stream.row]), 0))[1:]
                for stream in (own, twin)
            ]
            np.testing.assert_array_equal(found[0], found[1])
            passed += len(found[0][0])
    # Two trees, whose clips pass a clap and two steps: each name is found once or twice.
    assert passed >= 6


def test_a_unique_can_be_for_another_body(pool_with_unique: StreamPool) -> None:
    pool = pool_with_unique
    uniques = UniquePool(pool)
    stream = pool.add("cheer", time=0.3)
    twin = pool.add_twin(stream, "old")
    made = [
        uniques.add("cheer", time=0.3, body="old"),
        uniques.add("cheer", time=0.3),
        uniques.add(body="old"),
    ]
    uniques.write(made[2], pool.bank.sample_one(pool.bank.index("cheer"), 0.3)[0])
    for part in (pool, uniques):
        part.evaluate(1)
    for part in (pool, uniques):
        part.commit(1)
    shown = [row_palettes(pool, Stream(uniques.row(unique), 0), 1) for unique in made]
    np.testing.assert_allclose(shown[0], row_palettes(pool, twin, 1), atol=1e-5)
    np.testing.assert_allclose(shown[1], row_palettes(pool, stream, 1), atol=1e-5)
    np.testing.assert_allclose(shown[2], shown[0], atol=1e-5)
    with pytest.raises(ValueError, match="no body type 'giant'"):
        uniques.add(body="giant")


@pytest.fixture
def pool_with_unique(factories: ModuleType, types: tuple[BodyType, ...]) -> StreamPool:
    character = factories.make_character()
    bank = ClipBank(character.skeleton, character.clips)
    return StreamPool(character.skeleton, bank, capacity=4, history=10, bodies=types, uniques=4)
