"""Pictures and clips on disk."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from tifo import GraphicsError


def write_png(path: str | Path, pixels: NDArray[np.uint8]) -> None:
    """Write (H, W, 3) uint8 sRGB pixels.

    Raises
    ------
    GraphicsError
        If the file can't be written.
    """
    from PIL import Image

    try:
        Image.fromarray(pixels).save(path, format="PNG")
    except OSError as error:
        raise GraphicsError(f"can't write the picture {path}: {error.strerror or error}") from None


def check_writable(path: str | Path) -> None:
    """Refuse a file that can't be written, before the work of drawing it.

    Raises
    ------
    GraphicsError
        If its folder doesn't exist or it is a folder.
    """
    file = Path(path)
    if file.is_dir():
        raise GraphicsError(f"can't write {path}: it is a folder")
    if not file.parent.is_dir():
        raise GraphicsError(f"can't write {path}: there is no folder {file.parent}")


class Clip:
    """An MP4 file that grows by one picture at a time.

    Parameters
    ----------
    path
        Where it goes.
    size
        Pixels (width, height); an odd row or column is cut off, as H.264 wants even sizes.
    rate
        Pictures a second.

    Raises
    ------
    GraphicsError
        If PyAV isn't installed or the file can't be written.
    """

    def __init__(self, path: str | Path, size: tuple[int, int], rate: int) -> None:
        try:
            import av
        except ImportError:
            raise GraphicsError(
                "clips need PyAV, which is not installed: pip install 'tifo[demo]'"
            ) from None
        self._av: Any = av
        self._size = (size[0] // 2 * 2, size[1] // 2 * 2)
        try:
            self._file: Any = av.open(str(path), "w", format="mp4")
        except OSError as error:
            raise GraphicsError(f"can't write the clip {path}: {error.strerror or error}") from None
        self._stream: Any = self._file.add_stream("libx264", rate=Fraction(rate))
        self._stream.width, self._stream.height = self._size
        self._stream.pix_fmt = "yuv420p"
        self._stream.options = {"crf": "20", "preset": "veryfast"}

    def add(self, pixels: NDArray[np.uint8]) -> None:
        """Append a picture (H, W, 3) uint8 sRGB."""
        width, height = self._size
        frame = self._av.VideoFrame.from_ndarray(
            np.ascontiguousarray(pixels[:height, :width]), format="rgb24"
        )
        self._file.mux(self._stream.encode(frame))

    def close(self) -> None:
        """Finish the file."""
        self._file.mux(self._stream.encode(None))
        self._file.close()

    def __enter__(self) -> Self:
        """The clip itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Finish the file."""
        self.close()
