"""What it costs to evaluate all streams for one pose tick, from sampling to the store."""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np

from ..engine.animation.clip_bank import ClipBank
from ..engine.animation.controllers import Blend2, ClipNode, Controller
from ..engine.streams.pool import StreamPool
from .measure import environment, spread, time_calls
from .synthetic import CLIPS, synthetic_character

TREES = ("plain", "deep")


def evaluate(
    *, streams: int, joints: int, history: int, runs: int, tree: str = "plain", seed: int = 1
) -> dict[str, Any]:
    """Time whole evaluations of `streams` running streams.

    Parameters
    ----------
    streams, joints, history
        Size of the pool.
    runs
        Pose ticks that are timed.
    tree
        ``"plain"``: each stream plays a clip. ``"deep"``: each has a tree of its own of five clips
        and four blends; the same clips are timed beside it, turn by turn, and the ratio is given.
    seed
        Of the synthetic character.

    Returns
    -------
    dict
        Figures with their units in their names, and the environment.
    """
    if tree not in TREES:
        raise ValueError(f"tree is {tree!r}, expected one of {', '.join(TREES)}")
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
    store = pool.store
    result: dict[str, Any] = {
        "benchmark": "evaluate",
        "tree": tree,
        "streams": streams,
        "joints": joints,
        "history_poses": history,
    }
    # Once round the ring first: the first touch of its memory is not a tick's cost.
    warm_up = store.capacity + 10
    if tree == "plain":
        result |= spread(time_calls(lambda number: _tick(pool, number), runs, warm_up))
    else:
        trees = StreamPool(character.skeleton, bank, capacity=streams, history=history)
        begin = perf_counter()
        for number in range(streams):
            trees.add(_deep(number), speed=rng.uniform(0.9, 1.1))
        added = perf_counter() - begin
        # In turns, so that both meet the same load of the machine.
        pools = (trees, pool)
        seconds = time_calls(lambda k: _tick(pools[k % 2], k // 2), 2 * runs, 2 * warm_up)
        deep, plain = spread(seconds[0::2]), spread(seconds[1::2])
        result |= deep | {
            "plain_median_ms": plain["median_ms"],
            "ratio": round(deep["median_ms"] / plain["median_ms"], 3),
            "add_stream_ms": round(1e3 * added / streams, 4),
        }
    return result | {
        "slice_bytes": store.ring[0].nbytes,
        "ring_bytes": store.ring.nbytes,
        "environment": environment(),
    }


def _tick(pool: StreamPool, number: int) -> None:
    pool.evaluate(number)
    pool.commit(number)


def _deep(number: int) -> Controller:
    """Five clips and four blends, each blend over the one before."""
    node: Controller = ClipNode(CLIPS[number % len(CLIPS)])
    for step in range(1, 5):
        clip = ClipNode(CLIPS[(number + step) % len(CLIPS)])
        node = Blend2(node, clip, 0.2 * step - 0.05, name=f"blend_{step}")
    return node
