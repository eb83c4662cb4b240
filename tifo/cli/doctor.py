"""Check graphics, drivers and dependencies, and say what to fix.

Exit code 0 if the demo can run here, in a window or off screen, and 1 if not.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import sys
from collections.abc import Iterator, Mapping
from ctypes.util import find_library
from dataclasses import asdict, dataclass, field
from importlib import import_module, metadata
from importlib.resources import files
from typing import Literal

from .text import printable

Status = Literal["ok", "note", "warning", "failed"]
"""What it means for the demo: all is well; well without it; it will do less; it can't run."""


@dataclass(frozen=True, slots=True)
class Check:
    """The outcome of one check.

    Parameters
    ----------
    name
        What was looked at.
    status
        See `Status`.
    finding
        What was found.
    fix
        What to do about it; empty if nothing needs to be done.
    details
        The finding's figures for programs.
    """

    name: str
    status: Status
    finding: str
    fix: str = ""
    details: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Package:
    """A package that tifo uses.

    Parameters
    ----------
    name, module
        What pip and what Python call it.
    at_least
        Oldest version that will do.
    below
        First version that will not, or empty.
    without
        What can't be done without it; empty if nothing can.
    extra
        The extra of tifo that brings an optional one.
    """

    name: str
    module: str
    at_least: str
    below: str = ""
    without: str = ""
    extra: str = ""


PACKAGES = (
    Package("esper", "esper", "3.9"),
    Package("fast_simplification", "fast_simplification", "0.1.7"),
    Package("numpy", "numpy", "1.26"),
    Package("pillow", "PIL", "10.3"),
    Package("pyglet", "pyglet", "2.1.19", below="3"),
    Package("rich", "rich", "13.7"),
    Package("trimesh", "trimesh", "5"),
    Package("av", "av", "12", without="no clips are written", extra="demo"),
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of ``tifo doctor``."""
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(options: argparse.Namespace) -> int:
    """Check this machine and print the outcome; the exit code."""
    checks = list(examine())
    ok = all(check.status != "failed" for check in checks)
    if options.json:
        print(json.dumps({"ok": ok, "checks": [asdict(check) for check in checks]}))
    else:
        _print_table(checks, ok)
    return 0 if ok else 1


def examine() -> Iterator[Check]:
    """Look at everything the demo needs, what is needed first first."""
    yield _check_python()
    for package in PACKAGES:
        yield check_package(package)
    yield _check_shaders()
    yield _check_spectator()
    display = _check_display()
    yield display
    if sys.platform.startswith("linux"):
        yield check_text(has_display=display.status == "ok")
    yield from check_graphics(has_display=display.status == "ok")


def check_package(package: Package) -> Check:
    """Whether a package is installed, new enough and can be imported."""
    wanted = f"{package.name}>={package.at_least}" + (f",<{package.below}" if package.below else "")
    fix = f"pip install '{wanted}'"
    if package.extra:
        fix = f"pip install 'tifo[{package.extra}]'"
    status: Status = "warning" if package.extra else "failed"
    lack = f"; {package.without}" if package.without else ""
    try:
        version = metadata.version(package.name)
    except metadata.PackageNotFoundError:
        return Check(package.name, status, f"not installed{lack}", fix, {"version": None})
    details = {"version": version}
    if _parts(version) < _parts(package.at_least):
        return Check(package.name, status, f"{version} is too old{lack}", fix, details)
    if package.below and _parts(version) >= _parts(package.below):
        return Check(package.name, status, f"{version} is too new{lack}", fix, details)
    try:
        import_module(package.module)
    except Exception as error:  # a broken package may raise anything
        finding = f"{version} can't be imported ({type(error).__name__}: {error}){lack}"
        repair = f"pip install --force-reinstall '{wanted}'"
        return Check(package.name, status, finding, repair, details)
    return Check(package.name, "ok", version, details=details)


def check_text(*, has_display: bool) -> Check:
    """Whether text can be written in windows on Linux, where pyglet asks fontconfig for fonts."""
    absent = [name for name in ("fontconfig", "freetype") if not find_library(name)]
    if not absent:
        return Check("text in windows", "ok", "fontconfig and freetype")
    libraries = " and ".join(f"lib{name}" for name in absent)
    fix = "on Debian or Ubuntu: apt-get install libfontconfig1"
    status: Status = "warning" if has_display else "note"
    return Check("text in windows", status, f"needs {libraries}, missing here", fix)


def check_graphics(*, has_display: bool) -> Iterator[Check]:
    """Try to draw off screen and in a window; either is enough for the demo."""
    from ..engine.gl.doctor import diagnose

    findings = diagnose()
    can_draw = any(finding.ok for finding in findings)
    infos = [finding.info for finding in findings if finding.ok and finding.info is not None]
    for finding in findings:
        details: dict[str, object] = {
            "info": None if finding.info is None else asdict(finding.info)
        }
        if finding.ok and finding.info is not None:
            info = finding.info
            message = (
                f"works with {info.renderer}, OpenGL {info.version[0]}.{info.version[1]}, "
                f"GLSL {info.glsl_version}; textures to {info.max_texture_size} texels, "
                f"{info.max_array_layers} layers, {info.max_samples} samples"
            )
            yield Check(finding.check, "ok", message, details=details)
        elif not can_draw:
            yield Check(finding.check, "failed", finding.message, details=details)
        elif "window" in finding.check and not has_display:
            yield Check(finding.check, "note", "needs a display", details=details)
        else:
            fix = "draw off screen: tifo demo --headless" if "window" in finding.check else ""
            yield Check(finding.check, "warning", finding.message, fix, details)
    if infos and all(info.is_software for info in infos):
        yield Check(
            "drawing speed",
            "warning",
            "a software renderer draws here: few spectators in real time",
            "install the GPU's driver if there is a GPU, or fill fewer seats: tifo demo --seats",
        )


def _check_python() -> Check:
    version = platform.python_version()
    finding = f"{version}, {platform.platform(terse=True)}"
    details = {"version": version, "executable": sys.executable, "platform": platform.platform()}
    return Check("Python", "ok", finding, details=details)


def _check_shaders() -> Check:
    try:
        folder = files(import_module("tifo.shaders"))
        found = [
            entry.read_text("utf-8")
            for sub in folder.iterdir()
            if sub.is_dir()
            for entry in sub.iterdir()
            if entry.name.endswith(".glsl")
        ]
    except (ImportError, OSError, UnicodeDecodeError) as error:
        return Check("shaders", "failed", f"can't be read: {error}", _REINSTALL)
    if not found or not all(found):
        return Check("shaders", "failed", "some are missing or empty", _REINSTALL)
    return Check("shaders", "ok", f"{len(found)} files", details={"files": len(found)})


def _check_spectator() -> Check:
    from ..engine.assets.spectator import builtin_spectator

    try:
        spectator = builtin_spectator()
    except Exception as error:  # a damaged file, a missing one, or a package that it needs
        return Check("spectator", "failed", f"can't be loaded: {error}", _REINSTALL)
    joints, clips = spectator.skeleton.joint_count, len(spectator.clips)
    return Check(
        "spectator",
        "ok",
        f"{joints} joints, {clips} clips, {spectator.triangle_count:,} triangles",
        details={"joints": joints, "clips": clips, "triangles": spectator.triangle_count},
    )


def _check_display() -> Check:
    if sys.platform in ("win32", "darwin"):
        return Check("display", "ok", "the desktop")
    name = os.environ.get("DISPLAY", "")
    if name:
        return Check("display", "ok", f"DISPLAY is {name}", details={"display": name})
    finding = "none (DISPLAY is not set); the demo draws off screen"
    if os.environ.get("WAYLAND_DISPLAY"):
        finding = "Wayland without Xwayland (DISPLAY is not set), which windows need"
    fix = "for a window start it from a desktop session, or under xvfb-run"
    return Check("display", "note", finding, fix, {"display": None})


def _parts(version: str) -> tuple[int, ...]:
    """Leading numbers of a version: (2, 1, 19) of ``"2.1.19rc1"``."""
    return tuple(int(part) for part in re.findall(r"\d+", version.split("+")[0])[:3])


_REINSTALL = "reinstall tifo: its package is incomplete"

_STYLES: dict[Status, str] = {"ok": "green", "note": "cyan", "warning": "yellow", "failed": "red"}


def _print_table(checks: list[Check], ok: bool) -> None:
    verdict = "The demo can run here." if ok else "The demo can't run here: see what failed."
    try:
        from rich import box
        from rich.console import Console
        from rich.table import Table
        from rich.text import Text
    except ImportError:
        for check in checks:
            fix = f" -> {check.fix}" if check.fix else ""
            print(printable(f"{check.status:8}{check.name}: {check.finding}{fix}"))
        print(verdict)
        return
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("status")
    table.add_column("check", no_wrap=True)
    table.add_column("finding and what to do")
    for check in checks:
        text = Text(printable(check.finding))
        if check.fix:
            text.append(f"\nto fix: {check.fix}", style="bold")
        status = Text(check.status, style=_STYLES[check.status])
        table.add_row(status, check.name, text)
    console = Console(highlight=False)
    console.print(table)
    console.print(verdict, style="green" if ok else "bold red")
