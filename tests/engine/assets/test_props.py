"""The props: sound meshes and clips, and that they sit on the built-in spectator."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.engine.animation.clip_bank import ClipBank
from tifo.engine.animation.kinematics import Kinematics
from tifo.engine.assets.character import Character
from tifo.engine.assets.props import PROPS, beat, builtin_prop, cap, drum, fits, flag
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.assets.spectator.skeleton import PALM_LENGTH, bind_positions
from tifo.engine.assets.variants import one_look


@pytest.fixture(scope="module")
def spectator() -> Character:
    return builtin_spectator()


def posed(character: Character, clip: int, time: float) -> NDArray[np.float64]:
    """(V, 3) vertices of the finest level in the character's model space."""
    bank = ClipBank(character.skeleton, character.clips)
    kinematics = Kinematics(character.skeleton, 1)
    palettes = np.empty((1, character.skeleton.joint_count, 3, 4), np.float32)
    kinematics.evaluate(bank.sample_one(clip, time), palettes)
    found = []
    for mesh in character.meshes:
        rows = np.einsum("vk,vkab->vab", mesh.weights, palettes[0][mesh.joints])
        found.append(np.einsum("vab,vb->va", rows[..., :3], mesh.positions) + rows[..., 3])
    return np.concatenate(found)


@pytest.mark.parametrize("name", PROPS)
def test_meshes_are_sound_and_coarser_by_level(name: str) -> None:
    character = builtin_prop(name).character
    counts = []
    for level in (character.meshes, *character.lower_levels):
        counts.append(sum(len(mesh.triangles) for mesh in level))
        for mesh in level:
            np.testing.assert_allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-6)
            assert (mesh.weights >= 0).all()
            assert mesh.joints.max() < character.skeleton.joint_count
            np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-5)
            corners = mesh.positions[mesh.triangles].astype(float)
            faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            area = np.linalg.norm(faces, axis=1)
            assert (area > 1e-9).all(), "flat triangles"
            # Faces look the way their vertices do.
            facing = np.einsum("ta,ta->t", faces, mesh.normals[mesh.triangles].mean(axis=1))
            assert (facing > 0).mean() > 0.97
    assert len(counts) == 3
    assert counts[0] < 1200
    assert counts[0] > 2 * counts[1] > 4 * counts[2]
    assert counts[2] < 120


@pytest.mark.parametrize("name", PROPS)
def test_clips_are_loops(name: str) -> None:
    for clip in builtin_prop(name).character.clips:
        dots = np.abs(np.sum(clip.rotation[0] * clip.rotation[-1], axis=1))
        np.testing.assert_allclose(dots, 1.0, atol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(clip.rotation, axis=2), 1.0, atol=1e-5)


@pytest.mark.parametrize("style", ["short", "crop", "ring", "bob", "long", "ponytail"])
def test_the_cap_goes_round_the_hair(spectator: Character, style: str) -> None:
    """Curls and buns are too high; who has them gets no cap."""
    prop = builtin_prop("cap")
    assert prop.hook == "head"
    head = -spectator.skeleton.inverse_bind[spectator.skeleton.index("head"), :, 3]
    np.testing.assert_allclose(head, cap.HEAD, atol=1e-3)
    look = one_look(spectator, {"hair": style, "body": None})
    hair = np.concatenate([mesh.positions for mesh in look.meshes])
    # A ponytail comes out behind.
    hair = hair[hair[:, 2] > (-0.10 if style == "ponytail" else -1.0)]
    inside = np.linalg.norm((hair - cap.CENTRE) / cap.RADII, axis=1)
    rim = 1.68
    assert inside[hair[:, 1] > rim].max() < 0.98
    top = max(float(mesh.positions[:, 1].max()) for mesh in prop.character.meshes) + cap.HEAD[1]
    assert max(hair[:, 1].max(), 1.735) < top < 1.79


def test_the_scarf_lies_on_the_chest_and_not_in_it(spectator: Character) -> None:
    prop = builtin_prop("scarf")
    chest = -spectator.skeleton.inverse_bind[spectator.skeleton.index(prop.hook), :, 3]
    body = np.concatenate([mesh.positions for mesh in spectator.meshes]).astype(float)
    front = body[(body[:, 2] > 0) & (np.abs(body[:, 0]) < 0.2)]
    for clip, time in ((0, 0.0), (0, 1.7), (1, 0.2), (1, 0.7)):
        points = posed(prop.character, clip, time) + chest
        hanging = points[(points[:, 1] < 1.38) & (np.abs(points[:, 0]) > 0.02)]
        assert len(hanging) > 100
        for point in hanging[::7]:
            away = np.hypot(front[:, 0] - point[0], front[:, 1] - point[1])
            surface = np.median(front[np.argsort(away)[:5], 2])
            assert surface - 0.015 < point[2] < surface + (0.12 if clip == 0 else 0.22)


def test_the_flag_is_in_the_fist(spectator: Character) -> None:
    prop = builtin_prop("flag")
    assert prop.hook == "hand_r"
    grip = prop.transform[:3, 3]
    np.testing.assert_allclose(
        prop.transform[:3, :3].T @ prop.transform[:3, :3], np.eye(3), atol=1e-9
    )
    bind = bind_positions()
    fingers = bind["fingers_r"] - bind["hand_r"]
    along = grip @ fingers / np.linalg.norm(fingers)
    assert 0.4 * PALM_LENGTH < along < PALM_LENGTH
    # In front of the palm by no more than the stick and a finger are thick.
    assert np.linalg.norm(grip - along * fingers / np.linalg.norm(fingers)) < 0.03


def test_the_foam_hand_goes_over_the_right_hand(spectator: Character) -> None:
    prop = builtin_prop("foam_hand")
    assert prop.hook == "hand_r"
    assert prop.transform is not None
    skeleton = spectator.skeleton
    wrist = -skeleton.inverse_bind[skeleton.index("hand_r"), :, 3].astype(float)
    bind = bind_positions()
    way = bind["fingers_r"] - bind["hand_r"]
    way /= np.linalg.norm(way)
    foam = np.concatenate([mesh.positions for mesh in prop.character.meshes]).astype(float)
    foam = foam @ prop.transform[:3, :3].T + prop.transform[:3, 3]
    assert 0.4 < (foam @ way).max() < 0.5, "the forefinger points where the fingers do"
    # Every vertex of the hand beyond the knuckles has foam on both sides of it.
    look = one_look(spectator)
    body = np.concatenate([mesh.positions for mesh in look.meshes]).astype(float) - wrist
    moved = np.concatenate(
        [(m.weights * (m.joints == skeleton.index("fingers_r"))).sum(axis=1) for m in look.meshes]
    )
    fingers = body[moved > 0.9]
    palm = np.array([1.0, -1.0, 0.0]) / np.sqrt(2)
    assert len(fingers) > 10
    for point in fingers:
        aside = foam - np.outer(foam @ palm, palm)
        near = np.linalg.norm(aside - (point - (point @ palm) * palm), axis=1)
        sides = foam[np.argsort(near)[:16]] @ palm
        assert sides.min() < point @ palm < sides.max()


def test_the_drum_has_its_drummers_joints(spectator: Character) -> None:
    prop = builtin_prop("drum")
    assert (prop.hook, prop.motion) == (None, "body")
    character = prop.character
    assert character.skeleton.names == spectator.skeleton.names
    used = {
        character.skeleton.names[joint]
        for mesh in character.meshes
        for joint in np.unique(mesh.joints[mesh.weights > 0])
    }
    assert used == {"spine", "chest", "hand_l", "hand_r"}
    # Between belly and drum there is air, and less than a hand.
    shell = next(m for m in character.meshes if character.materials[m.material].name == "shirt")
    body = np.concatenate([mesh.positions for mesh in one_look(spectator).meshes])
    belly = body[(np.abs(body[:, 1] - 0.9) < 0.12) & (np.abs(body[:, 0]) < 0.1), 2].max()
    assert 0.0 < shell.positions[:, 2].min() - belly < 0.1


@pytest.mark.parametrize("side", ["l", "r"])
def test_sticks_meet_the_skin_at_each_hit_and_only_then(side: str) -> None:
    sign = 1.0 if side == "l" else -1.0
    bind = bind_positions()
    shoulder, elbow, wrist = (bind[f"{j}_{side}"] for j in ("upper_arm", "lower_arm", "hand"))

    def above(time: float) -> float:
        upper, lower, hand = beat.arm_turns(side, beat.lift(side, time))
        bent = upper @ lower
        place = shoulder + upper @ (elbow - shoulder) + bent @ (wrist - elbow)
        place = place + bent @ hand @ (drum.stick_tip(sign) - wrist) - drum.CENTRE
        across = float(
            np.hypot(place[0], np.cos(drum.LEAN) * place[2] - np.sin(drum.LEAN) * place[1])
        )
        height = float(np.cos(drum.LEAN) * place[1] + np.sin(drum.LEAN) * place[2])
        assert across < drum.RADIUS
        return height - 0.5 * drum.HEIGHT

    for hit in beat.HITS[side]:
        assert above(hit) == pytest.approx(0.012, abs=0.004)  # as thick as the stick
    heights = np.array([above(time) for time in np.linspace(0.0, beat.PERIOD, 81)])
    assert heights.min() > 0.005
    assert heights.max() > 0.25
    # From key to key no hand moves faster than people's do.
    assert np.abs(np.diff(heights)).max() / (beat.PERIOD / 80) < 6.0


@pytest.mark.parametrize("name", PROPS)
def test_props_are_made_the_same_each_time(name: str) -> None:
    once = builtin_prop(name).character
    builtin_prop.cache_clear()
    again = builtin_prop(name).character
    assert once is not again
    for before, after in zip(
        (once.meshes, *once.lower_levels), (again.meshes, *again.lower_levels), strict=True
    ):
        for a, b in zip(before, after, strict=True):
            for column in ("positions", "normals", "weights", "joints", "triangles"):
                np.testing.assert_array_equal(getattr(a, column), getattr(b, column))


@pytest.mark.parametrize("time", [0.0, 0.45, 1.3])
@pytest.mark.parametrize("clip", [0, 1])
def test_the_cloth_is_not_stretched(clip: int, time: float) -> None:
    character = builtin_prop("flag").character
    rest = np.concatenate([mesh.positions for mesh in character.meshes[:-1]])
    points = posed(character, clip, time)[: len(rest)]
    for edge in (flag.TOP, flag.TOP - flag.HEIGHT):
        on_edge = np.flatnonzero(np.isclose(rest[:, 1], edge))
        order = on_edge[np.argsort(rest[on_edge, 0])]
        length = np.linalg.norm(np.diff(points[order], axis=0), axis=1).sum()
        assert 0.85 * flag.LENGTH < length < 1.02 * flag.LENGTH
    fly = points[np.argmax(rest[:, 0] - 0.001 * rest[:, 1])]
    # It flies to the side in one clip and falls along the stick in the other.
    assert (fly[0] > 0.7 * flag.LENGTH) == (clip == 0)
    assert (fly[1] < 0.0) == (clip == 1)


def test_props_fit_the_built_in_spectator_only(spectator: Character) -> None:
    assert fits(spectator)
    assert not fits(builtin_prop("cap").character)
    with pytest.raises(ValueError, match="name is 'horn', expected one of cap, drum, flag, foam_h"):
        builtin_prop("horn")
