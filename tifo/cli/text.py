"""What commands share to print what files and drivers say."""

from __future__ import annotations

import sys


def printable(text: str) -> str:
    """Text that any terminal takes: nothing that moves its cursor or that it can't encode.

    Names in files are anybody's bytes: ``printable("a\\x1b[2J")`` is ``"a?[2J"``.
    """
    shown = "".join(letter if letter.isprintable() else "?" for letter in text)
    encoding = sys.stdout.encoding or "ascii"
    return shown.encode(encoding, "replace").decode(encoding)
