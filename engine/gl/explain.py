"""What to do when there is no usable OpenGL: pyglet's and the system's failures in plain words."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from ..errors import GraphicsError

FLOOR = (3, 3)
"""Oldest OpenGL (major, minor) that the passes run on."""

INSTALL_HINT = (
    "on Debian or Ubuntu install libegl1 libgl1 libgl1-mesa-dri, elsewhere the GPU's driver"
)
UPDATE_HINT = (
    "update the GPU's driver, or draw with Mesa's software renderer by setting "
    "LIBGL_ALWAYS_SOFTWARE=1"
)
_NEEDED = f"OpenGL {FLOOR[0]}.{FLOOR[1]}"


@contextmanager
def explained(what: str, *, windowed: bool) -> Iterator[None]:
    """Turn any failure inside into a GraphicsError of one sentence.

    Parameters
    ----------
    what
        What is being made: ``"a window"``.
    windowed
        Whether it needs a display.

    Raises
    ------
    GraphicsError
        Says what to install or which switch to use.
    """
    try:
        yield
    except GraphicsError:
        raise
    except (Exception, _shader_exception()) as error:
        raise GraphicsError(f"can't make {what}: {_cause(error, windowed)}") from error


def too_old(renderer: str, version: tuple[int, int]) -> GraphicsError:
    """Return the error for a driver below the floor."""
    return GraphicsError(
        f"the driver '{renderer}' offers OpenGL {version[0]}.{version[1]} and tifo needs "
        f"{FLOOR[0]}.{FLOOR[1]}: {UPDATE_HINT}"
    )


def _cause(error: BaseException, windowed: bool) -> str:
    """Return what failed and what helps; pyglet's kinds of errors are told by name."""
    kind = type(error).__name__
    said = " ".join(str(error).split()).rstrip(".") or kind
    on_linux = sys.platform.startswith("linux")
    if isinstance(error, ImportError):
        return f"a system library is missing ({said}); {INSTALL_HINT}"
    if kind == "NoSuchDisplayException" or (
        windowed and on_linux and not os.environ.get("DISPLAY")
    ):
        if windowed:
            return (
                "no display was found; start it from a desktop session, run it under xvfb-run, "
                "or draw off screen with --headless"
            )
        return (
            "pyglet was loaded for windows and no display was found; set PYGLET_HEADLESS=1, or "
            "import nothing of pyglet's windows before"
        )
    if kind == "NoSuchConfigException":
        return f"no driver offers 8 bit RGBA with 24 bit depth in {_NEEDED}; {INSTALL_HINT}"
    if kind == "ContextException":
        return f"the driver refuses {_NEEDED} ({said}); {UPDATE_HINT}"
    return f"{_NEEDED} did not start ({kind}: {said}); {INSTALL_HINT}"


def _shader_exception() -> type[BaseException]:
    """Return pyglet's ShaderException, which is no Exception, once it can have been raised."""
    module = sys.modules.get("pyglet.graphics.shader")
    kind: type[BaseException] = module.ShaderException if module else Exception
    return kind
