"""Creating a GL context: off screen without a display, or a window.

pyglet decides at the first import of `pyglet.gl` whether it is headless, and opens a hidden
"shadow" window then unless told not to; both functions here settle that first. Every failure
becomes one sentence that says what to install or which switch to use.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import Any

from ..errors import GraphicsError
from .api import get_integer, gl, require_context
from .explain import FLOOR, explained, too_old

_SOFTWARE = ("llvmpipe", "softpipe", "swrast", "software", "apple software renderer", "gdi generic")

# pyglet closes a window that nobody holds, and a second headless one crashes.
_offscreen: list[Any] = []


@dataclass(frozen=True, slots=True)
class ContextInfo:
    """What the current context can do.

    Parameters
    ----------
    renderer, vendor
        As the driver names them.
    version
        OpenGL (major, minor).
    glsl_version
        As the driver names it, such as ``"4.50"``.
    is_software
        Whether a processor draws (llvmpipe and its like).
    max_texture_size
        Most texels along a side of a 2D texture.
    max_array_layers
        Most layers of an array texture.
    max_samples
        Most samples of a multisampled framebuffer.
    """

    renderer: str
    vendor: str
    version: tuple[int, int]
    glsl_version: str
    is_software: bool
    max_texture_size: int
    max_array_layers: int
    max_samples: int


def create_offscreen_context(size: tuple[int, int] = (64, 64), *, debug: bool = False) -> Any:
    """Make a GL context that needs no display, make it current and return its pyglet window.

    On Linux it is EGL without a window system, whether or not a display exists; elsewhere, and
    where pyglet was already loaded for windows, a hidden window. A second call returns the first
    window again: draw to a `Framebuffer` of your own size, never to this window.

    Parameters
    ----------
    size
        (width, height) of the window's own buffer, in pixels.
    debug
        Check for GL errors after every call (`pyglet.options.debug_gl`) and ask for a debug
        context; only effective before pyglet's GL is loaded.

    Raises
    ------
    GraphicsError
        When no usable GL exists; says what to install.
    ValueError
        For a size that is not positive.
    """
    _check_size(size)
    for window in _offscreen:
        if window.context is not None:
            window.switch_to()
            return window
    _offscreen.clear()
    with explained("an offscreen OpenGL context", windowed=False):
        _configure_pyglet(headless=sys.platform.startswith("linux"), debug=debug)
        import pyglet.gl
        import pyglet.window

        config = _config(0, double_buffer=False, debug=debug)
        window = pyglet.window.Window(*size, visible=False, vsync=False, config=config)
    _check_version()
    _offscreen.append(window)
    return window


def open_window(
    size: tuple[int, int] = (1280, 720),
    caption: str = "tifo",
    *,
    vsync: bool = True,
    fullscreen: bool = False,
    samples: int = 4,
    resizable: bool = True,
    visible: bool = True,
    debug: bool = False,
) -> Any:
    """Open a pyglet window with a 3.3 core context and a 24 bit depth buffer.

    Its framebuffer may have more pixels than `size` on high-density screens: use the window's
    ``get_framebuffer_size()`` for viewports.

    Parameters
    ----------
    size
        (width, height) in the window system's units; ignored when `fullscreen`.
    samples
        Samples a pixel wanted; halved until the driver agrees, 0 for none.
    vsync, fullscreen, resizable, visible
        As in pyglet's Window.
    debug
        As in `create_offscreen_context`.

    Raises
    ------
    GraphicsError
        Without a display or a usable GL.
    ValueError
        For a size that is not positive or negative samples.
    """
    _check_size(size)
    if samples < 0:
        raise ValueError(f"samples is {samples}, expected 0 or more")
    with explained("a window", windowed=True):
        _configure_pyglet(headless=False, debug=debug)
        import pyglet

        if pyglet.options["headless"]:
            raise GraphicsError(
                "can't open a window because pyglet runs headless in this process: unset "
                "PYGLET_HEADLESS and open the window before any offscreen context"
            )
        import pyglet.gl
        import pyglet.window

        config = _matching_config(pyglet.display.get_display(), samples, debug)
        width, height = (None, None) if fullscreen else size
        window = pyglet.window.Window(
            width,
            height,
            caption=caption,
            resizable=resizable and not fullscreen,
            fullscreen=fullscreen,
            visible=visible,
            vsync=vsync,
            config=config,
        )
    _check_version()
    return window


def describe_context() -> ContextInfo:
    """Return what the current context can do.

    Raises
    ------
    GraphicsError
        Without a current context.
    """
    require_context()
    renderer = _get_string("GL_RENDERER")
    return ContextInfo(
        renderer=renderer,
        vendor=_get_string("GL_VENDOR"),
        version=(get_integer("GL_MAJOR_VERSION"), get_integer("GL_MINOR_VERSION")),
        glsl_version=_get_string("GL_SHADING_LANGUAGE_VERSION"),
        is_software=any(word in renderer.lower() for word in _SOFTWARE),
        max_texture_size=get_integer("GL_MAX_TEXTURE_SIZE"),
        max_array_layers=get_integer("GL_MAX_ARRAY_TEXTURE_LAYERS"),
        max_samples=get_integer("GL_MAX_SAMPLES"),
    )


def _configure_pyglet(*, headless: bool, debug: bool) -> None:
    """Set pyglet's options while they still count."""
    import pyglet

    if "pyglet.gl" in sys.modules:
        return
    pyglet.options["shadow_window"] = False
    pyglet.options["debug_gl"] = debug
    if headless:
        pyglet.options["headless"] = True


def _config(samples: int, *, double_buffer: bool, debug: bool) -> Any:
    return gl.Config(
        major_version=FLOOR[0],
        minor_version=FLOOR[1],
        forward_compatible=True,
        debug=debug or None,
        red_size=8,
        green_size=8,
        blue_size=8,
        alpha_size=8,
        depth_size=24,
        double_buffer=double_buffer,
        sample_buffers=1 if samples else None,
        samples=samples or None,
    )


def _matching_config(display: Any, samples: int, debug: bool) -> Any:
    """Return the best config of the screen with at most `samples` samples."""
    screen = display.get_default_screen()
    while True:
        try:
            return screen.get_best_config(_config(samples, double_buffer=True, debug=debug))
        except Exception as error:  # pyglet's kinds differ between platforms
            if samples == 0:
                raise error
        samples //= 2


def _check_size(size: tuple[int, int]) -> None:
    if len(size) != 2 or min(size) < 1:
        raise ValueError(f"size is {size}, expected (width, height) of at least 1")


def _check_version() -> None:
    info = describe_context()
    if info.version < FLOOR:
        raise too_old(info.renderer, info.version)


def _get_string(parameter: str) -> str:
    import ctypes

    pointer = gl.glGetString(getattr(gl, parameter))
    raw = ctypes.cast(pointer, ctypes.c_char_p).value
    return raw.decode("utf-8", "replace") if raw else ""
