"""The README's example and the programs under examples/ run as they stand."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
DRAWING = {"run_scene": ("--headless",), "in_moderngl": (), "in_pyglet": ("--seconds", "2")}
"""Examples that draw, with the words that let them end by themselves."""
COUNT = """
import gc, runpy
import pyglet
from tifo.systems.crowd import Crowd

contexts, draw = [], Crowd.draw
def counting(crowd, *words, **more):
    draw(crowd, *words, **more)
    if id(pyglet.gl.current_context) not in contexts:
        contexts.append(id(pyglet.gl.current_context))
        kept.append(pyglet.gl.current_context)  # so that no other one gets its id
kept = []
Crowd.draw = counting
runpy.run_path({path!r}, run_name="__main__")
Crowd.draw = draw
kept.clear()
from tifo.engine.gl import collect, live_objects
gc.collect()
collect()
print("windows drawn in:", len(contexts))
print("objects:", live_objects())
"""
EXAMPLES = sorted(p for p in (ROOT / "examples").glob("*.py") if p.stem not in DRAWING)


def run(path: Path, *words: str, folder: Path = ROOT, display: str = "") -> str:
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, sys.path)]),
    }
    environment |= {"DISPLAY": display, "PYGLET_HEADLESS": ""} if display else {}
    done = subprocess.run(
        [sys.executable, str(path), *words],
        capture_output=True,
        text=True,
        cwd=folder,
        timeout=120,
        env=environment,
    )
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    return done.stdout


@pytest.mark.gl
def test_the_embedding_example_runs(tmp_path: Path) -> None:
    text = (ROOT / "README.md").read_text("utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    script = tmp_path / "example.py"
    script.write_text(code + "print(pixels.shape, pixels.std() > 20)\n", "utf-8")
    reacting, picture = run(script).splitlines()
    done, present = (int(word) for word in re.findall(r"\d+", reacting))
    assert 0.5 * present < done <= present
    assert picture == "(360, 640, 3) True"


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(path: Path) -> None:
    assert run(path).strip()


@pytest.mark.gl
def test_a_scene_runs_in_tifos_own_loop(tmp_path: Path) -> None:
    said = run(ROOT / "examples" / "run_scene.py", *DRAWING["run_scene"], folder=tmp_path)
    assert said == "the ball comes down at x = 12.0, 7.0 m high\n"
    assert is_a_picture(tmp_path / "run_scene.png")


@pytest.mark.gl
def test_a_crowd_is_drawn_in_a_moderngl_program(tmp_path: Path) -> None:
    pytest.importorskip("moderngl")
    said = run(ROOT / "examples" / "in_moderngl.py", folder=tmp_path)
    assert "80 seats, GL errors: GL_NO_ERROR" in said
    assert is_a_picture(tmp_path / "in_moderngl.png")


@pytest.mark.gl
def test_two_crowds_run_in_a_pyglet_game(display: str, tmp_path: Path) -> None:
    """One window is closed and opened again on the way, and no GL object is left."""
    script = tmp_path / "count.py"
    script.write_text(COUNT.format(path=str(ROOT / "examples" / "in_pyglet.py")))
    said = run(script, *DRAWING["in_pyglet"], display=display)
    shares = [int(share) for share in re.findall(r"stand \d+: (\d+)% are up", said)]
    assert len(shares) == 2
    assert min(shares) > 50
    assert said.splitlines()[-2:] == ["windows drawn in: 3", "objects: {}"]


def is_a_picture(path: Path) -> bool:
    """Whether there is more than a sky on it."""
    with Image.open(path) as image:
        return bool(np.asarray(image).std() > 20)


def test_pages_and_pictures_that_are_linked_exist() -> None:
    for page in [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]:
        for link in re.findall(r"\]\(([^)#:]+)\)", page.read_text("utf-8")):
            assert (page.parent / link).exists(), f"{page.name} links to {link}"
