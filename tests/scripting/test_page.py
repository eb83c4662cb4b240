"""The example and the scene file of the page on scripting work as they stand."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

import tifo
from tifo import AssetError, Node, Node3D, Signal, export, load_scene

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "scripting.md").read_text("utf-8")

SCRIPT = """\
from tifo import Node3D, Signal, export


class Ball(Node3D):
    goal_scored = Signal[str, int]()
    speed: float = export(default=8.0, range=(0, 40))
"""


class CheeringStand(Node3D):
    """The root of the stand in the page's scene."""

    width: float = export(default=3.0)
    moved = Signal[()]()

    def cheer(self, team: str, score: int, how: str) -> None:
        """Cheer."""


def test_the_example_runs(capsys: Any) -> None:
    code, _ = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(code, "page", "exec"), {"__name__": "page_of_scripting"})
    assert capsys.readouterr().out == "home: 1, board at 2.0 m\n"


def test_the_replay_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _, code = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {"tree": tifo.SceneTree(), "tifo": tifo}
    names["tree"].run(0.1)
    exec(compile(code, "page", "exec"), names)
    assert names["log"].ticks == 6
    assert names["tree"].tick == 12


def test_the_scene_file_is_read(folder: Path) -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    (folder / "match.toml").write_text(text)
    (folder / "ball.py").write_text(SCRIPT)
    (folder / "stand.toml").write_text('[[node]]\nname = "S"\ntype = "CheeringStand"\n')
    match = load_scene("res://match.toml").instantiate()
    assert match["%Ball"].speed == 12.0  # type: ignore[attr-defined]
    assert isinstance(match["North"], CheeringStand)
    assert len(match["Ball"].goal_scored.connections) == 1  # type: ignore[attr-defined]
    (folder / "wrong.toml").write_text(text.replace("speed", "sped"))
    with pytest.raises(AssetError) as caught:
        load_scene("res://wrong.toml")
    assert str(caught.value).replace("wrong", "match") in PAGE


def test_names_that_the_page_gives_exist() -> None:
    here = re.findall(r"^\|[^|]*\|([^|]*)\|$", PAGE, re.MULTILINE)
    words = set(re.findall(r"`(?:tree\.)?([a-z_]{4,})", " ".join(here)))
    known = {name for cls in (Node3D, tifo.SceneTree, tifo.Tween) for name in dir(cls)}
    known |= {name for node in tifo.nodes.__all__ for name in dir(getattr(tifo.nodes, node))}
    known |= {"parameters", "playback", "tifo"}
    known |= {*tifo.__all__, "input", "input_map", "autoloads", "choices", "group", "changed"}
    known |= {"binds", "deferred", "persist", "node", "await", "async", "from", "from_"}
    assert words <= known, words - known
    assert issubclass(Node3D, Node)
