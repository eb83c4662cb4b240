"""Exported agents of different looks: each wears its own meshes, shared with who has the same."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from exported import GltfFile, check_gltf, shown_points, worn_meshes
from numpy.typing import NDArray

from tifo.engine.behaviour.events import Goal
from tifo.engine.crowd.body_types import CHILD, OLD
from tifo.engine.crowd.kits import Kit
from tifo.engine.crowd.looks import choose
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.export.recording import Recording
from tifo.systems.export import export_gltf, export_usd
from tifo.systems.simulation import Simulation

SHARE = 1e-4
"""Of the height, by which vertices may differ."""


@dataclass
class Looks:
    """One moment of a woman with long hair, a child, an old man with a beard, two men alike."""

    recording: Recording
    crowd: Any
    points: dict[int, NDArray[Any]]
    woman: int
    child: int
    old: int
    twins: tuple[int, int]

    def close(self, points: NDArray[Any], agent: int) -> None:
        assert points.shape == self.points[agent].shape
        limit = SHARE * self.recording.height * float(self.crowd.placement.scale[agent])
        assert np.abs(points - self.points[agent]).max() <= limit

    def triangles(self, level: int = 0) -> int:
        return sum(
            len(mesh.triangles)
            for agent in self.points
            for mesh in worn_meshes(self.crowd, agent, level)
        )


@pytest.fixture(scope="module")
def looks() -> Iterator[Looks]:
    spec = CrowdSpec(
        layout="stand", rows=5, columns=8, occupancy=1.0, children=0.3, old=0.3, streams=64, seed=8
    )
    simulation = Simulation(spec)
    crowd = simulation.crowd
    body = crowd.body
    kind, woman = body.kind, body.woman
    adult = (kind != CHILD) & (kind != OLD)
    found = {
        "woman": int(np.flatnonzero(adult & woman)[0]),
        "child": int(np.flatnonzero(kind == CHILD)[0]),
        "old": int(np.flatnonzero((kind == OLD) & ~woman)[0]),
    }
    first, second = map(int, np.flatnonzero(adult & ~woman)[:2])
    for agents, choices in (
        ([found["woman"]], {"body": "woman_skirt", "hair": "long", "beard": None}),
        ([found["child"]], {"body": "child_shorts", "hair": "ponytail", "beard": None}),
        ([found["old"]], {"body": "man_sweater", "hair": None, "beard": "full"}),
        ([first, second], {"body": "man_shirt", "hair": "crop", "beard": "moustache"}),
    ):
        choose(crowd.character, body, np.array(agents), choices)
    # One with a pattern is a look of its own in USD; the two men are both without.
    Kit((200, 100, 50), (20, 30, 240), "hoops").put_on(crowd.appearance, [found["woman"]])
    Kit((200, 100, 50)).put_on(crowd.appearance, [first, second])
    simulation.send(Goal(side=0))
    simulation.run(seconds=0.9)
    clock = simulation.clock
    ids = sorted([*found.values(), first, second])
    points = {a: shown_points(crowd, a, clock.pose_tick, clock.alpha) for a in ids}
    yield Looks(simulation.record(ids), crowd, points, **found, twins=(first, second))
    simulation.close()


def test_a_recording_says_who_wears_what(looks: Looks) -> None:
    names = {
        agent: {mesh.name for mesh in looks.recording.select(agent).meshes(0)}
        for agent in looks.points
    }
    for agent, own in names.items():
        assert own == {mesh.name for mesh in worn_meshes(looks.crowd, agent)}
    assert "long.hair" in names[looks.woman]
    assert {"full.hair", "man_sweater.shirt"} <= names[looks.old]
    # Bald: the beard and the brows are all the hair he has.
    assert len([name for name in names[looks.old] if name.endswith("hair")]) == 2
    assert names[looks.twins[0]] == names[looks.twins[1]]
    every = {mesh.name for mesh in looks.recording.meshes(0)}
    assert every == set().union(*names.values())


def test_changes_after_the_recording_are_not_in_it(looks: Looks) -> None:
    character, body = looks.crowd.character, looks.crowd.body
    before = body.choice.copy()
    choose(character, body, looks.recording.agents, {"hair": "bun"})
    assert "bun.hair" not in {mesh.name for mesh in looks.recording.meshes(0)}
    body.choice[:] = before


@pytest.mark.parametrize("baked", [False, True])
def test_gltf_has_every_agents_own_meshes(looks: Looks, tmp_path: Path, baked: bool) -> None:
    path = tmp_path / "looks.glb"
    done = export_gltf(looks.recording, path, baked=baked)
    check_gltf(path)
    file = GltfFile(path)
    kind = "agent" if baked else "body"
    for agent in looks.points:
        looks.close(file.points(f"{kind} {agent}"), agent)
    assert done.triangles == looks.triangles()
    assert done.triangles == sum(
        len(file.array(primitive.indices)) // 3
        for mesh in file.gltf.meshes
        for primitive in mesh.primitives
    )
    # No material is left that nobody shows.
    shown = {primitive.material for mesh in file.gltf.meshes for primitive in mesh.primitives}
    assert shown == set(range(len(file.gltf.materials)))


def test_gltf_agents_share_what_they_both_wear_and_nothing_else(
    looks: Looks, tmp_path: Path
) -> None:
    path = tmp_path / "looks.glb"
    export_gltf(looks.recording, path)
    file = GltfFile(path)

    def places(agent: int) -> list[int]:
        (mesh,) = [mesh for mesh in file.gltf.meshes if mesh.name == f"body {agent}"]
        return [primitive.attributes.POSITION for primitive in mesh.primitives]

    assert places(looks.twins[0]) == places(looks.twins[1])
    assert not set(places(looks.woman)) & set(places(looks.child))
    held = sum(len(file.array(k)) for k in {k for agent in looks.points for k in places(agent)})
    assert held == sum(len(points) for points in looks.points.values()) - len(
        looks.points[looks.twins[0]]
    )


@pytest.mark.parametrize("level", [1, 2])
def test_coarser_levels_have_their_own_meshes(looks: Looks, tmp_path: Path, level: int) -> None:
    done = export_gltf(looks.recording, tmp_path / "looks.glb", level=level)
    assert done.triangles == looks.triangles(level)
    check_gltf(tmp_path / "looks.glb")


@pytest.fixture(scope="module")
def usd() -> ModuleType:
    pytest.importorskip("pxr", reason="usd-core is not installed, so no USD file can be written")
    import usd_files

    return usd_files


@pytest.mark.parametrize("instances", [True, False])
def test_usd_has_every_agents_own_meshes(
    looks: Looks, usd: ModuleType, tmp_path: Path, instances: bool
) -> None:
    from pxr import Usd, UsdGeom

    path = tmp_path / "looks.usda"
    done = export_usd(looks.recording, path, instances=instances)
    assert usd.complaints(path) == []
    for agent in looks.points:
        looks.close(usd.skinned_points(path, agent), agent)
    stage = Usd.Stage.Open(str(path))
    shown = [
        prim
        for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies())
        if prim.IsA(UsdGeom.Mesh)
    ]
    triangles = sum(len(UsdGeom.Mesh(m).GetFaceVertexCountsAttr().Get()) for m in shown)
    assert triangles == done.triangles == looks.triangles()
    # Points are written once for each mesh that is worn.
    lines = [line for line in path.read_text().splitlines() if "point3f[] points" in line]
    assert len(lines) == len(looks.recording.meshes(0))


def test_usd_agents_of_one_look_are_instances_of_one_prototype(
    looks: Looks, usd: ModuleType, tmp_path: Path
) -> None:
    from pxr import Usd, UsdGeom, UsdShade

    path = tmp_path / "looks.usda"
    export_usd(looks.recording, path, rigid=True)
    stage = Usd.Stage.Open(str(path))
    prims = {agent: stage.GetPrimAtPath(f"/Crowd/agent_{agent}") for agent in looks.points}
    assert all(prim.IsInstance() for prim in prims.values())
    first, second = (prims[agent].GetPrototype() for agent in looks.twins)
    assert first == second
    assert len(stage.GetPrototypes()) == 4
    # Her hair has her colour, and the eyes in her face are dark.
    hair = prims[looks.woman].GetChild("long_hair")
    color = UsdGeom.PrimvarsAPI(hair).FindPrimvarWithInheritance("hairColor")
    k = list(looks.recording.agents).index(looks.woman)
    np.testing.assert_allclose(
        color.Get(), (looks.recording.colors[k, 1] / 255.0) ** 2.2, atol=0.02
    )
    material, _ = UsdShade.MaterialBindingAPI(hair).ComputeBoundMaterial()
    assert material.GetPrim().GetName() == "hair"
    dark = prims[looks.woman].GetChild("woman_skirt_skin").GetChild("dark")
    material, _ = UsdShade.MaterialBindingAPI(dark).ComputeBoundMaterial()
    assert material.GetPrim().GetName() == "skin_dark"


def test_usd_points_are_of_what_is_worn(looks: Looks, usd: ModuleType, tmp_path: Path) -> None:
    path = tmp_path / "baked.usdc"
    done = export_usd(looks.recording, path, baked=True)
    assert usd.complaints(path) == []
    assert done.triangles == looks.triangles()
    for agent in looks.points:
        looks.close(usd.mesh_points(path, agent), agent)
