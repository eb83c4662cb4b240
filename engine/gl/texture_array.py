"""Array textures: pose rings, sprites and everything else that comes in equal layers."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from .api import gl
from .texture import Filter, Texture, Wrap, set_unpacking
from .texture_format import TextureFormat


class TextureArray(Texture):
    """Equal textures addressed by a layer number.

    Parameters
    ----------
    size
        (width, height) of each layer in texels.
    layers
        How many.
    format, levels, filter, wrap, compare
        As in `Texture2D`.

    Raises
    ------
    GraphicsError
        Without a current context.
    ValueError
        For sizes beyond the driver's limits or a filter that the format forbids.
    """

    __slots__ = ()

    _target = "GL_TEXTURE_2D_ARRAY"

    def __init__(
        self,
        size: tuple[int, int],
        layers: int,
        format: TextureFormat = TextureFormat.RGBA8,
        *,
        levels: int = 1,
        filter: Filter | None = None,
        wrap: Wrap = "clamp",
        compare: bool = False,
    ) -> None:
        super().__init__(size, layers, format, levels, filter, wrap, compare)

    def write(
        self, array: NDArray[Any], x: int = 0, y: int = 0, layer: int = 0, *, level: int = 0
    ) -> None:
        """Copy texels into a rectangle of one layer or of several.

        Parameters
        ----------
        array
            (height, width, channels) for one layer or (layers, height, width, channels), of the
            format's dtype; the axis of channels may be missing for one channel, and then only
            arrays of three axes are taken, as (layers, height, width).
        x, y, layer
            Texel and layer at which the array's first texel goes.
        level
            Mipmap level.

        Raises
        ------
        ValueError
            For a wrong dtype or shape, or texels outside; nothing is written then.
        """
        one_layer = array.ndim == 3 and self._format.channels == array.shape[2]
        block = self._block(array[None] if one_layer or array.ndim == 2 else array, 3)
        width, height = self._level_size(level)
        self._check_inside("columns", x, block.shape[2], width)
        self._check_inside("rows", y, block.shape[1], height)
        self._check_inside("layers", layer, block.shape[0], self._layers)
        if block.size == 0:
            return
        target = self._attach()
        set_unpacking()
        gl.glTexSubImage3D(
            target,
            level,
            x,
            y,
            layer,
            block.shape[2],
            block.shape[1],
            block.shape[0],
            *self._format.transfer,
            block.ctypes.data,
        )
        self._detach()

    def read(self, level: int = 0) -> NDArray[Any]:
        """Return all texels of a level, (layers, height, width, channels); waits for the GPU."""
        width, height = self._level_size(level)
        return self._read((self._layers, height, width, self._format.channels), level)

    def _allocate(self, level: int) -> None:
        gl.glTexImage3D(
            getattr(gl, self._target),
            level,
            self._format.internal,
            *self._level_size(level),
            self._layers,
            0,
            *self._format.transfer,
            None,
        )
