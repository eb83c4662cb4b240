"""The crowd spec: defaults, checks and its TOML form."""

from __future__ import annotations

import dataclasses
import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.errors import AssetError

SHARE = st.floats(0.0, 1.0)
SELECTIONS = st.lists(
    st.sampled_from(["12|345", "rows 3-10", "columns 1", "rows 2-4 columns 10-20", "section 5"])
)
TEXT = st.text(st.characters(exclude_categories=["Cs"]))
VALUES: dict[str, st.SearchStrategy[Any]] = {
    "layout": st.sampled_from(["bowl", "stand"]),
    "seats": st.integers(1, 1_000_000),
    "rows": st.integers(1, 1000),
    "columns": st.integers(1, 1000),
    "step": st.floats(0.3, 10.0),
    "rise": st.floats(0.0, 10.0),
    "depth": st.floats(0.3, 10.0),
    "occupancy": SHARE,
    "occupied": SELECTIONS,
    "empty": SELECTIONS,
    "sides": st.integers(1, 8),
    "neutrals": st.floats(0.0, 0.5),
    "away_share": st.floats(0.0, 0.5),
    "children": st.floats(0.0, 0.5),
    "old": st.floats(0.0, 0.5),
    "women": st.floats(0.0, 1.0),
    "props": st.floats(0.0, 1.0),
    "tint": st.floats(0.0, 1.0),
    "casting": st.booleans(),
    "streams": st.integers(1, 256),
    "spare_streams": st.integers(0, 256),
    "history": st.integers(2, 254),
    "slots": st.integers(0, 8192),
    "uniques": st.integers(0, 2048),
    "poses": st.sampled_from(["streams", "baked", "none"]),
    "offsets": st.sampled_from(["normal", "uniform"]),
    "rest_idle": st.booleans(),
    "seed": st.integers(0, 2**63 - 1),
    "lod": st.booleans(),
    "character": TEXT,
    "motions": st.lists(TEXT),
    "fans": st.sampled_from(["away block", "mixed", "blocks"]),
    "parties": st.sampled_from(["football", "general"]),
    "ultras": SHARE,
    "behaviour": TEXT,
    "embarrassment": SHARE,
    "latecomers": SHARE,
    "stewards": st.integers(0, 1000),
    "walking": st.booleans(),
}


def test_defaults() -> None:
    spec = CrowdSpec()
    assert (spec.layout, spec.seats, spec.occupancy) == ("bowl", 65_000, 0.96)
    assert (spec.step, spec.rise, spec.depth) == (1.5, 2.0, 2.0)
    assert (spec.sides, spec.neutrals, spec.away_share) == (1, 0.03, 0.05)
    assert (spec.fans, spec.ultras, spec.behaviour) == ("away block", 0.05, "sport")
    assert spec.embarrassment == 0.25
    assert (spec.streams, spec.history, spec.seed, spec.lod) == (256, 60, 1, True)
    assert (spec.occupied, spec.empty, spec.character, spec.motions) == ((), (), "", ())


def test_every_field_is_tried_and_has_help() -> None:
    assert {f.name for f in dataclasses.fields(CrowdSpec)} == set(VALUES)
    assert all(f.metadata["help"] for f in dataclasses.fields(CrowdSpec))


@given(st.fixed_dictionaries({}, optional=VALUES))
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_round_trip(tmp_path: Path, values: dict[str, Any]) -> None:
    spec = CrowdSpec(**values)
    file = tmp_path / "crowd.toml"
    file.write_text(spec.to_toml(), encoding="utf-8", newline="")
    assert CrowdSpec.from_toml(file) == spec
    assert set(tomllib.loads(spec.to_toml())) == set(VALUES)


@pytest.mark.parametrize(
    ("name", "value", "allowed"),
    [
        ("layout", "arena", "'bowl' or 'stand'"),
        ("poses", "frozen", "'streams' or 'baked' or 'none'"),
        ("offsets", 3, "'normal' or 'uniform'"),
        ("seats", 0, "from 1 to 1000000"),
        ("seats", -5, "from 1 to 1000000"),
        ("seats", 10**9, "from 1 to 1000000"),
        ("seats", 65_000.0, "whole number"),
        ("seats", True, "whole number"),
        ("seats", "many", "whole number"),
        ("seats", math.nan, "whole number"),
        ("rows", 0, "from 1 to"),
        ("columns", 0, "from 1 to"),
        ("step", 0.0, "from 0.3 to 10"),
        ("rise", -1.0, "from 0 to 10"),
        ("depth", math.inf, "from 0.3 to 10"),
        ("occupancy", math.nan, "from 0 to 1"),
        ("occupancy", 1.01, "from 0 to 1"),
        ("occupancy", "96 %", "number"),
        ("neutrals", -0.1, "from 0 to 1"),
        ("away_share", True, "number"),
        ("props", 1.5, "from 0 to 1"),
        ("sides", 9, "from 1 to 8"),
        ("streams", 257, "from 1 to 256"),
        ("history", 1, "from 2 to 254"),
        ("history", 255, "from 2 to 254"),
        ("seed", -1, "from 0"),
        ("lod", 1, "true or false"),
        ("occupied", "12|345", "list of texts"),
        ("empty", ["rows"], "'rows 3-10'"),
        ("motions", [1], "list of texts"),
        ("character", 7, "file name"),
    ],
)
def test_wrong_values(name: str, value: Any, allowed: str) -> None:
    with pytest.raises(ValueError, match=name) as caught:
        CrowdSpec(**{name: value})
    assert allowed in str(caught.value)


def test_values_that_do_not_go_together() -> None:
    with pytest.raises(ValueError, match=r"rows \* columns must be at most 1,000,000"):
        CrowdSpec(layout="stand", rows=1001, columns=1000)
    assert CrowdSpec(layout="bowl", rows=1001, columns=1000).seat_count == 65_000
    with pytest.raises(ValueError, match=r"neutrals \+ away_share"):
        CrowdSpec(sides=2, neutrals=0.6, away_share=0.6)
    assert CrowdSpec(sides=1, neutrals=0.6, away_share=0.6).sides == 1


def test_numpy_numbers_and_paths_become_plain() -> None:
    values: dict[str, Any] = {
        "seats": np.int32(10),
        "occupancy": np.float32(0.5),
        "character": Path("fan.glb"),
        "motions": ["a.bvh"],
    }
    spec = CrowdSpec(**values)
    assert type(spec.seats) is int
    assert type(spec.occupancy) is float
    assert spec.character == "fan.glb"
    assert spec.motions == ("a.bvh",)


def test_replace() -> None:
    spec = CrowdSpec(seats=500)
    assert spec.replace(layout="stand", rows=3, columns=4).seat_count == 12
    assert spec.seats == 500
    with pytest.raises(ValueError, match="seat is not a field"):
        spec.replace(seat=3)
    with pytest.raises(ValueError, match="history"):
        spec.replace(history=0)


@pytest.mark.parametrize(
    ("text", "layout"),
    [
        ("", "bowl"),
        ("rows = 3", "stand"),
        ("columns = 3", "stand"),
        ("rows = 3\nseats = 100", "stand"),
        ('layout = "bowl"\nrows = 3', "bowl"),
    ],
)
def test_rows_or_columns_in_a_file_make_a_stand(tmp_path: Path, text: str, layout: str) -> None:
    file = tmp_path / "crowd.toml"
    file.write_text(text)
    assert CrowdSpec.from_toml(file).layout == layout


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("seats = 100\nhistroy = 30", "line 2: unknown key 'histroy'; did you mean history?"),
        ("[stadium]\nseats = 3", "line 1: unknown key 'stadium'; known: layout, seats, rows"),
        ("\nseats = 'many'", "line 2: seats must be a whole number"),
        ("seats = 0", "line 1: seats must be a whole number from 1 to 1000000, not 0"),
        ("occupancy = nan", "line 1: occupancy must be a number from 0 to 1, not nan"),
        ("seats = 10\nrows = [", "line 2: not valid TOML"),
        ("seats = ", "not valid TOML"),
        ("a" * 10, "not valid TOML"),
        ("seats = " + "9" * 5000, "not valid TOML"),
        ("x = " + "[" * 5000, "nested too deeply"),
        ("seats = 1\nseats = 2", "line 2: not valid TOML"),
        ("rows = 10000\ncolumns = 10000", "rows * columns must be at most"),
        ("empty = ['rows 3-1']", "line 1: empty: 'rows 3-1' runs backwards"),
        ("seats = 2024-01-01", "line 1: seats must be"),
    ],
)
def test_bad_files(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "crowd.toml"
    file.write_text(text)
    with pytest.raises(AssetError) as caught:
        CrowdSpec.from_toml(file)
    assert message in str(caught.value)
    assert str(caught.value).startswith(str(file))
    assert "\n" not in str(caught.value)


def test_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(AssetError, match="no such file"):
        CrowdSpec.from_toml(tmp_path / "none.toml")
    with pytest.raises(AssetError, match="no such file"):
        CrowdSpec.from_toml(tmp_path)
    with pytest.raises(AssetError, match=r"no such file|can't be read"):
        CrowdSpec.from_toml("a\0b")
    (tmp_path / "latin.toml").write_bytes(b'character = "M\xfcnchen.glb"')
    with pytest.raises(AssetError, match="byte 14: the file is not UTF-8"):
        CrowdSpec.from_toml(tmp_path / "latin.toml")


def test_spare_streams_come_on_top_of_the_crowds_own() -> None:
    assert CrowdSpec(streams=20, spare_streams=256).spare_streams == 256
    with pytest.raises(ValueError, match="spare_streams must be a whole number from 0 to 256"):
        CrowdSpec(spare_streams=-1)
