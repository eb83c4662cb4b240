from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tifo.cli import main
from tifo.cli.inspect import describe
from tifo.cli.text import printable
from tifo.engine.assets import spectator

SPECTATOR = Path(spectator.__file__).parent / "spectator.glb"

# A hip 1 m up with one child, moving for two frames of half a second.
BVH = """HIERARCHY
ROOT {root}
{{
  OFFSET 0 100 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT chest
  {{
    OFFSET 0 50 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {{
      OFFSET 0 25 0
    }}
  }}
}}
MOTION
Frames: 3
Frame Time: 0.5
0 100 0 0 0 0 0 0 0
0 100 0 10 0 0 0 0 0
0 100 0 20 0 0 0 0 0
"""


@pytest.fixture
def bvh(tmp_path: Path) -> Path:
    path = tmp_path / "turn.bvh"
    path.write_text(BVH.format(root="hips"), "utf-8")
    return path


def said(capsys: pytest.CaptureFixture[str]) -> Any:
    return json.loads(capsys.readouterr().out)


def test_a_motion_is_described(bvh: Path) -> None:
    entry = describe(bvh, 0.01)
    assert entry["format"] == "BVH"
    assert entry["unit"] == "0.01 m, as --scale says"
    assert entry["skeleton"] == {
        "joints": 2,
        "roots": 1,
        "levels": 2,
        "names": ["hips", "chest"],
        "parents": [-1, 0],
    }
    (clip,) = entry["clips"]
    assert clip["name"] == "turn"
    assert clip["duration"] == 1.0
    # Every half second is divided into 30 steps, which makes 60 a second.
    assert (clip["keys"], clip["key_rate"]) == (61, 60.0)
    assert clip["looping"] is False
    assert [mesh["influences"] for mesh in entry["meshes"]] == [1]
    assert entry["triangles"] == sum(mesh["triangles"] for mesh in entry["meshes"])
    # Hips to the tip of the chest is 0.75 m; the ball around the hips adds a little.
    assert 0.75 <= entry["size"][1] <= 0.85
    json.dumps(entry, allow_nan=False)


def test_the_parts_of_a_body_are_shown(bvh: Path, capsys: pytest.CaptureFixture[str]) -> None:
    body = describe(SPECTATOR)["humanoid"]
    assert (body["found_by"], body["missing"], body["unmapped"]) == ("names", [], ["root"])
    assert body["joints"]["left_upper_arm"] == "upper_arm_l"
    assert describe(bvh)["humanoid"]["is_humanoid"] is False
    assert main(["inspect", str(SPECTATOR)]) == 0
    assert "left_upper_arm" in capsys.readouterr().out


def test_the_scale_is_guessed_and_said(bvh: Path) -> None:
    entry = describe(bvh)
    assert entry["unit"] == "guessed, see the notes"
    assert any("1 unit is taken as" in note for note in entry["notes"])


def test_the_built_in_spectator_is_described() -> None:
    entry = describe(SPECTATOR)
    whole = spectator.builtin_spectator()
    assert entry["format"] == "glTF, binary"
    assert entry["skeleton"]["joints"] == whole.skeleton.joint_count
    assert [clip["name"] for clip in entry["clips"]] == [clip.name for clip in whole.clips]
    assert 1.6 < entry["size"][1] < 1.9
    levels = (whole.meshes, *whole.lower_levels)
    triangles = sum(len(mesh.triangles) for level in levels for mesh in level)
    assert entry["triangles"] + sum(entry["lower_levels"]) == triangles
    assert {"skin", "shirt"} <= {material["name"] for material in entry["materials"]}
    assert all(1 <= mesh["influences"] <= 4 for mesh in entry["meshes"])


def test_the_page_fits_80_columns(bvh: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(SPECTATOR), str(bvh), "--tree"]) == 0
    printed = capsys.readouterr().out
    for word in ("sit_idle", "shirt", "24 joints", "2 joints in 2 levels, 1 root", "└── chest"):
        assert word in printed
    lines = [line for line in printed.splitlines() if not line.startswith(str(SPECTATOR.anchor))]
    assert max(map(len, lines)) <= 80


def test_json_is_one_object_also_for_bad_files(
    bvh: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    missing = tmp_path / "nothing.glb"
    assert main(["inspect", "--json", str(missing), str(bvh)]) == 1
    captured = capsys.readouterr()
    answer = json.loads(captured.out)
    assert answer["ok"] is False
    first, second = answer["files"]
    assert first == {"file": str(missing), "error": f"{missing}: there is no such file"}
    assert second["skeleton"]["joints"] == 2
    assert captured.err == f"tifo: {missing}: there is no such file\n"


def test_a_bad_file_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    broken = tmp_path / "broken.bvh"
    broken.write_text("HIERARCHY\nROOT hips\n", "utf-8")
    assert main(["inspect", str(broken)]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith(f"tifo: {broken}")
    assert captured.err.count("\n") == 1


def test_a_scale_out_of_range_is_refused(bvh: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", "--scale", "nan", str(bvh)]) == 1
    assert "scale is nan, expected metres" in capsys.readouterr().err
    assert main(["inspect", "--scale", "0.5", str(SPECTATOR)]) == 1
    assert "glTF files are in metres" in capsys.readouterr().err


def test_names_can_not_move_the_cursor(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "odd.bvh"
    path.write_text(BVH.format(root="hi\x1b[2Jps[bold]:smile:"), "utf-8")
    assert main(["inspect", "--tree", str(path)]) == 0
    printed = capsys.readouterr().out
    assert "\x1b" not in printed
    assert "hi?[2Jps[bold]:smile:" in printed


def test_text_is_made_printable() -> None:
    assert printable("a\x1b[2J\n\udcff") == "a?[2J??"
    assert printable("Tête 頭") == "Tête 頭"
