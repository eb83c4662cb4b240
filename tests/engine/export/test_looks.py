"""Recordings of agents who wear different meshes of one character."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from characters import make_body, make_box

from tifo.engine.assets.character import Character, Material, Variant
from tifo.engine.assets.variants import MOST_CHOICES
from tifo.engine.export.gltf import write_baked_gltf, write_gltf
from tifo.engine.export.paints import mix_paints
from tifo.engine.export.recording import Recording

NONE = MOST_CHOICES


def make_looks(choice: list[list[int]] | None, agents: int = 3) -> Recording:
    """A coat or a vest for everybody, hats for some; shoes for all."""
    skeleton = make_body()
    box = make_box(skeleton, np.array([-0.3, 0.0, -0.2]), np.array([0.3, 1.75, 0.2]), joint=1)
    meshes = (
        replace(box, name="coat", variant=Variant("body", "coat", {"man": 0.5})),
        replace(box, name="vest", variant=Variant("body", "vest", {"man": 0.5})),
        replace(box, name="shoes", material=1),
        replace(box, name="hat", variant=Variant("hat", "hat", {"man": 0.2}), material=2),
    )
    materials = (Material("shirt"), Material("leather"), Material("felt"))
    return Recording(
        character=Character("doll", skeleton, meshes, materials, ()),
        agents=np.arange(agents) + 10,
        labels=tuple(f"0|{k}" for k in range(agents)),
        fps=10.0,
        palettes=np.tile(np.eye(3, 4, dtype=np.float32), (1, agents, 7, 1, 1)),
        position=np.zeros((1, agents, 3), np.float32),
        yaw=np.zeros((1, agents), np.float32),
        scale=np.ones((1, agents), np.float32),
        girth=np.zeros(agents, np.float32),
        head=np.zeros(agents, np.float32),
        colors=np.full((agents, 5, 3), 188, np.uint8),
        choice=None if choice is None else np.array(choice, np.uint8),  # type: ignore[arg-type]
    )


def names(recording: Recording) -> list[str]:
    return [mesh.name for mesh in recording.meshes(0)]


def test_who_wears_what() -> None:
    recording = make_looks([[1, 0, NONE], [0, NONE, NONE]])
    assert names(recording) == ["coat", "vest", "shoes", "hat"]
    assert recording.worn(recording.meshes(0)).tolist() == [
        [False, True, True, True],
        [True, False, True, False],
        [False, False, True, False],
    ]
    assert names(recording.select(11)) == ["coat", "shoes"]
    assert names(recording.select([12, 10])) == ["vest", "shoes", "hat"]
    assert names(recording.select([12, 10]).frame(0)) == ["vest", "shoes", "hat"]


@pytest.mark.parametrize("choice", [None, np.zeros((0, 3)).tolist()])
def test_where_nobody_chose_everybody_has_what_is_needed(choice: list[list[int]] | None) -> None:
    recording = make_looks(choice)
    assert names(recording) == ["coat", "shoes"]
    assert recording.worn(recording.meshes(0)).all()


def test_choices_that_there_are_not() -> None:
    for choice, said in (
        ([[0, 2, 0], [0, 0, 0]], "choice has 2 for 'body', expected 0 to 1, or 255 for none"),
        ([[0, 0, 0], [0, 1, 0]], "choice has 1 for 'hat', expected 0 to 0"),
        ([[0, 0, 0]], r"choice has shape \(1, 3\), expected \(2, 3\)"),
        ([[0, 0], [0, 0]], r"choice has shape \(2, 2\), expected \(2, 3\)"),
    ):
        with pytest.raises(ValueError, match=said):
            make_looks(choice)


def test_only_worn_meshes_are_painted() -> None:
    recording = make_looks([[1, 0, NONE], [NONE, NONE, NONE]])
    recording.colors[2, 2] = 0  # Of a shirt that the third has not.
    paints, chosen = mix_paints(recording, recording.meshes(0))
    assert [paint.name for paint in paints] == ["shirt #bcbcbc", "leather"]
    assert chosen.tolist() == [[-1, 0, 1], [0, -1, 1], [-1, -1, 1]]


@pytest.mark.parametrize("write", [write_gltf, write_baked_gltf])
def test_somebody_who_wears_nothing_is_there_all_the_same(write, tmp_path: Path) -> None:
    recording = make_looks([[0, NONE, 1], [NONE, NONE, 0]])
    no_shoes = tuple(mesh for mesh in recording.character.meshes if mesh.name != "shoes")
    bare = replace(recording, character=replace(recording.character, meshes=no_shoes))
    done = write(bare, tmp_path / "doll.gltf")
    assert (done.agents, done.triangles) == (3, 3 * 12)
    document = json.loads((tmp_path / "doll.gltf").read_text())
    assert [mesh["name"] for mesh in document["meshes"]] == ["body 10", "body 12"]
    assert [len(mesh["primitives"]) for mesh in document["meshes"]] == [1, 2]
    shown = [node["name"] for node in document["nodes"]]
    assert {"agent 10", "agent 11", "agent 12"} <= set(shown)
    with pytest.raises(ValueError, match="no triangles there to export"):
        write(bare.select(11), tmp_path / "nobody.glb")
