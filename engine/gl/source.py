"""Shader text: packaged files, includes, defines, and compiler messages that name the file.

GLSL knows no include, and drivers disagree about ``#line`` with source numbers (Mesa gets them
wrong for some errors). So includes are flattened here, a map from flat lines to files is kept,
and the compiler's log is rewritten with it.
"""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from importlib.resources.abc import Traversable

from ..errors import GraphicsError

Defines = Mapping[str, int | float | str | bool]

DEFINES_FILE = "<defines>"
TEXT_FILE = "<text>"

_VERSION = re.compile(r"\s*#\s*version\b")
_INCLUDE = re.compile(r"\s*#\s*include\b(.*)")
_QUOTED = re.compile(r'\s*"([^"]+)"\s*(?://.*)?$')
_COMMENT = re.compile(r"//[^\r\n]*|/\*.*?\*/", re.DOTALL)
_COMMENT_PART = re.compile(r"//|/\*|\*/")
_IDENTIFIER = re.compile(r"[A-Za-z_]\w*\Z")
_POSITIONS = (
    re.compile(r"^\s*\d+:(?P<line>\d+)\(\d+\)\s*:\s*"),  # Mesa       0:12(19): error: ...
    re.compile(r"^\s*\d+\((?P<line>\d+)\)\s*:\s*"),  # NVIDIA     0(12) : error C1008: ...
    re.compile(r"^(?P<kind>ERROR|WARNING):\s*\d+:(?P<line>\d+):\s*"),  # Apple, AMD, Intel
    re.compile(r"^\s*\d+:(?P<line>\d+):\s*"),  # some Intel drivers
)


@dataclass(frozen=True, slots=True)
class ShaderSource:
    """Flat GLSL text and where each of its lines came from.

    Parameters
    ----------
    name
        Of the main file, for messages.
    text
        What the compiler gets.
    lines
        (file, line) of each flat line; both counted from 1 in messages and in `location`.
    """

    name: str
    text: str
    lines: tuple[tuple[str, int], ...]

    def location(self, flat_line: int) -> tuple[str, int]:
        """Return (file, line) of a line of `text`, counted from 1.

        Raises
        ------
        ValueError
            When there is no such line.
        """
        if not 1 <= flat_line <= len(self.lines):
            raise ValueError(f"flat_line is {flat_line}, expected 1 to {len(self.lines)}")
        return self.lines[flat_line - 1]

    def translate_log(self, log: str) -> str:
        """Rewrite the positions in a compiler's log to ``file:line`` and quote those lines.

        ``0:12(19): error: `x' undeclared`` becomes ``lib/skin.glsl:4: error: `x' undeclared`` and
        below it the source line. An include whose name has a space is no file: ``my text, line 4``.
        Lines of the log in no known form are kept as they are.
        """
        flat = self.text.split("\n")
        out: list[str] = []
        quoted = 0
        for entry in log.replace("\0", "").strip().split("\n"):
            out.append(entry.rstrip())
            for pattern in _POSITIONS:
                found = pattern.match(entry)
                if found is None:
                    continue
                number = int(found["line"])
                if 1 <= number <= len(self.lines):
                    file, line = self.lines[number - 1]
                    kind = found.groupdict().get("kind")
                    label = f"{kind.lower()}: " if kind else ""
                    rest = entry[found.end() :].rstrip()
                    place = f"{file}, line {line}" if " " in file else f"{file}:{line}"
                    out[-1] = f"{place}: {label}{rest}"
                    if number != quoted:
                        out.append(f"    {flat[number - 1].strip()}")
                    quoted = number
                break
        return "\n".join(out)


def compose(
    source: str,
    *,
    defines: Defines | None = None,
    includes: Mapping[str, str] | None = None,
    name: str | None = None,
) -> ShaderSource:
    """Flatten a shader into one text.

    Parameters
    ----------
    source
        Name of a packaged shader file (``"skinning/near.vert.glsl"``), or shader text: a string
        with a line break is text. It starts with a ``#version`` line.
    defines
        Inserted right after ``#version``. True is 1 and False is 0, so test them with ``#if``.
    includes
        Texts that ``#include`` finds before the packaged files, by name: how a user's own GLSL
        gets into a packaged shader. Errors in them are reported under these names.
    name
        How messages call `source` when it is text.

    Notes
    -----
    ``#include "lib/x.glsl"`` names a file from the root of the shader folder and is replaced by
    its text at the first time, by nothing at later times; it is followed inside ``#if`` branches
    that are off, too, and ignored inside comments.

    Raises
    ------
    GraphicsError
        For a missing or badly written include, a cycle, or a missing ``#version``; names the
        chain of files.
    ValueError
        For a define that is no identifier or has no GLSL form.
    """
    prologue = [f"#define {key} {_literal(key, value)}" for key, value in (defines or {}).items()]
    flattener = _Flattener(includes or {}, prologue)
    if "\n" in source:
        main = name or TEXT_FILE
        flattener.add(main, source)
    else:
        main = source
        flattener.add(main, _find(main, flattener.includes, ()))
    return ShaderSource(main, "\n".join(flattener.text) + "\n", tuple(flattener.lines))


class _Flattener:
    """Collects the lines of one shader and of what it includes."""

    def __init__(self, includes: Mapping[str, str], prologue: list[str]) -> None:
        self.includes = includes
        self.prologue = prologue
        self.text: list[str] = []
        self.lines: list[tuple[str, int]] = []
        self.done: set[str] = set()
        self.chain: list[str] = []

    def add(self, file: str, text: str) -> None:
        self.done.add(file)
        self.chain.append(file)
        is_main = len(self.chain) == 1
        if is_main and not _starts_with_version(text):
            raise GraphicsError(f"shader {file} does not start with '#version 330 core'")
        in_comment = False
        for number, line in enumerate(_split(text), 1):
            starts_in_comment, in_comment = in_comment, _ends_in_comment(line, in_comment)
            include = None if starts_in_comment else _INCLUDE.match(line)
            version = None if starts_in_comment else _VERSION.match(line)
            if include:
                self._include(include[1], number)
                continue
            if version and not (is_main and not self._has_version()):
                raise GraphicsError(
                    f"only the first line of a shader may be '#version', found it in "
                    f"{self._trace()}, line {number}"
                )
            self._emit(line, file, number)
            if version:
                for index, define in enumerate(self.prologue, 1):
                    self._emit(define, DEFINES_FILE, index)
        self.chain.pop()

    def _include(self, argument: str, number: int) -> None:
        quoted = _QUOTED.match(argument)
        if quoted is None:
            raise GraphicsError(
                f'#include needs a file name in quotes, as in #include "lib/pose.glsl", '
                f"found '{argument.strip()}' in {self._trace()}, line {number}"
            )
        file = quoted[1]
        if file in self.chain:
            raise GraphicsError(f"shader files include each other: {self._trace()} -> {file}")
        if file not in self.done:
            self.add(file, _find(file, self.includes, (self._trace(), number)))

    def _emit(self, line: str, file: str, number: int) -> None:
        self.text.append(line)
        self.lines.append((file, number))

    def _has_version(self) -> bool:
        return any(_VERSION.match(line) for line in self.text)

    def _trace(self) -> str:
        return " -> ".join(self.chain)


def _find(name: str, includes: Mapping[str, str], asked_by: tuple[()] | tuple[str, int]) -> str:
    """Return the text of an include or of a packaged shader file."""
    if name in includes:
        return includes[name]
    where = f" (included by {asked_by[0]}, line {asked_by[1]})" if asked_by else ""
    parts = name.split("/")
    if "\\" in name or any(part in ("", ".", "..") for part in parts):
        raise GraphicsError(
            f"'{name}' is no shader name{where}: write it from the root of the shader folder "
            "with forward slashes, as in 'lib/pose.glsl'"
        )
    root = files(f"{__name__.partition('.')[0]}.shaders")
    resource = root.joinpath(*parts)
    if not resource.is_file():
        known = [*includes, *_packaged(root)]
        near = difflib.get_close_matches(name, known, 1)
        hint = f"; did you mean '{near[0]}'?" if near else ""
        raise GraphicsError(f"shader file '{name}' not found{where}{hint}")
    return resource.read_text(encoding="utf-8")


def _packaged(folder: Traversable, prefix: str = "") -> list[str]:
    """Return the names of all packaged shader files."""
    found: list[str] = []
    for entry in folder.iterdir():
        if entry.is_dir():
            found += _packaged(entry, f"{prefix}{entry.name}/")
        elif entry.name.endswith(".glsl"):
            found.append(prefix + entry.name)
    return sorted(found)


def _split(text: str) -> list[str]:
    """Split at the line ends that GLSL compilers count, and no others."""
    lines = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    return lines[:-1] if lines[-1] == "" else lines


def _starts_with_version(text: str) -> bool:
    """Whether the first code is ``#version``."""
    return _VERSION.match(_COMMENT.sub(" ", text.removeprefix("\ufeff"))) is not None


def _ends_in_comment(line: str, inside: bool) -> bool:
    """Whether a block comment is open at the end of a line."""
    position = 0
    while found := _COMMENT_PART.search(line, position):
        if inside:
            inside = found[0] != "*/"
        elif found[0] == "//":
            break
        elif found[0] == "/*":
            inside = True
        position = found.end()
    return inside


def _literal(name: str, value: int | float | str | bool) -> str:
    """Return the GLSL text of a define's value."""
    if not _IDENTIFIER.match(name) or name.startswith("GL_") or "__" in name:
        raise ValueError(f"define '{name}' is no GLSL identifier that a program may define")
    if isinstance(value, bool):
        return "1" if value else "0"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(f"define '{name}' is {value}, expected a finite number")
        return repr(float(value))
    if isinstance(value, str) and "\n" not in value and "\r" not in value:
        return value
    raise ValueError(f"define '{name}' is {value!r}, expected a number, bool or one line of text")
