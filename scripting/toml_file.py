"""TOML files with the line of everything in them, which the parser of the library doesn't tell."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

from ..engine.errors import AssetError

_HEADER = re.compile(r"\s*(\[\[?)\s*([^\]]*?)\s*\]\]?\s*(#.*)?$")
_PART = re.compile(r"\s*(?:\"([^\"]*)\"|'([^']*)'|([A-Za-z0-9_-]+))\s*(\.|=|$)")
_AT = re.compile(r"\(at (line \d+, column \d+)\)|\(at (end of document)\)")


class TomlFile:
    """A parsed file.

    Attributes
    ----------
    path
        As the user named it, for messages.
    document
        The values.
    """

    def __init__(self, path: str | Path, text: str) -> None:
        self.path = path
        try:
            self.document: dict[str, Any] = tomllib.loads(text)
        except RecursionError:
            raise AssetError(path, "", "values are nested too deeply") from None
        except tomllib.TOMLDecodeError as error:
            at = _AT.search(str(error))
            place = (at[1] or f"line {len(text.splitlines())}") if at else ""
            cause = _AT.sub("", str(error)).strip()
            raise AssetError(path, place, f"not valid TOML: {cause}") from None
        self._lines = line_numbers(text)

    @classmethod
    def read(cls, path: str | Path, file: Path) -> TomlFile:
        """Read `file`, which is called `path` in messages. AssetError if it can't be."""
        try:
            if not file.is_file():
                raise AssetError(path, "", "there is no such file")
            return cls(path, file.read_bytes().decode("utf-8"))
        except UnicodeDecodeError as error:
            raise AssetError(path, f"byte {error.start}", "the file is not UTF-8 text") from None
        except OSError as error:
            raise AssetError(path, "", f"can't be read: {error}") from None

    def place(self, *keys: str | int) -> str:
        """``"line 12"`` of a key, or of the nearest thing around it: ``("node", 2, "name")``."""
        for count in range(len(keys), 0, -1):
            line = self._lines.get(keys[:count])
            if line is not None:
                return f"line {line}"
        return ""

    def error(self, keys: tuple[str | int, ...], cause: str) -> AssetError:
        """An error at a key."""
        return AssetError(self.path, self.place(*keys), cause)


def line_numbers(text: str) -> dict[tuple[str | int, ...], int]:
    """Lines of all keys and tables by their path; entries of arrays of tables by number."""
    lines: dict[tuple[str | int, ...], int] = {}
    counts: dict[tuple[str | int, ...], int] = {}
    table: tuple[str | int, ...] = ()
    quote, depth = "", 0
    for number, line in enumerate(text.split("\n"), start=1):
        rest = line
        if not quote and depth == 0:
            header = _HEADER.match(line)
            if header and not line.lstrip().startswith("#"):
                names = _names(header[2] + "=")
                table = ()
                for name in names[:-1]:
                    table = (*table, name)
                    if table in counts:
                        table = (*table, counts[table])
                table = (*table, *names[-1:])
                if header[1] == "[[":
                    counts[table] = counts.get(table, -1) + 1
                    table = (*table, counts[table])
                lines.setdefault(table, number)
                continue
            names = _names(line)
            if names:
                for count in range(1, len(names) + 1):
                    lines.setdefault((*table, *names[:count]), number)
                rest = line.partition("=")[2]
        quote, depth = _scan(rest, quote, depth)
    return lines


def literal(value: Any) -> str:
    """A value as TOML on one line: tables inline, lists in brackets."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list):
        return f"[{', '.join(map(literal, value))}]"
    if isinstance(value, dict):
        entries = (f"{literal(name)} = {literal(entry)}" for name, entry in value.items())
        return f"{{ {', '.join(entries)} }}" if value else "{}"
    return repr(float(value)) if isinstance(value, float) else repr(int(value))


def _names(line: str) -> list[str]:
    """Parts of the key that a line begins with, up to its ``=``."""
    names: list[str] = []
    at = 0
    while True:
        part = _PART.match(line, at)
        if part is None:
            return []
        names.append(next(text for text in part.groups()[:3] if text is not None))
        if part[4] != ".":
            return names if part[4] == "=" else []
        at = part.end()


def _scan(text: str, quote: str, depth: int) -> tuple[str, int]:
    """Inside which quote and how many brackets a line ends that began inside these."""
    at = 0
    while at < len(text):
        if quote:
            if quote[0] == '"' and text[at] == "\\":
                at += 2
            elif text.startswith(quote, at):
                at += len(quote)
                quote = ""
            else:
                at += 1
            continue
        sign = text[at]
        if sign == "#":
            break
        if sign in "\"'":
            quote = sign * 3 if text.startswith(sign * 3, at) else sign
            at += len(quote)
            continue
        depth += (sign in "[{") - (sign in "]}")
        at += 1
    return (quote if len(quote) == 3 else ""), max(depth, 0)
