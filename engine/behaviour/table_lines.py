"""On which line of a TOML file a table or a key stands; the standard parser doesn't tell."""

from __future__ import annotations

import re

_HEADER = re.compile(r"\s*(\[\[?)\s*([^\[\]#]+?)\s*\]\]?\s*(#.*)?$")
_KEY = re.compile(r"\s*([A-Za-z0-9_-]+|\"[^\"]*\"|'[^']*')\s*[=.]")


class Lines:
    """Lines of the headers of a file, and of the keys below them.

    Parameters
    ----------
    text
        The file.
    """

    def __init__(self, text: str) -> None:
        self._lines = text.splitlines()
        self._headers: dict[str, list[int]] = {}
        for number, line in enumerate(self._lines, start=1):
            match = _HEADER.match(line)
            if match:
                name = ".".join(part.strip().strip("\"'") for part in match[2].split("."))
                self._headers.setdefault(name, []).append(number)

    def of(self, header: str, index: int = 0, key: str = "") -> int:
        """Line of the header's `index`-th appearance, or of a key below it; 0 if not found."""
        found = self._headers.get(header, []) if header else [0]
        if not found:
            # ``[a.b.c]`` opens the tables a and a.b, too.
            below = (n for name, n in self._headers.items() if name.startswith(f"{header}."))
            found = next(below, [])
        if index >= len(found):
            return 0
        begin = found[index]
        if not key:
            return begin
        for number in range(begin, len(self._lines)):
            if _HEADER.match(self._lines[number]):
                break
            match = _KEY.match(self._lines[number])
            if match and match[1].strip("\"'") == key:
                return number + 1
        return begin
