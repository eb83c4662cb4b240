"""Random trees of controllers, and clips for them to play."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tifo.engine.animation import Clip, Skeleton
from tifo.engine.animation.controllers import (
    Additive,
    Blend2,
    BlendN,
    BlendSpace1D,
    BlendSpace2D,
    ClipNode,
    Controller,
    Mask,
    Masked,
    OneShot,
    Overlay,
    StateMachine,
    TimeScale,
    Transition,
)

Array = NDArray[Any]

CLIPS = tuple(f"move {number}" for number in range(6))
STATES = ("a", "b", "c", "d")
SHARE = st.sampled_from([0.0, 1.0]) | st.floats(0, 1)
SIGNED = st.floats(-2, 2)


def make_moves(skeleton: Skeleton, count: int = 6) -> list[Clip]:
    """Clips that turn about all axes, move and stretch every joint; odd ones don't loop."""
    rng = np.random.default_rng(5)
    clips = []
    for number in range(count):
        duration = (0.4, 0.9, 1.5, 0.7, 2.0, 0.5)[number % 6]
        phase = np.linspace(0, 2 * np.pi, round(duration * 60) + 1)[:, None, None]
        joints = skeleton.joint_count

        def swing(size: float, phase: Array = phase, joints: int = joints) -> Array:
            return size * np.sin(phase + rng.uniform(0, 6, (1, joints, 3)))

        turn = Rotation.from_rotvec(swing(0.4).reshape(-1, 3)).as_quat().reshape(-1, joints, 4)
        clips.append(
            Clip(
                f"move {number}",
                duration,
                (turn * (-1 if number % 3 == 2 else 1)).astype(np.float32),
                (skeleton.rest_translation + swing(0.1)).astype(np.float32),
                (1 + swing(0.1)).astype(np.float32),
                number % 2 == 0,
            )
        )
    return clips


def clip_nodes() -> st.SearchStrategy[Controller]:
    return st.builds(
        ClipNode,
        st.sampled_from(CLIPS),
        speed=SIGNED,
        loop=st.sampled_from([None, True, False]),
        phase=SHARE,
    )


def masks() -> st.SearchStrategy[Mask]:
    joints = st.sampled_from(["hips", "chest", "head", "hand_l", "foot_r"])
    return st.builds(
        Mask, st.dictionaries(joints, SHARE, min_size=1, max_size=3), descendants=st.booleans()
    )


def _points(place: Any, children: Any) -> Any:
    return st.lists(st.tuples(place, children), min_size=1, max_size=5, unique_by=lambda p: p[0])


def _wrap(children: st.SearchStrategy[Controller]) -> st.SearchStrategy[Controller]:
    overlays = st.builds(Overlay, children, masks(), SHARE)
    coordinate = st.integers(-200, 200).map(lambda x: x / 100)
    plane = st.tuples(coordinate, coordinate)
    return st.one_of(
        st.builds(Blend2, children, children, SHARE),
        st.lists(st.tuples(children, SHARE), min_size=1, max_size=5).map(
            lambda pairs: BlendN([n for n, _ in pairs], [w for _, w in pairs])
        ),
        st.builds(TimeScale, children, SIGNED),
        st.builds(Masked, children, st.lists(overlays, min_size=1, max_size=3)),
        st.builds(
            Additive, children, children, SHARE, st.sampled_from(["", "move 1", "move 2"]), SHARE
        ),
        st.builds(BlendSpace1D, _points(SIGNED, children), SIGNED),
        st.builds(BlendSpace2D, _points(plane, children), plane),
    )


def plain_trees() -> st.SearchStrategy[Controller]:
    """Trees without states of their own."""
    return st.recursive(clip_nodes(), _wrap, max_leaves=10)


def states() -> st.SearchStrategy[Controller]:
    clip = st.builds(
        ClipNode,
        st.sampled_from(CLIPS),
        speed=st.sampled_from([1.0, 2.0, -1.0]),
        loop=st.sampled_from([None, True, False]),
        phase=st.sampled_from([0.0, 0.5]),
    )
    leaf = clip | st.builds(Blend2, clip, clip, st.sampled_from([0.0, 0.25, 0.75]))
    shot = st.builds(
        OneShot, clip, leaf, st.sampled_from([0.0, 0.11]), st.sampled_from([0.0, 0.17])
    )
    return leaf | shot | st.builds(TimeScale, leaf, st.sampled_from([2.0, -1.0]))


def transitions() -> st.SearchStrategy[list[Transition]]:
    way = st.builds(
        Transition,
        st.sampled_from(("*", *STATES)),
        st.sampled_from(STATES),
        trigger=st.sampled_from(["", "t", "u"]),
        when=st.sampled_from(["", "x", "not x", "y > 0.5", "y <= 0.5"]),
        at_end=st.booleans(),
        duration=st.sampled_from([0.0, 0.07, 0.2]),
        curve=st.sampled_from(["linear", "smooth"]),
        sync=st.booleans(),
        priority=st.integers(0, 2),
        interrupt=st.sampled_from(["any", "priority", "none"]),
    )
    return st.lists(way, max_size=8)


def machines() -> st.SearchStrategy[Controller]:
    """State machines whose states are small trees, some with one-shots, some in a blend."""
    nodes = st.fixed_dictionaries({state: states() for state in STATES})
    machine = st.builds(
        StateMachine, nodes, transitions(), parameters=st.just({"x": 0.0}), name=st.just("m")
    )
    return machine | st.builds(Blend2, machine, clip_nodes(), SHARE)
