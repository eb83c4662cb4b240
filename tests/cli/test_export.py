from __future__ import annotations

from pathlib import Path

import pytest
from exported import GltfFile, check_gltf

from tifo.cli import main

SMALL = ("--rows", "2", "--columns", "3", "--occupancy", "1", "--streams", "32", "--history", "20")


def test_a_stand_after_a_goal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "stand.glb"
    what = ("--agents", "rows 1", "0", "--seconds", "0.2", "--fps", "10", "--goal", "home")
    assert main(["export", *SMALL, *what, "--start", "0.1", "--level", "2", "--out", str(out)]) == 0
    assert "4 agents, 3 frames" in capsys.readouterr().out
    check_gltf(out)
    bodies = [n.name for n in GltfFile(out).gltf.nodes if n.name.startswith("body")]
    assert sorted(bodies) == [f"body {k}" for k in (0, 3, 4, 5)]


def test_usd_by_its_ending(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pxr", reason="usd-core is not installed, so no USD file can be written")
    out = tmp_path / "stand.usda"
    assert main(["export", *SMALL, "--no-instances", "--out", str(out)]) == 0
    assert "6 agents, 1 frame," in capsys.readouterr().out
    assert out.read_text("utf-8").startswith("#usda 1.0")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--out", "crowd.fbx"), "must end in one of .glb, .gltf, .usd, .usda, .usdc"),
        (("--out", "crowd.glb", "--format", "usd"), "must end in .usd or .usda or .usdc"),
        (("--out", "no/such/crowd.glb"), "there is no folder"),
        (("--out", "crowd.glb", "--seconds", "1e9"), "seconds is 1000000000.0, expected 0 to"),
        (("--out", "crowd.glb", "--fps", "nan"), "fps is nan, expected 1 to 240"),
        (("--out", "crowd.glb", "--baked", "--seconds", "1"), "baked glTF holds one moment"),
        (("--out", "crowd.glb", "--baked", "--rigid"), "--rigid is about skeletons"),
        (("--out", "crowd.glb", "--no-instances"), "--no-instances is for USD"),
        (("--out", "crowd.usda", "--split"), "--split is for glTF"),
        (("--out", "crowd.glb", "--agents", "7"), "there is no agent 7, expected 0 to 5"),
        (("--out", "crowd.glb", "--agents", "section 8"), "names no seat"),
        (("--out", "crowd.glb", "--level", "5"), "level is 5, expected 0 to 2"),
    ],
)
def test_mistakes_are_one_sentence(
    options: tuple[str, ...],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["export", *SMALL, *options]) == 1
    error = capsys.readouterr().err
    assert said in error
    assert error.startswith("tifo: ")
    assert error.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_schedule_of_clips(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "clips.csv"
    words = [*SMALL, "--seconds", "2", "--goal", "home", "--schedule", str(out)]
    assert main(["export", *words]) == 0
    assert "clip instances of" in capsys.readouterr().out
    assert out.read_text("utf-8").startswith("agent,seat,clip,state,start,end,source_start")
    assert main(["export", *SMALL, "--schedule", str(out)]) == 1
    assert "--seconds is 0, but a schedule needs a time" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["export", *words, "--out", str(tmp_path / "a.glb")])
