"""The motions of a spec, on the character of the spec."""

from __future__ import annotations

from pathlib import Path

import pytest

import tifo
from tifo.engine.crowd.motions import sort_motions

DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "bvh"


def test_named_motions_are_shown_by_the_built_in_spectator() -> None:
    if not DATA.is_dir():
        pytest.skip(f"the motion files are not at {DATA}")
    spec = tifo.CrowdSpec(motions=(str(DATA / "cmu_02_01.bvh"), str(DATA / "mh_walk1.bvh")))
    character = tifo.character_of(spec)
    assert [clip.name for clip in character.clips] == ["cmu_02_01", "mh_walk1"]
    assert character.skeleton.names == tifo.builtin_spectator().skeleton.names
    # A walk across the room was closed, in place.
    walk = character.clip("cmu_02_01")
    assert walk.looping
    hips = walk.translation[:, character.skeleton.index("hips")]
    assert abs(hips[0] - hips[-1]).max() < 1e-4
    assert sort_motions(character.clips).names == ("cmu_02_01", "mh_walk1")
