"""Overrides as the shaders apply them: against the CPU, by hand, and where they don't compile."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import overrides as texts
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tifo.components import AgentAnimID, BakedAnim, Placement, Transition
from tifo.engine.animation import Clip, ClipBank, Skeleton
from tifo.engine.errors import GraphicsError
from tifo.engine.overrides import Bodies, JointOverride, OverrideSet, look_at
from tifo.engine.streams import BakedPoses, StreamPool
from tifo.engine.streams.blending import agent_palettes, begin_blend

pytestmark = pytest.mark.gl

AGENTS = 24
IDS = np.arange(AGENTS)


def random_skeleton(factories: ModuleType, rng: np.random.Generator) -> Skeleton:
    count = int(rng.integers(2, 13))
    parents = [-1, *sorted(int(rng.integers(0, joint)) for joint in range(1, count))]
    order = np.argsort(_depths(parents), kind="stable")
    back = np.argsort(order)
    sorted_parents = [-1 if parents[k] < 0 else int(back[parents[k]]) for k in order]
    made: Skeleton = factories.make_skeleton(sorted_parents, rng.normal(0, 0.4, (count, 3)))
    return made


def _depths(parents: list[int]) -> list[int]:
    depths: list[int] = []
    for parent in parents:
        depths.append(0 if parent < 0 else depths[parent] + 1)
    return depths


def random_place(rng: np.random.Generator) -> Placement:
    return Placement(
        rng.uniform(-20, 20, (3, AGENTS)).astype(np.float32),
        rng.uniform(-3, 3, AGENTS).astype(np.float32),
        rng.uniform(0.8, 1.2, AGENTS).astype(np.float32),
    )


def some_joints(skeleton: Skeleton, rng: np.random.Generator) -> list[str]:
    count = int(rng.integers(1, min(skeleton.joint_count, 4) + 1))
    return [str(name) for name in rng.choice(skeleton.names, count, replace=False)]


def random_overrides(skeleton: Skeleton, rng: np.random.Generator) -> OverrideSet:
    overrides = OverrideSet(skeleton, AGENTS)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    turn = texts.turn("turn", some_joints(skeleton, rng), 0.7, axis)
    shape = np.eye(3) + rng.uniform(-0.2, 0.2, (3, 3))
    bend = texts.bend("bend", some_joints(skeleton, rng), shape, rng.normal(0, 0.2, (2, 3)))
    parts = rng.dirichlet(np.ones(len(joints := some_joints(skeleton, rng))))
    look = look_at(dict(zip(joints, parts.tolist(), strict=True)))
    look.aim(rng.uniform(-30, 30, 3))
    look.aim(rng.uniform(-30, 30, 3), 0.3)
    again = texts.turn("again", some_joints(skeleton, rng), -0.4, axis[::-1])
    for override in rng.permutation(np.array([turn, bend, look, again], object))[
        : rng.integers(1, 5)
    ]:
        overrides.add(override)
        values = rng.uniform(0, 1, (AGENTS, 4)).astype(np.float32)
        overrides.set_values(override.name, IDS, values)
    return overrides


def check(
    crowd: Any, shown: NDArray[np.float32], tick: int, alpha: float, probe: Any
) -> NDArray[np.float32]:
    """The shader's points must be those of the CPU's palettes; the largest change by overrides."""
    placement = crowd.placement
    before = shown.copy()
    crowd.overrides.apply(shown, IDS, placement)
    points = probe.positions.reshape(shown.shape[1], 4, 3)
    model = np.einsum("kjrc,jpc->kjpr", shown[..., :3], points) + shown[:, :, None, :, 3]
    turn = np.stack([np.sin(placement.yaw), np.cos(placement.yaw)], axis=1)
    body = Bodies(placement.position.T, placement.scale, turn)
    flat = model.reshape(AGENTS, -1, 3)
    expected = np.stack([body.to_stadium(flat[:, k]) for k in range(flat.shape[1])], axis=1)
    found = crowd.skinned(probe, IDS, tick, alpha)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-4)
    change: NDArray[np.float32] = np.abs(shown - before).max()
    return change


@settings(
    max_examples=12, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(seed=st.integers(0, 2**32 - 1), alpha=st.sampled_from([0.0, 0.4, 1.0]))
def test_gpu_and_cpu_agree_on_every_joint(
    seed: int, alpha: float, factories: ModuleType, shader_crowd: Any, probe_mesh: Any
) -> None:
    rng = np.random.default_rng(seed)
    skeleton = random_skeleton(factories, rng)
    clips = [factories.make_clip(skeleton, f"clip {k}", 1.0 + k, reach=0.8) for k in range(2)]
    pool = StreamPool(skeleton, ClipBank(skeleton, clips), capacity=3, history=6)
    for row in range(3):
        pool.add(row % 2, time=float(rng.uniform(0, 1)))
    anim = AgentAnimID.allocate(1, AGENTS, 0)
    transition = Transition.allocate(1, AGENTS)
    anim.row[0] = rng.integers(0, 3, AGENTS)
    anim.start[0] = anim.target[0] = rng.uniform(0, 4, AGENTS)
    for tick in range(1, 9):
        pool.evaluate(tick)
        pool.commit(tick)
    blending = np.flatnonzero(rng.random(AGENTS) < 0.5)
    rows = rng.integers(0, 3, len(blending)).astype(np.int32)
    zeros = np.zeros(len(blending), np.float32)
    begin_blend(anim, transition, 0, blending, rows, zeros, 6, zeros + np.float32(6))
    overrides = random_overrides(skeleton, rng)
    crowd = shader_crowd((pool, anim, transition), placement=random_place(rng), overrides=overrides)
    crowd.update(8)
    shown = agent_palettes(pool, anim, transition, 0, IDS, 8, alpha)
    assert check(crowd, shown, 8, alpha, probe_mesh(skeleton.joint_count)) > 1e-3


def test_baked_crowds_agree_as_well(
    factories: ModuleType, shader_crowd: Any, probe_mesh: Any
) -> None:
    rng = np.random.default_rng(5)
    character = factories.make_character()
    bank = ClipBank(character.skeleton, character.clips)
    baked = BakedPoses(character.skeleton, bank)
    anim = BakedAnim(
        rng.integers(0, len(character.clips), AGENTS).astype(np.int32),
        np.ones(AGENTS, np.float32),
        -rng.integers(0, 50, AGENTS).astype(np.float64),
    )
    overrides = random_overrides(character.skeleton, rng)
    crowd = shader_crowd((baked, anim), placement=random_place(rng), overrides=overrides)
    crowd.update(8)
    seconds = (8.0 - anim.began) / 30.0
    rows = baked.frame_rows(anim.clip.astype(np.int64), anim.speed, seconds)
    assert check(crowd, baked.palettes[rows], 9, 0.0, probe_mesh(7)) > 1e-3


def one_pose(
    factories: ModuleType, shader_crowd: Any, squeeze: float = 1.0
) -> tuple[Any, OverrideSet]:
    """An arm along +X with joints at 0, 1 and 2, and a side above the first; two agents."""
    places = np.array([[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 0, 0]], float)
    skeleton = factories.make_skeleton([-1, 0, 0, 2], places, names=("root", "side", "arm", "hand"))
    still: Clip = factories.make_still(skeleton, "still")
    pool = StreamPool(skeleton, ClipBank(skeleton, [still]), capacity=1, history=2)
    pool.add(0)
    for tick in (1, 2):
        pool.evaluate(tick)
        pool.commit(tick)
    pool.store.ring[..., 2, :] *= np.float32(squeeze)
    overrides = OverrideSet(skeleton, 2)
    poses = (pool, AgentAnimID.allocate(1, 2, 0), Transition.allocate(1, 2))
    return shader_crowd(poses, overrides=overrides), overrides


def test_descendants_follow_a_quarter_turn_and_siblings_do_not(
    factories: ModuleType, shader_crowd: Any
) -> None:
    crowd, overrides = one_pose(factories, shader_crowd)
    overrides.add(texts.turn("turn", ["arm"], np.pi / 2 - 0.25, values=(1.0, 0.0, 0.0, 0.0)))
    crowd.update(2)
    palettes = crowd.palettes([0, 1], 2, 1.0)
    still = np.eye(3, 4)
    # About (1, 0, 0): x becomes 1 - y, and y becomes x - 1.
    turned = np.array([[0, -1, 0, 1], [1, 0, 0, -1], [0, 0, 1, 0]])
    np.testing.assert_allclose(palettes, [[still, still, turned, turned]] * 2, atol=1e-6)


def test_flat_joints_are_left_alone(factories: ModuleType, shader_crowd: Any) -> None:
    crowd, overrides = one_pose(factories, shader_crowd, squeeze=0.0)
    overrides.add(texts.turn("turn", ["arm"], 1.0, values=(1.0, 0.0, 0.0, 0.0)))
    crowd.update(2)
    flat = np.diag([1.0, 1.0, 0.0])
    found = crowd.palettes([0, 1], 2, 1.0)
    np.testing.assert_allclose(found[..., :3], np.tile(flat, (2, 4, 1, 1)), atol=1e-6)


def test_changed_values_and_uniforms_are_seen_and_copied_once(
    factories: ModuleType, shader_crowd: Any
) -> None:
    crowd, overrides = one_pose(factories, shader_crowd)
    turn = texts.turn("turn", ["root"], 1.0)
    overrides.add(turn)

    def angles() -> NDArray[np.float64]:
        x, y = crowd.palettes([0, 1], 2, 1.0)[:, 0, :2, 0].T
        found: NDArray[np.float64] = np.arctan2(y, x)
        return found

    crowd.update(2)
    quiet = crowd.update(2)
    np.testing.assert_allclose(angles(), [0.25, 0.25], atol=1e-5)
    overrides.set_values("turn", np.array([1]), (0.5, 0, 0, 0))
    assert crowd.update(2) == quiet + 256 * 16
    np.testing.assert_allclose(angles(), [0.25, 0.75], atol=1e-5)
    turn.uniforms["amount"] = 2.0
    assert crowd.update(2) == quiet
    np.testing.assert_allclose(angles(), [0.25, 1.25], atol=1e-5)


LINE_3 = """float one() { return 1.0; }
uniform float scale;
mat4 broken(OverriddenJoint joint) { return nothing * scale * joint.pose; }
"""


@pytest.mark.parametrize("first", [False, True])
def test_a_compile_error_names_the_override_and_the_line(
    first: bool, factories: ModuleType, shader_crowd: Any
) -> None:
    crowd, overrides = one_pose(factories, shader_crowd)
    broken = JointOverride("broken", ["arm"], LINE_3, uniforms={"scale": 1.0})
    good = texts.turn("good", ["arm"])
    for override in (broken, good) if first else (good, broken):
        overrides.add(override)
    crowd.update(2)
    with pytest.raises(GraphicsError, match=r"^override 'broken', line 3: .*nothing") as caught:
        crowd.palettes([0], 2, 1.0)
    assert "nothing * scale * joint.pose" in str(caught.value)
    assert "override0" not in str(caught.value)
    assert "override1" not in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "mat4 broken(OverriddenJoint joint) { return joint.pose;",
        "/* mat4 */ mat4 broken(OverriddenJoint joint) { return joint.pose; } /*",
        "mat4 broken(OverriddenJoint joint);",
        "#version 330 core\nmat4 broken(OverriddenJoint joint) { return joint.pose; }",
        '#include "lib/none.glsl"\nmat4 broken(OverriddenJoint joint) { return joint.pose; }',
        "#if 1\nmat4 broken(OverriddenJoint joint) { return joint.pose; }",
    ],
)
def test_texts_that_spoil_what_follows_are_found_out(
    text: str, factories: ModuleType, shader_crowd: Any
) -> None:
    crowd, overrides = one_pose(factories, shader_crowd)
    overrides.add(texts.turn("good", ["arm"]))
    try:
        overrides.add(JointOverride("broken", ["arm"], text))
    except ValueError as error:
        assert str(error).startswith("override 'broken'")  # noqa: PT017
        return
    crowd.update(2)
    with pytest.raises(GraphicsError, match=r"^override 'broken'"):
        crowd.palettes([0], 2, 1.0)
