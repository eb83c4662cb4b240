"""The small language that names seats in a crowd file and on the command line.

One text names one seat (``"12|345"``: row 12, column 345) or a range: ``"rows 3-10"``,
``"columns 1"``, ``"section 5"``, or several of these, which narrow each other:
``"rows 2-4 columns 10-20"``. Rows, columns and sections count from 0. This module knows the
grammar only; `occupancy` looks the seats up in a plan.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_LABEL = re.compile(r"\s*(\d{1,7})\s*\|\s*(\d{1,7})\s*\Z", re.ASCII)
_RANGE = re.compile(r"(row|column|section)s?\s+(\d{1,7})(?:\s*-\s*(\d{1,7}))?(?:\s+|\Z)", re.ASCII)
_ALLOWED = (
    "allowed are a seat such as '12|345' and ranges such as 'rows 3-10', 'columns 1', "
    "'rows 2-4 columns 10-20' and 'section 5'"
)

Span = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Selection:
    """What one text names: first and last number of each kind, both included, None for any.

    Parameters
    ----------
    text
        As the user wrote it, for messages.
    rows, columns, sections
        A single seat has a span of one row and one column.
    """

    text: str
    rows: Span | None = None
    columns: Span | None = None
    sections: Span | None = None

    @property
    def is_seat(self) -> bool:
        """Whether exactly one row and one column of the whole plan is named."""
        return (
            self.rows is not None
            and self.columns is not None
            and self.sections is None
            and self.rows[0] == self.rows[1]
            and self.columns[0] == self.columns[1]
        )


def parse_label(text: str) -> tuple[int, int]:
    """Row and column of a label: ``"12|345"`` gives (12, 345); ValueError says what a label is."""
    match = _LABEL.match(text)
    if match is None:
        raise ValueError(f"a seat label is 'row|column' such as '12|345', not {text!r}")
    return int(match[1]), int(match[2])


def parse_selection(text: str) -> Selection:
    """Read one text, for example ``"rows 2-4 columns 10-20"``.

    Raises
    ------
    ValueError
        The text is neither a seat nor a range, a range runs backwards, or a kind comes twice.
    """
    match = _LABEL.match(text)
    if match is not None:
        row, column = int(match[1]), int(match[2])
        return Selection(text, (row, row), (column, column))
    spans: dict[str, Span] = {}
    rest = text.strip()
    if not rest:
        raise ValueError(f"{text!r} names no seat; {_ALLOWED}")
    while rest:
        part = _RANGE.match(rest)
        if part is None:
            raise ValueError(f"{text!r} can't be read from {rest!r} on; {_ALLOWED}")
        kind, first = part[1], int(part[2])
        last = first if part[3] is None else int(part[3])
        if last < first:
            raise ValueError(f"{text!r} runs backwards: write {kind}s {last}-{first}")
        if kind in spans:
            raise ValueError(f"{text!r} names {kind}s twice; write two entries instead")
        spans[kind] = (first, last)
        rest = rest[part.end() :]
    return Selection(text, spans.get("row"), spans.get("column"), spans.get("section"))
