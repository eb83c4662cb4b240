"""`make` and the scripts behind it: they parse, and say the right line where something lacks."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
BASH = shutil.which("bash") or ""
MAKE = shutil.which("make") or ""

pytestmark = pytest.mark.skipif(
    sys.platform == "win32" or not BASH, reason="the scripts are for systems with bash"
)
needs_make = pytest.mark.skipif(not MAKE, reason="make is not installed")

Setup = Callable[..., "subprocess.CompletedProcess[str]"]

# Commands that .ci/setup may use as they are.
HARMLESS = ("bash", "cat", "cksum", "dirname", "mktemp", "rm", "tail", "uname")

OLD = "exit 1"
"""A Python that is not new enough: it fails whatever it is asked."""

NO_VENV = """case "$*" in
*ensurepip*) exit 1 ;;
*-venv*) echo python3.12-venv ;;
--version) echo Python 3.12.3 ;;
esac"""
"""Debian's Python without python3-venv."""

GOOD = """case "$*" in
*'-m pip install'*) echo "pip $*" >>"$CALLS"; exit 0 ;;
*'-m venv'*) mkdir -p .venv/bin && cp "$0" .venv/bin/python ;;
-) cat >/dev/null ;;
'- '*) cat >/dev/null; exit "${GL:-0}" ;;
*fontconfig*) exit "${TEXT:-0}" ;;
--version) echo Python 3.12.3 ;;
esac"""
"""A Python that makes environments; what it makes draws if GL is 0, and writes if TEXT is 0."""


@pytest.fixture
def run_setup(tmp_path: Path) -> Setup:
    """Run .ci/setup of a copy of the project on a machine that is made of pretended commands."""
    project, commands = tmp_path / "a project", tmp_path / "bin"
    (project / ".ci").mkdir(parents=True)
    commands.mkdir()
    shutil.copy(ROOT / ".ci" / "setup", project / ".ci")
    shutil.copy(ROOT / "pyproject.toml", project)
    for name in (*HARMLESS, "mkdir", "cp"):
        found = shutil.which(name)
        assert found, name
        (commands / name).symlink_to(found)

    def run(
        target: str,
        user: int = 1000,
        gl: int = 0,
        text: int = 0,
        display: str = "",
        **pretended: str,
    ) -> subprocess.CompletedProcess[str]:
        for name, body in {"id": f"echo {user}", **pretended}.items():
            script = commands / name.replace("python3_", "python3.").replace("_", "-")
            script.write_text(f"#!{BASH}\n{body}\n", "utf-8")
            script.chmod(0o755)
        return subprocess.run(
            [BASH, str(project / ".ci" / "setup"), target],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
            stdin=subprocess.DEVNULL,
            cwd=tmp_path,
            env={
                "PATH": str(commands),
                "CALLS": str(tmp_path / "calls"),
                "GL": str(gl),
                "TEXT": str(text),
                "DISPLAY": display,
            },
        )

    return run


@pytest.mark.parametrize("name", ["setup", "run"])
def test_the_scripts_parse(name: str) -> None:
    script = ROOT / ".ci" / name
    assert os.access(script, os.X_OK)
    subprocess.run([BASH, "-n", str(script)], check=True, timeout=60)


def recipe(target: str) -> str:
    """The commands that make would run."""
    return subprocess.run(
        [MAKE, "--no-print-directory", "-C", str(ROOT), "-n", target],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    ).stdout


@needs_make
def test_make_test_lints_checks_types_and_tests() -> None:
    steps = ["ruff format --check", "ruff check", "-m mypy", ".ci/setup test", '-m "not slow"']
    places = [recipe("test").find(step) for step in steps]
    assert -1 not in places
    assert places == sorted(places)
    assert '-m "slow or not slow"' in recipe("test-all")
    assert ".ci/setup demo" in recipe("demo")


@needs_make
def test_make_alone_lists_the_targets() -> None:
    listed = subprocess.run(
        [MAKE, "--no-print-directory", "-C", str(ROOT)],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    ).stdout
    names = re.findall(r"^  make (\S+) +\S", listed, re.MULTILINE)
    assert set(names) == {"help", "demo", "bench", "pictures", "test", "test-all", "lint", "clean"}


def test_the_setup_explains_a_missing_python(run_setup: Setup) -> None:
    process = run_setup("demo", python3=OLD, python=OLD)
    assert process.returncode == 1
    assert process.stdout == ""
    assert "Python 3.11 or newer is needed" in process.stderr
    assert "sudo apt-get install -y --no-install-recommends python3 python3-venv" in process.stderr


def test_the_setup_names_the_package_that_makes_environments(run_setup: Setup) -> None:
    process = run_setup("demo", python3=NO_VENV, apt_get="exit 9")
    assert process.returncode == 1
    line = "sudo apt-get install -y --no-install-recommends python3.12-venv"
    assert process.stderr.strip() == (f"tifo: python3 can't make virtual environments; run: {line}")


def test_the_setup_prefers_a_python_that_makes_environments(
    run_setup: Setup, tmp_path: Path
) -> None:
    process = run_setup("lint", python3_13=NO_VENV, python3_12=OLD, python3=GOOD)
    assert process.returncode == 0, process.stderr
    made = tmp_path / "a project" / ".venv" / "bin" / "python"
    assert GOOD in made.read_text("utf-8")


def test_root_gets_the_package_that_makes_environments(run_setup: Setup, tmp_path: Path) -> None:
    process = run_setup("demo", user=0, python3=NO_VENV, apt_get='echo "$*" >>"$CALLS"')
    assert "apt" not in process.stdout
    calls = (tmp_path / "calls").read_text("utf-8").splitlines()
    assert calls[0].startswith("update")
    assert calls[1].startswith("install")
    assert calls[1].endswith(" python3.12-venv")
    assert process.returncode == 1  # the pretended one lacks it still
    assert "lacks the modules venv and ensurepip" in process.stderr


def test_the_setup_installs_once(run_setup: Setup, tmp_path: Path) -> None:
    for _ in range(2):
        process = run_setup("lint", python3=GOOD)
        assert process.returncode == 0, process.stderr
    assert process.stderr == ""
    assert run_setup("demo", python3=GOOD).returncode == 0
    (call,) = (tmp_path / "calls").read_text("utf-8").splitlines()
    assert call.endswith("--editable .[demo,test]")


def test_a_changed_pyproject_is_installed_again(run_setup: Setup, tmp_path: Path) -> None:
    run_setup("demo", python3=GOOD)
    with (tmp_path / "a project" / "pyproject.toml").open("a", encoding="utf-8") as file:
        file.write("\n# changed\n")
    run_setup("demo", python3=GOOD)
    assert len((tmp_path / "calls").read_text("utf-8").splitlines()) == 2


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="apt-get is for Linux")
def test_without_gl_the_line_that_installs_it_is_said(run_setup: Setup) -> None:
    process = run_setup("demo", gl=1, python3=GOOD, apt_get="exit 9")
    assert process.returncode == 1
    line = "libegl1 libgl1 libgl1-mesa-dri libglx-mesa0"
    assert process.stderr.splitlines()[-1] == (
        f"tifo: run: sudo apt-get install -y --no-install-recommends {line}"
    )


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="apt-get is for Linux")
def test_without_gl_and_apt_the_libraries_are_named(run_setup: Setup) -> None:
    process = run_setup("test", gl=1, python3=GOOD)
    assert process.returncode == 1
    assert "install libEGL, libGL and Mesa's drivers" in process.stderr


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="apt-get is for Linux")
def test_root_gets_gl(run_setup: Setup, tmp_path: Path) -> None:
    process = run_setup("test", user=0, gl=1, python3=GOOD, apt_get='echo "$*" >>"$CALLS"')
    installed = (tmp_path / "calls").read_text("utf-8").splitlines()[-1]
    assert installed.startswith("install -qq -y --no-install-recommends")
    assert installed.endswith("libegl1 libgl1 libgl1-mesa-dri libglx-mesa0")
    assert process.returncode == 1  # the pretended machine still can't draw
    assert "OpenGL still does not work here" in process.stderr


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Xvfb is for Linux")
def test_no_display_is_no_error(run_setup: Setup) -> None:
    process = run_setup("test", python3=GOOD, apt_get="exit 9")
    assert process.returncode == 0
    assert "tests that open a window are skipped" in process.stderr
    assert process.stderr.strip().endswith("--no-install-recommends xvfb xauth libfontconfig1")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="fontconfig is for Linux")
def test_windows_need_fontconfig(run_setup: Setup, tmp_path: Path) -> None:
    assert run_setup("demo", text=1, python3=GOOD).returncode == 0
    process = run_setup("demo", text=1, display=":0", python3=GOOD, apt_get="exit 9")
    assert process.returncode == 1
    assert process.stderr.splitlines()[-1] == (
        "tifo: run: sudo apt-get install -y --no-install-recommends libfontconfig1"
    )
    record = 'echo "$*" >>"$CALLS"'
    process = run_setup(
        "test", user=0, text=1, python3=GOOD, apt_get=record, xvfb_run="true", xauth="true"
    )
    assert process.returncode == 0, process.stderr
    installed = (tmp_path / "calls").read_text("utf-8").splitlines()[-1]
    assert installed.endswith(" libfontconfig1")


def test_a_wrong_target_is_refused(run_setup: Setup) -> None:
    process = run_setup("paint", python3=GOOD)
    assert process.returncode == 1
    assert "usage: .ci/setup demo|lint|test" in process.stderr
