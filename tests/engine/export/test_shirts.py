"""Sheets of patterns: where they lie, what is on them, and which shirts have none."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from characters import make_body, make_box

from tifo.engine.assets.character import Character, Material
from tifo.engine.crowd.colours import draw_appearance
from tifo.engine.crowd.kits import second_share
from tifo.engine.crowd.regions import Regions
from tifo.engine.export.gltf import write_baked_gltf, write_gltf
from tifo.engine.export.paints import mix_paints
from tifo.engine.export.pixels import to_linear
from tifo.engine.export.recording import Recording
from tifo.engine.export.shirts import Shirt, lay_sheet, parted_colours

LOW, HIGH = np.array([-0.3, 0.4, -0.2]), np.array([0.5, 1.4, 0.2])
RED, BLUE = (200, 30, 45), (30, 60, 231)
FRAME = Regions(1.0, 1.5, np.array([1, 0], np.float32), 0.1, False, np.zeros(7, np.bool_))
"""The trunk is 0.5 m high, so what is here a metre is two heights of it."""


def make_shirts(**fields) -> Recording:
    """Stripes, plain and stripes of one colour; on two shirts and shorts."""
    skeleton = make_body()
    box = make_box(skeleton, LOW, HIGH, joint=1)
    lower = make_box(skeleton, np.array([0, -0.1, 0]), np.array([0.1, 0.5, 0.1]), joint=1)
    uvs = np.linspace(0, 1, 2 * len(box.positions), dtype=np.float32).reshape(-1, 2)
    meshes = (box, replace(lower, name="tail", uvs=uvs), replace(box, name="shorts", material=1))
    colors = np.zeros((3, 5, 3), np.uint8)
    colors[:, 2] = RED
    values = {
        "character": Character("doll", skeleton, meshes, (Material("shirt"), Material("x")), ()),
        "agents": np.arange(3),
        "labels": ("a", "b", "c"),
        "fps": 10.0,
        "palettes": np.tile(np.eye(3, 4, dtype=np.float32), (1, 3, 7, 1, 1)),
        "position": np.zeros((1, 3, 3), np.float32),
        "yaw": np.zeros((1, 3), np.float32),
        "scale": np.ones((1, 3), np.float32),
        "girth": np.zeros(3, np.float32),
        "head": np.zeros(3, np.float32),
        "colors": colors,
        "second": np.array([BLUE, BLUE, RED], np.uint8),
        "pattern": np.array([1, 0, 1], np.uint8),
        "regions": FRAME,
    }
    return Recording(**{**values, **fields})


def test_places_on_the_trunk() -> None:
    points = np.array([(0.1, 1.0, 9), (0.35, 1.5, 0), (-0.4, 0.75, 0)], np.float32)
    np.testing.assert_allclose(FRAME.on_trunk(points), [(0, 0), (0.5, 1), (-1, -0.5)], atol=1e-6)
    sideways = replace(FRAME, across=np.array([0, -1], np.float32))
    np.testing.assert_allclose(
        sideways.on_trunk(np.array([(7, 1, -0.6)], np.float32)), [(1, 0)], atol=1e-6
    )


def test_a_sheet_is_as_large_as_all_shirts() -> None:
    recording = make_shirts()
    meshes = recording.meshes(0)
    sheet = lay_sheet(recording, meshes)
    assert sheet is not None
    # From -0.3 to 0.5 m across and from -0.1 to 1.4 m up.
    np.testing.assert_allclose(sheet.corner, [-0.8, -2.2], atol=1e-6)
    np.testing.assert_allclose(sheet.extent, [1.6, 3.0], atol=1e-6)
    # 1.6 / 0.0125 is 128, within rounding; 3 / 0.0125 is 240.
    assert sheet.texels[0] in (128, 256)
    assert sheet.texels[1] == 256
    assert [sheet.covers(mesh) for mesh in meshes] == [True, True, False]
    box = sheet.coordinates(meshes[0])
    np.testing.assert_allclose(box.min(axis=0), [0, 1 / 3], atol=1e-6)
    np.testing.assert_allclose(box.max(axis=0), [1, 1], atol=1e-6)
    np.testing.assert_allclose(sheet.coordinates(meshes[1])[:, 0].min(), 0.3 / 0.8, atol=1e-6)


@pytest.mark.parametrize("pattern", [1, 2, 3, 4])
def test_texels_are_the_rules(pattern: int) -> None:
    recording = make_shirts()
    sheet = lay_sheet(recording, recording.meshes(0))
    assert sheet is not None
    (width, height), rng = sheet.texels, np.random.default_rng(1)
    palette, texels = sheet.picture(Shirt(pattern, (0, 0, 0), (255, 255, 255)))
    assert texels.shape == (height, width)
    share = to_linear(palette)[:, 0][texels]
    for column, row in zip(rng.integers(0, width, 200), rng.integers(0, height, 200), strict=True):
        across = -0.8 + 1.6 * (column + 0.5) / width
        up = 0.8 - 3.0 * (row + 0.5) / height
        exact = second_share(pattern, across, up, (1.6 / width, 3.0 / height))
        assert abs(share[row, column] - exact) < 0.01
    assert set(np.unique(share)) >= {0.0, 1.0}


def test_who_shows_a_pattern() -> None:
    recording = make_shirts()
    assert recording.patterned.tolist() == [True, False, False]
    assert recording.select([2, 0]).patterned.tolist() == [False, True]
    paints, chosen = mix_paints(recording, recording.meshes(0))
    names = [paint.name for paint in paints]
    striped = "shirt #c81e2d #1e3ce7 stripes"
    # Where a mesh has coordinates of its own, the pattern's are its second ones.
    assert names == [striped, "shirt #c81e2d", striped, "x"]
    assert [paint.coordinates for paint in paints] == [0, 0, 1, 0]
    assert chosen.tolist() == [[0, 2, 3], [1, 1, 3], [1, 1, 3]]
    for nobody in (
        make_shirts(regions=None),
        make_shirts(second=None),
        make_shirts(pattern=None),
        recording.select([1, 2]),
    ):
        assert not nobody.patterned.any()
        assert lay_sheet(nobody, nobody.meshes(0)) is None
        assert len(mix_paints(nobody, nobody.meshes(0))[0]) == 2


def test_shirts_with_a_picture_keep_it() -> None:
    recording = make_shirts()
    pictured = Material("shirt", image=np.full((2, 2, 4), 255, np.uint8))
    character = replace(recording.character, materials=(pictured, Material("x")))
    own = replace(recording, character=character)
    assert lay_sheet(own, own.meshes(0)) is None
    assert all(paint.shirt is None for paint in mix_paints(own, own.meshes(0))[0])


@pytest.mark.parametrize("write", [write_gltf, write_baked_gltf])
def test_coordinates_come_after_a_meshs_own(write, tmp_path: Path) -> None:
    write(make_shirts(), tmp_path / "doll.gltf")
    document = json.loads((tmp_path / "doll.gltf").read_text())
    for mesh in document["meshes"]:
        box, tail, shorts = (primitive["attributes"] for primitive in mesh["primitives"])
        assert {"TEXCOORD_0"} == {name for name in box if name.startswith("TEX")}
        assert {"TEXCOORD_0", "TEXCOORD_1"} == {name for name in tail if name.startswith("TEX")}
        assert not [name for name in shorts if name.startswith("TEX")]
    textures = [
        material["pbrMetallicRoughness"].get("baseColorTexture")
        for material in document["materials"]
    ]
    assert textures == [{"index": 0}, None, {"index": 0, "texCoord": 1}, None]


def test_what_is_no_pattern() -> None:
    for fields, said in (
        ({"pattern": np.array([0, 5, 0], np.uint8)}, "pattern has 5, expected 0 to 4"),
        ({"pattern": np.zeros(2, np.uint8)}, r"pattern has shape \(2,\), expected \(3,\)"),
        ({"second": np.zeros((3, 4), np.uint8)}, r"second has shape \(3, 4\), expected \(3, 3\)"),
    ):
        with pytest.raises(ValueError, match=said):
            make_shirts(**fields)


def test_colours_parted_in_a_factor_and_a_picture() -> None:
    factor, first, second = parted_colours(np.uint8([255, 0, 188]), np.uint8([0, 0, 255]))
    np.testing.assert_allclose(factor, [1, 0, 1])
    assert (first, second) == ((255, 255, 190), (0, 255, 255))
    rng = np.random.default_rng(2)
    for given in rng.integers(0, 256, (200, 2, 3)).astype(np.uint8):
        factor, *left = parted_colours(*given)
        light = factor * to_linear(np.array(left))
        srgb = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
        assert np.abs(255 * srgb - given).max() < 3.0


def test_thousands_of_faded_shirts_share_some_pictures() -> None:
    rng = np.random.default_rng(4)
    looks = draw_appearance(np.zeros(4000, np.int8), rng, fervour=1.0)
    who = np.flatnonzero(looks.pattern)
    pairs = {(bytes(looks.shirt[k, :3]), bytes(looks.second[k, :3])) for k in who}
    pictures = {parted_colours(looks.shirt[k, :3], looks.second[k, :3])[1:] for k in who}
    assert len(pairs) > 1000
    assert len(pictures) < 60
