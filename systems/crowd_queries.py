"""Questions about a crowd's agents that are answered by arrays of ids."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from numbers import Integral
from typing import TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..components import MotionState, Party, Placement, Seat, Team
from ..engine.crowd.motions import MotionLibrary
from ..engine.crowd.seating import SeatPlan

Wanted = int | Iterable[int]
"""A number, or several: a range, a list, an array."""


Frame = tuple[ArrayLike, tuple[float, float, float, float]]
"""A (4, 4) matrix from the stadium to clip space, and left, bottom, right and top of a rectangle
there, -1 to 1 being the picture; `FreeCamera.rectangle` makes one of pixels."""
CHEST = 1.0
"""Metres above their feet of what has to be in a rectangle."""


class Question(TypedDict, total=False):
    """What `Crowd.where` can be asked."""

    team: Wanted | None
    row: Wanted | None
    column: Wanted | None
    section: Wanted | str | Sequence[str] | None
    tier: Wanted | None
    party: Wanted | None
    motion: str | Sequence[str] | None
    near: tuple[ArrayLike, float] | None
    framed: Frame | None
    mask: NDArray[np.bool_] | None
    present: bool | None


class QueryCalls:
    """Calls of a `Crowd` that find agents."""

    __slots__ = ()

    library: MotionLibrary
    motion: MotionState
    placement: Placement
    plan: SeatPlan
    seat: Seat
    team: Team

    @property
    @abstractmethod
    def party(self) -> Party:
        """Who came with whom."""

    @abstractmethod
    def __len__(self) -> int:
        """Number of agents."""

    def where(
        self,
        *,
        team: Wanted | None = None,
        row: Wanted | None = None,
        column: Wanted | None = None,
        section: Wanted | str | Sequence[str] | None = None,
        tier: Wanted | None = None,
        party: Wanted | None = None,
        motion: str | Sequence[str] | None = None,
        near: tuple[ArrayLike, float] | None = None,
        framed: Frame | None = None,
        mask: NDArray[np.bool_] | None = None,
        present: bool | None = True,
    ) -> NDArray[np.int64]:
        """Agents of whom everything holds that is asked for.

        Parameters
        ----------
        team
            0 home, 1 away, -1 neutral.
        row, column, tier
            Of their seats, from 0.
        section
            Name or number of the section, or several.
        party
            Numbers of parties: the people who came together have the same in `party.party`.
        motion
            Name of the motion that they show, or several.
        near
            A place in metres, in the stadium's frame, and how far from it their feet may be.
        framed
            A rectangle of a camera's picture in which their chests are, hidden or not; see
            `FreeCamera.rectangle`.
        mask
            (N,) bool: whatever you know of them yourself.
        present
            Those who are there, those who aren't (False), or both (None).

        Returns
        -------
        (K,) int64 ids, ascending

        Raises
        ------
        ValueError
            For a value of the wrong kind, or a section or motion that isn't there.

        Examples
        --------
        >>> away_front = crowd.where(team=1, row=range(5))
        """
        found = np.ones(len(self), np.bool_)
        if present is not None:
            found &= self.seat.occupied if present else ~self.seat.occupied
        columns = (
            ("team", team, self.team.side),
            ("row", row, self.seat.row),
            ("column", column, self.seat.column),
            ("tier", tier, self.plan.tier),
            ("party", party, self.party.party),
            ("section", self._section_numbers(section), self.seat.section),
        )
        for name, wanted, values in columns:
            if wanted is not None:
                found &= np.isin(values, _numbers(name, wanted))
        if motion is not None:
            found &= np.isin(self.motion.shown, self._motion_numbers(motion))
        if near is not None:
            found &= self._within(near)
        if framed is not None:
            found &= self._inside(framed)
        if mask is not None:
            given = np.asarray(mask)
            if given.dtype != np.bool_ or given.shape != found.shape:
                raise ValueError(
                    f"mask has shape {given.shape} of {given.dtype}, expected {found.shape} of bool"
                )
            found &= given
        return np.flatnonzero(found)

    def _section_numbers(self, wanted: Wanted | str | Sequence[str] | None) -> Wanted | None:
        if wanted is None or isinstance(wanted, int):
            return wanted
        names = [name for name, _, _ in self.plan.sections]
        given = [wanted] if isinstance(wanted, str) else [*wanted]
        return [_index("section", one, names) if isinstance(one, str) else one for one in given]

    def _motion_numbers(self, wanted: str | Sequence[str]) -> list[int]:
        given = [wanted] if isinstance(wanted, str) else [*wanted]
        return [_index("motion", one, self.library.names) for one in given]

    def _within(self, near: tuple[ArrayLike, float]) -> NDArray[np.bool_]:
        try:
            point, distance = near
            place, reach = np.asarray(point, np.float64), float(distance)
        except (TypeError, ValueError):
            place, reach = np.zeros(0), np.nan
        if place.shape != (3,) or not np.isfinite(place).all() or not reach >= 0.0:
            raise ValueError(f"near is {near!r}, expected a place (x, y, z) and metres >= 0")
        off = self.placement.position - place.astype(np.float32)[:, None]
        inside: NDArray[np.bool_] = np.einsum("kn,kn->n", off, off) <= reach * reach
        return inside

    def _inside(self, framed: Frame) -> NDArray[np.bool_]:
        try:
            matrix, (left, bottom, right, top) = framed
            clip = np.asarray(matrix, np.float64)
            edges = np.array([left, bottom, right, top], np.float64)
        except (TypeError, ValueError):
            clip, edges = np.zeros(0), np.full(4, np.nan)
        if clip.shape != (4, 4) or not np.isfinite(clip).all() or not np.isfinite(edges).all():
            raise ValueError(
                f"framed is {framed!r}, expected a (4, 4) matrix and (left, bottom, right, top)"
            )
        chest = np.append(self.placement.position, np.ones((1, len(self))), axis=0)
        chest[1] += CHEST
        x, y, _, w = clip @ chest
        ahead = np.maximum(w, 1e-9)
        inside: NDArray[np.bool_] = (w > 0) & (x >= edges[0] * ahead) & (x <= edges[2] * ahead)
        inside &= (y >= edges[1] * ahead) & (y <= edges[3] * ahead)
        return inside


def _numbers(name: str, wanted: Wanted) -> NDArray[np.int64]:
    if isinstance(wanted, Integral) and not isinstance(wanted, bool):
        return np.array([int(wanted)], np.int64)
    try:
        numbers = np.array([*wanted])  # type: ignore[misc]
    except TypeError:
        numbers = np.array([None])
    if numbers.size and (numbers.ndim != 1 or numbers.dtype.kind not in "iu"):
        raise ValueError(f"{name} is {wanted!r}, expected a whole number or several")
    return numbers.astype(np.int64)


def _index(what: str, name: object, known: Sequence[str]) -> int:
    if name in known:
        return known.index(str(name))
    near = get_close_matches(str(name), known, n=3) or list(known[:12])
    raise ValueError(f"there is no {what} '{name}'; there are {', '.join(near)}")
