"""Crowds in real windows on a virtual display: several contexts, closed and opened again."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.gl

BEGIN = """
import gc
import esper
import numpy as np
import pyglet
pyglet.options.debug_gl = True
from pyglet import gl
from pyglet.math import Mat4, Vec3
import tifo
from tifo.engine.gl import collect, live_objects

spec = tifo.CrowdSpec(layout="stand", rows=3, columns=8, streams=16, history=14, seed=2)
crowds = []
for seed in (2, 3):
    one = spec.replace(seed=seed)
    crowds.append(tifo.spawn_crowd(one, tifo.build_seats(one), tifo.builtin_spectator()))
for system in crowds[0].systems():
    esper.add_processor(system)
place = Mat4.from_translation(Vec3(0, 0, -12))
view = Mat4.look_at(Vec3(6, 6, 14), Vec3(6, 2, 0), Vec3(0, 1, 0))
projection = Mat4.perspective_projection(4 / 3, 0.1, 300.0, 45)

def window():
    config = gl.Config(major_version=3, minor_version=3, depth_size=24, double_buffer=True)
    return pyglet.window.Window(160, 120, config=config, vsync=False)

def draw(one, which):
    one.switch_to()
    gl.glClearColor(0, 0, 0, 1)
    one.clear()
    for crowd, at in which:
        crowd.draw(view, projection, world_from_crowd=at)
    pixels = (gl.GLubyte * (160 * 120 * 3))()
    gl.glReadBuffer(gl.GL_BACK)
    gl.glPixelStorei(gl.GL_PACK_ALIGNMENT, 1)
    gl.glReadPixels(0, 0, 160, 120, gl.GL_RGB, gl.GL_UNSIGNED_BYTE, pixels)
    one.flip()
    return np.frombuffer(pixels, np.uint8).reshape(120, 160, 3).astype(int)

both = [(crowds[0], None), (crowds[1], place)]
"""

TWO = (
    BEGIN
    + """
first, second = window(), window()
for frame in range(6):
    esper.process(1 / 30)
    shown = [draw(first, both), draw(second, both)]
    assert shown[0].std() > 10
    assert (shown[0] == shown[1]).all(), frame
# One window is drawn every frame and the other seldom: neither misses what the other was told.
for frame in range(5):
    esper.process(1 / 30)
    often = draw(first, both)
crowds[0].send(tifo.Goal(side=0))
for frame in range(20):
    esper.process(1 / 30)
    often = draw(first, both)
assert (draw(second, both) == often).all()
# Another window with only one of them.
alone = draw(second, both[:1])
assert 0 < (alone != often).any(axis=2).mean() < 0.9
for crowd in crowds:
    crowd.release_graphics()
for one in (first, second):
    one.switch_to()
    collect()
print(live_objects())
"""
)

AGAIN = (
    BEGIN
    + """
def names():
    tests = (gl.glIsBuffer, gl.glIsTexture, gl.glIsProgram, gl.glIsVertexArray)
    return [sum(bool(test(name)) for name in range(1, 400)) for test in tests]

keeper = window()
keeper.switch_to()
plain = names()
pictures = []
counts = []
for time in range(3):
    guest = window()
    pictures.append(draw(guest, both))
    counts.append(live_objects())
    guest.close()
    del guest
    # Nothing is told; the next picture in another window finds it out.
    keeper.switch_to()
    draw(keeper, both)
    gc.collect()
    collect()
    kept = names(), live_objects()
    if time == 0:
        first = kept
    assert kept == first, (kept, first)
assert counts[1] == counts[2], counts
assert (pictures[0] == pictures[1]).all() and (pictures[1] == pictures[2]).all()
assert pictures[0].std() > 10
for crowd in crowds:
    crowd.release_graphics()
assert names() == plain, (names(), plain)
print(live_objects())
"""
)

ALONE = (
    "import pyglet\npyglet.options.shadow_window = False\n"
    + BEGIN
    + """
shown = []
for time in range(3):
    only = window()
    shown.append(draw(only, both))
    only.close()
    assert gl.current_context is None
assert (shown[0] == shown[2]).all() and shown[0].std() > 10
del only
for crowd in crowds:
    crowd.release_graphics()
gc.collect()
collect()
print(live_objects())
"""
)

RUN = """
import sys, gc
import tifo
from tifo.engine.gl import collect, live_objects

class Main(tifo.Node3D):
    frames: int = 0
    def _process(self, delta):
        self.frames += 1
        if self.frames == 6:
            self.tree.quit(7)

def scene():
    main = Main(name="Main")
    stadium = main.add_child(tifo.Stadium(name="Stadium", layout="stand", rows=3, columns=8,
                                          streams=16, history=14))
    stadium.add_child(tifo.Camera(name="Camera", preset="close"))
    return main

for time in range(2):
    code = tifo.run(scene(), size=(160, 120), vsync=False, screenshot=sys.argv[1])
    assert code == 7, code
assert tifo.run(scene(), size=(160, 120), vsync=False, seconds=0.01) == 0
gc.collect(); collect()
print(live_objects())
"""


def run(display: str, code: str, *words: str) -> str:
    environment = {**os.environ, "DISPLAY": display, "PYGLET_HEADLESS": ""}
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, sys.path))
    done = subprocess.run(
        [sys.executable, "-c", code, *words],
        capture_output=True,
        text=True,
        env=environment,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_two_crowds_in_two_windows(display: str) -> None:
    assert run(display, TWO) == "{}"


def test_a_window_that_is_closed_and_opened_again_beside_another(display: str) -> None:
    assert run(display, AGAIN) == "{}"


def test_the_only_window_is_closed_and_opened_again(display: str) -> None:
    assert run(display, ALONE) == "{}"


def test_run_opens_a_window_and_closes_it_again(display: str, tmp_path: object) -> None:
    assert run(display, RUN, f"{tmp_path}/last.png") == "{}"
