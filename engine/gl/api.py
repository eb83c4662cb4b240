"""Late access to `pyglet.gl`.

Importing `pyglet.gl` loads the GL library, fixes the window system for the rest of the process
and, unless told otherwise, opens a hidden window. Modules of this package must be importable
where none of that exists, so they take `gl` from here: a name is looked up in `pyglet.gl` at its
first use and costs a plain attribute access from then on.
"""

from __future__ import annotations

import sys
from typing import Any

from ..errors import GraphicsError

NO_CONTEXT = (
    "there is no OpenGL context: open a window or call create_offscreen_context() before "
    "making or using graphics objects"
)


class _LateGL:
    """Forwards to `pyglet.gl`, remembering functions and constants but never changing state."""

    def __getattr__(self, name: str) -> Any:
        module = sys.modules.get("pyglet.gl")
        if module is None:
            raise GraphicsError(NO_CONTEXT)
        value = getattr(module, name)
        if name.startswith(("gl", "GL")):
            self.__dict__[name] = value
        return value


gl: Any = _LateGL()
"""Stands for the module `pyglet.gl`: ``gl.glDrawArrays``, ``gl.GL_FLOAT``, ``gl.GLuint``."""


def current_context() -> Any:
    """Return pyglet's current context, or None (also when pyglet is not loaded)."""
    module = sys.modules.get("pyglet.gl")
    return None if module is None else module.current_context


def require_context() -> Any:
    """Return pyglet's current context.

    Raises
    ------
    GraphicsError
        When there is none.
    """
    context = current_context()
    if context is None:
        raise GraphicsError(NO_CONTEXT)
    return context


def get_integer(parameter: str) -> int:
    """Return the integer state or limit that a constant's name stands for.

    ``get_integer("GL_MAX_TEXTURE_SIZE")`` is 16384 on most drivers.
    """
    value = gl.GLint(0)
    gl.glGetIntegerv(getattr(gl, parameter), value)
    return int(value.value)
