"""Flat TOML files of named values: reading with the place of every mistake, and writing."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from difflib import get_close_matches
from pathlib import Path

from ..errors import AssetError

_AT = re.compile(r"\(at (line \d+, column \d+)\)|\(at (end of document)\)")


def read_settings(
    path: str | Path, known: tuple[str, ...]
) -> tuple[dict[str, object], dict[str, str]]:
    """Values by key, and for each key its place in the file for messages.

    Parameters
    ----------
    path
        The file.
    known
        The keys that may occur.

    Raises
    ------
    AssetError
        The file can't be read, is not TOML, or has an unknown key; near matches are offered.
    """
    file = Path(path)
    try:
        if not file.is_file():
            raise AssetError(path, "", "there is no such file")
        text = file.read_bytes().decode("utf-8")
    except UnicodeDecodeError as error:
        raise AssetError(path, f"byte {error.start}", "the file is not UTF-8 text") from error
    except (OSError, ValueError) as error:
        raise AssetError(path, "", f"can't be read: {error}") from error
    try:
        values: dict[str, object] = tomllib.loads(text)
    except RecursionError as error:
        raise AssetError(path, "", "values are nested too deeply") from error
    except ValueError as error:
        at = _AT.search(str(error))
        place = ""
        if at:
            place = at[1] or f"line {len(text.splitlines())}"
        cause = _AT.sub("", str(error)).strip()
        raise AssetError(path, place, f"not valid TOML: {cause}") from error
    places = {key: _place(text, key) for key in values}
    for key in values:
        if key not in known:
            near = get_close_matches(key, known, n=2, cutoff=0.7)
            hint = f"did you mean {' or '.join(near)}?" if near else f"known: {', '.join(known)}"
            raise AssetError(path, places[key], f"unknown key '{key}'; {hint}")
    return values, places


def format_settings(values: Mapping[str, object]) -> str:
    """TOML text with one line a value: whole numbers, floats, booleans, texts, tuples of texts."""
    return "".join(f"{key} = {_literal(value)}\n" for key, value in values.items())


def _literal(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, tuple):
        return f"[{', '.join(_literal(item) for item in value)}]"
    return repr(value)


def _place(text: str, key: str) -> str:
    """Line on which `key` (or its table) begins; the parser does not tell."""
    name = re.escape(key)
    begins = re.compile(rf"\s*(?:\[+\s*)?(?:{name}|\"{name}\"|'{name}')\s*[=.\]]")
    for number, line in enumerate(text.splitlines(), start=1):
        if begins.match(line):
            return f"line {number}"
    return f"key '{key}'"
