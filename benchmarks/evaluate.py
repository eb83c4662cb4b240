"""What it costs to evaluate all streams for one pose tick, from sampling to the store."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ..engine.animation.clip_bank import ClipBank
from ..engine.streams.pool import StreamPool
from .measure import environment, spread, time_calls
from .synthetic import synthetic_character


def evaluate(
    *, streams: int, joints: int, history: int, runs: int, seed: int = 1
) -> dict[str, Any]:
    """Time whole evaluations of `streams` running clip streams.

    Parameters
    ----------
    streams, joints, history
        Size of the pool.
    runs
        Pose ticks that are timed.
    seed
        Of the synthetic character.

    Returns
    -------
    dict
        Figures with their units in their names, and the environment.
    """
    rng = np.random.default_rng(seed)
    character = synthetic_character(joints, rng)
    # Finding clip events is a step of its own, which `tick` measures.
    clips = [replace(clip, events=()) for clip in character.clips]
    bank = ClipBank(character.skeleton, clips)
    pool = StreamPool(character.skeleton, bank, capacity=streams, history=history)
    for number in range(streams):
        clip = number % len(character.clips)
        time = rng.uniform(0.0, character.clips[clip].duration)
        pool.add(clip, time=time, speed=rng.uniform(0.9, 1.1))

    def tick(number: int) -> None:
        pool.evaluate(number)
        pool.commit(number)

    # Once round the ring first: the first touch of its memory is not a tick's cost.
    seconds = time_calls(tick, runs, warm_up=pool.store.capacity + 10)
    store = pool.store
    return {
        "benchmark": "evaluate",
        "streams": streams,
        "joints": joints,
        "history_poses": history,
        **spread(seconds),
        "slice_bytes": store.ring[0].nbytes,
        "ring_bytes": store.ring.nbytes,
        "environment": environment(),
    }
