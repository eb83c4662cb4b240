from __future__ import annotations

import json
import sys
from collections.abc import Callable
from importlib import metadata
from typing import Any

import pytest

from tifo.cli import doctor, main
from tifo.cli.doctor import Package, check_graphics, check_package
from tifo.engine.assets import spectator
from tifo.engine.gl import doctor as graphics
from tifo.engine.gl.context import ContextInfo
from tifo.engine.gl.doctor import Finding

Pretend = Callable[..., None]

CARD = ContextInfo("A Card", "A Maker", (4, 1), "4.10", False, 8192, 2048, 8)
SOFTWARE = ContextInfo("llvmpipe", "Mesa", (4, 5), "4.50", True, 16384, 2048, 4)
OFFSCREEN, WINDOW = "drawing off screen", "drawing in a window"


@pytest.fixture
def pretend(monkeypatch: pytest.MonkeyPatch) -> Pretend:
    """Decide what graphics the machine has; None for a way that doesn't work."""

    def decide(offscreen: ContextInfo | None, window: ContextInfo | None) -> None:
        findings = [
            Finding(check, info is not None, "works" if info else "is broken: mend it", info)
            for check, info in ((OFFSCREEN, offscreen), (WINDOW, window))
        ]
        monkeypatch.setattr(graphics, "diagnose", lambda: findings)

    return decide


def statuses(**options: Any) -> dict[str, str]:
    return {check.name: check.status for check in check_graphics(**options)}


def test_either_way_of_drawing_is_enough(pretend: Pretend) -> None:
    pretend(CARD, CARD)
    assert statuses(has_display=True) == {OFFSCREEN: "ok", WINDOW: "ok"}
    pretend(None, CARD)
    assert statuses(has_display=True) == {OFFSCREEN: "warning", WINDOW: "ok"}
    pretend(CARD, None)
    assert statuses(has_display=True) == {OFFSCREEN: "ok", WINDOW: "warning"}
    assert statuses(has_display=False) == {OFFSCREEN: "ok", WINDOW: "note"}
    pretend(None, None)
    assert statuses(has_display=False) == {OFFSCREEN: "failed", WINDOW: "failed"}


def test_a_software_renderer_is_warned_of(pretend: Pretend) -> None:
    pretend(SOFTWARE, SOFTWARE)
    assert statuses(has_display=True)["drawing speed"] == "warning"
    pretend(SOFTWARE, CARD)
    assert "drawing speed" not in statuses(has_display=True)


def test_the_driver_is_described(pretend: Pretend) -> None:
    pretend(CARD, None)
    offscreen, window = check_graphics(has_display=True)
    assert offscreen.finding == (
        "works with A Card, OpenGL 4.1, GLSL 4.10; textures to 8192 texels, 2048 layers, 8 samples"
    )
    assert window.finding == "is broken: mend it"
    assert window.fix == "draw off screen: tifo demo --headless"


@pytest.mark.parametrize(
    ("version", "status", "finding"),
    [
        ("2.1.19", "ok", "2.1.19"),
        ("2.10", "ok", "2.10"),
        ("2.1.18", "failed", "2.1.18 is too old"),
        ("3.0.dev1", "failed", "3.0.dev1 is too new"),
        ("2.2+local7", "ok", "2.2+local7"),
    ],
)
def test_versions_are_compared(
    monkeypatch: pytest.MonkeyPatch, version: str, status: str, finding: str
) -> None:
    monkeypatch.setattr(metadata, "version", lambda name: version)
    check = check_package(Package("pyglet", "pyglet", "2.1.19", below="3"))
    assert (check.status, check.finding) == (status, finding)
    assert (check.fix == "pip install 'pyglet>=2.1.19,<3'") == (status == "failed")


def test_a_missing_package_says_what_it_is_for() -> None:
    needed = check_package(Package("no-such-package", "nothing", "1"))
    assert (needed.status, needed.fix) == ("failed", "pip install 'no-such-package>=1'")
    optional = check_package(
        Package("no-such-package", "nothing", "1", without="no clips", extra="demo")
    )
    assert (optional.status, optional.finding) == ("warning", "not installed; no clips")
    assert optional.fix == "pip install 'tifo[demo]'"


def test_a_broken_package_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "trimesh", None)
    check = check_package(Package("trimesh", "trimesh", "5"))
    assert check.status == "failed"
    assert "can't be imported (ModuleNotFoundError" in check.finding
    assert check.fix.startswith("pip install --force-reinstall")


def test_the_exit_code_says_whether_the_demo_can_run(
    pretend: Pretend, capsys: pytest.CaptureFixture[str]
) -> None:
    pretend(CARD, None)
    assert main(["doctor"]) == 0
    assert "The demo can run here." in capsys.readouterr().out
    pretend(None, None)
    assert main(["doctor"]) == 1
    printed = capsys.readouterr().out
    assert "The demo can't run here" in printed
    assert "is broken: mend it" in printed
    assert max(map(len, printed.splitlines())) <= 80


def test_json_is_one_object(pretend: Pretend, capsys: pytest.CaptureFixture[str]) -> None:
    pretend(SOFTWARE, CARD)
    assert main(["doctor", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["ok"] is True
    checks = {check["name"]: check for check in said["checks"]}
    assert checks[OFFSCREEN]["details"]["info"]["max_texture_size"] == 16384
    assert checks["numpy"]["details"]["version"] == metadata.version("numpy")
    assert checks["shaders"]["details"]["files"] > 0
    assert checks["spectator"]["details"]["clips"] > 0


def test_a_damaged_package_is_a_finding(
    pretend: Pretend, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail() -> None:
        raise FileNotFoundError("spectator.glb")

    pretend(CARD, CARD)
    monkeypatch.setattr(spectator, "builtin_spectator", fail)
    monkeypatch.setitem(sys.modules, "tifo.shaders", None)
    assert main(["doctor", "--json"]) == 1
    checks = {check["name"]: check for check in json.loads(capsys.readouterr().out)["checks"]}
    for name in ("shaders", "spectator"):
        assert checks[name]["status"] == "failed"
        assert checks[name]["fix"] == "reinstall tifo: its package is incomplete"


def test_it_speaks_without_rich(
    pretend: Pretend, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pretend(CARD, CARD)
    for name in [name for name in sys.modules if name.partition(".")[0] == "rich"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "rich", None)
    assert main(["doctor"]) == 1
    printed = capsys.readouterr().out
    assert "failed  rich: " in printed
    assert "The demo can't run here" in printed


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="others always have a display")
@pytest.mark.parametrize(
    ("display", "wayland", "status", "word"),
    [(":3", "", "ok", ":3"), ("", "", "note", "none"), ("", "wayland-0", "note", "Xwayland")],
)
def test_the_display(
    pretend: Pretend,
    monkeypatch: pytest.MonkeyPatch,
    display: str,
    wayland: str,
    status: str,
    word: str,
) -> None:
    pretend(CARD, CARD)
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.setenv("WAYLAND_DISPLAY", wayland)
    (check,) = [check for check in doctor.examine() if check.name == "display"]
    assert check.status == status
    assert word in check.finding


def test_missing_fonts_are_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "find_library", lambda name: None)
    check = doctor.check_text(has_display=True)
    assert check.status == "warning"
    assert check.finding == "needs libfontconfig and libfreetype, missing here"
    assert check.fix.endswith("apt-get install libfontconfig1")
    assert doctor.check_text(has_display=False).status == "note"
    monkeypatch.setattr(doctor, "find_library", lambda name: f"lib{name}.so.1")
    assert doctor.check_text(has_display=True).status == "ok"


@pytest.mark.gl
def test_this_machine_can_run_the_demo(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", "--json"]) == 0
    checks = {check["name"]: check for check in json.loads(capsys.readouterr().out)["checks"]}
    assert checks[OFFSCREEN]["details"]["info"]["version"] >= [3, 3]
