"""``tifo demo``: options become a spec, and mistakes one sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from tifo.cli import build_parser, main
from tifo.cli.demo import parse_size, spec_from


def spec(*words: str):  # type: ignore[no-untyped-def]
    return spec_from(build_parser().parse_args(["demo", *words]))


def test_a_bowl_with_two_sides_unless_told_otherwise() -> None:
    assert (spec().layout, spec().seats, spec().sides) == ("bowl", 65_000, 2)


def test_rows_or_columns_make_a_stand() -> None:
    made = spec("--rows", "4", "--occupancy", "0.5")
    assert (made.layout, made.rows, made.occupancy) == ("stand", 4, 0.5)


def test_options_override_a_spec_file(tmp_path: Path) -> None:
    file = tmp_path / "match.toml"
    file.write_text("seats = 900\nseed = 5\nhistory = 30\n", "utf-8")
    made = spec("--spec", str(file), "--seed", "9", "--lod", "off")
    assert (made.seats, made.seed, made.history, made.lod) == (900, 9, 30, False)


def test_every_option_of_the_spec_reaches_it() -> None:
    made = spec(
        *("--streams", "12", "--history", "20", "--sides", "1", "--poses", "baked"),
        *("--offsets", "uniform", "--character", "a.glb", "--motions", "b.bvh", "c.bvh"),
    )
    assert (made.streams, made.history, made.sides) == (12, 20, 1)
    assert (made.poses, made.offsets) == ("baked", "uniform")
    assert (made.character, made.motions) == ("a.glb", ("b.bvh", "c.bvh"))


def test_sizes() -> None:
    assert parse_size("640x360") == (640, 360)
    for text in ("640", "0x0", "99999x99999", "x", "-5x20"):
        with pytest.raises(ValueError, match="--size"):
            parse_size(text)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--seats", "0"), "seats must be"),
        (("--seats", "-5"), "seats must be"),
        (("--occupancy", "nan"), "occupancy must be"),
        (("--size", "5x5"), "--size is 5x5"),
        (("--seconds", "0"), "--seconds is 0"),
        (("--spec", "nowhere.toml"), "nowhere.toml"),
        (("--headless", "--character", "nowhere.glb"), "nowhere.glb: there is no such file"),
        (("--headless", "--screenshot", "no/such/folder/a.png"), "there is no folder"),
    ],
)
def test_mistakes_are_one_sentence(
    words: tuple[str, ...], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["demo", *words]) == 1
    told = capsys.readouterr().err.strip().splitlines()
    assert says in told[-1]
    assert told[-1].startswith("tifo: ")


@pytest.mark.gl
def test_headless_run_writes_a_picture_and_a_clip(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    av = pytest.importorskip("av")
    from PIL import Image

    picture, clip = tmp_path / "a.png", tmp_path / "a.mp4"
    words = ("--headless", "--seats", "400", "--size", "161x90", "--seconds", "0.5")
    assert main(["demo", *words, "--screenshot", str(picture), "--record", str(clip)]) == 0
    with Image.open(picture) as image:
        assert image.size == (161, 90)
    with av.open(str(clip)) as film:
        frames = list(film.decode(video=0))
    assert (frames[0].width, frames[0].height) == (160, 90)
    assert len(frames) >= 6
    assert str(picture) in capsys.readouterr().err.replace("\n", "")


def test_the_lab_is_a_scene_of_the_help(capsys: pytest.CaptureFixture[str]) -> None:
    parser = build_parser()
    assert parser.parse_args(["demo"]).scene == "stadium"
    assert parser.parse_args(["demo", "--scene", "lab"]).scene == "lab"
    with pytest.raises(SystemExit):
        parser.parse_args(["demo", "--help"])
    assert "--scene {stadium,lab}" in capsys.readouterr().out
    assert main(["demo", "--scene", "lab", "--headless", "--character", "x.glb"]) != 0
    assert "the lab shows the built-in spectator" in capsys.readouterr().err
