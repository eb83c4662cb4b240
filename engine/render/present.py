"""From a framebuffer of our own to the window's."""

from __future__ import annotations

from ..gl.api import gl
from ..gl.framebuffer import Framebuffer


def present(framebuffer: Framebuffer, size: tuple[int, int]) -> None:
    """Copy a finished picture to the window's framebuffer, which stays bound for overlays.

    The bytes are copied as they are: they hold sRGB already, whatever the window's format says.

    Parameters
    ----------
    framebuffer
        The picture; several samples a pixel are resolved first.
    size
        Pixels of the window's framebuffer.
    """
    source = framebuffer.resolve()
    gl.glDisable(gl.GL_FRAMEBUFFER_SRGB)
    gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, source.name)
    gl.glBindFramebuffer(gl.GL_DRAW_FRAMEBUFFER, 0)
    nearest = source.size == size
    gl.glBlitFramebuffer(
        0,
        0,
        *source.size,
        0,
        0,
        *size,
        gl.GL_COLOR_BUFFER_BIT,
        gl.GL_NEAREST if nearest else gl.GL_LINEAR,
    )
    gl.glBindFramebuffer(gl.GL_FRAMEBUFFER, 0)
    gl.glViewport(0, 0, *size)
    gl.glDisable(gl.GL_DEPTH_TEST)
    gl.glDisable(gl.GL_CULL_FACE)
