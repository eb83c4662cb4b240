"""Memory on the GPU: vertices, indices, instances and uniform blocks alike."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import DTypeLike, NDArray

from .api import gl
from .objects import GLObject

Usage = Literal["static", "dynamic", "stream"]

_USAGES = {"static": "GL_STATIC_DRAW", "dynamic": "GL_DYNAMIC_DRAW", "stream": "GL_STREAM_DRAW"}


class Buffer(GLObject):
    """A block of GPU memory without a fixed role.

    It is bound to GL_COPY_WRITE_BUFFER for every transfer, so no vertex array loses its index
    buffer and no drawing state changes.

    Parameters
    ----------
    data
        An array to copy, of any shape and dtype, or a number of bytes to reserve.
    usage
        ``"static"`` (written once), ``"dynamic"`` (now and then) or ``"stream"`` (each frame).

    Raises
    ------
    GraphicsError
        Without a current context.
    ValueError
        For a negative size or an unknown usage.
    """

    __slots__ = ("_nbytes", "_usage")

    def __init__(self, data: NDArray[Any] | int, usage: Usage = "static") -> None:
        if usage not in _USAGES:
            raise ValueError(f"usage is '{usage}', expected one of {', '.join(_USAGES)}")
        nbytes = _size_of(data)
        super().__init__("buffer")
        self._usage: Usage = usage
        self._nbytes = nbytes
        self.replace(data)

    @property
    def nbytes(self) -> int:
        """Size in bytes."""
        return self._nbytes

    @property
    def usage(self) -> Usage:
        """How often it is expected to be written."""
        return self._usage

    def replace(self, data: NDArray[Any] | int) -> None:
        """Give the buffer new contents and a new size; vertex arrays that use it stay valid.

        Parameters
        ----------
        data
            An array to copy, or a number of bytes whose contents are undefined.
        """
        nbytes = _size_of(data)
        self._bind()
        if isinstance(data, np.ndarray):
            block = np.ascontiguousarray(data)
            gl.glBufferData(
                gl.GL_COPY_WRITE_BUFFER, nbytes, block.ctypes.data, self._usage_constant()
            )
        else:
            gl.glBufferData(gl.GL_COPY_WRITE_BUFFER, nbytes, None, self._usage_constant())
        self._nbytes = nbytes

    def write(self, array: NDArray[Any], offset: int = 0, *, orphan: bool = False) -> None:
        """Copy an array into the buffer.

        Parameters
        ----------
        array
            Any shape and dtype; copied in C order.
        offset
            First byte written.
        orphan
            Drop the old contents first, so that the driver need not wait for draws that still
            read them: use it when the whole of what is drawn next gets written anew.

        Raises
        ------
        ValueError
            When the array does not fit; nothing is written then.
        """
        block = np.ascontiguousarray(array)
        if offset < 0 or offset + block.nbytes > self._nbytes:
            raise ValueError(
                f"array has {block.nbytes} bytes at offset {offset}, "
                f"and the buffer holds {self._nbytes}"
            )
        if block.nbytes == 0:
            return
        self._bind()
        if orphan:
            gl.glBufferData(gl.GL_COPY_WRITE_BUFFER, self._nbytes, None, self._usage_constant())
        gl.glBufferSubData(gl.GL_COPY_WRITE_BUFFER, offset, block.nbytes, block.ctypes.data)

    def read(
        self, dtype: DTypeLike = np.uint8, count: int | None = None, offset: int = 0
    ) -> NDArray[Any]:
        """Copy part of the buffer back; waits until the GPU has written it.

        Parameters
        ----------
        dtype
            Of the returned elements; may be structured.
        count
            Elements to read; by default all that fit behind `offset`.
        offset
            First byte read.

        Returns
        -------
        (count,) array

        Raises
        ------
        ValueError
            When the range does not lie inside the buffer.
        """
        kind = np.dtype(dtype)
        if count is None:
            count = max(0, self._nbytes - offset) // kind.itemsize
        nbytes = count * kind.itemsize
        if offset < 0 or count < 0 or offset + nbytes > self._nbytes:
            raise ValueError(
                f"{count} elements of {kind.itemsize} bytes at offset {offset} don't lie in a "
                f"buffer of {self._nbytes} bytes"
            )
        out = np.empty(count, kind)
        if nbytes:
            self._bind()
            gl.glGetBufferSubData(gl.GL_COPY_WRITE_BUFFER, offset, nbytes, out.ctypes.data)
        return out

    def bind_uniform(self, binding: int) -> None:
        """Make it the contents of the uniform blocks with that binding point.

        Binding 0 is pyglet's window block.
        """
        gl.glBindBufferBase(gl.GL_UNIFORM_BUFFER, binding, self.name)

    def _bind(self) -> None:
        gl.glBindBuffer(gl.GL_COPY_WRITE_BUFFER, self.name)

    def _usage_constant(self) -> int:
        return int(getattr(gl, _USAGES[self._usage]))


def _size_of(data: NDArray[Any] | int) -> int:
    if isinstance(data, np.ndarray):
        return data.nbytes
    if data < 0:
        raise ValueError(f"data is {data} bytes, expected 0 or more")
    return int(data)
