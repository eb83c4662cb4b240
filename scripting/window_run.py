"""`tifo.run`: a scene in a window of its own, or without one, from opening to closing."""

from __future__ import annotations

import sys
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..engine.clock import BASE_RATE
from ..engine.crowd.cameras import camera_presets
from ..engine.gl.context import create_offscreen_context, open_window
from ..engine.gl.objects import collect
from .camera import FreeCamera
from .hot_reload import HotReload
from .lifecycle import below
from .node import Node
from .nodes import Camera, Stadium
from .packed_scene import PackedScene
from .reports import Report
from .stage import Stage, Viewpoint
from .tree import SceneTree
from .window_input import WindowInput


class Picture:
    """The picture of a tree: its first stadium, seen by its camera.

    The stage is made when there is a stadium, and anew when the stadium was rebuilt or another
    scene has another one.

    Parameters
    ----------
    tree
        What is drawn.
    size
        Pixels (width, height).
    samples
        Samples a pixel, fewer if the driver has fewer.
    """

    def __init__(self, tree: SceneTree, size: tuple[int, int], samples: int) -> None:
        self._tree, self._size, self._samples = tree, size, samples
        self._stage: Stage | None = None
        self._camera: tuple[Stage, FreeCamera] | None = None

    def draw(self) -> Stage | None:
        """Draw the picture; the stage that has it, or None without a stadium."""
        stadium = next((n for n in below(self._tree.root) if isinstance(n, Stadium)), None)
        simulation = stadium._simulation if stadium is not None else None
        if self._stage is not None and self._stage.simulation is not simulation:
            self.close()
        if stadium is None or simulation is None:
            return None
        if self._stage is None:
            self._stage = Stage(simulation, self._size, samples=self._samples)
        placed = stadium.global_transform
        unmoved = bool((placed == np.eye(4)).all())
        self._stage.show(self._viewpoint(self._stage), None if unmoved else placed)
        return self._stage

    def resize(self, size: tuple[int, int]) -> None:
        """Draw pictures of another size from now on."""
        self._size = size
        if self._stage is not None:
            self._stage.resize(size)

    def close(self) -> None:
        """Delete everything on the GPU."""
        if self._stage is not None:
            self._stage.close()
            self._stage = None
        collect()

    def _viewpoint(self, stage: Stage) -> Viewpoint:
        cameras = [node for node in below(self._tree.root) if isinstance(node, Camera)]
        chosen = next((camera for camera in cameras if camera.current), None)
        if chosen is not None or cameras:
            return chosen or cameras[0]
        if self._camera is None or self._camera[0] is not stage:
            preset = camera_presets(stage.simulation.plan)["tv"]
            self._camera = (stage, FreeCamera.looking(*preset))
        return self._camera[1]


def run(
    scene: Node | PackedScene | str | Path | SceneTree,
    *,
    size: tuple[int, int] = (1280, 720),
    caption: str = "tifo",
    headless: bool = False,
    seconds: float | None = None,
    screenshot: str | Path | None = None,
    fullscreen: bool = False,
    vsync: bool = True,
    samples: int = 4,
    hot_reload: bool = True,
    report: Report | None = None,
) -> int:
    """Run a scene until a script calls `SceneTree.quit` or the window is closed.

    Parameters
    ----------
    scene
        The scene's root node, its file, or a tree that was made for it; the tree is closed at the
        end in any case.
    size, caption, fullscreen, vsync
        Of the window; `size` in pixels of the picture when headless.
    headless
        Run without a display, in frames of 1/60 s of the game's time, as fast as it goes. Only a
        `screenshot` is drawn, and needs OpenGL.
    seconds
        End after so many seconds of the game's time.
    screenshot
        PNG file for the last picture.
    samples
        Samples a pixel, fewer if the driver has fewer.
    hot_reload
        Take changed scripts, scenes and other files over while the game runs; see `HotReload`.
    report
        Gets the errors of scripts, unless `scene` is a tree; they are logged if it is None.

    Returns
    -------
    int
        What `quit` was given, else 0.

    Raises
    ------
    AssetError
        If the scene file can't be used.
    GraphicsError
        Without OpenGL where something is to be drawn, or without a display unless `headless`.
    ValueError
        If `scene` is no scene, or `seconds` is negative.
    """
    if seconds is not None and not seconds >= 0.0:
        raise ValueError(f"seconds is {seconds}, expected 0 or more")
    tree = scene if isinstance(scene, SceneTree) else SceneTree(scene, report=report)
    reload = HotReload(tree) if hot_reload else None
    try:
        if headless:
            _run_headless(tree, size, samples, seconds, screenshot, reload)
        else:
            window = open_window(size, caption, vsync=vsync, fullscreen=fullscreen, samples=0)
            _Game(tree, window, samples, seconds, screenshot, reload).run(vsync)
    finally:
        tree.close()
    return tree.exit_code


def _run_headless(
    tree: SceneTree,
    size: tuple[int, int],
    samples: int,
    seconds: float | None,
    screenshot: str | Path | None,
    reload: HotReload | None,
) -> None:
    if screenshot is not None:
        create_offscreen_context()
    last = None if seconds is None else tree.tick + round(seconds * BASE_RATE)
    while last is None or tree.tick < last:
        if reload is not None:
            reload.poll()
        if not tree.advance(1.0 / BASE_RATE):
            break
    if screenshot is None:
        return
    picture = Picture(tree, size, samples)
    try:
        stage = picture.draw()
        if stage is not None:
            _write(screenshot, stage.pixels())
    finally:
        picture.close()


class _Game:
    """A window with a tree in it."""

    def __init__(
        self,
        tree: SceneTree,
        window: Any,
        samples: int,
        seconds: float | None,
        screenshot: str | Path | None,
        reload: HotReload | None,
    ) -> None:
        self._tree, self._window, self._reload = tree, window, reload
        self._picture = Picture(tree, window.get_framebuffer_size(), samples)
        self._input = WindowInput(window, tree)
        self._last = None if seconds is None else tree.tick + round(seconds * BASE_RATE)
        self._screenshot = screenshot
        self._before = perf_counter()
        window.push_handlers(self)

    def run(self, vsync: bool) -> None:
        """Play until the end, and close the window."""
        import pyglet

        try:
            self._before = perf_counter()
            pyglet.app.run(1.0 / BASE_RATE if vsync else 0)
        finally:
            self._close()

    def on_draw(self) -> None:
        """One frame."""
        import pyglet

        now = perf_counter()
        delta, self._before = now - self._before, now
        if self._reload is not None:
            self._reload.poll()
        goes_on = self._tree.advance(delta)
        stage = self._picture.draw()
        size = self._window.get_framebuffer_size()
        if stage is not None:
            stage.present(size)
        else:
            self._window.clear()
        if not goes_on or (self._last is not None and self._tree.tick >= self._last):
            if self._screenshot is not None and stage is not None:
                _write(self._screenshot, stage.pixels())
            pyglet.app.exit()

    def on_resize(self, width: int, height: int) -> None:
        """Draw pictures of the window's new size."""
        if width > 0 and height > 0:
            self._picture.resize(self._window.get_framebuffer_size())

    def on_close(self) -> bool:
        """The window's cross, or Escape: end the game, which closes the window."""
        import pyglet

        pyglet.app.exit()
        return True

    def _close(self) -> None:
        window = self._window
        if window.context is None:
            return
        window.switch_to()
        self._input.close()
        self._picture.close()
        window.remove_handlers(self)
        window.close()


def _write(path: str | Path, pixels: NDArray[np.uint8]) -> None:
    from PIL import Image

    try:
        Image.fromarray(pixels).save(path)
    except (OSError, ValueError) as error:
        print(f"tifo: {path} can't be written: {error}", file=sys.stderr)
