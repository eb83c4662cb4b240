"""Skinned vertices on the GPU against equation 1 of *Streams 2017*, evaluated in float64."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import AgentAnimID, Transition
from tifo.engine.animation import Clip, ClipBank
from tifo.engine.assets.character import Character, SkinnedMesh
from tifo.engine.assets.load import load_character
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.streams import StreamPool

pytestmark = pytest.mark.gl

FILES = [
    "CesiumMan.gltf",
    "KayKit_Knight.glb",
    "RiggedSimple.gltf",
    "RobotExpressive.glb",
    "phoenix_bird.glb",
    "03_skinned_cylinder/03_skinned_cylinder.gltf",
    "SkinType_u8/Animation_SkinType_01.gltf",
    "01_cs_rotate/01_cs_rotate.gltf",
    "07_nla-anim/07_nla-anim.gltf",
]
FIRST = 5
OFFSETS = (0.0, 1.0, 2.25, 5.75)
MOMENTS = ((12, 0.0), (12, 0.5), (13, 0.25), (14, 1.0))


@pytest.mark.parametrize("name", FILES)
def test_vertices_of_files(
    name: str, shared_data: Path, shader_crowd: Any, factories: ModuleType
) -> None:
    check(load_character(shared_data / "gltf" / name), shader_crowd, factories)


def test_vertices_of_the_spectator(shader_crowd: Any, factories: ModuleType) -> None:
    check(builtin_spectator(), shader_crowd, factories)


def check(character: Character, shader_crowd: Any, factories: ModuleType) -> None:
    """Vertices of agents that mix slices are where float64 says, at several moments."""
    clips = (character.clips * 2)[: max(2, min(len(character.clips), 3))]
    bank = ClipBank(character.skeleton, clips)
    pool = StreamPool(character.skeleton, bank, capacity=len(clips), history=14)
    starts = [0.1 * clip.duration for clip in clips]
    for clip, start in enumerate(starts):
        pool.add(clip, time=start)
    anim = AgentAnimID.allocate(1, len(clips) * len(OFFSETS), 0)
    anim.row[0] = np.repeat(np.arange(len(clips)), len(OFFSETS))
    anim.start[0] = anim.target[0] = np.tile(OFFSETS, len(clips))
    crowd = shader_crowd((pool, anim, Transition.allocate(1, anim.row.shape[1])))
    mesh = joined(character)
    # At most 800 vertices of each, spread over the whole body.
    mesh_part = thinned(mesh, 800)
    height = float(np.ptp(mesh.positions, axis=0).max())
    agents = np.arange(anim.row.shape[1])
    reached = 0.0
    for tick in range(FIRST, 15):
        pool.evaluate(tick)
        pool.commit(tick)
        for at, alpha in MOMENTS:
            if at != tick:
                continue
            crowd.update(tick)
            shown = crowd.skinned(mesh_part, agents, tick, alpha)
            for agent in agents:
                clip = int(anim.row[0, agent])
                time = tick - 1 + alpha - float(anim.start[0, agent]) - FIRST
                expected = mixed(
                    character, clips[clip], starts[clip], max(time, 0.0), mesh_part, factories
                )
                np.testing.assert_allclose(shown[agent], expected, rtol=0, atol=1e-4 * height)
                reached = max(reached, float(np.abs(expected - mesh_part.positions).max()))
    assert reached > 1e-3 * height, "nothing moved: the comparison would not see a fault"


def mixed(
    character: Character,
    clip: Clip,
    start: float,
    ticks: float,
    mesh: SkinnedMesh,
    factories: ModuleType,
) -> NDArray[np.float64]:
    """(V, 3) vertices half way between those of two pose ticks, as the mix of palettes is."""
    whole = int(np.floor(ticks))
    share = ticks - whole
    parts = [skin(character, clip, start + (whole + k) / 30.0, mesh, factories) for k in (0, 1)]
    return (1.0 - share) * parts[0] + share * parts[1]


def skin(
    character: Character, clip: Clip, time: float, mesh: SkinnedMesh, factories: ModuleType
) -> NDArray[np.float64]:
    """(V, 3) float64: the sum over four influences of weight, palette and vertex."""
    last = clip.frame_count - 1
    if clip.duration > 0:
        time = np.mod(time, clip.duration) if clip.looping else min(time, clip.duration)
        place = time / clip.duration * last
    else:
        place = 0.0
    before = min(int(place), max(last - 1, 0))
    after = min(before + 1, last)
    share = place - before
    q, t, s = (
        (1.0 - share) * keys[before].astype(float) + share * keys[after].astype(float)
        for keys in (clip.rotation, clip.translation, clip.scale)
    )
    palettes = factories.reference_palettes(character.skeleton, q, t, s)
    points = np.concatenate([mesh.positions, np.ones((len(mesh.positions), 1))], axis=1)
    moved = np.einsum("vkij,vj->vki", palettes[mesh.joints], points)
    out: NDArray[np.float64] = np.einsum("vk,vki->vi", mesh.weights.astype(float), moved)
    return out


def joined(character: Character) -> SkinnedMesh:
    """All meshes of a character as one, without triangles."""
    meshes = character.meshes
    fields = ("positions", "normals", "uvs", "colors", "joints", "weights")
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(m, name) for m in meshes]) for name in fields
    }
    return SkinnedMesh("all", **columns, triangles=np.zeros((1, 3), np.uint32))


def thinned(mesh: SkinnedMesh, most: int) -> SkinnedMesh:
    """Every n-th vertex."""
    step = -(-len(mesh.positions) // most)
    fields = ("positions", "normals", "uvs", "colors", "joints", "weights")
    columns: dict[str, Any] = {name: getattr(mesh, name)[::step] for name in fields}
    return SkinnedMesh("some", **columns, triangles=np.zeros((1, 3), np.uint32))
