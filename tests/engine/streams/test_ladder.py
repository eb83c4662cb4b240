"""The blend ladder: which rung a request takes, that none is lost, and that nothing jumps."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.components import AgentAnimID, Placement, Transition
from tifo.engine.animation import ClipBank
from tifo.engine.streams import BlendLadder, SlotPool, Stream, StreamPool, UniquePool
from tifo.engine.streams.blend_counts import BlendCounts
from tifo.engine.streams.blending import agent_palettes, blend_weight, hurry
from tifo.engine.streams.ladder import Focus

HISTORY = 30
Array = NDArray[Any]


class Crowd:
    """A few agents on a few streams, ticked by hand; remembers where all joints were."""

    def __init__(
        self, factories: ModuleType, agents: int = 4, slots: int = 4, streams: int = 6
    ) -> None:
        character = factories.make_character()
        self.bank = ClipBank(character.skeleton, character.clips)
        self.pool = StreamPool(
            character.skeleton,
            self.bank,
            capacity=streams,
            history=HISTORY,
            uniques=3,
            slots=slots,
            markers=np.arange(character.skeleton.joint_count),
        )
        self.streams = [self.pool.add(k % len(self.bank.clips)) for k in range(streams)]
        self.uniques = UniquePool(self.pool)
        self.slots = SlotPool(self.pool.store)
        self.anim = AgentAnimID.allocate(1, agents, 0)
        self.transition = Transition.allocate(1, agents)
        zeros = np.zeros(agents, np.float32)
        place = np.zeros((3, agents), np.float32)
        place[0] = 10.0 * np.arange(agents)
        self.placement = Placement(place, zeros, zeros + np.float32(1))
        self.ladder = BlendLadder(
            self.pool, self.uniques, self.slots, self.anim, self.transition, self.placement
        )
        self.rng = np.random.default_rng(7)
        self.all = np.arange(agents)
        self.now = -HISTORY
        for _ in range(HISTORY):
            self.tick()

    def tick(self) -> BlendCounts:
        """One pose tick; which rungs it used."""
        self.now += 1
        self.ladder.step(self.now, self.rng)
        self.pool.evaluate(self.now)
        self.uniques.evaluate(self.now)
        self.pool.commit(self.now)
        self.uniques.commit(self.now)
        return self.ladder.counts.tick

    def ask(
        self, agents: int | list[int] | Array, row: int | Array, duration: float = 12.0
    ) -> None:
        ids = np.atleast_1d(np.asarray(agents, np.int64))
        rows = np.broadcast_to(np.asarray(row, np.int32), ids.shape)
        self.ladder.ask(0, ids, rows, 3.0, duration)

    def palettes(self, alpha: float = 1.0) -> Array:
        return agent_palettes(self.pool, self.anim, self.transition, 0, self.all, self.now, alpha)

    def joints(self, alpha: float = 1.0) -> Array:
        """(N, J, 3) where the joints of everyone are shown."""
        return self.pool.markers.places(self.palettes(alpha)).astype(np.float64)

    def is_consistent(self) -> bool:
        """Slots are used by exactly the blends that come from them, each by one."""
        blending = self.transition.duration[0] > 0
        rows = self.transition.row[0, blending]
        held = np.sort(rows[rows >= self.pool.store.first_slot] - self.pool.store.first_slot)
        return bool(np.array_equal(held, np.flatnonzero(self.slots.used))) and (
            self.slots.free == len(self.slots.used) - len(held)
        )


def steps_and_reach(crowd: Crowd) -> tuple[float, float]:
    """Largest step of a joint in a tick of any clip, and the farthest two poses are apart."""
    places = []
    step = 0.0
    for clip, motion in enumerate(crowd.bank.clips):
        times = np.arange(0.0, motion.duration + 0.1, 1 / 30)
        still = StreamPool(
            crowd.pool.skeleton,
            crowd.bank,
            capacity=1,
            history=2,
            markers=crowd.pool.markers.joints,
        )
        still.add(clip)
        path = []
        for tick in range(len(times)):
            still.evaluate(tick)
            still.commit(tick)
            path.append(still.store.ring_markers[still.store.slice_of(tick), 0, :, :3].copy())
        walked = np.array(path, float)
        step = max(step, float(np.linalg.norm(np.diff(walked, axis=0), axis=2).max()))
        places.append(walked)
    everything = np.concatenate(places)
    apart = max(float(np.linalg.norm(everything - pose, axis=2).max()) for pose in everything[::3])
    return step, apart


def test_a_resting_agent_blends_from_its_motion(factories: ModuleType) -> None:
    crowd = Crowd(factories)
    before = crowd.joints()
    crowd.ask([1, 3], [2, 4])
    assert crowd.tick() == BlendCounts(two_source=2)
    assert crowd.anim.row[0].tolist() == [0, 2, 0, 4]
    assert crowd.transition.begin[0, 1] == crowd.now - 1
    # The first picture after the request shows what the last one before it did.
    np.testing.assert_allclose(crowd.joints(0.0), before, atol=1e-5)
    for _ in range(11):
        assert crowd.transition.duration[0, 1] == 12.0
        crowd.tick()
    assert (crowd.transition.duration[0, [1, 3]] == 12.0).all()
    crowd.tick()
    assert not crowd.transition.duration.any()
    assert crowd.ladder.counts.total == BlendCounts(two_source=2)


def test_in_the_middle_of_a_blend_a_slot_keeps_what_is_shown(factories: ModuleType) -> None:
    crowd = Crowd(factories, slots=1)
    crowd.ask(0, 2)
    for _ in range(5):
        crowd.tick()
    before = crowd.palettes()[0]
    crowd.ask(0, 3)
    assert crowd.tick() == BlendCounts(snapshot=1)
    slot = crowd.pool.store.first_slot
    assert crowd.transition.row[0, 0] == slot
    np.testing.assert_allclose(
        crowd.pool.store.static[slot - crowd.pool.store.stream_rows], before, atol=1e-6
    )
    np.testing.assert_allclose(crowd.palettes(0.0)[0], before, atol=1e-6)
    assert crowd.slots.free == 0
    # Interrupted again, it writes into the slot that it has.
    crowd.tick()
    before = crowd.palettes()[0]
    crowd.ask(0, 4)
    assert crowd.tick() == BlendCounts(snapshot=1)
    np.testing.assert_allclose(crowd.palettes(0.0)[0], before, atol=1e-6)
    assert crowd.is_consistent()
    for _ in range(12):
        crowd.tick()
    assert (crowd.slots.free, crowd.anim.row[0, 0]) == (1, 4)
    assert not crowd.transition.duration.any()


def test_slots_keep_markers_for_the_far_level(factories: ModuleType) -> None:
    crowd = Crowd(factories, slots=2)
    crowd.ask(0, 2)
    for _ in range(4):
        crowd.tick()
    expected = crowd.joints()[0]
    crowd.ask(0, 3)
    crowd.tick()
    static = crowd.transition.row[0, 0] - crowd.pool.store.stream_rows
    np.testing.assert_allclose(crowd.pool.store.static_markers[static, :, :3], expected, atol=1e-5)


def test_without_a_slot_the_blend_hurries_and_the_last_request_follows(
    factories: ModuleType,
) -> None:
    crowd = Crowd(factories, slots=0)
    crowd.ask(0, 2)
    for _ in range(6):
        crowd.tick()
    shown, weight = crowd.palettes()[0], _weight(crowd, crowd.now)
    crowd.ask(0, 3)
    assert crowd.tick() == BlendCounts(deferred=1)
    assert _weight(crowd, crowd.now - 1) == pytest.approx(weight, abs=1e-6)
    np.testing.assert_allclose(crowd.palettes(0.0)[0], shown, atol=1e-6)
    crowd.ask(0, 4)
    assert crowd.tick() == BlendCounts()
    crowd.ask(0, 5)
    waited = 2
    while crowd.anim.row[0, 0] != 5:
        crowd.tick()
        waited += 1
        assert crowd.anim.row[0, 0] in (2, 5)
    # Half of the twelve ticks are gone, the other half takes three of its six, and one to see it.
    assert waited <= 5
    assert crowd.ladder.counts.total == BlendCounts(two_source=2, deferred=1)


def _weight(crowd: Crowd, shown: float) -> float:
    columns = crowd.transition.begin[0, :1], crowd.transition.duration[0, :1]
    return float(blend_weight(*columns, shown)[0])


@settings(max_examples=60, deadline=None)
@given(
    duration=st.floats(0.5, 200.0, width=32),
    passed=st.integers(0, 100),
    tick=st.sampled_from([5, 70_000, 10**6 + 3]),
)
def test_hurrying_keeps_the_weight_and_never_takes_longer(
    duration: float, passed: int, tick: int
) -> None:
    anim, transition = AgentAnimID.allocate(1, 1, 0), Transition.allocate(1, 1)
    transition.begin[0], transition.duration[0] = tick - passed, duration
    agents = np.zeros(1, np.int64)
    before = float(blend_weight(transition.begin[0], transition.duration[0], tick)[0])
    end = tick - passed + duration
    hurry(anim, transition, 0, agents, tick, 6.0)
    after = float(blend_weight(transition.begin[0], transition.duration[0], tick)[0])
    assert after == pytest.approx(before, abs=3.1e-4)
    assert (transition.begin[0, 0] * 256) % 1 == 0
    new_end = transition.begin[0, 0] + float(transition.duration[0, 0])
    assert new_end <= max(end, tick) + 1e-3
    assert new_end <= tick + 6.5


def test_far_from_the_focus_a_long_wait_ends_in_a_jump(factories: ModuleType) -> None:
    crowd = Crowd(factories, agents=6, slots=0)
    crowd.ladder.focus = Focus((0.0, 0.0, 0.0), 25.0)  # agents 0 to 2 are within it
    crowd.ask(crowd.all, 2, 60.0)
    crowd.tick()
    crowd.tick()
    crowd.ask(crowd.all, 3, 60.0)
    counts = [crowd.tick() for _ in range(4)]
    assert [count.cut for count in counts] == [0, 0, 0, 3]
    assert counts[0].deferred == 6
    assert crowd.anim.row[0].tolist() == [2, 2, 2, 3, 3, 3]
    assert crowd.transition.duration[0, 3:].tolist() == [0, 0, 0]
    for _ in range(8):
        crowd.tick()
    assert (crowd.anim.row[0] == 3).all()
    assert crowd.ladder.counts.total == BlendCounts(two_source=9, deferred=6, cut=3)


def test_without_a_focus_nobody_ever_jumps(factories: ModuleType) -> None:
    crowd = Crowd(factories, agents=6, slots=0)
    for tick in range(40):
        crowd.ask(crowd.all, tick % 6, 60.0)
        crowd.tick()
    assert crowd.ladder.counts.total.cut == 0
    assert crowd.ladder.counts.total.deferred > 6


def test_a_duration_of_nothing_is_a_jump(factories: ModuleType) -> None:
    crowd = Crowd(factories, slots=1)
    crowd.ask(0, 1)
    crowd.tick()
    crowd.ask(0, 2)
    crowd.tick()
    assert crowd.slots.free == 0
    crowd.ask([0, 1], 3, 0.0)
    assert crowd.tick() == BlendCounts(cut=2)
    assert crowd.anim.row[0, :2].tolist() == [3, 3]
    assert crowd.is_consistent()
    assert crowd.slots.free == 1


def test_of_two_requests_in_one_tick_the_last_wins(factories: ModuleType) -> None:
    crowd = Crowd(factories)
    crowd.ask([0, 1], 2)
    crowd.ask([1, 2], 4)
    crowd.tick()
    assert crowd.anim.row[0].tolist() == [2, 4, 4, 0]


def test_offsets_that_nobody_chose_are_drawn_within_the_history(factories: ModuleType) -> None:
    crowd = Crowd(factories, agents=400)
    crowd.ladder.ask(0, crowd.all, 2, np.nan, 8.0)
    crowd.tick()
    assert crowd.anim.start[0].min() >= 0.0
    assert crowd.anim.start[0].max() <= HISTORY - 2
    assert crowd.anim.start[0].std() > 5.0
    fresh = crowd.streams[3]
    crowd.pool.seek(fresh, 0.0)
    crowd.tick()
    crowd.ladder.ask(0, crowd.all, fresh.row, np.nan, 8.0)
    for _ in range(20):
        crowd.tick()
    assert (crowd.anim.row[0] == fresh.row).all()


def test_a_unique_can_be_blended_to_and_from(factories: ModuleType) -> None:
    crowd = Crowd(factories)
    live = crowd.uniques.add()
    pose = crowd.bank.sample_one(3, 0.4)[0]
    row = crowd.uniques.row(live)
    crowd.ladder.ask(0, np.array([0]), row, 0.0, 6.0)
    for _ in range(8):
        crowd.uniques.write(live, pose)
        crowd.tick()
    assert crowd.anim.row[0, 0] == row
    still = StreamPool(crowd.pool.skeleton, crowd.bank, capacity=1, history=2)
    still.add(3, time=0.4)
    still.evaluate(0)
    np.testing.assert_allclose(crowd.palettes()[0], still.store.ring[0, 0], atol=1e-5)
    before = crowd.palettes()[0]
    crowd.ask(0, 1)
    crowd.tick()
    np.testing.assert_allclose(crowd.palettes(0.0)[0], before, atol=1e-5)


def test_before_a_cut_agents_are_saved_into_slots(factories: ModuleType) -> None:
    crowd = Crowd(factories, agents=5, slots=8)
    crowd.ask([3, 4], 1)  # blends that leave stream 0
    for _ in range(4):
        crowd.tick()
    before = crowd.palettes()
    total = crowd.ladder.counts.total
    crowd.pool.seek(crowd.streams[0], 0.5)
    assert (total.snapshot, total.cut) == (5, 0)
    # Also the pictures that are still to come in this tick, while stream 0 has no pose.
    np.testing.assert_allclose(crowd.palettes(1.0), before, atol=1e-6)
    crowd.tick()
    np.testing.assert_allclose(crowd.palettes(0.0), before, atol=1e-5)
    step, reach = steps_and_reach(crowd)
    last = crowd.joints(0.0)
    for _ in range(20):
        now = crowd.joints(1.0)
        moved = np.linalg.norm(now - last, axis=2).max()
        assert moved <= 1.5 * step + 1.5 * reach / 6
        last = now
        crowd.tick()
    assert crowd.anim.row[0].tolist() == [0, 0, 0, 1, 1]
    assert not crowd.transition.duration.any()
    assert crowd.is_consistent()
    assert crowd.slots.free == 8


def test_a_cut_without_slots_is_no_error_and_counted(factories: ModuleType) -> None:
    crowd = Crowd(factories, agents=5, slots=1)
    crowd.ask([3, 4], 1)
    crowd.tick()
    crowd.pool.play(crowd.streams[0], 2)
    assert crowd.ladder.counts.total.cut == 4
    for _ in range(14):
        crowd.tick()
    assert crowd.anim.row[0].tolist() == [0, 0, 0, 1, 1]
    assert crowd.is_consistent()
    assert crowd.slots.free == 1


def test_agents_of_a_removed_stream_go_to_the_bind_pose_or_their_last_request(
    factories: ModuleType,
) -> None:
    crowd = Crowd(factories, agents=6, slots=3)
    crowd.ask([1, 2], 2)
    for _ in range(3):
        crowd.tick()
    crowd.ask([3], 2)
    crowd.ask([4], 1)
    before = crowd.palettes()
    crowd.pool.remove(crowd.streams[2])
    np.testing.assert_allclose(crowd.palettes(), before, atol=1e-6)
    again = crowd.pool.add(5)
    assert again.row == 2
    for _ in range(16):
        crowd.tick()
    bind = crowd.pool.store.bind_row
    # The request for the stream that is gone was dropped; nobody inherits the new one.
    assert crowd.anim.row[0].tolist() == [0, bind, bind, 0, 1, 0]
    np.testing.assert_allclose(
        crowd.palettes()[1], np.broadcast_to(np.eye(3, 4), (7, 3, 4)), atol=1e-6
    )
    assert crowd.is_consistent()


def test_a_removed_unique_leaves_nobody_behind(factories: ModuleType) -> None:
    crowd = Crowd(factories)
    live = crowd.uniques.add("cheer")
    crowd.ladder.ask(0, np.array([0]), crowd.uniques.row(live), 0.0, 4.0)
    for _ in range(8):
        crowd.tick()
    before = crowd.palettes()[0]
    crowd.uniques.remove(live)
    np.testing.assert_allclose(crowd.palettes()[0], before, atol=1e-6)
    for _ in range(14):
        crowd.tick()
    assert crowd.anim.row[0, 0] == crowd.pool.store.bind_row
    assert crowd.is_consistent()


@pytest.mark.parametrize("slots", [0, 100, 1500])
def test_a_burst_loses_no_request(factories: ModuleType, slots: int) -> None:
    """2,000 requests a tick for ten seconds; every agent ends on its last one."""
    crowd = Crowd(factories, agents=3000, slots=slots)
    rng = np.random.default_rng(slots)
    last = np.zeros(3000, np.int32)
    for tick in range(300):
        agents = rng.permutation(3000)[:2000]
        last[agents] = rng.integers(0, 6, 2000)
        duration = rng.uniform(1.0, 20.0, 2000).astype(np.float32)
        crowd.ladder.ask(0, agents, last[agents], np.nan, duration)
        crowd.tick()
        if tick % 50 == 0:
            assert crowd.is_consistent()
    for _ in range(30):
        crowd.tick()
    np.testing.assert_array_equal(crowd.anim.row[0], last)
    assert (crowd.transition.next_row == -1).all()
    assert not crowd.transition.duration.any()
    assert crowd.slots.free == slots
    total = crowd.ladder.counts.total
    assert total.cut == 0
    assert (total.snapshot > 0) == (slots > 0)
    assert total.deferred > 0


@pytest.mark.parametrize("slots", [0, 5, 60])
def test_a_storm_of_requests_and_cuts_never_jumps(factories: ModuleType, slots: int) -> None:
    crowd = Crowd(factories, agents=40, slots=slots)
    rng = np.random.default_rng(slots)
    step, reach = steps_and_reach(crowd)
    limit = 1.5 * step + reach / 6.0 * 1.5
    last: Array | None = None
    largest = 0.0
    for tick in range(200):
        agents = np.flatnonzero(rng.random(40) < 0.12)
        duration = rng.uniform(6.0, 20.0, len(agents)).astype(np.float32)
        rows = rng.integers(0, 6, len(agents)).astype(np.int32)
        crowd.ladder.ask(0, agents, rows, rng.uniform(0, 20, len(agents)), duration)
        # Cuts are snapshotted where there is room for all.
        if slots == 60 and tick % 17 == 3:
            crowd.pool.seek(Stream(2, 1), float(rng.uniform(0, 1)))
        crowd.tick()
        for alpha in (0.0, 1.0):
            now = crowd.joints(alpha)
            if last is not None:
                largest = max(largest, float(np.linalg.norm(now - last, axis=2).max()))
            last = now
    assert largest <= limit
    # The limit is no empty one: blends that nobody takes care of would break it.
    assert reach > 2.0 * limit
