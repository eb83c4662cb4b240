"""Reads the HIERARCHY part of a BVH file: joints, offsets, channels and end sites.

Apart from `bvh_document.py`, which reads the rows below it, because a tree of joints and a table
of numbers have nothing in common but the file.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ..errors import AssetError

MAX_JOINTS = 65_536
"""Meshes refer to joints by 16 bits."""

MAX_NUMBER = 1e9
"""Largest magnitude of a number; what is beyond is a damaged file and overflows float32."""

_CHANNELS = {f"{axis}{kind}" for axis in "xyz" for kind in ("position", "rotation")}


@dataclass(frozen=True, slots=True)
class EndSite:
    """The tip of a bone that ends in no joint: index of its joint and offset from it."""

    joint: int
    offset: tuple[float, float, float]


class Hierarchy:
    """The joints of the lines above MOTION; iterative, so nesting may be thousands deep.

    Parameters
    ----------
    path
        The file, for error messages.
    lines
        All lines of the file.

    Attributes
    ----------
    names, parents, offsets, channels, end_sites
        As in `BvhDocument`.
    notes
        Joints that had to be renamed.
    motion_line
        Number of the line that holds MOTION, counted from 1.

    Raises
    ------
    AssetError
        At the first line that is not as the format wants it.
    """

    def __init__(self, path: str | Path, lines: list[bytes]) -> None:
        """Read the lines up to MOTION."""
        self._path = path
        self._lines = lines
        self.names: list[str] = []
        self.parents: list[int] = []
        self.offsets: list[tuple[float, float, float]] = []
        self.channels: list[tuple[str, ...]] = []
        self.end_sites: list[EndSite] = []
        self.notes: list[str] = []
        self.motion_line = 0
        self._line = 1
        self._used: dict[str, int] = {}
        self._renamed: list[str] = []
        self._tokens = self._split()
        self._read()

    def _error(self, cause: str) -> AssetError:
        return AssetError(self._path, f"line {self._line}", cause)

    def _split(self) -> Iterator[str]:
        for number, line in enumerate(self._lines, start=1):
            self._line = number
            try:
                text = line.decode("utf-8")
            except UnicodeDecodeError:
                text = line.decode("latin-1")
            yield from text.replace("{", " { ").replace("}", " } ").split()

    def _next(self, wanted: str) -> str:
        token = next(self._tokens, None)
        if token is None:
            raise self._error(f"expected {wanted}, but the file ends here")
        return token

    def _number(self, wanted: str) -> float:
        token = self._next(wanted)
        return parse_number(self._path, self._line, token)

    def _vector(self, wanted: str) -> tuple[float, float, float]:
        return self._number(wanted), self._number(wanted), self._number(wanted)

    def _read(self) -> None:
        token = self._next("HIERARCHY")
        if token.upper() != "HIERARCHY":
            raise self._error(f"expected HIERARCHY, found {shown(token)}: this is not a BVH file")
        open_joints: list[int] = []
        known = {"ROOT", "MOTION"}
        while True:
            token = self._next(" or ".join(sorted(known)))
            word = token.upper()
            if word not in known:
                raise self._error(f"expected {' or '.join(sorted(known))}, found {shown(token)}")
            if word == "MOTION":
                break
            if word in ("ROOT", "JOINT"):
                open_joints.append(self._open(open_joints[-1] if open_joints else -1))
            elif word == "OFFSET":
                if not math.isnan(self.offsets[open_joints[-1]][0]):
                    raise self._error(
                        f"second OFFSET of joint {shown(self.names[open_joints[-1]])}"
                    )
                self.offsets[open_joints[-1]] = self._vector("three numbers after OFFSET")
            elif word == "CHANNELS":
                if self.channels[open_joints[-1]]:
                    raise self._error(
                        f"second CHANNELS of joint {shown(self.names[open_joints[-1]])}"
                    )
                self.channels[open_joints[-1]] = self._channels()
            elif word == "END":
                self.end_sites.append(EndSite(open_joints[-1], self._end_site()))
            else:
                closed = open_joints.pop()
                if math.isnan(self.offsets[closed][0]):
                    raise self._error(f"joint {shown(self.names[closed])} has no OFFSET")
            inside = {"JOINT", "OFFSET", "CHANNELS", "END", "}"}
            known = inside if open_joints else {"ROOT", "MOTION"}
        if not self.names:
            raise self._error("MOTION comes before any ROOT")
        self.motion_line = self._line
        if self._renamed:
            self.notes.append(
                f"{len(self._renamed)} joints bear an earlier joint's name and got a number: "
                + ", ".join(self._renamed[:3] + ["..."] * (len(self._renamed) > 3))
            )

    def _name(self, wanted: str) -> str:
        words: list[str] = []
        line = self._line
        while (token := self._next(wanted)) != "{":
            if words and self._line != line:
                raise self._error(f"expected '{{' after {shown(' '.join(words))}")
            line = self._line
            words.append(token)
        return " ".join(words)

    def _open(self, parent: int) -> int:
        line = self._line
        name = self._name("a joint's name and '{'")
        if not name:
            raise self._error("a joint has no name")
        if len(self.names) == MAX_JOINTS:
            raise self._error(f"more than {MAX_JOINTS} joints")
        self.parents.append(parent)
        self.names.append(self._unique(name, line))
        self.offsets.append((math.nan,) * 3)
        self.channels.append(())
        return len(self.names) - 1

    def _unique(self, name: str, line: int) -> str:
        """`name`, or with the first free number behind it, as skeletons need unique names."""
        unique = name
        while unique in self._used:
            self._used[name] += 1
            unique = f"{name}_{self._used[name]}"
        self._used[unique] = 1
        if unique != name:
            self._renamed.append(f"'{unique}' (line {line})")
        return unique

    def _channels(self) -> tuple[str, ...]:
        count = self._next("a count after CHANNELS")
        if count not in {str(n) for n in range(len(_CHANNELS) + 1)}:
            raise self._error(f"CHANNELS {shown(count)}, expected a count from 0 to 6")
        found: list[str] = []
        for _ in range(int(count)):
            token = self._next(f"{count} channel names")
            if token.lower() not in _CHANNELS:
                raise self._error(
                    f"expected {count} channel names, found {shown(token)}; known are "
                    "Xposition, Yposition, Zposition, Xrotation, Yrotation, Zrotation"
                )
            if token.lower() in found:
                raise self._error(f"channel {shown(token)} is listed twice")
            found.append(token.lower())
        return tuple(found)

    def _end_site(self) -> tuple[float, float, float]:
        self._name("'{' after End Site")
        token = self._next("OFFSET of an End Site")
        if token.upper() != "OFFSET":
            raise self._error(f"expected OFFSET of an End Site, found {shown(token)}")
        offset = self._vector("three numbers after OFFSET")
        token = self._next("'}' of an End Site")
        if token != "}":
            raise self._error(f"expected '}}' of an End Site, found {shown(token)}")
        return offset


def parse_number(path: str | Path, line: int, token: str) -> float:
    """`token` as a finite float, or an AssetError that names the line."""
    try:
        if "_" in token:
            raise ValueError
        value = float(token)
    except ValueError:
        hint = "; decimals need a point" if "," in token else ""
        raise AssetError(
            path, f"line {line}", f"expected a number, found {shown(token)}{hint}"
        ) from None
    if not abs(value) <= MAX_NUMBER:
        raise AssetError(
            path, f"line {line}", f"{shown(token)} is not a finite number up to {MAX_NUMBER:g}"
        )
    return value


def shown(text: str) -> str:
    """Quote a piece of the file so that it fits in a sentence and a terminal."""
    return repr(text if len(text) <= 24 else f"{text[:21]}...")
