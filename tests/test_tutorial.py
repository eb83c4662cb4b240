"""The tutorial works as written: its boxes are put together in an empty folder, step by step."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = (Path(__file__).resolve().parents[1] / "docs" / "tutorial.md").read_text("utf-8")
STEPS = re.split(r"^## (?=\d)", PAGE, flags=re.MULTILINE)[1:]

# Runs a script of the tutorial with a `tifo.run` that ends by itself and refuses errors.
PLAY = """
import runpy, sys
import tifo

errors = []
real = tifo.run
def run(scene, **how):
    tree = tifo.SceneTree(scene, report=errors.append)
    def press(key):
        tree.push_input(tifo.InputEventKey(key))
        tree.push_input(tifo.InputEventKey(key, False))
    timer = tree.create_timer(0.1, process_in_physics=True)
    timer.timeout.connect(lambda: [press(key) for key in sys.argv[1]])
    real(tree, size=(96, 54), headless=True, seconds=0.5, screenshot="step.png", samples=0)
tifo.run = run
runpy.run_path("main.py", run_name="__main__")
for error in errors:
    print("ERROR", error)
"""


def boxes(step: int) -> list[tuple[str, str, str]]:
    """File, remark and text of each box of a step."""
    found = re.findall(r"```\w+\n# ([\w.]+)(?:, ([^\n]*))?\n(.*?)```", STEPS[step - 1], re.DOTALL)
    assert len(found) == STEPS[step - 1].count("```") // 2, "every box names its file"
    return found


def put(folder: Path, step: int) -> None:
    """Write a step's files; a box with a remark takes the place of the nodes that it names."""
    for name, remark, text in boxes(step):
        file = folder / name
        if not remark:
            file.write_text(text)
            continue
        nodes = [part for part in re.split(r"(?=\[\[node\]\])", file.read_text()) if part.strip()]
        for new in [part for part in re.split(r"(?=\[\[node\]\])", text) if part.strip()]:
            names = [re.search(r'name = "(\w+)"', part) for part in (*nodes, new)]
            keys = [match[1] if match else "" for match in names]
            if keys[-1] in keys[:-1]:
                nodes[keys.index(keys[-1])] = new
            else:
                nodes.append(new)
        file.write_text("\n".join(part.strip() + "\n" for part in nodes))


def play(folder: Path, keys: str = "") -> str:
    done = subprocess.run(
        [sys.executable, "-c", PLAY, keys],
        capture_output=True,
        text=True,
        cwd=folder,
        timeout=120,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("match")


@pytest.mark.gl
@pytest.mark.parametrize(
    ("step", "keys", "said"),
    [
        (1, "", ""),
        (2, "", ""),
        (3, "GH", "1 : 0\n1 : 1\n"),
        (4, "G", "1 : 0\n"),
        (5, "G", "1 : 0\n"),
    ],
)
def test_each_step_runs(folder: Path, step: int, keys: str, said: str) -> None:
    put(folder, step)
    assert play(folder, keys) == said
    assert (folder / "step.png").stat().st_size > 1000
    (folder / "step.png").unlink()


@pytest.mark.gl
def test_the_away_fans_wave(folder: Path) -> None:
    put(folder, 6)
    wave, score = play(folder, "HW").splitlines()
    assert score == "0 : 1"
    assert int(wave.removesuffix(" fans wave")) > 100


def test_the_tutorials_own_test_passes(folder: Path) -> None:
    put(folder, 8)
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_match.py"],
        capture_output=True,
        text=True,
        cwd=folder,
        timeout=120,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    assert done.returncode == 0, done.stdout
    assert "1 passed" in done.stdout


def test_saving_a_script_changes_the_running_game(folder: Path) -> None:
    code = """
import os, sys
import tifo
tree = tifo.SceneTree("match.toml")
reload = tifo.HotReload(tree)
tree.run(0.1)
reload.check()
def press():
    for key in "HW":
        tree.push_input(tifo.InputEventKey(key))
        tree.push_input(tifo.InputEventKey(key, False))
    tree.run(0.1)
press()
text = open("waving.py").read()
open("waving.py", "w").write(text.replace("range(10)", "range(20)"))
assert reload.check() == ["res://waving.py"]
press()
open("waving.py", "w").write(text)
tree.close()
"""
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        cwd=folder,
        timeout=120,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert [line for line in lines if ":" in line] == ["0 : 1", "0 : 2"], "the score stays"
    wave, more = [line for line in lines if ":" not in line]
    assert int(more.split()[0]) > 1.2 * int(wave.split()[0])


def test_all_that_it_uses_is_installed_on_the_way() -> None:
    installed = set(re.findall(r"^    pip install (\w+)$", PAGE, re.MULTILINE))
    assert installed == {"tifo", "pytest"}
    texts = [text for step in range(1, 9) for name, _, text in boxes(step) if name[-3:] == ".py"]
    used = {name for text in texts for name in re.findall(r"^(?:from|import) (\w+)", text, re.M)}
    used |= set(re.findall(r"^    python -m (\w+)", PAGE, re.MULTILINE))
    assert "pytest" in used
    assert used - installed <= sys.stdlib_module_names


def test_a_letter_in_a_number_is_told_with_its_line(folder: Path, tmp_path: Path) -> None:
    import tifo

    text = next(text for name, _, text in boxes(2) if name == "match.toml")
    file = tmp_path / "match.toml"
    file.write_text(text.replace("5_000", "5_00O"))
    line = text.split("\n").index("seats = 5_000") + 1
    with pytest.raises(tifo.AssetError, match=f"line {line}"):
        tifo.load_scene(file)
