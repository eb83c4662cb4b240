"""Errors that a user of tifo can meet.

Every message is one sentence that names the thing, the place and the cause, so that the command
line can print it as it is.
"""

from __future__ import annotations

from pathlib import Path


class TifoError(Exception):
    """Base class of the errors that tell the user what to do; the command line prints these."""


class AssetError(TifoError):
    """A file can't be used.

    Parameters
    ----------
    path
        The file as the user named it.
    place
        Where in the file: ``"line 12"``, ``"accessor 3"``, ``"skins[0].joints"``; empty for the
        whole file.
    cause
        What is wrong there and, where it helps, what was expected.
    """

    def __init__(self, path: str | Path, place: str, cause: str) -> None:
        self.path = Path(path)
        self.place = place
        self.cause = cause
        where = f"{path}, {place}" if place else f"{path}"
        super().__init__(f"{where}: {cause}")


class GraphicsError(TifoError):
    """No usable OpenGL, display or shader; says what to install or which switch to use."""
