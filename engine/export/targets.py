"""Where files are written: checked before the work is done, and replaced only when it is."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from ..errors import AssetError

Progress = Callable[[str, int, int], None]
"""Called as ``progress(what, done, total)``."""

LARGEST_FILE = 2**31 - 1
"""Bytes; many readers count in 31 bits."""


@dataclass(frozen=True, slots=True)
class Exported:
    """What an export wrote.

    Parameters
    ----------
    path
        The file; others may lie beside it.
    size
        Bytes of all of them.
    agents, frames
        How many of each are in it.
    triangles
        Of all agents together.
    stretched
        Agents whose bones have further joints for stretch; see docs/export.md.
    deviation
        Largest distance in metres, in the character's own size, by which one joint's stretch moves
        a vertex where it was left out.
    """

    path: Path
    size: int
    agents: int
    frames: int
    triangles: int
    stretched: int = 0
    deviation: float = 0.0


def check_target(path: str | Path, kinds: tuple[str, ...]) -> Path:
    """The path, if a file can be written there.

    Parameters
    ----------
    path
        Of the file.
    kinds
        Endings that are allowed, such as ``".glb"``.

    Raises
    ------
    AssetError
        For another ending, a folder that doesn't exist, or one that can't be written to.
    """
    target = Path(path)
    if target.suffix.lower() not in kinds:
        raise AssetError(path, "", f"its name must end in {' or '.join(kinds)}")
    if target.is_dir():
        raise AssetError(path, "", "is a folder")
    folder = target.parent
    if not folder.is_dir():
        raise AssetError(path, "", f"there is no folder '{folder}'")
    if not os.access(target if target.exists() else folder, os.W_OK):
        raise AssetError(path, "", "can't be written: permission denied")
    return target


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A path beside `path` to write to, which takes its place in the end.

    Raises
    ------
    AssetError
        If the file can't be written; what was there before stays.
    """
    part = path.with_name(f".{path.stem}.part{path.suffix}")
    try:
        yield part
        part.replace(path)
    except OSError as error:
        raise AssetError(path, "", f"can't be written: {error.strerror or error}") from error
    finally:
        part.unlink(missing_ok=True)


def check_size(path: Path, size: int, advice: str) -> None:
    """AssetError if a file of `size` bytes would be too large for its readers."""
    if size > LARGEST_FILE:
        raise AssetError(
            path, "", f"would take {size / 1e9:.1f} GB, at most 2.1 GB can be read; {advice}"
        )
