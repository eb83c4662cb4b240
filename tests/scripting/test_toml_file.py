"""Lines of keys in TOML files, against files of which they are known."""

from __future__ import annotations

import tomllib
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from tifo.scripting.toml_file import line_numbers, literal

TEXT = '''\
# [[node]]
a = 1
[[node]] # first
name = "x # [y]"
[node.exports]
list = [
  1, # key = 2
  "]",
]
text = """
name = "not a key"
[[node]]
"""
"quoted key" = 'it''s'.x
'''


def test_a_hand_counted_file() -> None:
    text = TEXT.replace("'it''s'.x", "'[['") + "[[node]]\nname = 'z'\n[node.exports]\nlist = []\n"
    tomllib.loads(text)
    assert line_numbers(text) == {
        ("a",): 2,
        ("node", 0): 3,
        ("node", 0, "name"): 4,
        ("node", 0, "exports"): 5,
        ("node", 0, "exports", "list"): 6,
        ("node", 0, "exports", "text"): 10,
        ("node", 0, "exports", "quoted key"): 14,
        ("node", 1): 15,
        ("node", 1, "name"): 16,
        ("node", 1, "exports"): 17,
        ("node", 1, "exports", "list"): 18,
    }


plain = st.recursive(
    st.booleans()
    | st.integers(-(2**63), 2**63 - 1)
    | st.floats(allow_nan=False)
    | st.text(st.characters(codec="utf-8")),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.text(st.characters(codec="utf-8"), max_size=4), inner, max_size=3)
    ),
    max_leaves=6,
)


@given(st.dictionaries(st.from_regex(r"[a-z]{1,5}", fullmatch=True), plain, max_size=4))
def test_literals_are_read_back_and_their_lines_found(values: dict[str, Any]) -> None:
    text = "".join(f"{key} = {literal(value)}\n" for key, value in values.items())
    assert tomllib.loads(text) == values
    lines = line_numbers(text)
    for number, key in enumerate(values, start=1):
        assert lines[(key,)] == number
