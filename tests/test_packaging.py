"""The package that users install holds what the tree holds."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
import tomllib
import venv
import zipfile
from dataclasses import dataclass
from importlib import import_module, metadata
from pathlib import Path
from typing import Any

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
CONFIG: dict[str, Any] = PROJECT["tool"]["setuptools"]

# Own folders of the import name; the others are links to the folders of the mapping.
OWN = ("tifo", "tifo.cli")


@dataclass(frozen=True)
class Built:
    wheel: Path
    sdist: Path


def folder_of(package: str) -> Path:
    """Where a package lies in the tree: ``tifo.engine.gl`` in ``engine/gl``."""
    for name, folder in CONFIG["package-dir"].items():
        if package == name or package.startswith(f"{name}."):
            return ROOT.joinpath(folder, *package.removeprefix(name).split(".")[1:])
    return ROOT.joinpath(*package.split("."))


def tree_files() -> set[str]:
    """Paths in the wheel of all code and data that lie in the packages' folders."""
    found = set()
    for package in CONFIG["packages"]:
        folder = folder_of(package)
        prefix = package.replace(".", "/")
        found |= {f"{prefix}/{path.name}" for path in folder.glob("*.py")}
    shaders = folder_of("tifo.shaders")
    for path in shaders.rglob("*.glsl"):
        found.add(f"tifo/shaders/{path.relative_to(shaders).as_posix()}")
    for path in folder_of("tifo.engine").rglob("*.glb"):
        found.add(f"tifo/engine/{path.relative_to(folder_of('tifo.engine')).as_posix()}")
    for path in (folder_of("tifo.engine.behaviour") / "tables").glob("*.toml"):
        found.add(f"tifo/engine/behaviour/tables/{path.name}")
    return found | {"tifo/py.typed"}


def has_build_backend() -> bool:
    """Whether the wheel can be built here without a download."""
    try:
        return int(metadata.version("setuptools").split(".")[0]) >= 80
    except metadata.PackageNotFoundError:
        return False


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    """The sdist of the tree, and the wheel of that sdist."""
    pytest.importorskip("build")
    target = tmp_path_factory.mktemp("dist")
    # A copy, because builds leave files beside the sources and read those of earlier ones.
    source = tmp_path_factory.mktemp("source")
    ignore = shutil.ignore_patterns("__pycache__")
    for folder in ("tifo", *CONFIG["package-dir"].values()):
        shutil.copytree(ROOT / folder, source / folder, symlinks=True, ignore=ignore)
    for path in ROOT.iterdir():
        if path.is_file():
            shutil.copy(path, source)
    isolation = ["--no-isolation"] if has_build_backend() else []
    process = subprocess.run(
        [sys.executable, "-m", "build", *isolation, "--outdir", str(target), str(source)],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert process.returncode == 0, process.stdout + process.stderr
    (wheel,), (sdist,) = target.glob("*.whl"), target.glob("*.tar.gz")
    return Built(wheel, sdist)


def test_every_package_folder_is_declared() -> None:
    found = set(OWN)
    for name, folder in CONFIG["package-dir"].items():
        for init in (ROOT / folder).rglob("__init__.py"):
            found.add(".".join((name, *init.parent.relative_to(ROOT / folder).parts)))
    assert found == set(CONFIG["packages"])


def test_every_folder_with_code_is_a_package() -> None:
    for folder in (*CONFIG["package-dir"].values(), "tifo/cli"):
        for path in (ROOT / folder).rglob("*.py"):
            assert (path.parent / "__init__.py").is_file(), path


def test_links_match_the_mapping() -> None:
    for name, folder in CONFIG["package-dir"].items():
        module = import_module(name)
        assert module.__file__ is not None
        assert Path(module.__file__).resolve() == ROOT / folder / "__init__.py"
        assert (ROOT / "tifo" / folder).resolve() == ROOT / folder
    links = {path.name for path in (ROOT / "tifo").iterdir() if path.is_symlink()}
    assert links == set(CONFIG["package-dir"].values())


def test_the_doctor_asks_for_what_the_package_asks_for() -> None:
    from tifo.cli.doctor import PACKAGES

    asked = {
        f"{package.name}>={package.at_least}" + (f",<{package.below}" if package.below else "")
        for package in PACKAGES
        if not package.extra
    }
    assert asked == set(PROJECT["project"]["dependencies"])
    extras = PROJECT["project"]["optional-dependencies"]
    for package in PACKAGES:
        if package.extra:
            assert f"{package.name}>={package.at_least}" in extras[package.extra]


def test_the_wheel_holds_the_tree(built: Built) -> None:
    with zipfile.ZipFile(built.wheel) as wheel:
        held = {name for name in wheel.namelist() if ".dist-info/" not in name}
    assert held == tree_files()
    assert {Path(name).suffix for name in held} == {".py", ".glsl", ".glb", ".toml", ".typed"}


def test_the_sdist_holds_what_the_wheel_needs(built: Built) -> None:
    with tarfile.open(built.sdist) as sdist:
        held = {name.partition("/")[2] for name in sdist.getnames()}
    for package in CONFIG["packages"]:
        folder = folder_of(package).relative_to(ROOT).as_posix()
        assert f"{folder}/__init__.py" in held
    for wanted in (
        "tifo/py.typed",
        "engine/assets/spectator/spectator.glb",
        "shaders/lib/skin.glsl",
        "pyproject.toml",
        "LICENSE",
    ):
        assert wanted in held


def test_the_wheel_runs_in_a_fresh_environment(built: Built, tmp_path: Path) -> None:
    home = tmp_path / "venv"
    venv.create(home, with_pip=False)
    python = home / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    install = [sys.executable, "-m", "pip", "--python", str(python), "install", "--quiet"]
    subprocess.run([*install, "--no-deps", "--no-index", built.wheel], check=True, timeout=120)
    # What tifo depends on is borrowed from here, behind the environment's own folders.
    borrowed = str(Path(np.__file__).parents[1])
    code = (
        f"import sys; sys.path.append({borrowed!r})\n"
        "import tifo\n"
        "from tifo.cli import main\n"
        "print(tifo.__file__)\n"
        "print(tifo.builtin_spectator().skeleton.joint_count)\n"
        "main(['--version'])\n"
    )
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    process = subprocess.run(
        [str(python), "-c", code],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        cwd=tmp_path,
        env=environment,
    )
    assert process.returncode == 0, process.stderr
    place, joints, version = process.stdout.split("\n")[:3]
    assert Path(place).is_relative_to(home.resolve()) or Path(place).is_relative_to(home)
    assert int(joints) > 0
    assert version == f"tifo {metadata_version(built.wheel)}"


def metadata_version(wheel: Path) -> str:
    """The version in a wheel's file name."""
    return wheel.name.split("-")[1]
