"""Where a pass draws to: own colour and depth, or layers of existing textures.

The window's own buffer is of unknown format (565 was seen), so everything is drawn here first.
"""

from __future__ import annotations

from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from .api import get_integer, gl, require_context
from .attachments import Image, Renderbuffer, as_texture, attach, check_layer, check_status
from .objects import GLObject
from .state import DrawTarget
from .texture import Texture2D, check_size
from .texture_array import TextureArray
from .texture_format import TextureFormat


class Framebuffer(GLObject):
    """A colour image, a depth image, or both, that can be drawn to.

    Parameters
    ----------
    size
        (width, height) in pixels: of the screen's pixels, not the window system's units.
    samples
        Samples a pixel, at most what the driver offers; with any, `resolve` before reading.
    color
        Format of the colour image, None for none. With SRGB8_ALPHA8 shaders write linear light
        and the bytes stored are sRGB.
    depth
        Whether there is a 24 bit depth image.

    Raises
    ------
    GraphicsError
        Without a context, or when the driver can't render to the formats.
    ValueError
        For a size or a number of samples that is not allowed, or no image at all.

    Examples
    --------
    >>> target = Framebuffer((640, 360), samples=4)
    >>> with target:  # bound, with its viewport; what was bound before comes back
    ...     target.clear((0.1, 0.2, 0.3, 1.0))
    ...     draw()
    >>> picture = target.read_pixels()  # (360, 640, 4) uint8, top row first
    """

    __slots__ = ("_color", "_color_format", "_depth", "_resolved", "_restore", "_samples", "_size")

    def __init__(
        self,
        size: tuple[int, int],
        samples: int = 0,
        color: TextureFormat | None = TextureFormat.SRGB8_ALPHA8,
        depth: bool = True,
    ) -> None:
        require_context()
        check_size(size)
        most = get_integer("GL_MAX_SAMPLES")
        if not 0 <= samples <= most:
            raise ValueError(f"samples is {samples}, this driver takes 0 to {most}")
        if color is not None and color.is_depth:
            raise ValueError(f"color is {color.name}, expected a colour format")
        images: list[Image | None] = []
        for format in (color, TextureFormat.DEPTH24 if depth else None):
            if format is None:
                images.append(None)
            elif samples:
                images.append(Renderbuffer(size, format, samples))
            else:
                images.append(Texture2D(size, format))
        self._build(images[0], images[1], size, color, samples, layer=0)

    @classmethod
    def onto(
        cls,
        color: Texture2D | TextureArray | None,
        depth: Texture2D | TextureArray | bool = False,
        *,
        layer: int = 0,
    ) -> Self:
        """Return a framebuffer that draws into existing textures.

        Parameters
        ----------
        color
            The colour image, None for a depth-only pass.
        depth
            The depth image; True makes one.
        layer
            Layer of array textures that is drawn to; see `select_layer`.

        Raises
        ------
        ValueError
            For textures of different sizes, a layer that does not exist, or no image at all.
        GraphicsError
            When the driver can't render to the formats.
        """
        given = [image for image in (color, depth) if not isinstance(image, bool) and image]
        if not given:
            raise ValueError("color is None and depth is no texture: there is nothing to draw to")
        size = given[0].size
        if any(image.size != size for image in given):
            raise ValueError(f"color {given[0].size} and depth {given[1].size} differ in size")
        if color is not None and color.format.is_depth:
            raise ValueError("color is a depth texture: give it as depth")
        if not isinstance(depth, bool) and not depth.format.is_depth:
            raise ValueError(f"depth is {depth.format.name}, expected DEPTH24")
        if depth is True:
            depth = Texture2D(size, TextureFormat.DEPTH24)
        self = cls.__new__(cls)
        format = None if color is None else color.format
        self._build(color, depth or None, size, format, 0, layer)
        return self

    def _build(
        self,
        color: Image | None,
        depth: Image | None,
        size: tuple[int, int],
        color_format: TextureFormat | None,
        samples: int,
        layer: int,
    ) -> None:
        if color is None and depth is None:
            raise ValueError("color is None and depth is False: there is nothing to draw to")
        GLObject.__init__(self, "framebuffer")
        self._color = color
        self._depth = depth
        self._color_format = color_format
        self._size = (int(size[0]), int(size[1]))
        self._samples = samples
        self._resolved: Framebuffer | None = None
        self._restore: list[DrawTarget] = []
        check_layer((color, depth), layer)
        before = DrawTarget.current()
        gl.glBindFramebuffer(gl.GL_FRAMEBUFFER, self.name)
        try:
            attach(self._color, self._depth, layer)
            buffer = gl.GL_NONE if color is None else gl.GL_COLOR_ATTACHMENT0
            gl.glDrawBuffer(buffer)
            gl.glReadBuffer(buffer)
            status = int(gl.glCheckFramebufferStatus(gl.GL_FRAMEBUFFER))
        finally:
            before.restore()
        check_status(status, self._size, color_format, samples)

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        return self._size

    @property
    def samples(self) -> int:
        """Samples a pixel; 0 for plain pixels."""
        return self._samples

    @property
    def color_texture(self) -> Texture2D | TextureArray:
        """The colour image, to sample from; of a multisampled one, resolve first and take its.

        Raises
        ------
        ValueError
            When there is none.
        """
        return as_texture(self._color, "colour")

    @property
    def depth_texture(self) -> Texture2D | TextureArray:
        """The depth image, to sample from.

        Raises
        ------
        ValueError
            When there is none.
        """
        return as_texture(self._depth, "depth")

    def bind(self) -> None:
        """Draw here from now on: sets the viewport and the sRGB encoding that the format wants."""
        gl.glBindFramebuffer(gl.GL_FRAMEBUFFER, self.name)
        gl.glViewport(0, 0, *self._size)
        if self._is_srgb:
            gl.glEnable(gl.GL_FRAMEBUFFER_SRGB)
        else:
            gl.glDisable(gl.GL_FRAMEBUFFER_SRGB)

    def __enter__(self) -> Self:
        """Bind it, remembering what was bound."""
        self._restore.append(DrawTarget.current())
        self.bind()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Bind what was bound before, with its viewport and encoding."""
        self._restore.pop().restore()

    def clear(
        self, color: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0), depth: float = 1.0
    ) -> None:
        """Fill both images while bound; leaves writing to colour and depth switched on.

        Parameters
        ----------
        color
            Linear red, green, blue and alpha; for an integer format whole numbers.
        depth
            0 is near, 1 far.
        """
        if self._color_format is not None:
            gl.glColorMask(True, True, True, True)
            if self._color_format.is_integer:
                whole = (gl.GLuint * 4)(*(int(part) for part in color))
                gl.glClearBufferuiv(gl.GL_COLOR, 0, whole)
            else:
                gl.glClearBufferfv(gl.GL_COLOR, 0, (gl.GLfloat * 4)(*color))
        if self._depth is not None:
            gl.glDepthMask(True)
            gl.glClearBufferfv(gl.GL_DEPTH, 0, gl.GLfloat(depth))

    def select_layer(self, layer: int) -> None:
        """Draw to another layer of its array textures; binds it.

        Raises
        ------
        ValueError
            When there is no such layer.
        """
        check_layer((self._color, self._depth), layer)
        self.bind()
        attach(self._color, self._depth, layer)

    def resolve(self) -> Framebuffer:
        """Return plain pixels: itself, or a framebuffer with the samples of each pixel averaged.

        The returned framebuffer belongs to this one, and the next call writes to it again.
        """
        if not self._samples:
            return self
        if self._resolved is None:
            self._resolved = Framebuffer(self._size, 0, self._color_format, self._depth is not None)
        mask = 0
        if self._color is not None:
            mask |= gl.GL_COLOR_BUFFER_BIT
        if self._depth is not None:
            mask |= gl.GL_DEPTH_BUFFER_BIT
        with self._resolved:
            gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, self.name)
            scissor = gl.glIsEnabled(gl.GL_SCISSOR_TEST)
            gl.glDisable(gl.GL_SCISSOR_TEST)
            area = (0, 0, *self._size)
            gl.glBlitFramebuffer(*area, *area, mask, gl.GL_NEAREST)
            if scissor:
                gl.glEnable(gl.GL_SCISSOR_TEST)
        return self._resolved

    def read_pixels(self) -> NDArray[np.uint8]:
        """Return the colours as (H, W, 4) uint8, top row first; resolves and waits for the GPU.

        The bytes of an SRGB8_ALPHA8 image are sRGB encoded, as image files want them.

        Raises
        ------
        ValueError
            For a format that does not hold bytes.
        """
        if self._color_format not in (TextureFormat.SRGB8_ALPHA8, TextureFormat.RGBA8):
            name = "no colour" if self._color_format is None else self._color_format.name
            raise ValueError(f"this framebuffer has {name}: read its color_texture instead")
        out = np.empty((self._size[1], self._size[0], 4), np.uint8)
        self.resolve()._read(gl.GL_RGBA, gl.GL_UNSIGNED_BYTE, out)
        return np.ascontiguousarray(out[::-1])

    def read_depth(self) -> NDArray[np.float32]:
        """Return the depths as (H, W) float32 in 0..1, top row first.

        Raises
        ------
        ValueError
            When there is no depth image.
        """
        if self._depth is None:
            raise ValueError("this framebuffer has no depth image")
        out = np.empty((self._size[1], self._size[0]), np.float32)
        self.resolve()._read(gl.GL_DEPTH_COMPONENT, gl.GL_FLOAT, out)
        return np.ascontiguousarray(out[::-1])

    def delete(self) -> None:
        """Free it and what it owns; textures given to `onto` stay."""
        if self._resolved is not None:
            self._resolved.delete()
        self._color = self._depth = None
        super().delete()

    @property
    def _is_srgb(self) -> bool:
        return self._color_format is TextureFormat.SRGB8_ALPHA8

    def _read(self, format: int, kind: int, out: NDArray[Any]) -> None:
        with self:
            gl.glBindBuffer(gl.GL_PIXEL_PACK_BUFFER, 0)
            gl.glPixelStorei(gl.GL_PACK_ALIGNMENT, 1)
            gl.glReadPixels(0, 0, *self._size, format, kind, out.ctypes.data)
