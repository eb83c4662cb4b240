"""The texts that name seats."""

from __future__ import annotations

import pytest

from tifo.engine.crowd.selection import Selection, parse_label, parse_selection


def test_label() -> None:
    assert parse_label("12|345") == (12, 345)
    assert parse_label(" 0 | 7 ") == (0, 7)


@pytest.mark.parametrize("text", ["", "12", "12|", "|3", "-1|2", "1|2|3", "a|b", "1.5|2", "١|٢"])
def test_bad_label(text: str) -> None:
    with pytest.raises(ValueError, match=r"'12\|345'"):
        parse_label(text)


@pytest.mark.parametrize(
    ("text", "rows", "columns", "sections"),
    [
        ("12|345", (12, 12), (345, 345), None),
        ("rows 3-10", (3, 10), None, None),
        ("row 3", (3, 3), None, None),
        ("columns 1", None, (1, 1), None),
        ("rows 2-4 columns 10-20", (2, 4), (10, 20), None),
        ("columns 10 - 20   row 2", (2, 2), (10, 20), None),
        ("section 5", None, None, (5, 5)),
        ("sections 1-2 rows 0", (0, 0), None, (1, 2)),
    ],
)
def test_selection(
    text: str,
    rows: tuple[int, int] | None,
    columns: tuple[int, int] | None,
    sections: tuple[int, int] | None,
) -> None:
    assert parse_selection(text) == Selection(text, rows, columns, sections)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "names no seat"),
        ("   ", "names no seat"),
        ("rows", "can't be read"),
        ("rows 3-", "can't be read from 'rows 3-'"),
        ("rows 3, columns 4", "can't be read"),
        ("rows 2 seats 4", "from 'seats 4' on"),
        ("rows 10-3", "write rows 3-10"),
        ("rows 1 rows 2", "names rows twice"),
        ("rows 99999999", "can't be read"),
        ("Rows 3", "can't be read"),
    ],
)
def test_bad_selection(text: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        parse_selection(text)


def test_only_one_row_and_column_is_a_seat() -> None:
    assert parse_selection("1|2").is_seat
    assert parse_selection("row 1 column 2").is_seat
    assert not parse_selection("rows 1-2 column 2").is_seat
    assert not parse_selection("row 1").is_seat
    assert not parse_selection("row 1 column 2 section 3").is_seat
