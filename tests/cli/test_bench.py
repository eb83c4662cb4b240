"""``tifo bench``: one JSON object with units in its names, and nothing else."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tifo.cli import main

FIGURES = {"median_ms", "min_ms", "p10_ms", "p90_ms", "runs"}


def figures(capsys: pytest.CaptureFixture[str], *words: str) -> dict[str, object]:
    assert main(["bench", *words, "--json"]) == 0
    out = capsys.readouterr().out
    assert len(out.strip().splitlines()) == 1
    result: dict[str, object] = json.loads(out)
    assert set(result) >= FIGURES
    return result


def test_evaluate(capsys: pytest.CaptureFixture[str]) -> None:
    result = figures(capsys, "evaluate", "--streams", "9", "--joints", "20", "--runs", "5")
    assert (result["streams"], result["joints"], result["runs"]) == (9, 20, 5)
    assert result["slice_bytes"] == 9 * 20 * 48


def test_evaluate_trees_beside_clips(capsys: pytest.CaptureFixture[str]) -> None:
    words = ("evaluate", "--tree", "deep", "--streams", "5", "--joints", "9", "--runs", "4")
    result = figures(capsys, *words)
    assert (result["tree"], result["runs"]) == ("deep", 4)
    for key in ("ratio", "plain_median_ms", "add_stream_ms"):
        assert result[key] > 0  # type: ignore[operator]
    assert main(["bench", *words]) == 0
    assert "times as long as plain clips" in capsys.readouterr().out


def test_tick_reports_every_system(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tifo.benchmarks.tick.CALM", 20)
    result = figures(
        capsys, "tick", "--agents", "300", "--streams", "16", "--joints", "12", "--runs", "6"
    )
    systems = result["systems"]
    assert isinstance(systems, dict)
    assert set(systems) == {
        *("behaviour", "transition", "dilation", "clap", "controller", "history", "clipevent"),
        *("walking", "record", "detail"),
    }
    assert all(set(figure) >= FIGURES for figure in systems.values())
    assert result["goal_tick_ms"] > 0  # type: ignore[operator]


def test_tick_with_slots_in_use(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tifo.benchmarks.tick.CALM", 20)
    words = ("--agents", "300", "--streams", "16", "--joints", "12", "--runs", "6")
    assert figures(capsys, "tick", *words, "--slots", "40")["slots_in_use"] == 40
    assert figures(capsys, "tick", *words, "--slots", "0")["slots_in_use"] == 0


def test_memory_counts_what_a_crowd_has(capsys: pytest.CaptureFixture[str]) -> None:
    words = ("memory", "--agents", "300", "--streams", "16", "--joints", "12", "--slots", "40")
    assert main(["bench", *words, "--history", "20", "--runs", "14", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    # A pose is 12 matrices of 3 x 4 floats; a ring for 20 poses has 32 slices.
    assert result["pose_bytes"] == 12 * 48
    assert result["clip_streamed_bytes"] == 32 * 12 * 48
    assert result["ring_bytes"] == 32 * 16 * 12 * 48
    assert result["slot_bytes"] == 40 * 12 * 48
    assert result["clip_baked_bytes"] == pytest.approx(
        result["clip_baked_frames"] * 12 * 48, rel=1e-3
    )
    assert result["clips_streamed"] == 520 * 2**20 // result["clip_streamed_bytes"]
    assert result["clips_streamed"] > 3 * result["clips_baked"]
    # One slice of 16 streams with 7 markers, 80 heads, and sometimes a table of 300 agents.
    slice_bytes = 16 * (12 * 48 + 7 * 16) + 16 * (16 + 64)
    quiet = result["copied_bytes_quiet_tick"]
    assert quiet >= slice_bytes
    assert result["copied_bytes_goal_tick"] >= slice_bytes + 300 * 48
    assert main(["bench", *words, "--runs", "2"]) == 0
    assert "baked ones" in capsys.readouterr().out


def test_scaling_measures_the_sizes_up_to_the_one_given(
    capsys: pytest.CaptureFixture[str],
) -> None:
    result = figures(capsys, "scaling", "--agents", "300", "--runs", "5")
    situations = result["situations"]
    assert isinstance(situations, dict)
    assert list(situations) == [
        f"300, {name}" for name in ("quiet", "tick of a goal", "10 s after it", "the worst of them")
    ]
    assert (result["agents"], result["runs"]) == (300, 5)
    goal, worst = situations["300, tick of a goal"], situations["300, the worst of them"]
    assert worst["min_ms"] >= goal["min_ms"] > 0


def test_scripting(capsys: pytest.CaptureFixture[str]) -> None:
    words = ("scripting", "--nodes", "50", "--listeners", "3", "--runs", "10")
    result = figures(capsys, *words)
    assert (result["nodes"], result["listeners"], result["runs"]) == (50, 3, 10)
    assert result["emits_per_second"] == pytest.approx(1e6 / result["emit_us"], rel=0.01)  # type: ignore[operator]
    assert main(["bench", *words]) == 0
    assert "emissions a second" in capsys.readouterr().out


@pytest.mark.slow
def test_ten_thousand_nodes_take_less_than_5_ms_a_frame(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The fastest of many, since other programs run on this machine too."""
    result = figures(capsys, "scripting", "--runs", "100")
    assert (result["nodes"], result["listeners"]) == (10_000, 10)
    assert result["min_ms"] < 5.0  # type: ignore[operator]
    assert result["frame_after_adding"]["min_ms"] < 10.0  # type: ignore[index]
    assert result["emits_per_second"] > 100_000  # type: ignore[operator]


@pytest.mark.slow
def test_behaviour_prints_published_figures_and_draws(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tifo.benchmarks.behaviour.MINUTES", 3.0)
    plot = tmp_path / "curves.png"
    words = ("behaviour", "--agents", "12000", "--runs", "5", "--plot", str(plot))
    result = figures(capsys, *words)
    situations = result["situations"]
    assert isinstance(situations, dict)
    assert set(situations) == {"quiet", "all_clap", "wave", "walking"}
    shown = result["figures"]
    assert isinstance(shown, list)
    assert len(shown) > 15
    assert all(set(figure) == {"name", "measured", "published"} for figure in shown)
    assert plot.stat().st_size > 20_000


@pytest.mark.gl
def test_frame(capsys: pytest.CaptureFixture[str]) -> None:
    result = figures(capsys, "frame", "--agents", "200", "--size", "80x60", "--runs", "2")
    cameras = result["cameras"]
    assert isinstance(cameras, dict)
    assert set(cameras) == {"tv", "close", "bowl"}
    assert all(camera["triangles"] > 0 for camera in cameras.values())


def test_a_table_for_people(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "evaluate", "--streams", "4", "--joints", "5", "--runs", "3"]) == 0
    assert "median ms" in capsys.readouterr().out


@pytest.mark.parametrize(
    "words",
    [
        ("evaluate", "--streams", "0"),
        ("evaluate", "--joints", "0"),
        ("evaluate", "--runs", "0"),
        ("tick", "--agents", "0"),
        ("tick", "--history", "1"),
        ("scripting", "--nodes", "0"),
    ],
)
def test_impossible_sizes_are_refused(
    words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bench", *words]) == 1
    assert capsys.readouterr().err.startswith("tifo: ")


def test_variety(capsys: pytest.CaptureFixture[str]) -> None:
    words = ("variety", "--agents", "900", "--streams", "64", "--history", "30")
    assert main(["bench", *words, "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    drawn, cast = result["moments"]["as drawn"], result["moments"]["cast"]
    assert cast["pairs"] == drawn["pairs"] > 5000
    assert cast["score"] < drawn["score"]
    assert cast["same_both"] == 0.0
    assert "3 s after a goal" in result["moments"]
    assert main(["bench", *words]) == 0
    assert "within 3 seats" in capsys.readouterr().out
