"""What a controller's parameters may be, and how they are called."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from enum import Enum, IntEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray


class OneShotRequest(IntEnum):
    """What a `OneShot` can be asked for."""

    NONE = 0
    FIRE = 1
    ABORT = 2
    FADE_OUT = 3


class Range(Enum):
    """Which values a parameter takes."""

    NUMBER = "-1e9 to 1e9"
    WEIGHT = "0 to 1e9"
    AMOUNT = "0 to 1"
    TRIGGER = "true or false"
    REQUEST = "'none', 'fire', 'abort' or 'fade_out'"


@dataclass(frozen=True, slots=True)
class Parameter:
    """One parameter of a program.

    Parameters
    ----------
    path
        Full path.
    offset, width
        Where its numbers lie among the program's values, and how many they are.
    range
        Which values it takes.
    """

    path: str
    offset: int
    width: int
    range: Range

    def values(self, given: ArrayLike | str | bool) -> NDArray[np.float64]:
        """Numbers of what a user sets it to: a scalar, (width,), (N,) or (N, width).

        Raises
        ------
        ValueError
            For values that are no numbers or out of range.
        """
        if self.range is Range.REQUEST and isinstance(given, str):
            if given.upper() not in OneShotRequest.__members__:
                raise self._wrong(given)
            return np.array(float(OneShotRequest[given.upper()]))
        try:
            out = np.asarray(given, np.float64)
        except (TypeError, ValueError):
            raise self._wrong(given) from None
        good = np.abs(out) <= 1e9
        if self.range is Range.WEIGHT:
            good &= out >= 0
        elif self.range is Range.AMOUNT:
            good &= (out >= 0) & (out <= 1)
        elif self.range is Range.TRIGGER:
            good &= (out == 0) | (out == 1)
        elif self.range is Range.REQUEST:
            good &= np.isin(out, list(OneShotRequest))
        if not good.all():
            raise self._wrong(out[~good].flat[0] if out.ndim else given)
        return out

    def _wrong(self, value: object) -> ValueError:
        return ValueError(f"'{self.path}' is {value!s}, expected {self.range.value}")


def unknown_path(path: str, known: Iterable[str], what: str = "parameter") -> ValueError:
    """The error for a path that isn't there; names near ones, or some."""
    all_known = list(known)
    near = get_close_matches(str(path), all_known, cutoff=0.5)
    if near:
        return ValueError(f"no {what} '{path}'; near: {', '.join(near)}")
    listed = ", ".join(all_known[:8]) + (", ..." if len(all_known) > 8 else "")
    return ValueError(f"no {what} '{path}'; known: {listed or 'none'}")
