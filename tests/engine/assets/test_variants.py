"""Variants: through a file and back, one look out of many, and what files may say wrongly."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from characters import make_box, make_character

from tifo.engine.assets.character import Character, Variant
from tifo.engine.assets.gltf_writer import character_to_glb
from tifo.engine.assets.levels import grouped_by_level
from tifo.engine.assets.load import load_character
from tifo.engine.assets.simplify import with_lower_levels
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.assets.variants import default_choices, one_look, variant_groups
from tifo.engine.errors import AssetError

HATS = (
    Variant("hat", "top hat", {"man": 0.25, "old man": 0.5}),
    Variant("hat", "bonnet", {"old woman": 1.0}),
)


def with_hats() -> Character:
    """A box with one of two smaller boxes on it, and a tail for everyone."""
    character = make_character()
    one = np.ones(3)
    hats = tuple(
        replace(make_box(character.skeleton, one * k, one * (k + 1)), name=v.choice, variant=v)
        for k, v in enumerate(HATS, start=2)
    )
    tail = replace(hats[0], name="tail", variant=Variant("tail", "tail"))
    return replace(character, meshes=(*character.meshes, *hats, tail))


def edited(tmp_path: Path, extras: object) -> Path:
    """A file whose last node has other extras."""
    data = character_to_glb(with_hats())
    (length,) = struct.unpack_from("<I", data, 12)
    document: dict[str, Any] = json.loads(data[20 : 20 + length])
    document["nodes"][-1]["extras"] = extras
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    path = tmp_path / "edited.glb"
    head = struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest))
    path.write_bytes(head + struct.pack("<I4s", len(text), b"JSON") + text + rest)
    return path


def test_groups_and_their_choices_in_order() -> None:
    assert variant_groups(make_character()) == {}
    assert variant_groups(with_hats()) == {
        "hat": HATS,
        "tail": (Variant("tail", "tail", {"everyone": 1.0}),),
    }


def test_one_look_shows_what_somebody_always_has() -> None:
    """Old women always have a hat, so a hat is shown where nobody chose."""
    character = with_hats()
    assert [mesh.name for mesh in one_look(character).meshes] == ["box", "top hat", "tail"]
    assert default_choices(character) == {"hat": 0, "tail": 0}
    bare = one_look(character, {"hat": None, "tail": None})
    assert [mesh.name for mesh in bare.meshes] == ["box"]
    assert variant_groups(bare) == {}
    assert one_look(bare) is bare
    beards = {"beard": 255, "body": 0, "hair": 0}
    assert default_choices(builtin_spectator()) == beards


def test_unknown_groups_and_choices_are_named() -> None:
    with pytest.raises(ValueError, match=r"group 'shoes'.*has: hat, tail"):
        one_look(with_hats(), {"shoes": "red"})
    with pytest.raises(ValueError, match="'cap' for 'hat', expected one of: top hat, bonnet"):
        one_look(with_hats(), {"hat": "cap"})


def test_a_file_keeps_variants_apart(tmp_path: Path) -> None:
    """All meshes have one skin and one material, which are merged otherwise."""
    path = tmp_path / "hats.glb"
    path.write_bytes(character_to_glb(with_hats()))
    read = load_character(path)
    assert variant_groups(read) == variant_groups(with_hats())
    assert [mesh.name for mesh in read.meshes] == ["box", "top hat", "bonnet", "tail"]
    np.testing.assert_allclose(read.meshes[2].positions, with_hats().meshes[2].positions)


def test_levels_and_variants_of_the_spectator_survive_a_file(tmp_path: Path) -> None:
    spectator = replace(builtin_spectator(), clips=())
    path = tmp_path / "spectator.glb"
    path.write_bytes(character_to_glb(spectator))
    read = grouped_by_level(load_character(path))
    for made, kept in zip(
        (read.meshes, *read.lower_levels),
        (spectator.meshes, *spectator.lower_levels),
        strict=True,
    ):
        assert [(m.name, m.variant) for m in made] == [(m.name, m.variant) for m in kept]
        assert [len(m.triangles) for m in made] == [len(m.triangles) for m in kept]


@pytest.mark.parametrize(
    ("extras", "message"),
    [
        ({"tifo_variant": "bun"}, r"tifo_variant.*is 'bun', expected a group and a choice"),
        ({"tifo_variant": 3}, "is a number, expected a text"),
        ({"tifo_variant": "hair/"}, "expected a group and a choice"),
        ({"tifo_variant": "hair/bun", "tifo_shares": {"dog": 1}}, "names 'dog', expected one of"),
        ({"tifo_variant": "hair/bun", "tifo_shares": {"man": -1}}, "is negative"),
        ({"tifo_variant": "hair/bun", "tifo_shares": {"man": "all"}}, "where a number belongs"),
        ({"tifo_variant": "hair/bun", "tifo_shares": 1}, "expected an object"),
    ],
)
def test_wrong_extras_are_told(tmp_path: Path, extras: object, message: str) -> None:
    with pytest.raises(AssetError, match=message):
        load_character(edited(tmp_path, extras))


@pytest.mark.parametrize("extras", [None, 3, "hair/bun", [], {}, {"other": {"x": 1}}])
def test_extras_of_others_mean_nothing(tmp_path: Path, extras: object) -> None:
    assert list(variant_groups(load_character(edited(tmp_path, extras)))) == ["hat"]


def test_coarser_levels_keep_variants_apart() -> None:
    """Each hat is reduced by itself, and none is lost to the others."""
    fine = replace(builtin_spectator(), lower_levels=())
    made = with_lower_levels(fine, (1200, 500))
    assert variant_groups(made) == variant_groups(fine)
    counts = [
        sum(len(mesh.triangles) for mesh in level)
        for level in (one_look(made).meshes, *one_look(made).lower_levels)
    ]
    assert counts[1] == pytest.approx(1200, rel=0.06)
    assert counts[2] == pytest.approx(500, rel=0.12)
    for level in made.lower_levels:
        assert {m.variant and m.variant.choice for m in level} == {
            m.variant and m.variant.choice for m in fine.meshes
        }
