"""Fixtures that every folder of tests shares: a GL context, an ECS world, and sample files.

A test marked ``gl`` draws for real and gets the `gl` fixture without asking for it.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import esper
import pyglet
import pytest

from tifo.engine.errors import GraphicsError

# Settled before any test module imports pyglet.gl, which reads these only once.
pyglet.options["headless"] = sys.platform.startswith("linux")
pyglet.options["shadow_window"] = False
pyglet.options["debug_gl"] = True

_SAMPLES = Path(__file__).resolve().parents[2] / "shared" / "data"
_TRUE = ("1", "true", "yes")
_NOT_DRAWN = "nothing can be drawn here: "


@pytest.fixture(scope="session")
def gl_context() -> Any:
    """The one offscreen context of the session, with GL errors raised at the faulty call."""
    from tifo.engine.gl import create_offscreen_context

    try:
        return create_offscreen_context(debug=True)
    except GraphicsError as error:
        if os.environ.get("CI", "").lower() in _TRUE:
            pytest.fail(f"CI must run the tests that draw: {error}", pytrace=False)
        pytest.skip(f"{_NOT_DRAWN}{error}")


@pytest.fixture
def gl(gl_context: Any) -> Iterator[Any]:
    """The GL context's window, in neutral state; the test must leave no GL error behind."""
    from tifo.engine.gl import check_errors, collect, reset_state

    gl_context.switch_to()
    collect()
    check_errors("preparing the test: an earlier one left them behind")
    reset_state()
    yield gl_context
    try:
        check_errors("running the test")
    finally:
        reset_state()
        collect()


@pytest.fixture(autouse=True)
def _draws_when_marked(request: pytest.FixtureRequest) -> None:
    if request.node.get_closest_marker("gl"):
        request.getfixturevalue("gl")


@pytest.fixture
def esper_world() -> Iterator[str]:
    """The name of a fresh ECS world that is current during the test."""
    before = esper.current_world
    name = f"test-{uuid.uuid4()}"
    esper.switch_world(name)
    yield name
    esper.switch_world(before)
    esper.delete_world(name)


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of sample files beside the checkout."""
    if not _SAMPLES.is_dir():
        pytest.skip(f"the sample files are not there: {_SAMPLES} does not exist")
    return _SAMPLES


@pytest.fixture(scope="session")
def display() -> Iterator[str]:
    """Name of an X display with software GL; skips without Xvfb, and fails in CI."""
    server = shutil.which("Xvfb")
    if server is None:
        message = "window tests need Xvfb: apt-get install xvfb"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    read, write = os.pipe()
    process = subprocess.Popen(
        [server, "-displayfd", str(write), "-screen", "0", "800x600x24", "-nolisten", "tcp"],
        pass_fds=[write],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    with os.fdopen(read) as answer:
        number = answer.readline().strip()
    if not number:
        process.kill()
        pytest.fail("Xvfb did not start")
    yield f":{number}"
    process.terminate()
    process.wait(timeout=10)


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Say in plain sight when nothing was drawn."""
    skipped = terminalreporter.stats.get("skipped", [])
    reasons = [r.longrepr[2] for r in skipped if isinstance(r.longrepr, tuple)]
    causes = [text.partition(_NOT_DRAWN)[2] for text in reasons if _NOT_DRAWN in text]
    if causes:
        terminalreporter.section("tests that draw were SKIPPED")
        terminalreporter.write_line(causes[0])
