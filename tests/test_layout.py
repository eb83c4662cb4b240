"""The arrows between the folders, and what else holds for every file of the tree.

`components <- engine <- systems <- scripting <- demo_game`: a folder imports only what stands to
its left. Imports are read from the text, so one inside a function counts like any other.
"""

from __future__ import annotations

import ast
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
LAYERS = ("components", "engine", "systems", "scripting", "demo_game")
CODE = (*LAYERS, "shaders", "benchmarks", "tifo")
MOST_LINES = 450

# Who may import pyglet: the GL layer, the passes, windows and their input, and the programs.
MAY_USE_PYGLET = re.compile(
    r"tifo\.(engine\.(gl|render)|demo_game|cli)(\.|$)"
    r"|tifo\.systems\.render\w*$"
    r"|tifo\.scripting\.(window|input)\w*$"
)
# Who may besides use the GL objects and passes: what holds a picture of a simulation.
MAY_DRAW = re.compile(MAY_USE_PYGLET.pattern + r"|tifo\.scripting\.stage$|tifo\.benchmarks(\.|$)")

TOP_LEVEL = {
    *(".ci", ".github", ".gitattributes", ".gitignore"),
    *("LICENSE", "Makefile", "README.md", "pyproject.toml"),
    *("benchmarks", "components", "demo_game", "docs", "engine", "examples"),
    *("scripting", "shaders", "systems", "tests", "tifo"),
}
TEXT = {".py", ".glsl", ".md", ".toml", ".yml", ".txt", ".typed", ""}

# A path of one machine, or of the workplace that a file was written in. A part in brackets keeps
# the pattern from finding itself. Paths of nodes, below /root, have names in capitals.
LOCAL_PATH = re.compile(
    r"/wor[k]/|/roo[t]/[.a-z]|/hom[e]/\w|/tm[p]/\w|/User[s]/\w|[A-Z]:\\+User[s]|file:/[/]/"
)


def modules() -> Iterator[tuple[str, Path]]:
    """Every module of the package as users import it, with its file."""
    for folder in CODE:
        prefix = () if folder == "tifo" else ("tifo",)
        for path in sorted((ROOT / folder).rglob("*.py")):
            relative = path.relative_to(ROOT)
            if folder == "tifo" and len(relative.parts) > 2 and relative.parts[1] != "cli":
                continue  # a link to a folder that is listed itself
            parts = (*prefix, *relative.with_suffix("").parts)
            yield ".".join(parts[:-1] if parts[-1] == "__init__" else parts), path


@cache
def imports(path: Path, module: str) -> frozenset[str]:
    """Full names of what a file imports: modules, and the names taken from them."""
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = package.split(".")[: len(package.split(".")) - node.level + 1]
                base = ".".join((*above, *([base] if base else [])))
            found |= {f"{base}.{alias.name}" for alias in node.names}
    return frozenset(found)


def layer(name: str) -> str | None:
    """The layer that a full module name belongs to: ``engine`` for ``tifo.engine.gl``."""
    parts = name.split(".")
    return parts[1] if len(parts) > 1 and parts[0] == "tifo" and parts[1] in LAYERS else None


def top(name: str) -> str:
    return name.partition(".")[0]


def sources() -> Iterator[Path]:
    """Every text file that belongs to the project."""
    for name in sorted(TOP_LEVEL):
        entry = ROOT / name
        for path in [entry] if entry.is_file() else sorted(entry.rglob("*")):
            is_kept = "__pycache__" not in path.parts and not path.is_symlink()
            inside_link = any(parent.is_symlink() for parent in path.parents)
            if path.is_file() and is_kept and not inside_link and path.suffix in TEXT:
                yield path


MODULES = dict(modules())


@pytest.mark.parametrize("folder", LAYERS[:-1])
def test_arrows_go_one_way(folder: str) -> None:
    lower = LAYERS[: LAYERS.index(folder) + 1]
    wrong = [
        f"{module} imports {name}"
        for module, path in MODULES.items()
        if layer(module) == folder
        for name in imports(path, module)
        if top(name) == "tifo"
        and (layer(name) or name) not in lower
        and not (folder in ("engine", "systems", "scripting") and name.startswith("tifo.shaders"))
    ]
    assert not wrong


def test_the_demo_game_uses_only_what_any_game_can() -> None:
    import tifo

    public = {f"tifo.{name}" for name in tifo.__all__} | {"tifo"}
    wrong = [
        f"{module} imports {name}"
        for module, path in MODULES.items()
        if layer(module) == "demo_game"
        for name in imports(path, module)
        if top(name) == "tifo" and layer(name) != "demo_game" and name not in public
    ]
    assert not wrong


def test_components_import_numpy_only() -> None:
    used = {
        top(name)
        for module, path in MODULES.items()
        if layer(module) == "components"
        for name in imports(path, module)
    }
    assert used - set(sys.stdlib_module_names) <= {"numpy", "tifo"}


def test_the_engine_knows_no_ecs() -> None:
    wrong = [
        module
        for module, path in MODULES.items()
        if layer(module) in ("components", "engine")
        if any(top(name) == "esper" for name in imports(path, module))
    ]
    assert not wrong


def test_only_what_draws_imports_pyglet() -> None:
    wrong = [
        module
        for module, path in MODULES.items()
        if not MAY_USE_PYGLET.match(module)
        if any(top(name) == "pyglet" for name in imports(path, module))
    ]
    assert not wrong


def test_only_what_draws_uses_gl_objects() -> None:
    wrong = [
        f"{module} imports {name}"
        for module, path in MODULES.items()
        if not MAY_DRAW.match(module) and module != "tifo"
        for name in imports(path, module)
        if re.match(r"tifo\.engine\.(gl|render)(\.|$)", name)
    ]
    assert not wrong


def test_inside_the_package_imports_are_relative() -> None:
    wrong = []
    for module, path in MODULES.items():
        if layer(module) == "demo_game":
            continue  # reads like any user's game
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and node.level == 0:
                names = [node.module or ""]
            wrong += [f"{module} imports {name}" for name in names if top(name) == "tifo"]
    assert not wrong


def test_no_folder_is_imported_past_the_package() -> None:
    """``engine`` and ``tifo.engine`` would be two modules of one file, with two of each class."""
    names = [name for name in MODULES if not name.endswith("__main__")]
    folders = {*LAYERS, "shaders", "benchmarks"}
    code = (
        "import importlib, sys\n"
        f"for name in {names!r}: importlib.import_module(name)\n"
        f"print(sorted(set(sys.modules) & {folders!r}))\n"
    )
    process = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        cwd=ROOT,
    )
    assert process.returncode == 0, process.stderr
    assert process.stdout.strip() == "[]"
    assert not set(sys.modules) & folders


def test_no_file_is_too_long() -> None:
    lengths = {
        str(path.relative_to(ROOT)): len(path.read_text("utf-8").splitlines())
        for path in sources()
        if path.suffix in (".py", ".glsl")
    }
    assert {name: lines for name, lines in lengths.items() if lines > MOST_LINES} == {}


def test_no_path_of_one_machine_is_in_the_text() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
        for path in sources()
        for number, line in enumerate(path.read_text("utf-8").splitlines(), 1)
        if LOCAL_PATH.search(line)
    ]
    assert not found


def test_nothing_else_lies_at_the_top() -> None:
    git = shutil.which("git")
    if git is None or not (ROOT / ".git").exists():
        pytest.skip("not a git checkout, so it can't be told what belongs to it")
    listed = subprocess.run(
        [git, "-C", str(ROOT), "ls-files"], capture_output=True, text=True, timeout=60, check=True
    ).stdout
    assert {top_name(line) for line in listed.splitlines()} <= TOP_LEVEL


def top_name(path: str) -> str:
    return path.strip('"').partition("/")[0]
