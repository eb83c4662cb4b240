"""GL contexts that neither pyglet nor tifo made: those of GLFW, SDL, Qt, moderngl, ..."""

from __future__ import annotations

import os
import sys
from typing import Any

from ..errors import GraphicsError
from .context import describe_context
from .explain import FLOOR, explained, too_old


class AdoptedContext:
    """Stands for a context of somebody else's, as pyglet's own contexts stand for theirs.

    tifo takes it to be the current one until `make_current` of another, or `switch_to` of a pyglet
    window, is called; it never makes anything current itself. All GL objects that tifo makes
    meanwhile belong to it.

    Attributes
    ----------
    object_space
        Stands for all contexts that share objects with it.
    """

    def __init__(self, shares_with: AdoptedContext | None = None) -> None:
        self.object_space: Any = _Group() if shares_with is None else shares_with.object_space
        self.canvas: Any = self

    def make_current(self) -> None:
        """Tell tifo that you have made this context current.

        Raises
        ------
        GraphicsError
            After `close`.
        """
        import pyglet.gl

        if self.canvas is None:
            raise GraphicsError("this context was closed and can't be current any more")
        pyglet.gl.current_context = self

    def close(self) -> None:
        """Tell tifo, while it is still current, that you are about to destroy it."""
        import pyglet.gl

        from .objects import collect

        if pyglet.gl.current_context is self:
            collect()
            pyglet.gl.current_context = None
        self.canvas = None


class _Group:
    """Contexts that share objects."""


def adopt_context(*, shares_with: AdoptedContext | None = None) -> AdoptedContext:
    """Let tifo draw in the GL context that is current now and that pyglet didn't make.

    Parameters
    ----------
    shares_with
        Another adopted context, if your window system was told to share objects between the two.

    Returns
    -------
    AdoptedContext
        tifo takes it to be current from now on.

    Raises
    ------
    GraphicsError
        If none is current, or it has less than OpenGL 3.3.
    """
    import pyglet

    with explained("an OpenGL context of yours", windowed=True):
        if "pyglet.gl" not in sys.modules:
            pyglet.options["shadow_window"] = False
            pyglet.options["debug_gl"] = False
            display = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
            if sys.platform.startswith("linux") and not display:
                pyglet.options["headless"] = True
        import pyglet.gl
    adopted = AdoptedContext(shares_with)
    before = pyglet.gl.current_context
    adopted.make_current()
    try:
        if not pyglet.gl.glGetString(pyglet.gl.GL_VERSION):
            raise GraphicsError(
                "no OpenGL context is current in this thread: make yours current before "
                "adopt_context()"
            )
        info = describe_context()
        if info.version < FLOOR:
            raise too_old(info.renderer, info.version)
    except GraphicsError:
        pyglet.gl.current_context = before
        raise
    return adopted
