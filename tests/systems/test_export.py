"""Exported files, read by others, against what the crowd shows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from exported import GltfFile, check_gltf, shown_points, worn_meshes
from numpy.typing import NDArray

from tifo.engine.behaviour.events import Goal
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.errors import AssetError
from tifo.engine.export.recording import Recording
from tifo.systems.export import export_gltf, export_usd
from tifo.systems.simulation import Simulation

SHARE = 1e-4
"""Of the height, by which vertices may differ."""
FPS, SECONDS = 15.0, 0.4


@dataclass
class Scene:
    """A recording, and what the same crowd showed, in the stadium, by frame and agent."""

    recording: Recording
    points: list[dict[int, NDArray[Any]]]
    scale: dict[int, float]
    triangles: dict[int, int]

    def close(self, points: NDArray[Any], frame: int, agent: int) -> None:
        off = np.abs(points - self.points[frame][agent]).max()
        assert off <= SHARE * self.recording.height * self.scale[agent]


def make_simulation() -> Simulation:
    """People of all kinds, half a second after a goal; one waves at what else it does."""
    spec = CrowdSpec(
        layout="stand", rows=4, columns=8, occupancy=1.0, children=0.3, old=0.3, streams=64, seed=5
    )
    simulation = Simulation(spec)
    crowd = simulation.crowd
    assert crowd.pool is not None
    simulation.send(Goal(side=0))
    simulation.run(seconds=0.6)
    crowd.overlay(chosen(crowd)[0], crowd.pool.stream(20), "arms", duration=0.3)
    simulation.run(seconds=0.2)
    return simulation


def chosen(crowd: Any) -> list[int]:
    """A child, an old and two adult people."""
    kind = crowd.body.kind
    return [int(np.flatnonzero(kind == k)[n]) for k, n in ((1, 0), (2, 0), (0, 0), (0, 3))]


@pytest.fixture(scope="module")
def scene() -> Iterator[Scene]:
    simulation, other = make_simulation(), make_simulation()
    agents = sorted(chosen(simulation.crowd))
    recording = simulation.record(agents, seconds=SECONDS, fps=FPS)
    points = []
    for frame in range(recording.frames):
        other.run(seconds=0.0 if frame == 0 else 1.0 / FPS)
        clock = other.clock
        points.append(
            {a: shown_points(other.crowd, a, clock.pose_tick, clock.alpha) for a in agents}
        )
    crowd = simulation.crowd
    scale = {a: float(crowd.placement.scale[a]) for a in agents}
    triangles = {a: sum(len(m.triangles) for m in worn_meshes(crowd, a)) for a in agents}
    yield Scene(recording, points, scale, triangles)
    simulation.close()
    other.close()


def test_a_skinned_gltf_moves_like_the_crowd(scene: Scene, tmp_path: Path) -> None:
    path = tmp_path / "crowd.glb"
    done = export_gltf(scene.recording, path)
    assert (done.agents, done.frames, done.size) == (4, 7, path.stat().st_size)
    check_gltf(path)
    file = GltfFile(path)
    assert len(file.gltf.animations) == 1
    names = [f"body {agent}" for agent in scene.recording.agents]
    for frame in (0, 2, 5, 6):
        for agent, points in zip(
            scene.recording.agents, file.all_points(names, frame / FPS), strict=True
        ):
            scene.close(points, frame, int(agent))
    # Somebody moved while it was recorded, and somebody's bones are mixed from two motions.
    moved = max(np.abs(scene.points[6][a] - scene.points[0][a]).max() for a in scene.points[0])
    assert moved > 0.1
    assert done.stretched > 0


def test_rigid_bones_are_off_by_what_is_said(scene: Scene, tmp_path: Path) -> None:
    done = export_gltf(scene.recording, tmp_path / "crowd.glb", rigid=True)
    file = GltfFile(tmp_path / "crowd.glb")
    assert done.stretched == 0
    assert not any("_stretch" in (node.name or "") for node in file.gltf.nodes)
    names = [f"body {agent}" for agent in scene.recording.agents]
    off = max(
        np.abs(points - scene.points[3][int(agent)]).max()
        for agent, points in zip(
            scene.recording.agents, file.all_points(names, 3 / FPS), strict=True
        )
    )
    assert SHARE * scene.recording.height < off <= 4 * done.deviation


def test_a_moment_is_the_nodes_own_pose(scene: Scene, tmp_path: Path) -> None:
    path = tmp_path / "moment.gltf"
    export_gltf(scene.recording.frame(4), path)
    assert (tmp_path / "moment.bin").exists()
    check_gltf(path)
    file = GltfFile(path)
    assert not file.gltf.animations
    for agent in scene.recording.agents:
        scene.close(file.points(f"body {agent}"), 4, int(agent))


def test_a_baked_moment_has_the_same_vertices(scene: Scene, tmp_path: Path) -> None:
    path = tmp_path / "baked.glb"
    export_gltf(scene.recording.frame(5), path, baked=True)
    check_gltf(path)
    file = GltfFile(path)
    assert not file.gltf.skins
    for agent in scene.recording.agents:
        scene.close(file.points(f"agent {agent}"), 5, int(agent))


def plain(recording: Recording) -> Recording:
    return replace(recording, pattern=np.zeros(len(recording), np.uint8))


def test_agents_have_their_colours_and_seats(scene: Scene, tmp_path: Path) -> None:
    path = tmp_path / "crowd.glb"
    export_gltf(plain(scene.recording), path, split=True)
    file = GltfFile(path)
    for k, agent in enumerate(scene.recording.agents):
        srgb = scene.recording.colors[k, 2] / 255.0
        linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
        (name,) = [name for name in file.colors(f"body {agent}") if name.startswith("shirt")]
        np.testing.assert_allclose(file.colors(f"body {agent}")[name], linear, atol=1e-6)
        node = next(node for node in file.gltf.nodes if node.name == f"agent {agent}")
        assert node.extras == {"agent": int(agent), "seat": scene.recording.labels[k]}
    assert {a.name for a in file.gltf.animations} <= {f"agent {a}" for a in scene.recording.agents}
    assert len(file.gltf.animations) > 1


def test_vertices_are_shared(scene: Scene, tmp_path: Path) -> None:
    """A further agent who looks the same costs its skeleton and its name, not its body."""
    same = np.repeat(scene.recording.choice[:, :1], 4, axis=1)
    alike = replace(scene.recording.frame(0), choice=same)
    one, all_ = (
        export_gltf(recording, tmp_path / "crowd.glb").size
        for recording in (alike.select(alike.agents[:1]), alike)
    )
    assert (all_ - one) / 3 < 0.1 * one


def test_the_exported_file_is_read_by_our_own_loader(scene: Scene, tmp_path: Path) -> None:
    from tifo.engine.assets.load import load_character

    export_gltf(scene.recording, tmp_path / "crowd.glb")
    character = load_character(tmp_path / "crowd.glb")
    assert character.triangle_count == sum(scene.triangles.values())
    assert character.clips[0].duration == pytest.approx(6 / FPS)


def test_a_simulation_is_exported_in_one_call(simulate: Any, tmp_path: Path) -> None:
    simulation = simulate(rows=2, columns=3, occupancy=1.0)
    seen: list[tuple[str, int, int]] = []
    done = export_gltf(
        simulation,
        tmp_path / "c.glb",
        agents="rows 1",
        start=0.5,
        seconds=0.2,
        fps=10,
        progress=lambda *step: seen.append(step),
    )
    assert (done.agents, done.frames, done.triangles) == (3, 3, 36)
    assert seen[-1] == ("agents", 3, 3)
    assert simulation.clock.tick == 42
    check_gltf(tmp_path / "c.glb")


def test_what_can_t_be_written_is_refused_at_once(
    simulate: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation = simulate(rows=2, columns=3)
    out = tmp_path / "c.glb"
    for values, said in (
        ({"baked": True, "seconds": 1.0}, "baked glTF holds one moment"),
        ({"level": 3}, "level is 3, expected 0 to 0"),
        ({"agents": 99}, "there is no agent 99"),
        ({"seconds": 1e9}, "seconds is"),
    ):
        with pytest.raises(ValueError, match=said):
            export_gltf(simulation, out, **values)
    recording = simulation.record(seconds=0.1)
    with pytest.raises(ValueError, match="has 4 frames, but baked glTF holds one"):
        export_gltf(recording, out, baked=True)
    with pytest.raises(ValueError, match="a recording has its frames"):
        export_gltf(recording, out, seconds=1.0)
    tick = simulation.clock.tick
    with pytest.raises(AssetError, match="there is no folder"):
        export_gltf(simulation, tmp_path / "no" / "c.glb", seconds=1.0)
    assert simulation.clock.tick == tick
    monkeypatch.setattr("tifo.engine.export.gltf.MOST_NODES", 20)
    with pytest.raises(ValueError, match="nodes, at most 20 are written"):
        export_gltf(recording, out)
    monkeypatch.setattr("tifo.engine.export.targets.LARGEST_FILE", 100)
    with pytest.raises(AssetError, match="can be read; export fewer agents"):
        export_gltf(recording.frame(0), out, baked=True)
    assert not out.exists()


def test_without_usd_core_it_says_what_to_install(
    simulate: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pxr", None)
    with pytest.raises(AssetError, match=r"without usd-core; pip install 'tifo\[usd\]'"):
        export_usd(simulate(rows=1, columns=2), tmp_path / "c.usda")


def test_a_knight_from_a_file(
    shared_data: Path, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """51 joints, textures, rigid parts, other proportions; as USD too where that is there."""
    knight = str(shared_data / "gltf" / "KayKit_Knight.glb")
    spec = CrowdSpec(layout="stand", rows=2, columns=3, occupancy=1.0, streams=32, character=knight)
    simulation = Simulation(spec)
    simulation.send(Goal(side=0))
    simulation.run(seconds=0.9)
    clock, crowd = simulation.clock, simulation.crowd
    expected = shown_points(crowd, 4, clock.pose_tick, clock.alpha)
    recording = simulation.record(4)
    simulation.close()
    limit = SHARE * recording.height * float(recording.scale[0, 0])
    export_gltf(recording, tmp_path / "knight.glb")
    check_gltf(tmp_path / "knight.glb")
    file = GltfFile(tmp_path / "knight.glb")
    assert np.abs(file.points("body 4") - expected).max() <= limit
    assert file.gltf.images
    usd = request.getfixturevalue("usd")
    export_usd(recording, tmp_path / "knight.usda")
    assert usd.complaints(tmp_path / "knight.usda") == []
    assert np.abs(usd.skinned_points(tmp_path / "knight.usda", 4) - expected).max() <= limit
    assert list(tmp_path.glob("knight_*.png"))


@pytest.fixture(scope="module")
def usd() -> ModuleType:
    pytest.importorskip("pxr", reason="usd-core is not installed, so no USD file can be written")
    import usd_files

    return usd_files


@pytest.mark.parametrize("instances", [True, False])
def test_usdskel_moves_agents_like_the_crowd(
    scene: Scene, usd: ModuleType, tmp_path: Path, instances: bool
) -> None:
    from pxr import Usd

    path = tmp_path / "crowd.usdc"
    done = export_usd(scene.recording, path, instances=instances)
    assert (done.agents, done.frames) == (4, 7)
    assert done.size == sum(file.stat().st_size for file in tmp_path.iterdir())
    assert usd.complaints(path) == []
    for frame in (0, 3, 6):
        for agent in scene.recording.agents:
            scene.close(usd.skinned_points(path, int(agent), frame), frame, int(agent))
    stage = Usd.Stage.Open(str(path))
    assert stage.GetTimeCodesPerSecond() == FPS
    # Everybody looks different.
    assert len(stage.GetPrototypes()) == (4 if instances else 0)


def test_usd_moments_and_points(scene: Scene, usd: ModuleType, tmp_path: Path) -> None:
    export_usd(scene.recording.frame(2), tmp_path / "moment.usda")
    export_usd(scene.recording, tmp_path / "baked.usdc", baked=True)
    assert usd.complaints(tmp_path / "moment.usda") == []
    assert usd.complaints(tmp_path / "baked.usdc") == []
    for agent in map(int, scene.recording.agents):
        scene.close(usd.skinned_points(tmp_path / "moment.usda", agent), 2, agent)
        for frame in (0, 5):
            points = usd.mesh_points(tmp_path / "baked.usdc", agent, frame)
            scene.close(points, frame, agent)


def test_the_checker_finds_faults(scene: Scene, usd: ModuleType, tmp_path: Path) -> None:
    path = tmp_path / "moment.usda"
    export_usd(scene.recording.frame(2), path)
    text = path.read_text()
    path.write_text(text.replace('upAxis = "Y"', "").replace('"StretchedSkeleton"', '"Lost"'))
    assert usd.complaints(path)


def test_usd_agents_have_their_colours(scene: Scene, usd: ModuleType, tmp_path: Path) -> None:
    from pxr import Usd, UsdGeom, UsdShade

    path = tmp_path / "crowd.usda"
    export_usd(plain(scene.recording.frame(0)), path)
    stage = Usd.Stage.Open(str(path))
    for k, agent in enumerate(scene.recording.agents):
        prim = stage.GetPrimAtPath(f"/Crowd/agent_{agent}")
        assert prim.IsInstance()
        srgb = scene.recording.colors[k, 2] / 255.0
        linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
        parts = prim.GetFilteredChildren(Usd.TraverseInstanceProxies())
        (shirt,) = [part for part in parts if part.GetName().endswith("_shirt")]
        color = UsdGeom.PrimvarsAPI(shirt).FindPrimvarWithInheritance("shirtColor")
        np.testing.assert_allclose(color.Get(), linear, atol=1e-6)
        material, _ = UsdShade.MaterialBindingAPI(shirt).ComputeBoundMaterial()
        assert material.GetPrim().GetName() == "shirt"
    own = tmp_path / "own.usda"
    export_usd(plain(scene.recording.frame(0)), own, instances=False)
    stage = Usd.Stage.Open(str(own))
    agent = int(scene.recording.agents[0])
    prims = stage.GetPrimAtPath(f"/Crowd/agent_{agent}").GetChildren()
    (shirt,) = [prim for prim in prims if prim.GetName().endswith("_shirt")]
    shown = np.array(UsdGeom.Mesh(shirt).GetDisplayColorAttr().Get())
    srgb = scene.recording.colors[0, 2] / 255.0
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    mesh = next(m for m in scene.recording.meshes(0) if m.name.replace(".", "_") == shirt.GetName())
    np.testing.assert_allclose(shown, mesh.colors[:, :3] * linear, atol=1e-6)
