"""Parts on the GPU against the CPU: every joint of every part, wherever its agent is."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tifo.components import AgentAnimID, Appearance, Detail, Level, Placement, Transition
from tifo.engine.assets.character import Character, Material, SkinnedMesh
from tifo.engine.behaviour import Goal
from tifo.engine.crowd.cameras import camera_presets
from tifo.engine.crowd.spec import CrowdSpec
from tifo.scripting.camera import FreeCamera
from tifo.systems.part import Part
from tifo.systems.simulation import Simulation

pytestmark = pytest.mark.gl

HISTORIES = (3, 30, 254)


def chain(factories: ModuleType, joints: int, seed: int) -> Character:
    """A part with a chain of joints, turned, moved and scaled in its bind pose, and three clips."""
    rng = np.random.default_rng(seed)
    skeleton = factories.make_skeleton(
        [k - 1 for k in range(joints)],
        rng.normal(0, 0.2, (joints, 3)),
        Rotation.random(joints, random_state=seed).as_quat(),
        rng.uniform(0.9, 1.1, (joints, 3)),
    )
    clips = tuple(
        factories.make_clip(skeleton, f"move {k}", 0.7 + 0.4 * k, reach=0.3 + 0.3 * k)
        for k in range(3)
    )
    mesh = factories.make_box(skeleton, np.zeros(3), np.full(3, 0.1))
    return Character(f"chain of {joints}", skeleton, (mesh,), (Material("shirt"),), clips)


def affine(rng: np.random.Generator) -> NDArray[np.float64]:
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.random(random_state=rng).as_matrix() @ np.diag(
        rng.uniform(0.5, 1.5, 3)
    )
    matrix[:3, 3] = rng.normal(0, 0.3, 3)
    return matrix


def make_simulation(factories: ModuleType, seed: int, **fields: Any) -> Simulation:
    spec = CrowdSpec(
        **{
            **{"layout": "stand", "rows": 6, "columns": 10, "streams": 12, "history": 20},
            **{"slots": 30, "seed": seed, **fields},
        }
    )
    simulation = Simulation(spec, factories.make_character())
    rng = np.random.default_rng(seed)
    placement = simulation.crowd.placement
    placement.yaw[:] = rng.uniform(-7, 7, len(placement.yaw))
    placement.scale[:] = rng.uniform(0.5, 1.6, len(placement.yaw))
    return simulation


def ask_around(simulation: Simulation, parts: list[Part], rng: np.random.Generator) -> None:
    """Somebody wants something else, in the crowd and in each part."""
    crowd = simulation.crowd
    holders: list[Any] = [part for part in parts if part.ladder is not None]
    if crowd.pool is not None:
        holders.append(crowd)
    for holder in holders:
        pool = holder.pool
        stream = pool.stream(int(rng.choice(np.flatnonzero(pool.alive))))
        agents = rng.random(len(crowd)) < 0.25
        holder.transition_to_streamed(agents, stream, duration=rng.uniform(0.05, 0.8))
        if rng.random() < 0.3:
            ids = np.flatnonzero(rng.random(len(crowd)) < 0.3)
            longest = float(pool.history_goal.max() - 2)
            targets = rng.uniform(0, longest, len(ids)).astype(np.float32)
            holder.dilate(ids, targets, 1.0)
        if rng.random() < 0.15:
            pool.seek(stream, rng.random())


def drawn(
    simulation: Simulation, parts: list[Part], probe: Any, tick: int, alpha: float
) -> list[NDArray[np.float32]]:
    """For each part (N, J, 4, 3): where the shaders put the four probes of each joint."""
    from tifo.engine.gl import Buffer, Program, VertexArray, VertexInput, capture
    from tifo.engine.render.body_mesh import VERTEX, make_batches
    from tifo.engine.render.crowd_inputs import CrowdColumns, CrowdInputs
    from tifo.engine.render.part_renderer import HookedList, HookPass

    crowd = simulation.crowd
    poses: Any = crowd.baked or (crowd.pool, crowd.anim, crowd.transition)
    parent = CrowdInputs(
        CrowdColumns(
            crowd.placement,
            crowd.appearance,
            Detail(),
            poses,
            overlays=crowd.overlays,
            body=crowd.body,
            physique=crowd.physique,
        )
    )
    parent.update(tick)
    found = []
    for part in parts:
        own: Any = poses
        if part.ladder is not None:
            own = (part.pool, part.ladder.anim, part.ladder.transition)
        columns = CrowdColumns(crowd.placement, crowd.appearance, Detail(), own)
        inputs = CrowdInputs(columns, parent)
        inputs.update(tick)
        agents = HookedList()
        agents.write(np.arange(len(crowd), dtype=np.uint32))
        hooks = HookPass(part.attachment, parent, (agents,))
        hooks.run(tick, alpha)
        joints = part.character.skeleton.joint_count
        (batch,) = make_batches((probe(joints),), (Material("probe"),))
        program = Program(
            "crowd/skinned.vert.glsl",
            defines={**inputs.defines, "HOOKED": 1},
            feedback=("f_place",),
        )
        buffer = Buffer(batch.vertices)
        feeds = [VertexInput(buffer, VERTEX, normalised=("color",)), *agents.inputs()]
        array = VertexArray(program, feeds)
        inputs.bind(program, tick, alpha, markers=False)
        program["view"] = program["projection"] = np.eye(4, dtype=np.float32)
        out = capture(program, array, None, len(crowd))["f_place"]
        found.append(np.asarray(out, np.float32).reshape(len(crowd), joints, 4, 3))
        for thing in (array, buffer, program, hooks, agents, inputs):
            thing.delete()
    parent.delete()
    return found


def expected(part: Part, tick: int, alpha: float) -> NDArray[np.float64]:
    """The same from the palettes of the CPU, placed agent by agent."""
    crowd = part.crowd
    palettes = part.palettes(np.arange(len(crowd)), tick, alpha).astype(np.float64)
    probes = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    points = np.einsum("njab,pb->njpa", palettes[..., :3], probes) + palettes[:, :, None, :, 3]
    turn = Rotation.from_euler("y", crowd.placement.yaw[:, None].astype(float)).as_matrix()
    points = np.einsum("nab,njpb->njpa", turn, points) * crowd.placement.scale[:, None, None, None]
    return np.asarray(points + crowd.placement.position.T[:, None, None])


@pytest.fixture
def probe(shader_crowd: Any) -> Any:
    """Four vertices a joint, as the other shader tests have them."""

    def make(joints: int) -> SkinnedMesh:
        count = 4 * joints
        owner = np.zeros((count, 4), np.uint16)
        owner[:, 0] = np.repeat(np.arange(joints), 4)
        weights = np.zeros((count, 4), np.float32)
        weights[:, 0] = 1.0
        points = np.concatenate([np.zeros((1, 3)), np.eye(3)])
        return SkinnedMesh(
            "probes",
            np.tile(points, (joints, 1)).astype(np.float32),
            np.tile(np.array([0, 1, 0], np.float32), (count, 1)),
            np.zeros((count, 2), np.float32),
            np.ones((count, 4), np.float32),
            owner,
            weights,
            np.arange(count - count % 3, dtype=np.uint32).reshape(-1, 3),
        )

    return make


@settings(
    max_examples=6,
    deadline=None,
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(
    seed=st.integers(1, 2**31),
    joints=st.tuples(*[st.integers(1, 24)] * 3),
    hooks=st.tuples(*[st.sampled_from([None, "head", "hand_l", "hips", "foot_r"])] * 4),
    alphas=st.lists(st.floats(0, 1), min_size=3, max_size=3),
    poses=st.sampled_from(["streams", "streams", "baked"]),
)
def test_parts_of_many_skeletons_are_where_the_cpu_says(
    factories: ModuleType,
    probe: Any,
    seed: int,
    joints: tuple[int, ...],
    hooks: tuple[str | None, ...],
    alphas: list[float],
    poses: str,
) -> None:
    rng = np.random.default_rng(seed)
    simulation = make_simulation(factories, seed, poses=poses)
    parts = [
        simulation.add_part(
            f"chain {k}",
            chain(factories, count, seed % 1000 + k),
            hook=hook,
            transform=affine(rng),
            streams=int(rng.integers(1, 9)),
            history=history,
            slots=20,
        )
        for k, (count, hook, history) in enumerate(zip(joints, hooks, HISTORIES, strict=False))
    ]
    if poses == "streams":
        cluster = simulation.add_part(
            "cluster",
            factories.make_character(),
            hook=hooks[3],
            transform=affine(rng),
            motion="crowd",
        )
        parts.append(cluster)
    for alpha in alphas:
        for _ in range(int(rng.integers(1, 5))):
            ask_around(simulation, parts, rng)
            simulation.run(seconds=float(rng.integers(1, 12)) / 30)
        tick = simulation.clock.pose_tick
        for part, shown in zip(parts, drawn(simulation, parts, probe, tick, alpha), strict=True):
            wanted = expected(part, tick, alpha)
            np.testing.assert_allclose(shown, wanted, rtol=0, atol=1e-4, err_msg=part.name)
    simulation.close()


def test_a_blending_joint_carries_its_part(factories: ModuleType, probe: Any) -> None:
    """Half way through a blend of the body the hat is half way, by hand."""
    simulation = make_simulation(factories, 5)
    crowd = simulation.crowd
    hat = Character(
        "hat",
        factories.make_skeleton([-1], np.zeros((1, 3))),
        factories.make_character().meshes,
        (Material("shirt"),),
        (),
    )
    part = simulation.add_part("hat", hat, hook="head", transform=np.eye(4), streams=1)
    pool, anim = crowd.pool, crowd.anim
    assert pool is not None
    assert anim is not None
    live = [crowd.uniques.add(), crowd.uniques.add()]
    body = pool.skeleton
    for unique, height in zip(live, (0.0, 1.0), strict=True):
        palettes = np.tile(np.eye(3, 4, dtype=np.float32), (body.joint_count, 1, 1))
        palettes[body.index("head"), 1, 3] = height
        crowd.uniques.write(unique, palettes)
    crowd.motion.wanted[:] = crowd.motion.shown
    crowd.transition_to_unique([0], live[0], duration=0.0)
    simulation.run(seconds=1 / 30)
    crowd.transition_to_unique([0], live[1], duration=8 / 30)
    simulation.run(seconds=5 / 30)
    tick = simulation.clock.pose_tick
    (shown,) = drawn(simulation, [part], probe, tick, 0.0)
    # The blend began with tick 2, so 4 of its 8 ticks have passed; the head's bind pose is 1.6 up.
    raised = (shown[0, 0, 0, 1] - crowd.placement.position[1, 0]) / crowd.placement.scale[0]
    assert raised == pytest.approx(0.9 + 0.4 + 0.3 + 0.5, abs=1e-4)
    simulation.close()


def test_only_agents_with_the_part_are_drawn(factories: ModuleType, gl: Any) -> None:
    from tifo.engine.gl import check_errors
    from tifo.scripting.stage import Stage

    simulation = make_simulation(factories, 3, occupancy=1.0, lod=False)
    stage = Stage(simulation, (96, 64), samples=1)
    camera = FreeCamera.looking(*camera_presets(simulation.plan)["tv"])
    stage.draw(camera)
    before, bare = stage.counts.triangles, stage.pixels()
    seen = len(simulation.crowd.detail.agents[Level.NEAR])
    assert seen == 60
    hat = chain(factories, 4, 1)
    part = simulation.add_part("hat", hat, hook="head", agents=[3, 4, 7])
    stage.draw(camera)
    assert stage.counts.triangles == before + 3 * 12
    assert not np.array_equal(stage.pixels(), bare)
    part.attach(np.arange(60))
    stage.draw(camera)
    assert stage.counts.triangles == before + 60 * 12
    part.detach(np.arange(60))
    stage.draw(camera)
    assert stage.counts.triangles == before
    np.testing.assert_array_equal(stage.pixels(), bare)
    part.attach(5)
    simulation.remove_part("hat")
    stage.draw(camera)
    assert stage.counts.triangles == before
    again = simulation.add_part("hat", hat, hook="head", agents=[])
    stage.draw(camera)
    uploaded = stage.counts.uploaded
    again.attach([1, 2])
    stage.draw(camera)
    assert stage.counts.uploaded > uploaded
    stage.close()
    check_errors("drawing parts")
    simulation.close()


def test_parts_are_not_drawn_at_the_farthest_level(factories: ModuleType, gl: Any) -> None:
    from tifo.scripting.stage import Stage

    simulation = make_simulation(factories, 3, occupancy=1.0)
    simulation.add_part("hat", chain(factories, 2, 1), hook="head")
    stage = Stage(simulation, (32, 18), samples=1)
    stage.draw(FreeCamera.looking(*camera_presets(simulation.plan)["bowl"]))
    assert len(simulation.crowd.detail.agents[Level.FAR]) == 60
    assert stage.counts.triangles == 2 * 60
    stage.close()
    simulation.close()


@pytest.mark.parametrize("poses", ["streams", "baked"])
def test_a_part_that_follows_the_body_covers_it(factories: ModuleType, gl: Any, poses: str) -> None:
    """The same mesh again, a little larger and in another colour, hides all of the first."""
    from tifo.scripting.stage import Stage

    simulation = make_simulation(factories, 4, occupancy=1.0, lod=False, poses=poses)
    crowd = simulation.crowd
    crowd.appearance.shirt[:] = (255, 0, 0, 255)
    skeleton = factories.make_body()
    low, high = np.array([-0.31, -0.01, -0.21]), np.array([0.31, 1.76, 0.21])
    coat = Character(
        "coat",
        skeleton,
        (factories.make_box(skeleton, low, high),),
        (Material("shirt"),),
        (),
    )
    simulation.run(seconds=0.3)
    simulation.send(Goal(0))
    simulation.run(seconds=0.4)
    stage = Stage(simulation, (120, 80), samples=1)
    camera = FreeCamera.looking(*camera_presets(simulation.plan)["tv"])

    def red() -> int:
        r, g, b = stage.pixels().astype(int).transpose(2, 0, 1)
        return int(((r > g + 60) & (r > b + 60)).sum())

    stage.draw(camera)
    assert red() > 100
    green = np.full((5, len(crowd), 4), 255, np.uint8)
    green[..., 0] = green[..., 2] = 0
    simulation.add_part("coat", coat, motion="body", appearance=Appearance(*green))
    stage.draw(camera)
    assert red() == 0
    stage.close()
    simulation.close()


def test_nothing_is_left_on_the_gpu(factories: ModuleType, gl: Any) -> None:
    from tifo.engine.gl import live_objects
    from tifo.scripting.stage import Stage

    simulation = make_simulation(factories, 6)
    before = live_objects()
    stage = Stage(simulation, (32, 18), samples=1)
    camera = FreeCamera.looking(*camera_presets(simulation.plan)["close"])
    simulation.add_part("hat", chain(factories, 3, 1), hook="head")
    simulation.add_part("cluster", factories.make_character(), motion="crowd")
    simulation.add_part("body", factories.make_character(), motion="body")
    stage.draw(camera)
    simulation.remove_part("cluster")
    stage.draw(camera)
    stage.close()
    assert live_objects() == before
    simulation.close()


def test_own_colours_of_a_part_leave_the_bodies_alone(factories: ModuleType, gl: Any) -> None:
    from tifo.engine.render.crowd_inputs import CrowdColumns, CrowdInputs

    count = 3
    zeros = np.zeros(count, np.float32)
    placement = Placement(np.zeros((3, count), np.float32), zeros, zeros + np.float32(1.0))
    colours = np.zeros((5, count, 4), np.uint8)
    looks, other = Appearance(*colours), Appearance(*(colours + 9))
    character = factories.make_character()
    simulation = make_simulation(factories, 1)
    pool = simulation.crowd.pool
    columns = (pool, AgentAnimID.allocate(1, count, 0), Transition.allocate(1, count))
    parent = CrowdInputs(CrowdColumns(placement, looks, Detail(), columns))
    parent.update(0)
    same = CrowdInputs(CrowdColumns(placement, looks, Detail(), columns), parent)
    own = CrowdInputs(CrowdColumns(placement, other, Detail(), columns), parent)
    # Only who plays what is copied; then places and looks as well: 256 rows of 3 and 6 texels.
    assert same.update(0) == 256 * 48
    assert own.update(0) == 256 * (48 + 48 + 24)
    for inputs in (own, same, parent):
        inputs.delete()
    assert character.meshes
    simulation.close()
