"""A stream pool against a list of numbers, under random calls in random order."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import ModuleType

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    Bundle,
    MultipleResults,
    RuleBasedStateMachine,
    consumes,
    initialize,
    invariant,
    multiple,
    precondition,
    rule,
    run_state_machine_as_test,
)

from tifo.engine.animation import ClipBank
from tifo.engine.streams import Stream, StreamPool

CLIP_SECONDS = (100.0, 0.7)
"""The first clip stays at its end, the second wraps."""


@dataclass
class Model:
    """What one stream should be."""

    clip: int
    time: float
    speed: float
    history: int
    running: bool = True
    head: int | None = None
    poses: list[float] = field(default_factory=list)
    """Clip times since the last cut, oldest first."""

    def advance(self) -> None:
        if self.poses:
            self.time += self.speed / 30.0
        if self.clip == 1:
            self.time %= CLIP_SECONDS[1]

    def shown(self) -> float:
        return self.time if self.clip == 1 else min(max(self.time, 0.0), CLIP_SECONDS[0])


class PoolMachine(RuleBasedStateMachine):
    """Every rule acts on the pool and on the models of its streams."""

    streams: Bundle[Stream] = Bundle("streams")
    removed: Bundle[Stream] = Bundle("removed")

    def __init__(self, pool: StreamPool) -> None:
        super().__init__()
        self.pool = pool
        self.models: dict[Stream, Model] = {}
        self.handles: set[Stream] = set()
        self.next_tick = 0

    @initialize(tick=st.integers(-70, 300))
    def start(self, tick: int) -> None:
        self.next_tick = tick

    @rule(
        target=streams,
        clip=st.integers(0, 1),
        time=st.floats(0, 5),
        speed=st.floats(-2, 2),
        history=st.sampled_from([None, 2, 5, 6]),
    )
    def add(
        self, clip: int, time: float, speed: float, history: int | None
    ) -> Stream | MultipleResults[Stream]:
        if len(self.models) == len(self.pool.alive):
            with pytest.raises(ValueError, match="all 4 stream rows are in use"):
                self.pool.add(clip)
            return multiple()
        stream = self.pool.add(clip, time=time, speed=speed, history=history)
        assert stream not in self.handles
        self.handles.add(stream)
        self.models[stream] = Model(clip, time, speed, 5 if history is None else history)
        return stream

    @rule(target=removed, stream=consumes(streams))
    def remove(self, stream: Stream) -> Stream:
        self.pool.remove(stream)
        del self.models[stream]
        return stream

    @rule(stream=removed)
    def use_a_stale_handle(self, stream: Stream) -> None:
        with pytest.raises(ValueError, match=r"is not alive|was removed"):
            self.pool.seek(stream, 0.0)

    @rule(stream=streams)
    def stop(self, stream: Stream) -> None:
        self.pool.stop(stream)
        self.models[stream].running = False

    @rule(stream=streams)
    def run(self, stream: Stream) -> None:
        self.pool.run(stream)
        model = self.models[stream]
        if not model.running:
            model.running = True
            model.poses.clear()

    @rule(stream=streams, time=st.floats(0, 5))
    def seek(self, stream: Stream, time: float) -> None:
        self.pool.seek(stream, time)
        self.models[stream].time = time
        self.models[stream].poses.clear()

    @rule(stream=streams, clip=st.integers(0, 1))
    def play(self, stream: Stream, clip: int) -> None:
        self.pool.play(stream, clip)
        model = self.models[stream]
        model.clip, model.time = clip, 0.0
        model.poses.clear()

    @rule(count=st.integers(1, 12))
    def tick(self, count: int) -> None:
        for _ in range(count):
            self.pool.evaluate(self.next_tick)
            self._commit([stream for stream, model in self.models.items() if model.running])

    @precondition(lambda self: any(model.running for model in self.models.values()))
    @rule(data=st.data(), cut=st.sampled_from(["stop", "seek", "stop and run"]))
    def tick_with_a_change_inside(self, data: st.DataObject, cut: str) -> None:
        running = [stream for stream, model in self.models.items() if model.running]
        changed = data.draw(st.sampled_from(running))
        self.pool.evaluate(self.next_tick)
        model = self.models[changed]
        model.advance()
        if cut == "seek":
            self.seek(changed, 1.0)
        else:
            self.stop(changed)
        if cut == "stop and run":
            self.run(changed)
        self._commit([stream for stream in running if stream != changed])

    def _commit(self, running: list[Stream]) -> None:
        for stream in running:
            model = self.models[stream]
            model.advance()
            model.poses.append(model.shown())
            model.head = self.next_tick
        self.pool.commit(self.next_tick)
        self.next_tick += 1

    @invariant()
    def columns_are_the_models(self) -> None:
        assert int(self.pool.alive.sum()) == len(self.models)
        for stream, model in self.models.items():
            row = self.pool.row(stream)
            assert self.pool.generation[row] == stream.generation
            assert bool(self.pool.running[row]) == model.running
            assert self.pool.valid[row] == min(len(model.poses), model.history)
            if model.poses:
                assert self.pool.head[row] == model.head

    @invariant()
    def every_valid_pose_is_in_the_ring(self) -> None:
        store = self.pool.store
        for stream, model in self.models.items():
            for age, time in enumerate(reversed(model.poses[-model.history :])):
                assert model.head is not None
                shown = store.ring[store.slice_of(model.head - age), stream.row, 0, 0, 3]
                expected = 30.0 * time + 5000.0 * model.clip
                assert abs(float(shown) - expected) < 2e-3 or self._at_seam(model, time)

    @staticmethod
    def _at_seam(model: Model, time: float) -> bool:
        """A wrapped time within rounding of the seam may show either end."""
        return model.clip == 1 and min(time, CLIP_SECONDS[1] - time) < 1e-6


def test_a_pool_behaves_as_its_model(factories: ModuleType) -> None:
    skeleton, stays = factories.make_slide(CLIP_SECONDS[0])
    _, wraps = factories.make_slide(CLIP_SECONDS[1], base=5000.0)
    bank = ClipBank(skeleton, [stays, replace(wraps, looping=True)])

    class Machine(PoolMachine):
        """The machine on a fresh pool."""

        def __init__(self) -> None:
            super().__init__(StreamPool(skeleton, bank, capacity=4, history=5))

    run_state_machine_as_test(
        Machine, settings=settings(max_examples=40, stateful_step_count=40, deadline=None)
    )
