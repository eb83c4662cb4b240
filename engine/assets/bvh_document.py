"""Reads the text of a BVH file, and nothing more: joints, channels and rows as they stand there.

`bvh.py` makes a skeleton and a clip of it. The split keeps the file's own numbers within reach:
tools and tests can look at a file before anything is scaled, dropped or resampled.

What is accepted beyond the usual: any order of channels and of OFFSET, CHANNELS and children,
joints with no channels, names with blanks, several roots, LF, CRLF and CR, tabs, a UTF-8 byte
order mark, ``Frames:12`` with no blank. One row of numbers is one line.
"""

from __future__ import annotations

import re
from array import array
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import AssetError
from .bvh_hierarchy import MAX_NUMBER, EndSite, Hierarchy, parse_number, shown

FRAME_TIMES = (1e-4, 1.0)
"""Seconds between frames that are believed; a count of frames a second fails here."""


@dataclass(frozen=True, slots=True, eq=False)
class BvhDocument:
    """A BVH file as it stands: its own units, degrees, joint order and frames.

    Parameters
    ----------
    names
        J unique joint names in the file's order (depth first).
    parents
        Index of each joint's parent, -1 for a root; parents come before children.
    offsets
        (J, 3) float64 OFFSETs in the file's unit.
    channels
        For each joint its channels, such as ``("xposition", "zrotation")``, in lower case.
    end_sites
        The End Sites in the file's order.
    frame_time
        Seconds between rows.
    values
        (F, C) float64, one column a channel in the order of `channels`; degrees or file units.
    notes
        What was changed or left out, one sentence each.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: NDArray[np.float64]
    channels: tuple[tuple[str, ...], ...]
    end_sites: tuple[EndSite, ...]
    frame_time: float
    values: NDArray[np.float64]
    notes: tuple[str, ...]


def parse_bvh(path: str | Path) -> BvhDocument:
    """Read a BVH file as it stands.

    Raises
    ------
    AssetError
        If the file can't be read or is not well formed; the place is the line.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise AssetError(path, "", f"can't be read: {error.strerror or error}") from error
    except ValueError as error:
        raise AssetError(path, "", f"can't be read: {error}") from error
    lines = data.removeprefix(b"\xef\xbb\xbf").splitlines()
    hierarchy = Hierarchy(path, lines)
    frame_time, declared, start = _motion_header(path, lines, hierarchy.motion_line)
    width = sum(len(names) for names in hierarchy.channels)
    if width == 0:
        raise AssetError(path, f"line {start}", "no joint has channels, so nothing moves")
    values, extra = _rows(path, lines, start, declared, width)
    notes = list(hierarchy.notes)
    if extra:
        notes.append(f"{extra} rows beyond the {declared} that 'Frames' declares were ignored")
    return BvhDocument(
        names=tuple(hierarchy.names),
        parents=tuple(hierarchy.parents),
        offsets=np.array(hierarchy.offsets),
        channels=tuple(hierarchy.channels),
        end_sites=tuple(hierarchy.end_sites),
        frame_time=frame_time,
        values=values,
        notes=tuple(notes),
    )


def _motion_header(
    path: str | Path, lines: list[bytes], motion_line: int
) -> tuple[float, int, int]:
    """Frame time, declared frame count and the number of lines up to the first row."""
    fields: list[tuple[int, bytes]] = []
    number = motion_line
    for label, pattern in (
        ("Frames:", rb"frames\s*:\s*(\S+)"),
        ("Frame Time:", rb"frame\s*time\s*:\s*(\S+)"),
    ):
        while number < len(lines) and not lines[number].strip():
            number += 1
        number += 1
        line = lines[number - 1].strip() if number <= len(lines) else b""
        match = re.fullmatch(pattern, line, flags=re.IGNORECASE)
        if match is None:
            raise AssetError(
                path,
                f"line {min(number, len(lines))}",
                f"expected '{label}' and a number, found {shown(line.decode('latin-1'))}",
            )
        fields.append((number, match.group(1)))
    (count_line, count), (time_line, seconds) = fields
    if not count.isdigit() or len(count) > 18 or int(count) == 0:
        raise AssetError(
            path,
            f"line {count_line}",
            f"Frames is {shown(count.decode('latin-1'))}, expected a count of at least 1",
        )
    frame_time = parse_number(path, time_line, seconds.decode("latin-1"))
    if not FRAME_TIMES[0] <= frame_time <= FRAME_TIMES[1]:
        raise AssetError(
            path,
            f"line {time_line}",
            f"Frame Time is {frame_time:g}, expected seconds a frame "
            f"from {FRAME_TIMES[0]:g} to {FRAME_TIMES[1]:g}",
        )
    return frame_time, int(count), number


def _rows(
    path: str | Path, lines: list[bytes], start: int, declared: int, width: int
) -> tuple[NDArray[np.float64], int]:
    """The (F, width) values below line `start`, and how many rows follow the declared ones."""
    numbers: list[int] = []
    flat = array("d")
    extra = 0
    for number, line in enumerate(lines[start:], start=start + 1):
        tokens = line.decode("latin-1").split()
        if not tokens:
            continue
        if len(numbers) == declared:
            extra += 1
            continue
        if len(tokens) != width:
            raise AssetError(
                path, f"line {number}", f"{len(tokens)} values, expected {width} (one a channel)"
            )
        try:
            # Python's own float takes 1_000, which no other program writes or reads.
            flat.extend(map(float, tokens if b"_" not in line else "_"))
        except ValueError:
            for token in tokens:
                parse_number(path, number, token)
        numbers.append(number)
    if len(numbers) < declared:
        raise AssetError(
            path,
            f"line {len(lines)}",
            f"the file ends after {len(numbers)} rows, but 'Frames' declares {declared}",
        )
    values = np.frombuffer(flat, dtype=np.float64).reshape(-1, width)
    bad = ~(np.abs(values) <= MAX_NUMBER)
    if bad.any():
        row = int(np.argmax(bad.any(axis=1)))
        parse_number(path, numbers[row], repr(float(values[row, np.argmax(bad[row])])))
    return values, extra
