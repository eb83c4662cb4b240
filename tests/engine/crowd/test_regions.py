"""Trousers, upper body and head by height, on characters of other people."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tifo.engine.assets.character import Character
from tifo.engine.assets.load import load_character
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.assets.variants import one_look
from tifo.engine.crowd.figure import make_figure
from tifo.engine.crowd.regions import HEAD, TROUSERS, UPPER_BODY, Regions, find_regions

FILES = Path(__file__).resolve().parents[4] / "shared" / "data" / "gltf"


def regions_of(character: Character) -> Regions:
    return find_regions(character, make_figure(character))


def imported(name: str) -> Character:
    if not (FILES / name).is_file():
        pytest.skip(f"the test character {name} is not there")
    return load_character(FILES / name)


def share_at(regions: Regions, *heights: float) -> list[int]:
    return list(regions.part_of(np.array(heights, np.float32)))


def test_below_the_waist_and_above_the_neck() -> None:
    spectator = builtin_spectator()
    regions = regions_of(spectator)
    assert not regions.parted
    assert regions.waist == pytest.approx(0.955, abs=0.03)
    assert regions.neck == pytest.approx(1.54, abs=0.03)
    # Exactly at a border counts as above it.
    edges = (regions.waist - 0.01, regions.waist + 1e-6, regions.neck - 0.01, regions.neck + 1e-6)
    assert share_at(regions, *edges) == [TROUSERS, UPPER_BODY, UPPER_BODY, HEAD]
    np.testing.assert_array_equal(regions.across, [1, 0])
    assert regions.middle == pytest.approx(0.0, abs=0.01)


def test_named_materials_agree_with_the_heights() -> None:
    # Long hair hangs below the neck.
    spectator = one_look(builtin_spectator(), {"hair": "crop"})
    regions = regions_of(spectator)
    wanted = {"trousers": TROUSERS, "shoes": TROUSERS, "shirt": UPPER_BODY, "hair": HEAD}
    for mesh in spectator.meshes:
        name = spectator.materials[mesh.material].name
        if name in wanted:
            parts = regions.part_of(mesh.positions[:, 1])
            assert (parts == wanted[name]).mean() > 0.8, name


def test_a_character_without_names_is_parted() -> None:
    spectator = builtin_spectator()
    bare = tuple(replace(material, name="cloth") for material in spectator.materials)
    assert regions_of(replace(spectator, materials=bare)).parted


def test_the_knight() -> None:
    knight = imported("KayKit_Knight.glb")
    regions = regions_of(knight)
    assert regions.parted
    # Hips and head of this rig are at 0.406 and 1.241 m of 2.47 m: its head is half of it.
    assert regions.waist == pytest.approx(0.406, abs=1e-3)
    assert regions.neck == pytest.approx(1.241, abs=1e-3)
    np.testing.assert_array_equal(regions.across, [1, 0])
    kept = {mesh.name for mesh in knight.meshes if regions.keeps_colours(mesh)}
    assert {"1H_Sword", "2H_Sword", "Round_Shield"} <= kept
    assert not kept & {"Knight_ArmLeft", "Knight_Cape", "Knight_Helmet"}


def test_cesium_man_who_is_bound_facing_aside() -> None:
    man = imported("CesiumMan.gltf")
    regions = regions_of(man)
    assert regions.parted
    assert regions.waist == pytest.approx(0.679, abs=1e-3)
    assert regions.neck == pytest.approx(1.19, abs=1e-3)
    # Its arms are along z.
    np.testing.assert_array_equal(np.abs(regions.across), [0, 1])
    (mesh,) = man.meshes
    parts = regions.part_of(mesh.positions[:, 1])
    assert np.bincount(parts, minlength=3).min() > 300
    # The hands, farthest out, are of the upper body.
    out = np.abs(mesh.positions[:, 2]) > 0.45
    assert (parts[out] == UPPER_BODY).all()


def test_joints_that_say_nothing() -> None:
    """The robot's joints are all bound at the origin; its head is what the head's joint moves."""
    robot = imported("RobotExpressive.glb")
    regions = regions_of(robot)
    assert 2.3 < regions.neck < 2.7
    assert 1.3 < regions.waist < 1.7
