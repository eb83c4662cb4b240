"""Which kind of file a path is, after checking that it can be opened."""

from __future__ import annotations

from pathlib import Path

from ..errors import AssetError

GLTF_SUFFIXES = (".glb", ".gltf")
SUFFIXES = (*GLTF_SUFFIXES, ".bvh")
"""Lower-case suffixes of the files that can be opened."""


def suffix_of(path: str | Path) -> str:
    """Lower-case suffix of a file that is there, can be opened and is of a known kind.

    Raises
    ------
    AssetError
        If it is not.
    """
    try:
        if not Path(path).exists():
            raise AssetError(path, "", "there is no such file")
        if Path(path).is_dir():
            raise AssetError(path, "", f"is a folder, expected a file ({', '.join(SUFFIXES)})")
        if not Path(path).is_file():
            raise AssetError(path, "", "is not a regular file")
        suffix = Path(path).suffix.lower()
        if suffix not in SUFFIXES:
            kind = f"'{suffix}' files" if suffix else "files without a suffix"
            raise AssetError(path, "", f"{kind} can't be read, only {', '.join(SUFFIXES)}")
        with Path(path).open("rb"):
            return suffix
    except OSError as error:
        raise AssetError(path, "", f"can't be read: {error.strerror or error}") from error
