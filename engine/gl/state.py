"""Error checks and the neutral state that tests and embedding applications start from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

from ..errors import GraphicsError
from .api import get_integer, gl


@dataclass(frozen=True, slots=True)
class DrawTarget:
    """Where drawing goes: the state that `Framebuffer` changes, to put back later.

    The application that a renderer is embedded in may be drawing to a framebuffer of its own.
    """

    draw_framebuffer: int
    read_framebuffer: int
    viewport: tuple[int, int, int, int]
    srgb: bool

    @classmethod
    def current(cls) -> Self:
        """Return where drawing goes now."""
        viewport = (gl.GLint * 4)()
        gl.glGetIntegerv(gl.GL_VIEWPORT, viewport)
        return cls(
            get_integer("GL_DRAW_FRAMEBUFFER_BINDING"),
            get_integer("GL_READ_FRAMEBUFFER_BINDING"),
            (viewport[0], viewport[1], viewport[2], viewport[3]),
            bool(gl.glIsEnabled(gl.GL_FRAMEBUFFER_SRGB)),
        )

    def restore(self) -> None:
        """Let drawing go there again."""
        gl.glBindFramebuffer(gl.GL_DRAW_FRAMEBUFFER, self.draw_framebuffer)
        gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, self.read_framebuffer)
        gl.glViewport(*self.viewport)
        (gl.glEnable if self.srgb else gl.glDisable)(gl.GL_FRAMEBUFFER_SRGB)


def takes_srgb_bytes() -> bool:
    """Whether the bound framebuffer holds bytes that GL doesn't encode as sRGB on the way in.

    A screen takes them for sRGB all the same, so shaders must encode. A framebuffer of floating
    point numbers, or without colour, is left in linear light.
    """
    buffer = get_integer("GL_DRAW_BUFFER0")
    if buffer == gl.GL_NONE:
        return False
    default = get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == 0
    if default:
        front = buffer in (gl.GL_FRONT, gl.GL_FRONT_LEFT)
        buffer = gl.GL_FRONT_LEFT if front else gl.GL_BACK_LEFT
    if _attachment(buffer, gl.GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE) == gl.GL_NONE:
        return False
    if _attachment(buffer, gl.GL_FRAMEBUFFER_ATTACHMENT_COLOR_ENCODING) == gl.GL_SRGB:
        return False
    kind = _attachment(buffer, gl.GL_FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE)
    return bool(kind == gl.GL_UNSIGNED_NORMALIZED)


def write_srgb(on: bool) -> None:
    """Whether GL encodes what shaders write where the framebuffer is in sRGB."""
    (gl.glEnable if on else gl.glDisable)(gl.GL_FRAMEBUFFER_SRGB)


def _attachment(buffer: int, what: int) -> int:
    value = gl.GLint(0)
    gl.glGetFramebufferAttachmentParameteriv(gl.GL_DRAW_FRAMEBUFFER, buffer, what, value)
    return int(value.value)


_ERRORS = {
    0x0500: "GL_INVALID_ENUM",
    0x0501: "GL_INVALID_VALUE",
    0x0502: "GL_INVALID_OPERATION",
    0x0505: "GL_OUT_OF_MEMORY",
    0x0506: "GL_INVALID_FRAMEBUFFER_OPERATION",
}

# A lost context can report errors without end.
_MOST_ERRORS = 32


def gl_errors() -> list[str]:
    """Take every pending GL error and return their names, oldest first."""
    found: list[str] = []
    while len(found) < _MOST_ERRORS:
        code = int(gl.glGetError())
        if code == 0:
            break
        found.append(_ERRORS.get(code, f"GL error 0x{code:04x}"))
    return found


def check_errors(where: str) -> None:
    """Raise for pending GL errors.

    Parameters
    ----------
    where
        What was being done, for the message: ``"drawing the far crowd"``.

    Raises
    ------
    GraphicsError
        Naming the errors and `where`.
    """
    errors = gl_errors()
    if errors:
        raise GraphicsError(f"OpenGL reported {', '.join(errors)} while {where}")


def reset_state() -> None:
    """Unbind everything that the objects of this package bind and switch the usual tests off."""
    gl.glUseProgram(0)
    gl.glBindVertexArray(0)
    gl.glBindFramebuffer(gl.GL_FRAMEBUFFER, 0)
    for target in (
        gl.GL_ARRAY_BUFFER,
        gl.GL_COPY_READ_BUFFER,
        gl.GL_COPY_WRITE_BUFFER,
        gl.GL_UNIFORM_BUFFER,
        gl.GL_PIXEL_PACK_BUFFER,
        gl.GL_PIXEL_UNPACK_BUFFER,
        gl.GL_TRANSFORM_FEEDBACK_BUFFER,
    ):
        gl.glBindBuffer(target, 0)
    for unit in range(get_integer("GL_MAX_TEXTURE_IMAGE_UNITS")):
        gl.glActiveTexture(gl.GL_TEXTURE0 + unit)
        gl.glBindTexture(gl.GL_TEXTURE_2D, 0)
        gl.glBindTexture(gl.GL_TEXTURE_2D_ARRAY, 0)
    gl.glActiveTexture(gl.GL_TEXTURE0)
    for switch in (
        gl.GL_BLEND,
        gl.GL_CULL_FACE,
        gl.GL_DEPTH_TEST,
        gl.GL_SCISSOR_TEST,
        gl.GL_STENCIL_TEST,
        gl.GL_POLYGON_OFFSET_FILL,
        gl.GL_RASTERIZER_DISCARD,
        gl.GL_FRAMEBUFFER_SRGB,
    ):
        gl.glDisable(switch)
    gl.glDepthMask(True)
    gl.glDepthFunc(gl.GL_LESS)
    gl.glColorMask(True, True, True, True)
