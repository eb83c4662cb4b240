"""The whole simulation runs where there is neither a window system nor GL, and loads lightly."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable

import pytest

Run = Callable[[str], str]

NO_PYGLET = """
import sys

class Refuse:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] == "pyglet":
            raise ImportError(f"{name} is not for machines without GL")

sys.meta_path.insert(0, Refuse())
"""

# What only some calls need: readers of pictures and files, GL, decoders, and tools of the build.
LATE = ("PIL", "av", "fast_simplification", "pyglet", "rich", "scipy", "skimage", "trimesh")


@pytest.fixture
def run() -> Run:
    """Run code in a process of its own, far from any display, and return what it prints."""

    def in_process(code: str) -> str:
        hidden = ("DISPLAY", "WAYLAND_DISPLAY", "PYGLET_HEADLESS")
        environment = {name: value for name, value in os.environ.items() if name not in hidden}
        process = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
            env={**environment, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        )
        assert process.returncode == 0, process.stderr
        return process.stdout

    return in_process


def test_a_match_is_simulated_without_pyglet(run: Run) -> None:
    code = """
from tifo.systems.simulation import Simulation
from tifo.engine.crowd.spec import CrowdSpec
from tifo.engine.behaviour.events import Goal

simulation = Simulation(CrowdSpec(seats=200, occupancy=1.0, neutrals=0.0, streams=16, seed=3))
ticks = simulation.clock.tick
simulation.run(seconds=1.0)
simulation.send(Goal(side=0))
simulation.run(seconds=1.0)
print(simulation.clock.tick - ticks)
print(len(simulation.crowd), int(simulation.crowd.behaviour.reacting.sum()))
print("pyglet" in sys.modules)
simulation.close()
"""
    ticks, seats, pyglet = run(NO_PYGLET + code).splitlines()
    assert ticks == "120"
    count, changed = map(int, seats.split())
    assert count == 200
    assert 100 < changed <= 200
    assert pyglet == "False"


def test_pyglet_is_missing_in_these_tests(run: Run) -> None:
    code = "try:\n    import pyglet.gl\nexcept ImportError as error:\n    print(error)\n"
    assert "not for machines without GL" in run(NO_PYGLET + code)


def test_files_are_read_without_pyglet(run: Run) -> None:
    code = "import tifo; print(len(tifo.builtin_spectator().clips))"
    assert int(run(NO_PYGLET + code)) > 0


def test_drawing_says_what_it_needs_only_when_asked(run: Run) -> None:
    code = """
import tifo
print(sorted(name for name in tifo.__all__ if not hasattr(tifo, name)))
"""
    assert run(NO_PYGLET + code).strip() == "[]"


@pytest.mark.parametrize(
    "module", ["tifo", "tifo.cli", "tifo.engine.gl", "tifo.systems.simulation"]
)
def test_importing_is_light(run: Run, module: str) -> None:
    code = f"import sys, {module}; print(*sorted(set({LATE!r}) & set(sys.modules)))"
    assert run(code).split() == []


def test_the_commands_answer_before_loading_what_they_need(run: Run) -> None:
    code = f"""
import sys
from tifo.cli import build_parser
build_parser()
print(*sorted(set({LATE!r}) & set(sys.modules)))
"""
    assert run(code).split() == []
