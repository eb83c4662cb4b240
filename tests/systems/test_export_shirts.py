"""Patterns of shirts in exported files: what is read from them is what the pattern's rule says."""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import esper
import numpy as np
import pytest
from exported import GltfFile, check_gltf, worn_meshes
from numpy.typing import NDArray
from PIL import Image

from tifo.engine.crowd.kits import PATTERNS, Kit, second_share
from tifo.engine.crowd.regions import Regions
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.export.recording import Recording
from tifo.systems.export import export_gltf, export_usd
from tifo.systems.simulation import Simulation

Array = NDArray[Any]

FIRST, SECOND = (200, 30, 45), (30, 70, 231)
PLAIN, ALIKE = 0, 8
"""Agents of a plain shirt, and in the same shirt as the fourth; 5 to 7 are in lighter and darker
stripes, with the same ratio of both colours."""
FADED = {5: ((198, 66, 66), (99, 33, 165)), 6: ((180, 60, 60), (90, 30, 150))}


def linear(srgb: Any) -> Array:
    """IEC 61966-2-1."""
    share = np.asarray(srgb, float) / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def srgb(light: Array) -> Array:
    high = np.maximum(light, 0.0031308)
    share = np.where(light <= 0.0031308, 12.92 * light, 1.055 * high ** (1 / 2.4) - 0.055)
    return 255.0 * share


def sampled(image: Array, places: Array) -> Array:
    """Bilinear, up to the edge; places (N, 2) are to the right and down."""
    height, width = image.shape[:2]
    x = np.clip(places[:, 0] * width - 0.5, 0, width - 1)
    y = np.clip(places[:, 1] * height - 0.5, 0, height - 1)
    left, top = np.minimum(x.astype(int), width - 2), np.minimum(y.astype(int), height - 2)
    right, down = (x - left)[:, None], (y - top)[:, None]
    above = image[top, left] * (1 - right) + image[top, left + 1] * right
    below = image[top + 1, left] * (1 - right) + image[top + 1, left + 1] * right
    result: Array = above * (1 - down) + below * down
    return result


def inside(mesh: Any, values: Array) -> Array:
    """Values of vertices in the middle of every triangle and near its corners."""
    shares = np.array([[1, 1, 1], [4, 1, 1], [1, 4, 1], [1, 1, 4]], float)
    shares /= shares.sum(axis=1, keepdims=True)
    return np.concatenate([np.einsum("c,tcn->tn", one, values[mesh.triangles]) for one in shares])


@dataclass
class Shirts:
    """A row of people in a plain shirt, each pattern, and some of the same."""

    recording: Recording
    crowd: Any
    regions: Regions

    def mesh(self, agent: int) -> Any:
        (shirt,) = [m for m in worn_meshes(self.crowd, agent) if m.name.endswith(".shirt")]
        return shirt

    def check(self, agent: int, sample: Any) -> None:
        """Compare `sample`, which gives the light at coordinates of the mesh, with the rule."""
        mesh, regions = self.mesh(agent), self.regions
        points = inside(mesh, mesh.positions.astype(float))
        trunk = regions.neck - regions.waist
        across = (points[:, [0, 2]] @ regions.across - regions.middle) / trunk
        up = (points[:, 1] - regions.waist) / trunk
        pattern = int(self.crowd.appearance.pattern[agent])
        # Two texels from a border both colours mix.
        share = second_share(pattern, across, up, (0.05, 0.05))
        first, second = share < 1e-6, share > 1 - 1e-6
        assert min(first.sum(), second.sum()) > 100
        assert first.sum() + second.sum() > 0.5 * len(points)
        shown = srgb(sample(mesh))
        looks = self.crowd.appearance
        for where, colours in ((first, looks.shirt), (second, looks.second)):
            assert np.abs(shown[where] - colours[agent, :3].astype(float)).max() < 3.0


@pytest.fixture(scope="module")
def shirts() -> Iterator[Shirts]:
    spec = CrowdSpec(
        layout="stand", rows=1, columns=10, occupancy=1.0, children=0, old=0, streams=32, seed=3
    )
    simulation = Simulation(spec)
    crowd = simulation.crowd
    for agent, pattern in enumerate(PATTERNS):
        Kit(FIRST, SECOND, pattern).put_on(crowd.appearance, [agent])
    for agent, (first, second) in FADED.items():
        Kit(first, second, "stripes").put_on(crowd.appearance, [agent])
    Kit((20, 20, 20), (0, 0, 0), "halves").put_on(crowd.appearance, [7])
    Kit(FIRST, SECOND, PATTERNS[3]).put_on(crowd.appearance, [ALIKE])
    # Both colours the same: nothing is seen of the pattern.
    Kit(FIRST, FIRST, "hoops").put_on(crowd.appearance, [9])
    with simulation.active():
        regions = esper.component_for_entity(crowd.entity, Regions)
    yield Shirts(simulation.record(), crowd, regions)
    simulation.close()


def shirt_of(file: GltfFile, agent: int, kind: str) -> tuple[Any, Any]:
    """The primitive and the material of an agent's shirt."""
    (node,) = [node for node in file.gltf.nodes if node.name == f"{kind} {agent}"]
    found = [
        (primitive, file.gltf.materials[primitive.material])
        for primitive in file.gltf.meshes[node.mesh].primitives
    ]
    ((primitive, material),) = [pair for pair in found if pair[1].name.startswith("shirt")]
    return primitive, material


def gltf_light(file: GltfFile, agent: int, kind: str, mesh: Any) -> Array:
    primitive, material = shirt_of(file, agent, kind)
    surface = material.pbrMetallicRoughness
    texture = file.gltf.textures[surface.baseColorTexture.index]
    sampler = file.gltf.samplers[texture.sampler]
    assert (sampler.wrapS, sampler.wrapT) == (33071, 33071)
    image = file.gltf.images[texture.source]
    assert image.mimeType == "image/png"
    view = file.gltf.bufferViews[image.bufferView]
    content = file.binary[view.byteOffset : view.byteOffset + view.byteLength]
    pixels = linear(np.asarray(Image.open(io.BytesIO(content)).convert("RGB")))
    number = surface.baseColorTexture.texCoord or 0
    places = file.array(getattr(primitive.attributes, f"TEXCOORD_{number}")).astype(float)
    assert places.shape == (len(mesh.positions), 2)
    assert places.min() >= 0.0
    assert places.max() <= 1.0
    np.testing.assert_array_equal(
        file.array(primitive.indices).reshape(-1, 3), mesh.triangles.astype(np.uint16)
    )
    return sampled(pixels, inside(mesh, places)) * np.array(surface.baseColorFactor[:3])


@pytest.mark.parametrize("baked", [False, True])
def test_gltf_shows_every_pattern(shirts: Shirts, tmp_path: Path, baked: bool) -> None:
    path = tmp_path / "shirts.glb"
    export_gltf(shirts.recording, path, baked=baked)
    check_gltf(path)
    file, kind = GltfFile(path), "agent" if baked else "body"
    for agent in (1, 2, 3, 4, *FADED, 7, ALIKE):
        shirts.check(agent, lambda mesh, k=agent: gltf_light(file, k, kind, mesh))
    for agent in (PLAIN, 9):
        _, material = shirt_of(file, agent, kind)
        assert material.name == "shirt #c81e2d"
        assert material.pbrMetallicRoughness.baseColorTexture is None


def test_gltf_shirts_share_materials_and_pictures(shirts: Shirts, tmp_path: Path) -> None:
    path = tmp_path / "shirts.gltf"
    export_gltf(shirts.recording, path)
    file = GltfFile(path)
    assert shirt_of(file, 3, "body")[1] is shirt_of(file, ALIKE, "body")[1]
    lighter, darker = (shirt_of(file, agent, "body")[1] for agent in FADED)
    assert lighter.name == "shirt #c64242 #6321a5 stripes"
    assert lighter.name != darker.name
    surfaces = lighter.pbrMetallicRoughness, darker.pbrMetallicRoughness
    assert surfaces[0].baseColorTexture.index == surfaces[1].baseColorTexture.index
    # Of the stripes, hoops, halves and sash, the faded stripes, and the dark halves.
    assert len(file.gltf.images) == len(file.gltf.textures) == 6
    assert len(file.gltf.samplers) == 1


def test_plain_shirts_have_no_pictures(shirts: Shirts, tmp_path: Path) -> None:
    export_gltf(shirts.recording, tmp_path / "plain.glb", agents=[PLAIN, 9])
    gltf = GltfFile(tmp_path / "plain.glb").gltf
    assert [gltf.images, gltf.textures, gltf.samplers] == [[], [], []]
    for mesh in gltf.meshes:
        assert all(primitive.attributes.TEXCOORD_0 is None for primitive in mesh.primitives)


@pytest.mark.parametrize("level", [1, 2])
def test_coarser_levels_have_patterns_too(shirts: Shirts, tmp_path: Path, level: int) -> None:
    export_gltf(shirts.recording, tmp_path / "coarse.glb", level=level)
    _, material = shirt_of(GltfFile(tmp_path / "coarse.glb"), 2, "body")
    assert material.pbrMetallicRoughness.baseColorTexture is not None


@pytest.fixture(scope="module")
def usd() -> ModuleType:
    pytest.importorskip("pxr", reason="usd-core is not installed, so no USD file can be written")
    import usd_files

    return usd_files


def usd_light(stage: Any, folder: Path, agent: int, mesh: Any) -> Array:
    """What a preview surface shows, by the specification of UsdUVTexture."""
    from pxr import Usd, UsdGeom, UsdShade

    below = Usd.PrimRange(
        stage.GetPrimAtPath(f"/Crowd/agent_{agent}"), Usd.TraverseInstanceProxies()
    )
    (prim,) = [one for one in below if one.GetName() == mesh.name.replace(".", "_")]
    material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
    surface = material.ComputeSurfaceSource()[0]
    assert surface.GetIdAttr().Get() == "UsdPreviewSurface"
    source = surface.GetInput("diffuseColor").GetConnectedSources()[0][0]
    texture = UsdShade.Shader(source.source.GetPrim())
    assert texture.GetIdAttr().Get() == "UsdUVTexture"
    value = {one.GetBaseName(): one.Get() for one in texture.GetInputs()}
    assert (value["wrapS"], value["wrapT"], value["sourceColorSpace"]) == ("clamp", "clamp", "raw")
    reader = UsdShade.Shader(texture.GetInput("st").GetConnectedSources()[0][0].source.GetPrim())
    primvar = UsdGeom.PrimvarsAPI(prim).GetPrimvar(reader.GetInput("varname").Get())
    assert primvar.GetInterpolation() == "vertex"
    places = np.array(primvar.Get(), float) * [1, -1] + [0, 1]
    image = np.asarray(Image.open(folder / value["file"].path).convert("RGB")) / 255.0
    shown = sampled(image, inside(mesh, places))
    return shown * np.array(value["scale"])[:3] + np.array(value["bias"])[:3]


@pytest.mark.parametrize(
    "options", [{}, {"instances": False}, {"baked": True}], ids=["instances", "own", "baked"]
)
def test_usd_shows_every_pattern(
    shirts: Shirts, usd: ModuleType, tmp_path: Path, options: dict[str, bool]
) -> None:
    from pxr import Usd

    path = tmp_path / "shirts.usda"
    done = export_usd(shirts.recording, path, **options)
    assert usd.complaints(path) == []
    stage = Usd.Stage.Open(str(path))
    for agent in (1, 2, 3, 4, *FADED, 7, ALIKE):
        shirts.check(agent, lambda mesh, k=agent: usd_light(stage, tmp_path, k, mesh))
    names = sorted(file.name for file in tmp_path.iterdir())
    patterns = ("halves", "hoops", "sash", "stripes")
    assert names == ["shirts.usda", *(f"shirts_{pattern}.png" for pattern in patterns)]
    assert done.size == sum(file.stat().st_size for file in tmp_path.iterdir())
    shirt = stage.GetPrimAtPath("/Crowd/Shirts")
    assert len(shirt.GetChildren()) == 7


def test_usd_instances_keep_their_other_materials(
    shirts: Shirts, usd: ModuleType, tmp_path: Path
) -> None:
    from pxr import Usd, UsdGeom, UsdShade

    path = tmp_path / "shirts.usdc"
    export_usd(shirts.recording, path, rigid=True)
    stage = Usd.Stage.Open(str(path))
    for agent in range(10):
        prim = stage.GetPrimAtPath(f"/Crowd/agent_{agent}")
        assert prim.IsInstance()
        for child in prim.GetFilteredChildren(Usd.TraverseInstanceProxies()):
            if not child.IsA(UsdGeom.Mesh):
                continue
            material, _ = UsdShade.MaterialBindingAPI(child).ComputeBoundMaterial()
            patterned = agent not in (PLAIN, 9) and child.GetName().endswith("_shirt")
            assert ("/Crowd/Shirts" in str(material.GetPath())) == patterned
    # Looks are shared by all with a pattern, whatever it is.
    first, second = (stage.GetPrimAtPath(f"/Crowd/agent_{k}") for k in (1, 2))
    same = {mesh.name for mesh in worn_meshes(shirts.crowd, 1)} == {
        mesh.name for mesh in worn_meshes(shirts.crowd, 2)
    }
    assert (first.GetPrototype() == second.GetPrototype()) == same
