"""Parts of a crowd without drawing: who has them, what they play, where they are."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import esper
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import tifo
from tifo.components import Attachment, Detail, Level, PartBits, View
from tifo.engine.assets.character import Character, Material
from tifo.engine.crowd.hooks import as_affine, hook_place
from tifo.systems.simulation import Simulation

MakeSimulation = Callable[..., Simulation]


@pytest.fixture
def hat(factories: ModuleType) -> Character:
    """Two joints, two clips of 1 s and 2 s."""
    skeleton = factories.make_skeleton([-1, 0], np.array([[0, 0, 0], [0, 0.2, 0.1]]))
    clips = (
        factories.make_clip(skeleton, "still", 1.0, reach=0.1),
        factories.make_clip(skeleton, "bob", 2.0),
    )
    mesh = factories.make_box(skeleton, np.zeros(3), np.ones(3) * 0.2)
    return Character("hat", skeleton, (mesh,), (Material("shirt"),), clips)


def whole(rows: Any) -> NDArray[np.float64]:
    """(..., 4, 4) from (..., 3, 4)."""
    out = np.zeros((*rows.shape[:-2], 4, 4))
    out[..., :3, :] = rows
    out[..., 3, 3] = 1.0
    return out


def test_parts_are_given_and_taken(simulate: MakeSimulation, hat: Character) -> None:
    simulation = simulate()
    part = simulation.add_part("hat", hat, hook="head", agents=[3, 5])
    assert np.flatnonzero(part.visible).tolist() == [3, 5]
    part.attach(9)
    mask = np.zeros(300, bool)
    mask[[5, 200]] = True
    part.attach(mask)
    assert np.flatnonzero(part.visible).tolist() == [3, 5, 9, 200]
    part.detach([3, 200, 7])
    assert np.flatnonzero(part.visible).tolist() == [5, 9]
    everybody = simulation.add_part("scarf", hat, hook="chest")
    assert everybody.visible.all()
    assert np.flatnonzero(part.visible).tolist() == [5, 9]
    assert set(simulation.crowd.parts) == {"hat", "scarf"}


def test_agents_with_a_part_are_drawn_at_the_level_of_their_body(
    simulate: MakeSimulation, hat: Character
) -> None:
    simulation = simulate(occupancy=1.0)
    part = simulation.add_part("hat", hat, hook="head", agents=np.arange(0, 300, 7))
    eye, target = tifo.camera_presets(simulation.plan)["tv"]
    camera = tifo.FreeCamera.looking(eye, target)
    for height in (60, 400, 3000):
        simulation.look(camera.view(), camera.projection((16, 9)), height)
        simulation.advance(0.0)
        bodies = simulation.crowd.detail.agents
        with simulation.active():
            hats = esper.component_for_entity(part.entity, Detail).agents
        for level in Level:
            wanted = [k for k in bodies[level] if k % 7 == 0]
            assert hats[level].tolist() == ([] if level is Level.FAR else wanted)
        assert hats[0].dtype == np.uint32


def test_a_part_is_where_its_joint_is(
    simulate: MakeSimulation, factories: ModuleType, hat: Character
) -> None:
    """Against matrices joint by joint, with a pose that the application wrote."""
    simulation = simulate()
    crowd = simulation.crowd
    rng = np.random.default_rng(4)
    skeleton = crowd.character.skeleton
    turn = Rotation.random(skeleton.joint_count, random_state=3).as_quat()
    pose = np.zeros((10, skeleton.joint_count))
    pose[:4] = turn.T
    pose[4:7] = rng.normal(0, 0.4, (3, skeleton.joint_count))
    pose[7:] = rng.uniform(0.8, 1.2, (3, skeleton.joint_count))
    live = crowd.uniques.add()
    crowd.uniques.write(live, pose.astype(np.float32))
    transform = np.eye(4)
    transform[:3, :3] = Rotation.from_euler("xyz", [0.3, -0.7, 1.1]).as_matrix() * 1.3
    transform[:3, 3] = 0.1, 0.2, -0.3
    part = simulation.add_part("hat", hat, hook="hand_l", transform=transform)
    own = part.uniques if part.pool.store.uniques else None
    assert own is None
    crowd.transition_to_unique([11], live, duration=0.0)
    simulation.run(seconds=1 / 30)
    tick = simulation.clock.pose_tick
    models = factories.reference_models(
        [int(p) for p in skeleton.parents], pose[:4].T, pose[4:7].T, pose[7:].T
    )
    wanted = models[skeleton.index("hand_l")] @ transform
    (hook,) = part.hooks([11], tick)
    np.testing.assert_allclose(whole(hook), wanted, atol=1e-5)
    # The part's own palettes come first, then the hook.
    anim, pool = part.ladder.anim, part.pool
    row, offset = int(anim.row[0, 11]), int(anim.start[0, 11])
    anim.start[0, 11] = anim.target[0, 11] = offset
    own_palette = pool.store.ring[pool.store.slice_of(tick - offset), row]
    (shown,) = part.palettes([11], tick)
    np.testing.assert_allclose(whole(shown), wanted @ whole(own_palette), atol=1e-4)


def test_without_a_hook_a_part_stands_between_the_feet(
    simulate: MakeSimulation, hat: Character
) -> None:
    simulation = simulate()
    place = np.eye(4)
    place[2, 3] = 0.5
    part = simulation.add_part("banner", hat, transform=place)
    simulation.run(seconds=0.5)
    hooks = part.hooks([0, 1, 2], simulation.clock.pose_tick)
    np.testing.assert_array_equal(hooks, np.tile(place[:3], (3, 1, 1)))


def test_parts_blend_and_end_on_their_last_request(
    simulate: MakeSimulation, hat: Character
) -> None:
    simulation = simulate()
    simulation.run(seconds=0.4)
    part = simulation.add_part("hat", hat, hook="head", streams=6, history=20)
    assert [len(part.streams(name)) for name in ("still", "bob")] == [3, 3]
    rows = {stream.row for stream in part.streams("still")}
    assert set(part.ladder.anim.row[0].tolist()) == rows
    first, last = part.streams("bob")[:2]
    agents = np.arange(100)
    part.transition_to_streamed(agents, first, duration=0.5)
    simulation.run(seconds=0.2)
    part.transition_to_streamed(agents, last, duration=0.3)
    simulation.run(seconds=1.5)
    assert (part.ladder.anim.row[0, :100] == last.row).all()
    assert set(part.ladder.anim.row[0, 100:].tolist()) <= rows
    assert not part.ladder.transition.duration.any()
    assert not part.ladder.slots.used.any()
    assert part.ladder.counts.total.snapshot == 64
    assert part.ladder.counts.total.deferred == 36


def test_a_parts_offsets_can_be_dilated(simulate: MakeSimulation, hat: Character) -> None:
    simulation = simulate()
    part = simulation.add_part("hat", hat, hook="head", history=40)
    agents = np.arange(50)
    part.dilate(agents, np.full(50, 30.0, np.float32), 1.0)
    simulation.run(seconds=6.0)
    anim = part.ladder.anim
    assert (anim.start[0, :50] == 30.0).all()
    assert (anim.rate == 0).all()
    with pytest.raises(ValueError, match="targets must be 0 to 38"):
        part.dilate(agents, np.full(50, 39.0, np.float32), 1.0)


def test_streams_of_a_part_rest_while_nobody_has_it(
    simulate: MakeSimulation, hat: Character
) -> None:
    simulation = simulate()
    part = simulation.add_part("hat", hat, hook="head", agents=[], streams=4, history=20)
    head = part.pool.head.copy()
    assert not part.pool.running.any()
    simulation.run(seconds=1.0)
    np.testing.assert_array_equal(part.pool.head, head)
    targets = part.ladder.anim.target.copy()
    part.attach([1])
    assert part.pool.running.all()
    simulation.run(seconds=0.1)
    tick = simulation.clock.pose_tick
    assert (part.pool.head == tick).all()
    simulation.run(seconds=8.0)
    np.testing.assert_allclose(part.ladder.anim.start, targets, atol=1e-4)
    part.detach([1])
    assert not part.pool.running.any()
    # A stream that the application had stopped stays so.
    part.pool.run(part.streams("bob")[0])
    part.attach([2])
    part.pool.stop(part.streams("still")[0])
    part.detach([2])
    part.attach([2])
    assert part.pool.running.sum() == 3


def test_a_part_that_never_moves_costs_no_evaluation(
    simulate: MakeSimulation, factories: ModuleType, hat: Character
) -> None:
    simulation = simulate()
    still = Character("rock", hat.skeleton, hat.meshes, hat.materials, ())
    part = simulation.add_part("rock", still, hook="head", streams=1)
    assert not part.pool.running.any()
    simulation.run(seconds=0.2)
    shown = part.palettes(np.arange(3), simulation.clock.pose_tick)
    hooks = part.hooks(np.arange(3), simulation.clock.pose_tick)
    np.testing.assert_allclose(shown, np.repeat(hooks[:, None], 2, axis=1), atol=1e-6)


def test_a_cluster_of_the_body_plays_streams_of_its_own(
    simulate: MakeSimulation, factories: ModuleType
) -> None:
    simulation = simulate(rest_idle=True)
    crowd = simulation.crowd
    part = simulation.add_part("coat", factories.make_character(), motion="crowd")
    assert part.pool is crowd.pool
    np.testing.assert_array_equal(part.ladder.anim.row[0], crowd.anim.row[0])
    simulation.run(seconds=4.0)
    resting = np.flatnonzero(~crowd.pool.running)
    assert len(resting)
    stream = crowd.pool.stream(int(resting[0]))
    part.transition_to_streamed([7], stream, duration=0.2)
    simulation.run(seconds=4.0)
    # Only the part shows it, and so it runs.
    assert not (crowd.anim.row == stream.row).any()
    assert crowd.pool.running[stream.row]
    assert part.ladder.anim.row[0, 7] == stream.row


def test_histories_shrink_only_as_far_as_parts_allow(
    simulate: MakeSimulation, factories: ModuleType
) -> None:
    simulation = simulate(history=30)
    crowd = simulation.crowd
    part = simulation.add_part("coat", factories.make_character(), motion="crowd")
    # Bodies are near the head of their stream, the parts far behind it.
    for column in ("start", "target"):
        getattr(crowd.anim, column)[:] = 0.0
        getattr(part.ladder.anim, column)[:] = 25.0
    crowd.pool.set_history(crowd.pool.stream(int(crowd.anim.row[0, 0])), 10)
    row = int(crowd.anim.row[0, 0])
    agents = np.flatnonzero(part.ladder.anim.row[0] == row)
    history = []
    for _ in range(90):
        simulation.run(seconds=1 / 30)
        history.append(int(crowd.pool.history[row]))
        shown = part.ladder.anim.target[0, agents].max()
        assert shown <= 25.0
    assert history[0] >= 26
    assert history[-1] == 10
    assert part.ladder.anim.target[0, agents].max() <= 8.0


def test_a_removed_part_gives_back_what_it_had(
    simulate: MakeSimulation, factories: ModuleType, hat: Character
) -> None:
    simulation = simulate(slots=40)
    crowd = simulation.crowd
    part = simulation.add_part("coat", factories.make_character(), motion="crowd")
    hooks = len(crowd.pool.before_cut)
    for wait in (0.3, 0.1):
        for row in (0, 1):
            part.transition_to_streamed(np.arange(30), crowd.pool.stream(row), duration=2.0)
            simulation.run(seconds=wait)
    assert crowd.ladder.slots.used.sum() >= 30
    simulation.remove_part("coat")
    assert crowd.ladder.slots.free == 40
    assert len(crowd.pool.before_cut) == hooks - 1
    with simulation.active():
        assert not esper.get_component(Attachment)
        assert (esper.component_for_entity(crowd.entity, PartBits).bits == 0).all()
    with pytest.raises(ValueError, match="part 'coat' was removed"):
        part.attach([1])
    with pytest.raises(ValueError, match="no part 'coat'; it has: none"):
        simulation.remove_part("coat")
    simulation.add_part("coat", hat, hook="head")
    with pytest.raises(ValueError, match="part 'coat' was removed"):
        _ = part.visible
    simulation.run(seconds=0.1)


def test_a_removed_stream_leaves_the_parts_on_it_in_the_bind_pose(
    simulate: MakeSimulation, factories: ModuleType
) -> None:
    simulation = simulate()
    crowd = simulation.crowd
    part = simulation.add_part("coat", factories.make_character(), motion="crowd")
    row = int(part.ladder.anim.row[0, 0])
    crowd.pool.remove(crowd.pool.stream(row))
    assert part.ladder.anim.row[0, 0] == crowd.pool.store.bind_row


def test_thirty_two_parts_and_no_more(simulate: MakeSimulation, hat: Character) -> None:
    simulation = simulate(rows=1, columns=4)
    for k in range(32):
        simulation.add_part(f"hat {k}", hat, hook="head", streams=1, history=2, agents=[k % 4])
    bits = {part.attachment.bit for part in simulation.crowd.parts.values()}
    assert bits == set(range(32))
    with pytest.raises(ValueError, match="the crowd has 32 parts"):
        simulation.add_part("one more", hat)
    simulation.remove_part("hat 31")
    simulation.remove_part("hat 6")
    again = simulation.add_part("again", hat, hook="head", agents=[0])
    assert again.attachment.bit == 6
    assert np.flatnonzero(again.visible).tolist() == [0]
    assert np.flatnonzero(simulation.crowd.parts["hat 30"].visible).tolist() == [2]


def test_the_body_itself_can_wear_something(
    simulate: MakeSimulation, factories: ModuleType
) -> None:
    for poses in ("streams", "baked"):
        simulation = simulate(poses=poses)
        part = simulation.add_part("coat", factories.make_character(), motion="body")
        simulation.run(seconds=0.3)
        tick, agents = simulation.clock.pose_tick, np.arange(20)
        np.testing.assert_array_equal(
            part.palettes(agents, tick, 0.4), simulation.crowd.palettes(agents, tick, 0.4)
        )
        with pytest.raises(ValueError, match="follows the body"):
            _ = part.pool


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"hook": "haed"}, "hook: no joint 'haed'; near: head"),
    ({"hook": "head", "transform": np.eye(3)}, r"shape \(3, 3\), expected \(4, 4\) or \(3, 4\)"),
    ({"transform": np.eye(4) * 2}, r"not affine: its last row is \(0, 0, 0, 2\)"),
    ({"transform": np.eye(4) + np.eye(4, k=-3)}, r"not affine: its last row is \(1, 0, 0, 1\)"),
    ({"transform": np.diag([1.0, 0.0, 1.0, 1.0])}, "flattens the part"),
    ({"transform": np.diag([-1.0, 1.0, 1.0, 1.0])}, "mirrors the part"),
    ({"transform": np.full((3, 4), np.nan)}, "not finite"),
    ({"motion": "none"}, "motion is 'none', expected one of 'own', 'crowd', 'body'"),
    ({"motion": "body", "hook": "head"}, "hook and transform: a part with motion='body'"),
    ({"motion": "crowd"}, "its 2 joints are not the crowd's 7; it has no joint 'joint 0'"),
    ({"streams": 0}, "streams is 0, expected 1 to 256"),
    ({"history": 1}, "history is 1, expected 2 to 254"),
    ({"slots": -1}, "slots is -1"),
    ({"agents": [300]}, "there is no agent 300"),
    ({"name": ""}, "name is ''"),
    ({"name": "taken"}, "the crowd has a part 'taken' already"),
    (
        {"appearance": tifo.Appearance(*np.zeros((5, 2, 4), np.uint8))},
        r"skin has shape \(2, 4\), expected \(300, 4\)",
    ),
]


@pytest.mark.parametrize(("wrong", "message"), WRONG)
def test_what_is_wrong_is_said_and_changes_nothing(
    simulate: MakeSimulation, hat: Character, wrong: dict[str, Any], message: str
) -> None:
    simulation = simulate()
    simulation.add_part("taken", hat, hook="head", agents=[1])
    before = simulation.crowd.state_hash()
    with pytest.raises(ValueError, match=message):
        simulation.add_part(**{"name": "hat", "character": hat, **wrong})
    assert set(simulation.crowd.parts) == {"taken"}
    assert simulation.crowd.state_hash() == before
    with simulation.active():
        assert len(esper.get_component(Attachment)) == 1


def test_baked_crowds_take_parts_with_streams_of_their_own(
    simulate: MakeSimulation, factories: ModuleType, hat: Character
) -> None:
    simulation = simulate(poses="baked")
    part = simulation.add_part("hat", hat, hook="head")
    simulation.run(seconds=1.0)
    assert (part.pool.head == simulation.clock.pose_tick).all()
    assert np.isfinite(part.palettes([0, 5], simulation.clock.pose_tick)).all()
    with pytest.raises(ValueError, match="this crowd is baked and has no streams"):
        simulation.add_part("coat", factories.make_character(), motion="crowd")


def test_a_character_without_meshes_is_refused(simulate: MakeSimulation, hat: Character) -> None:
    bare = Character("bare", hat.skeleton, (), hat.materials, hat.clips)
    with pytest.raises(ValueError, match="'bare' has no meshes"):
        simulate().add_part("hat", bare)


def test_the_state_of_parts_is_state(simulate: MakeSimulation, hat: Character) -> None:
    hashes = []
    for late in (False, False, True):
        simulation = simulate()
        bare = simulation.crowd.state_hash()
        part = simulation.add_part("hat", hat, hook="head", agents=[1, 2])
        assert simulation.crowd.state_hash() != bare
        part.transition_to_streamed([1], part.streams("bob")[0])
        simulation.run(seconds=0.5)
        before = simulation.crowd.state_hash()
        part.attach([4])
        assert simulation.crowd.state_hash() != before
        if late:
            part.detach([4])
        hashes.append(simulation.crowd.state_hash())
    assert hashes[0] == hashes[1] != hashes[2]


def test_parts_leave_what_bodies_do_alone(simulate: MakeSimulation, hat: Character) -> None:
    plain, with_part = simulate(), simulate()
    with_part.add_part("hat", hat, hook="head")
    for simulation in (plain, with_part):
        simulation.run(seconds=0.5)
        simulation.send(tifo.Goal(0))
        simulation.run(seconds=2.0)
    with_part.remove_part("hat")
    assert plain.crowd.state_hash() == with_part.crowd.state_hash()


def test_an_own_world_can_have_parts(factories: ModuleType, hat: Character) -> None:
    before = esper.current_world
    esper.switch_world("parts in a world of their own")
    spec = tifo.CrowdSpec(layout="stand", rows=3, columns=4, streams=12, history=10)
    crowd = tifo.spawn_crowd(spec, tifo.build_seats(spec), factories.make_character())
    part = tifo.add_part(crowd, "hat", hat, tick=0, hook="head", history=10)
    clock = tifo.Clock()
    tifo.add_systems(spec.seed)
    eye = np.eye(4, dtype=np.float32)
    esper.create_entity(View(eye, eye, 100))
    for _ in range(20):
        clock.advance()
        esper.process(clock)
    assert (part.pool.head == clock.pose_tick).all()
    tifo.remove_part(crowd, "hat")
    esper.process(clock)
    esper.switch_world(before)
    esper.delete_world("parts in a world of their own")


def test_hooks_are_in_the_joints_own_frame(factories: ModuleType) -> None:
    """A joint that is turned by 90 degrees about Z in its bind pose, by hand."""
    turn = Rotation.from_euler("z", 90, degrees=True).as_quat()[None]
    skeleton = factories.make_skeleton([-1], np.array([[1.0, 2.0, 3.0]]), turn)
    move = np.eye(4)
    move[0, 3] = 0.5
    joint, place = hook_place(skeleton, "joint 0", move)
    assert joint == 0
    # Half a metre along the joint's X, which is the model's Y.
    np.testing.assert_allclose(place[:, 3], (1.0, 2.5, 3.0), atol=1e-6)
    assert as_affine(move[:3])[3].tolist() == [0, 0, 0, 1]
