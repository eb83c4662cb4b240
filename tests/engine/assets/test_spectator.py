"""The spectator that ships: its shape and its weights; `spectator/` has the motions."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.engine.animation.clip import Clip
from tifo.engine.animation.kinematics import Kinematics
from tifo.engine.animation.pose import pack_poses
from tifo.engine.assets.character import Character, SkinnedMesh
from tifo.engine.assets.spectator import MOTIONS, builtin_spectator
from tifo.engine.assets.variants import one_look, variant_groups

SITTING = ("sit_idle", "sit_idle_2", "sit_clap")


@pytest.fixture(scope="module")
def spectator() -> Character:
    return builtin_spectator()


def palettes(character: Character, clip: Clip) -> NDArray[np.float32]:
    """(F, J, 3, 4) skinning matrices of every key."""
    kinematics = Kinematics(character.skeleton, clip.frame_count)
    out = np.empty((clip.frame_count, clip.joint_count, 3, 4), dtype=np.float32)
    kinematics.evaluate(pack_poses(clip.rotation, clip.translation, clip.scale), out)
    return out


def joint_paths(character: Character, clip: Clip, *names: str) -> NDArray[np.float64]:
    """(F, K, 3) model-space positions of some joints."""
    rows = [character.skeleton.index(name) for name in names]
    palette = palettes(character, clip)[:, rows].astype(np.float64)
    bind = -character.skeleton.inverse_bind[rows, :, 3]
    path: NDArray[np.float64] = np.einsum("fkab,kb->fka", palette[..., :3], bind)
    path += palette[..., 3]
    return path


def skinned(mesh: SkinnedMesh, palette: NDArray[np.float32]) -> NDArray[np.float32]:
    """(V, 3) vertices in the pose of (J, 3, 4) palettes."""
    turn = np.einsum("vk,vkab->vab", mesh.weights, palette[mesh.joints])
    moved: NDArray[np.float32] = np.einsum("vab,vb->va", turn[:, :, :3], mesh.positions)
    moved += turn[:, :, 3]
    return moved


def levels(character: Character) -> list[tuple[SkinnedMesh, ...]]:
    return [character.meshes, *character.lower_levels]


def merged(meshes: tuple[SkinnedMesh, ...]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """One surface whose vertices are told apart by their position alone."""
    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    points = np.concatenate([mesh.positions for mesh in meshes]).astype(np.float64)
    faces = np.concatenate([m.triangles + s for m, s in zip(meshes, starts[:-1], strict=True)])
    unique, index = np.unique(points.round(7), axis=0, return_inverse=True)
    return unique, index.reshape(-1)[faces]


def test_contents(spectator: Character) -> None:
    assert spectator.name == "spectator"
    assert spectator.notes == ()
    assert spectator.skeleton.joint_count == 24
    assert [m.name for m in spectator.materials] == ["skin", "hair", "shirt", "trousers", "shoes"]
    names = {
        group: [variant.choice for variant in choices]
        for group, choices in variant_groups(spectator).items()
    }
    assert list(names) == ["body", "hair", "beard"]
    assert names["body"][0] == "man_shirt"
    assert {name.split("_")[0] for name in names["body"]} == {"man", "woman", "child"}
    assert len(names["body"]) == len(names["hair"]) == 8
    assert {clip.name for clip in spectator.clips} == set(MOTIONS)


def test_everybody_has_as_many_triangles_as_the_level_allows(spectator: Character) -> None:
    """With any body and hair, and a full beard."""
    groups = variant_groups(spectator)
    limits = ((2700, 3400), (800, 1250), (250, 440))
    for body in groups["body"]:
        for hair in groups["hair"]:
            choices = {"body": body.choice, "hair": hair.choice, "beard": "full"}
            look = one_look(spectator, choices)
            for level, (least, most) in zip(levels(look), limits, strict=True):
                assert least <= sum(len(mesh.triangles) for mesh in level) <= most


def test_stands_on_the_ground_and_is_175_cm_tall(spectator: Character) -> None:
    look = one_look(spectator)
    for level, tolerance in zip(levels(look), (0.005, 0.015, 0.04), strict=True):
        points = np.concatenate([mesh.positions for mesh in level])
        assert points[:, 1].min() == pytest.approx(0.0, abs=tolerance)
        assert points[:, 1].max() == pytest.approx(1.75, abs=tolerance)


def solids(character: Character, level: int) -> Iterator[tuple[str, tuple[SkinnedMesh, ...]]]:
    """The meshes of every variant."""
    meshes: dict[str, list[SkinnedMesh]] = {}
    for mesh in levels(character)[level]:
        assert mesh.variant is not None
        meshes.setdefault(f"{mesh.variant.group}/{mesh.variant.choice}", []).append(mesh)
    for name, members in meshes.items():
        yield name, tuple(members)


@pytest.mark.parametrize("level", [0, 1, 2])
def test_every_variant_is_closed_and_wound_outward(spectator: Character, level: int) -> None:
    for name, meshes in solids(spectator, level):
        volume = closed_volume(meshes)
        # A person of this height displaces some 70 litres; clothes add a few.
        least, most = (0.045, 0.085) if name.startswith("body/") else (1e-6, 0.009)
        assert least < volume < most, name


def test_women_are_slimmer_above_and_wider_below(spectator: Character) -> None:
    """Than the man in the same clothes, on the same joints."""

    def width(body: str, low: float, high: float) -> float:
        look = one_look(spectator, {"body": body, "hair": None})
        points = np.concatenate([mesh.positions for mesh in look.meshes])
        band = points[(points[:, 1] > low) & (points[:, 1] < high)]
        return float(band[np.abs(band[:, 0]) < 0.22, 0].max())

    assert width("woman_shirt", 1.05, 1.12) < width("man_shirt", 1.05, 1.12) - 0.01
    assert width("woman_shirt", 0.83, 0.90) > width("man_shirt", 0.83, 0.90)


def test_no_hair_leaves_bald_patches(spectator: Character) -> None:
    """Rays from outside the head, from above and behind, meet hair before skin."""
    for level in range(3):
        skin = [m for m in dict(solids(spectator, level))["body/man_shirt"] if m.material == 0]
        head = merged(tuple(skin))
        for name, meshes in solids(spectator, level):
            if not name.startswith("hair/") or name == "hair/ring":
                continue
            hair = merged(meshes)
            for turn in np.linspace(np.pi - 1.2, np.pi + 1.2, 5):
                for rise in (0.25, 0.7, 1.2):
                    way = np.array(
                        [np.cos(rise) * np.sin(turn), np.sin(rise), np.cos(rise) * np.cos(turn)]
                    )
                    inner = np.array([0.003, 1.66, -0.011])
                    assert reach(hair, inner, way) > reach(head, inner, way), (name, level)


def reach(
    surface: tuple[NDArray[np.float64], NDArray[np.int64]],
    start: NDArray[np.float64],
    way: NDArray[np.float64],
) -> float:
    """How far along a ray a surface is met last; 0 if never. Moeller and Trumbore 1997."""
    points, faces = surface
    a, b, c = (points[faces[:, k]] for k in range(3))
    across = np.cross(way, c - a)
    scale = np.einsum("ij,ij->i", b - a, across)
    safe = np.where(np.abs(scale) < 1e-12, 1e-12, scale)
    u = np.einsum("ij,ij->i", start - a, across) / safe
    side = np.cross(start - a, b - a)
    v = side @ way / safe
    along = np.einsum("ij,ij->i", c - a, side) / safe
    met = (u >= 0) & (v >= 0) & (u + v <= 1) & (along > 0) & (np.abs(scale) > 1e-12)
    return float(along[met].max(initial=0.0))


def closed_volume(meshes: tuple[SkinnedMesh, ...]) -> float:
    """Cubic metres within meshes; fails if they are open together."""
    points, faces = merged(meshes)
    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges, uses = np.unique(directed, axis=0, return_counts=True)
    assert (uses == 1).all()
    assert {tuple(e) for e in edges.tolist()} == {tuple(e[::-1]) for e in edges.tolist()}
    a, b, c = (points[faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


@pytest.mark.parametrize("level", [0, 1, 2])
def test_left_and_right_are_mirror_images(spectator: Character, level: int) -> None:
    for mesh in levels(spectator)[level]:
        here = {tuple(p) for p in mesh.positions.astype(np.float64).round(5).tolist()}
        there = {(-x + 0.0, y, z) for x, y, z in here}
        assert here == {(x + 0.0, y, z) for x, y, z in there}
    names = spectator.skeleton.names
    rest = dict(zip(names, spectator.skeleton.rest_translation, strict=True))
    for name in names:
        if name.endswith("_l"):
            np.testing.assert_allclose(rest[name] * (-1, 1, 1), rest[name[:-2] + "_r"], atol=1e-6)
            # The spectator faces +Z, so its own left is +X.
            assert -spectator.skeleton.inverse_bind[names.index(name), 0, 3] > 0


def test_weights_are_clean(spectator: Character) -> None:
    names = spectator.skeleton.names
    for level in levels(spectator):
        for mesh in level:
            np.testing.assert_allclose(mesh.weights.sum(axis=1), 1.0, atol=1e-5)
            assert (mesh.weights >= 0).all()
            arms = [k for k, name in enumerate(names) if name.startswith(("lower_arm", "hand"))]
            legs = [k for k, name in enumerate(names) if name.startswith(("lower_leg", "foot"))]
            on_arm = (np.isin(mesh.joints, arms) * mesh.weights).sum(axis=1)
            on_leg = (np.isin(mesh.joints, legs) * mesh.weights).sum(axis=1)
            # Neither the trunk nor the other side follows a forearm or a shin.
            assert (np.abs(mesh.positions[on_arm > 0.01, 0]) > 0.25).all()
            assert (mesh.positions[on_leg > 0.01, 1] < 0.65).all()
            for side, sign in (("_l", 1.0), ("_r", -1.0)):
                own = [k for k, name in enumerate(names) if name.endswith(side)]
                share = (np.isin(mesh.joints, own) * mesh.weights).sum(axis=1)
                assert (share[mesh.positions[:, 0] * sign < -0.09] < 0.02).all()


def test_shading_is_subtle_outside_the_face(spectator: Character) -> None:
    for mesh in spectator.meshes:
        grey = mesh.colors[:, 0]
        if spectator.materials[mesh.material].name in ("shirt", "trousers", "shoes"):
            assert grey.min() >= 0.54
            assert grey.max() <= 1.0
            assert np.ptp(grey) > 0.05
            np.testing.assert_allclose(mesh.colors[:, :3], grey[:, None].repeat(3, 1), atol=1e-6)


@pytest.mark.parametrize("name", SITTING)
def test_seated_body_rests_on_the_seat(spectator: Character, name: str) -> None:
    pose = palettes(spectator, spectator.clip(name))[0]
    points = np.concatenate([skinned(mesh, pose) for mesh in one_look(spectator).meshes])
    over_seat = (points[:, 2] > -0.65) & (points[:, 2] < -0.25) & (np.abs(points[:, 0]) < 0.25)
    assert points[over_seat, 1].min() == pytest.approx(0.44, abs=0.012)
    hips, knee = joint_paths(spectator, spectator.clip(name), "hips", "lower_leg_l")[0]
    assert hips[2] == pytest.approx(-0.42, abs=0.02)
    assert knee[2] == pytest.approx(0.0, abs=0.04)


@pytest.mark.parametrize("name", ["clap", "sit_clap"])
def test_claps_meet_eight_times_at_equal_steps(spectator: Character, name: str) -> None:
    clip = spectator.clip(name)
    pose = palettes(spectator, clip)
    skin = one_look(spectator).meshes[0]
    index = spectator.skeleton.index

    def palm(side: str, frame: int) -> NDArray[np.float32]:
        mine = [index("hand" + side), index("fingers" + side)]
        share = (np.isin(skin.joints, mine) * skin.weights).sum(axis=1)
        hand: NDArray[np.float32] = skinned(skin, pose[frame])[share > 0.9]
        return hand

    wrists = joint_paths(spectator, clip, "hand_l", "hand_r")
    distance = np.linalg.norm(wrists[:, 0] - wrists[:, 1], axis=1)
    inner = distance[1:-1]
    touches = 1 + np.flatnonzero((inner < distance[:-2]) & (inner < distance[2:]))
    assert [0, *touches] == list(range(0, 144, 18))
    for frame in (0, 18, 90):
        gap = palm("_l", frame)[:, 0].min() - palm("_r", frame)[:, 0].max()
        # Flesh gives: the mitten-like hands overlap by up to a centimetre each.
        assert -0.022 < gap < 0.004
    assert palm("_l", 9)[:, 0].min() - palm("_r", 9)[:, 0].max() > 0.05
