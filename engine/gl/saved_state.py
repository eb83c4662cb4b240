"""The GL state of somebody else's program: put aside before drawing, and put back after.

Where pixels go is the other program's choice and is left as it is: framebuffers, viewport, scissor,
stencil and depth range. How they are drawn is the passes' own choice, and the rest of the state is
set for them by `prepare_state`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .api import get_integer, gl
from .state import DrawTarget
from .texture import SPARE_UNIT

UNITS = (*range(16), SPARE_UNIT)
"""Texture units that passes and transfers use."""

_OFF = (
    *("GL_BLEND", "GL_POLYGON_OFFSET_FILL", "GL_RASTERIZER_DISCARD", "GL_PRIMITIVE_RESTART"),
    *("GL_DEPTH_CLAMP", "GL_COLOR_LOGIC_OP", "GL_SAMPLE_COVERAGE", "GL_SAMPLE_MASK"),
    *("GL_SAMPLE_ALPHA_TO_ONE", "GL_SAMPLE_ALPHA_TO_COVERAGE", "GL_PROGRAM_POINT_SIZE"),
    *("GL_POLYGON_SMOOTH", *(f"GL_CLIP_DISTANCE{plane}" for plane in range(8))),
)
"""What would change what the passes draw."""
_OTHER = ("GL_DEPTH_TEST", "GL_CULL_FACE")
_BUFFERS = {
    "GL_ARRAY_BUFFER": "GL_ARRAY_BUFFER_BINDING",
    "GL_COPY_READ_BUFFER": "GL_COPY_READ_BUFFER",
    "GL_COPY_WRITE_BUFFER": "GL_COPY_WRITE_BUFFER",
    "GL_PIXEL_PACK_BUFFER": "GL_PIXEL_PACK_BUFFER_BINDING",
    "GL_PIXEL_UNPACK_BUFFER": "GL_PIXEL_UNPACK_BUFFER_BINDING",
}
_UNPACKING = (
    *("GL_UNPACK_ALIGNMENT", "GL_UNPACK_SWAP_BYTES", "GL_UNPACK_LSB_FIRST"),
    *("GL_UNPACK_ROW_LENGTH", "GL_UNPACK_IMAGE_HEIGHT"),
    *("GL_UNPACK_SKIP_PIXELS", "GL_UNPACK_SKIP_ROWS", "GL_UNPACK_SKIP_IMAGES"),
)
_TEXTURES = (
    ("GL_TEXTURE_2D", "GL_TEXTURE_BINDING_2D"),
    ("GL_TEXTURE_2D_ARRAY", "GL_TEXTURE_BINDING_2D_ARRAY"),
)


def prepare_state() -> None:
    """Set all state that passes rely on and don't set themselves.

    Only the first colour buffer is written: the shaders have one output.
    """
    for name in _OFF:
        gl.glDisable(getattr(gl, name))
    gl.glPolygonMode(gl.GL_FRONT_AND_BACK, gl.GL_FILL)
    gl.glColorMask(False, False, False, False)
    gl.glColorMaski(0, True, True, True, True)
    for unit in UNITS:
        gl.glBindSampler(unit, 0)


class SavedState:
    """All state that drawing a crowd, and making its objects, may change.

    Uniform buffers, and among them pyglet's window block at binding 0, are never touched.

    Examples
    --------
    >>> before = SavedState()
    >>> prepare_state()
    >>> draw()
    >>> before.restore()
    """

    def __init__(self) -> None:
        self._target = DrawTarget.current()
        self._program = get_integer("GL_CURRENT_PROGRAM")
        self._vertex_array = get_integer("GL_VERTEX_ARRAY_BINDING")
        self._renderbuffer = get_integer("GL_RENDERBUFFER_BINDING")
        self._buffers = {target: get_integer(query) for target, query in _BUFFERS.items()}
        self._feedback = _indexed_feedback()
        self._unpacking = {name: get_integer(name) for name in _UNPACKING}
        self._pack_alignment = get_integer("GL_PACK_ALIGNMENT")
        self._switches = {
            name: bool(gl.glIsEnabled(getattr(gl, name))) for name in (*_OFF[1:], *_OTHER)
        }
        self._colour_buffers = range(get_integer("GL_MAX_DRAW_BUFFERS"))
        self._blends = [bool(gl.glIsEnabledi(gl.GL_BLEND, k)) for k in self._colour_buffers]
        self._masks = [_mask(k) for k in self._colour_buffers]
        self._depth_mask = bool(get_integer("GL_DEPTH_WRITEMASK"))
        self._depth_function = get_integer("GL_DEPTH_FUNC")
        self._cull_mode = get_integer("GL_CULL_FACE_MODE")
        self._front_face = get_integer("GL_FRONT_FACE")
        self._polygon_mode = _integers("GL_POLYGON_MODE", 2)[0]
        self._active = get_integer("GL_ACTIVE_TEXTURE")
        self._units = [self._unit(unit) for unit in UNITS]
        gl.glActiveTexture(self._active)

    def _unit(self, unit: int) -> tuple[int, ...]:
        gl.glActiveTexture(gl.GL_TEXTURE0 + unit)
        return (
            get_integer("GL_SAMPLER_BINDING"),
            *(get_integer(query) for _, query in _TEXTURES),
        )

    def restore(self) -> None:
        """Make everything as it was."""
        for unit, (sampler, *textures) in zip(UNITS, self._units, strict=True):
            gl.glActiveTexture(gl.GL_TEXTURE0 + unit)
            gl.glBindSampler(unit, sampler)
            for (target, _), texture in zip(_TEXTURES, textures, strict=True):
                gl.glBindTexture(getattr(gl, target), texture)
        gl.glActiveTexture(self._active)
        for name, on in self._switches.items():
            _switch(getattr(gl, name), on)
        for k, blends, mask in zip(self._colour_buffers, self._blends, self._masks, strict=True):
            (gl.glEnablei if blends else gl.glDisablei)(gl.GL_BLEND, k)
            gl.glColorMaski(k, *mask)
        gl.glDepthMask(self._depth_mask)
        gl.glDepthFunc(self._depth_function)
        gl.glCullFace(self._cull_mode)
        gl.glFrontFace(self._front_face)
        gl.glPolygonMode(gl.GL_FRONT_AND_BACK, self._polygon_mode)
        for name, value in self._unpacking.items():
            gl.glPixelStorei(getattr(gl, name), value)
        gl.glPixelStorei(gl.GL_PACK_ALIGNMENT, self._pack_alignment)
        self._restore_feedback()
        # The vertex array before the buffers: it doesn't hold any of these.
        gl.glBindVertexArray(self._vertex_array)
        for target, buffer in self._buffers.items():
            gl.glBindBuffer(getattr(gl, target), buffer)
        gl.glBindRenderbuffer(gl.GL_RENDERBUFFER, self._renderbuffer)
        gl.glUseProgram(self._program)
        self._target.restore()

    def _restore_feedback(self) -> None:
        generic, indexed, start, size = self._feedback
        kind = gl.GL_TRANSFORM_FEEDBACK_BUFFER
        if indexed and size:
            gl.glBindBufferRange(kind, 0, indexed, start, size)
        else:
            gl.glBindBufferBase(kind, 0, indexed)
        gl.glBindBuffer(kind, generic)


def _indexed_feedback() -> tuple[int, int, int, int]:
    """Transform feedback buffers: the general one, and the first indexed one with its range."""
    index = gl.GLint(0)
    gl.glGetIntegeri_v(gl.GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 0, index)
    span = [gl.GLint64(0), gl.GLint64(0)]
    for value, name in zip(span, ("START", "SIZE"), strict=True):
        query = getattr(gl, f"GL_TRANSFORM_FEEDBACK_BUFFER_{name}")
        gl.glGetInteger64i_v(query, 0, value)
    generic = get_integer("GL_TRANSFORM_FEEDBACK_BUFFER_BINDING")
    return generic, int(index.value), int(span[0].value), int(span[1].value)


def _mask(buffer: int) -> tuple[bool, ...]:
    values = (gl.GLboolean * 4)()
    gl.glGetBooleani_v(gl.GL_COLOR_WRITEMASK, buffer, values)
    return tuple(bool(value) for value in values)


def _integers(name: str, count: int) -> Sequence[int]:
    values: Any = (gl.GLint * count)()
    gl.glGetIntegerv(getattr(gl, name), values)
    return [int(value) for value in values]


def _switch(capability: int, on: bool) -> None:
    (gl.glEnable if on else gl.glDisable)(capability)
