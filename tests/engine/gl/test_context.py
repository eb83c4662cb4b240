from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from typing import Any

import pytest

from tifo.engine.errors import GraphicsError
from tifo.engine.gl import create_offscreen_context, describe_context, open_window
from tifo.engine.gl import doctor as doctor_module
from tifo.engine.gl.doctor import Finding, diagnose
from tifo.engine.gl.explain import explained

on_linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="EGL and X11 only")

Run = Callable[..., str]

ENV = {
    **{name: v for name, v in os.environ.items() if name not in ("DISPLAY", "PYGLET_HEADLESS")},
    "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
}

MISSING_LIBRARY = """
import pyglet.lib
def refuse(*names, **options):
    raise ImportError('Library "EGL" not found.')
pyglet.lib.load_library = refuse
"""
OFFSCREEN = "from tifo.engine.gl import create_offscreen_context as make; make()"
WINDOW = "from tifo.engine.gl import open_window as make; make()"


@pytest.fixture
def fails_with() -> Run:
    """Return the sentence of the GraphicsError that code ends with in a process of its own."""

    def run(code: str, env: Mapping[str, str] | None = None) -> str:
        process = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
            env={**ENV, **(env or {})},
        )
        last = process.stderr.strip().splitlines()[-1]
        assert "GraphicsError: " in last, process.stderr
        return last.split("GraphicsError: ")[1]

    return run


@pytest.mark.gl
def test_the_context_is_described(gl_context: Any) -> None:
    info = describe_context()
    assert info.version >= (3, 3)
    assert info.renderer
    assert info.is_software == ("llvmpipe" in info.renderer.lower())
    assert info.max_texture_size >= 1024
    assert info.max_array_layers >= 256


@pytest.mark.gl
def test_a_second_offscreen_context_is_the_first(gl_context: Any) -> None:
    assert create_offscreen_context((300, 200)) is gl_context


@pytest.mark.gl
@on_linux
def test_a_window_can_not_follow_an_offscreen_context(gl_context: Any) -> None:
    with pytest.raises(GraphicsError, match="open the window before any offscreen context"):
        open_window()


@pytest.mark.parametrize("size", [(0, 10), (10, -1)])
def test_sizes_are_checked(size: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match="size is"):
        create_offscreen_context(size)
    with pytest.raises(ValueError, match="size is"):
        open_window(size)
    with pytest.raises(ValueError, match="samples is -1"):
        open_window(samples=-1)


def test_the_package_is_imported_without_pyglet() -> None:
    code = "import sys; sys.modules['pyglet'] = None; import tifo.engine.gl, tifo.engine.gl.doctor"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60, env=ENV)


def test_graphics_objects_without_a_context(fails_with: Run) -> None:
    message = fails_with("from tifo.engine.gl import Buffer; Buffer(4)")
    assert "call create_offscreen_context() before" in message


@on_linux
def test_a_missing_library_says_what_to_install(fails_with: Run) -> None:
    message = fails_with(MISSING_LIBRARY + OFFSCREEN)
    assert "install libegl1 libgl1 libgl1-mesa-dri" in message
    assert 'Library "EGL" not found' in message


@on_linux
def test_no_display_names_the_switch(fails_with: Run) -> None:
    assert "no display was found; " in fails_with(WINDOW)
    assert "--headless" in fails_with(WINDOW, {"DISPLAY": ":9999"})


@on_linux
def test_pyglet_loaded_for_windows_without_a_display(fails_with: Run) -> None:
    code = "import pyglet; pyglet.options.shadow_window = False; import pyglet.window\n"
    assert "set PYGLET_HEADLESS=1" in fails_with(code + OFFSCREEN)


@pytest.mark.gl
def test_too_old_a_driver_says_so(fails_with: Run) -> None:
    if "llvmpipe" not in describe_context().renderer:
        pytest.skip("only Mesa can play an older driver")
    message = fails_with(OFFSCREEN, {"MESA_GL_VERSION_OVERRIDE": "3.0"})
    assert "refuses OpenGL 3.3" in message
    assert "LIBGL_ALWAYS_SOFTWARE=1" in message


def test_other_failures_become_one_sentence() -> None:
    class NoSuchConfigException(Exception):  # noqa: N818
        """Named like pyglet's."""

    with (
        pytest.raises(GraphicsError, match="no driver offers 8 bit RGBA") as caught,
        explained("a thing", windowed=False),
    ):
        raise NoSuchConfigException("none")
    assert "\n" not in str(caught.value)
    with (
        pytest.raises(GraphicsError, match=r"did not start \(AttributeError: broke off\)"),
        explained("a thing", windowed=False),
    ):
        raise AttributeError("broke\n  off.")


@on_linux
@pytest.mark.skipif(not os.environ.get("DISPLAY"), reason="no display: run under xvfb-run")
def test_a_window_opens_with_fewer_samples_than_wanted() -> None:
    code = (
        "from tifo.engine.gl import *\n"
        "window = open_window((64, 48), samples=1024, visible=False)\n"
        "assert window.get_framebuffer_size() == (64, 48)\n"
        "assert window.config.depth_size >= 24\n"
        "assert describe_context().version >= (3, 3)\n"
    )
    env = {**ENV, "DISPLAY": os.environ["DISPLAY"]}
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60, env=env)


@pytest.mark.gl
def test_diagnosis_of_a_machine_that_draws() -> None:
    offscreen, window = diagnose()
    assert offscreen.ok, offscreen
    assert offscreen.info is not None
    assert offscreen.info.version >= (3, 3)
    assert offscreen.info.renderer in offscreen.message
    assert window.ok == (window.info is not None)
    assert isinstance(window.message, str)


@pytest.mark.parametrize(
    ("code", "timeout", "message"),
    [
        ("import os; os.abort()", 30.0, "the graphics driver crashed (SIGABRT)"),
        ("import time; print(%r); time.sleep(60)", 0.5, "did not answer within 0.5 s"),
        ("raise SystemExit('out of luck')", 30.0, "ended with code 1: out of luck"),
        ("print(%r)", 30.0, "ended with code 0: it said nothing"),
    ],
)
def test_diagnosis_survives_broken_drivers(
    monkeypatch: pytest.MonkeyPatch, code: str, timeout: float, message: str
) -> None:
    if "SIGABRT" in message and sys.platform == "win32":
        pytest.skip("Windows has exit codes instead of signals")
    monkeypatch.setattr(doctor_module, "_CODE", code if "%r" in code else f"{code} # %r")
    monkeypatch.setattr(doctor_module, "_CHECKS", {"offscreen": "drawing off screen"})
    (finding,) = diagnose(timeout)
    assert not finding.ok
    assert finding.info is None
    assert message in finding.message


def test_diagnosis_survives_a_missing_interpreter(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "/no/such/python")
    assert [finding.ok for finding in diagnose()] == [False, False]


def test_findings_come_back_whole(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse() -> None:
        raise GraphicsError("no luck")

    monkeypatch.setattr(doctor_module, "create_offscreen_context", refuse)
    doctor_module.probe("offscreen")
    printed = capsys.readouterr().out
    monkeypatch.setattr(doctor_module, "_CODE", f"import sys; sys.stdout.write({printed!r}) # %r")
    monkeypatch.setattr(doctor_module, "_CHECKS", {"offscreen": "drawing off screen"})
    assert diagnose() == [Finding("drawing off screen", False, "no luck")]
