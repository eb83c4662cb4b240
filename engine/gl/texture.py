"""Plain textures, and what all textures share.

Row 0 of an array is the row at texture coordinate t = 0. Transfers and creation bind to one
texture unit that no pass uses, so they never change what a pass has bound.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .api import get_integer, gl, require_context
from .objects import GLObject
from .texture_format import TextureFormat

Filter = Literal["nearest", "linear"]
Wrap = Literal["clamp", "repeat"]

# GL 3.3 guarantees units 0 to 47; passes use the first 16.
SPARE_UNIT = 47
_WRAPS = {"clamp": "GL_CLAMP_TO_EDGE", "repeat": "GL_REPEAT"}


class Texture(GLObject):
    """What `Texture2D` and `TextureArray` share."""

    __slots__ = ("_format", "_layers", "_levels", "_size")

    _target = ""

    def __init__(
        self,
        size: tuple[int, int],
        layers: int,
        format: TextureFormat,
        levels: int,
        filter: Filter | None,
        wrap: Wrap,
        compare: bool,
    ) -> None:
        require_context()
        check_size(size)
        _check_counts(size, layers, levels)
        default: Filter = "linear" if format.dtype.itemsize < 4 else "nearest"
        chosen = filter or ("linear" if compare else default)
        _check_sampling(format, chosen, wrap, compare)
        super().__init__("texture")
        self._size = (int(size[0]), int(size[1]))
        self._layers = int(layers)
        self._format = format
        self._levels = levels
        target = self._attach()
        # A bound unpack buffer would be read, although no texels are given.
        set_unpacking()
        for level in range(levels):
            self._allocate(level)
        mag = "GL_LINEAR" if chosen == "linear" else "GL_NEAREST"
        minify = mag if levels == 1 else f"{mag}_MIPMAP_{mag.removeprefix('GL_')}"
        gl.glTexParameteri(target, gl.GL_TEXTURE_MAX_LEVEL, levels - 1)
        gl.glTexParameteri(target, gl.GL_TEXTURE_MAG_FILTER, getattr(gl, mag))
        gl.glTexParameteri(target, gl.GL_TEXTURE_MIN_FILTER, getattr(gl, minify))
        for axis in (gl.GL_TEXTURE_WRAP_S, gl.GL_TEXTURE_WRAP_T):
            gl.glTexParameteri(target, axis, getattr(gl, _WRAPS[wrap]))
        if compare:
            gl.glTexParameteri(target, gl.GL_TEXTURE_COMPARE_MODE, gl.GL_COMPARE_REF_TO_TEXTURE)
            gl.glTexParameteri(target, gl.GL_TEXTURE_COMPARE_FUNC, gl.GL_LEQUAL)
        self._detach()

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in texels."""
        return self._size

    @property
    def layers(self) -> int:
        """Layers; 1 for a `Texture2D`."""
        return self._layers

    @property
    def levels(self) -> int:
        """Mipmap levels; 1 for none."""
        return self._levels

    @property
    def format(self) -> TextureFormat:
        """How texels are stored."""
        return self._format

    @property
    def nbytes(self) -> int:
        """Bytes of level 0 in client memory."""
        width, height = self._size
        return width * height * self._layers * self._format.channels * self._format.dtype.itemsize

    def bind(self, unit: int) -> None:
        """Make it what samplers set to this texture unit read (0 to 15); unit 0 stays active."""
        gl.glActiveTexture(gl.GL_TEXTURE0 + unit)
        gl.glBindTexture(getattr(gl, self._target), self.name)
        gl.glActiveTexture(gl.GL_TEXTURE0)

    def build_mipmaps(self) -> None:
        """Compute the levels above 0 from level 0; sRGB texels are averaged in linear light."""
        target = self._attach()
        gl.glGenerateMipmap(target)
        self._detach()

    @abstractmethod
    def _allocate(self, level: int) -> None:
        """Make the memory of a level."""

    def _attach(self) -> int:
        gl.glActiveTexture(gl.GL_TEXTURE0 + SPARE_UNIT)
        target = int(getattr(gl, self._target))
        gl.glBindTexture(target, self.name)
        return target

    def _detach(self) -> None:
        gl.glBindTexture(getattr(gl, self._target), 0)
        gl.glActiveTexture(gl.GL_TEXTURE0)

    def _level_size(self, level: int) -> tuple[int, int]:
        if not 0 <= level < self._levels:
            raise ValueError(f"level is {level}, expected 0 to {self._levels - 1}")
        return max(1, self._size[0] >> level), max(1, self._size[1] >> level)

    def _block(self, array: NDArray[Any], axes: int) -> NDArray[Any]:
        """Return texels as a C-contiguous array with `axes` axes and one of channels."""
        channels = self._format.channels
        if array.dtype != self._format.dtype:
            raise ValueError(
                f"array is {array.dtype}, texture format {self._format.name} takes "
                f"{self._format.dtype}"
            )
        shape = array.shape
        if channels == 1 and array.ndim == axes:
            shape = (*shape, 1)
        if len(shape) != axes + 1 or shape[-1] != channels:
            names = ("layers", "height", "width")[3 - axes :]
            raise ValueError(
                f"array has shape {array.shape}, expected ({', '.join(names)}, {channels})"
            )
        return np.ascontiguousarray(array).reshape(shape)

    def _check_inside(self, what: str, first: int, count: int, limit: int) -> None:
        if first < 0 or first + count > limit:
            raise ValueError(f"{what} {first} to {first + count} lie outside of 0 to {limit}")

    def _read(self, shape: tuple[int, ...], level: int) -> NDArray[Any]:
        out = np.empty(shape, self._format.dtype)
        target = self._attach()
        gl.glBindBuffer(gl.GL_PIXEL_PACK_BUFFER, 0)
        gl.glPixelStorei(gl.GL_PACK_ALIGNMENT, 1)
        gl.glGetTexImage(target, level, *self._format.transfer, out.ctypes.data)
        self._detach()
        return out


class Texture2D(Texture):
    """A texture.

    Parameters
    ----------
    size
        (width, height) in texels.
    format
        How texels are stored.
    levels
        Mipmap levels; fill those above 0 with `write` or `build_mipmaps`.
    filter
        By default linear for 8 and 16 bit formats and nearest for 32 bit ones.
    wrap
        What coordinates outside of 0..1 read: the edge, or the texture repeated.
    compare
        Depth only: shaders read it through a shadow sampler, ``reference <= depth``.

    Raises
    ------
    GraphicsError
        Without a current context.
    ValueError
        For a size beyond the driver's limits or a filter that the format forbids.

    Notes
    -----
    The contents are undefined until written.
    """

    __slots__ = ()

    _target = "GL_TEXTURE_2D"

    def __init__(
        self,
        size: tuple[int, int],
        format: TextureFormat = TextureFormat.RGBA8,
        *,
        levels: int = 1,
        filter: Filter | None = None,
        wrap: Wrap = "clamp",
        compare: bool = False,
    ) -> None:
        super().__init__(size, 1, format, levels, filter, wrap, compare)

    def write(self, array: NDArray[Any], x: int = 0, y: int = 0, *, level: int = 0) -> None:
        """Copy texels into a rectangle.

        Parameters
        ----------
        array
            (height, width, channels), or (height, width) for one channel, of the format's dtype.
        x, y
            Texel at which the array's [0, 0] goes.
        level
            Mipmap level.

        Raises
        ------
        ValueError
            For a wrong dtype or shape, or texels outside; nothing is written then.
        """
        block = self._block(array, 2)
        width, height = self._level_size(level)
        self._check_inside("columns", x, block.shape[1], width)
        self._check_inside("rows", y, block.shape[0], height)
        if block.size == 0:
            return
        target = self._attach()
        set_unpacking()
        gl.glTexSubImage2D(
            target,
            level,
            x,
            y,
            block.shape[1],
            block.shape[0],
            *self._format.transfer,
            block.ctypes.data,
        )
        self._detach()

    def read(self, level: int = 0) -> NDArray[Any]:
        """Return all texels of a level, (height, width, channels); waits for the GPU."""
        width, height = self._level_size(level)
        return self._read((height, width, self._format.channels), level)

    def _allocate(self, level: int) -> None:
        gl.glTexImage2D(
            getattr(gl, self._target),
            level,
            self._format.internal,
            *self._level_size(level),
            0,
            *self._format.transfer,
            None,
        )


def set_unpacking() -> None:
    """Make GL read tightly packed texels from client memory, whatever was set before."""
    gl.glBindBuffer(gl.GL_PIXEL_UNPACK_BUFFER, 0)
    gl.glPixelStorei(gl.GL_UNPACK_ALIGNMENT, 1)
    for parameter in (
        gl.GL_UNPACK_SWAP_BYTES,
        gl.GL_UNPACK_ROW_LENGTH,
        gl.GL_UNPACK_IMAGE_HEIGHT,
        gl.GL_UNPACK_SKIP_PIXELS,
        gl.GL_UNPACK_SKIP_ROWS,
        gl.GL_UNPACK_SKIP_IMAGES,
    ):
        gl.glPixelStorei(parameter, 0)


def check_size(size: tuple[int, int]) -> None:
    """Raise ValueError for a (width, height) that the driver does not take."""
    most = get_integer("GL_MAX_TEXTURE_SIZE")
    if len(size) != 2 or not (1 <= size[0] <= most and 1 <= size[1] <= most):
        raise ValueError(f"size is {size}, this driver takes 1 to {most} texels a side")


def _check_counts(size: tuple[int, int], layers: int, levels: int) -> None:
    most = get_integer("GL_MAX_ARRAY_TEXTURE_LAYERS")
    if not 1 <= layers <= most:
        raise ValueError(f"layers is {layers}, this driver takes 1 to {most}")
    most = max(size).bit_length()
    if not 1 <= levels <= most:
        raise ValueError(f"levels is {levels}, a texture of {size} has 1 to {most}")


def _check_sampling(format: TextureFormat, filter: str, wrap: str, compare: bool) -> None:
    if filter not in ("nearest", "linear"):
        raise ValueError(f"filter is '{filter}', expected nearest or linear")
    if filter == "linear" and format.is_integer:
        raise ValueError(f"filter is linear, but integer format {format.name} takes only nearest")
    if wrap not in _WRAPS:
        raise ValueError(f"wrap is '{wrap}', expected one of {', '.join(_WRAPS)}")
    if compare and not format.is_depth:
        raise ValueError(f"compare is for DEPTH24, not for {format.name}")
