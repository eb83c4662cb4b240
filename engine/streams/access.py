"""How streams, uniques and their controllers are reached: handles, parameters, machines, phase."""

from __future__ import annotations

from typing import Any, ClassVar, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..animation.clip_bank import ClipBank
from ..animation.controllers import Controller
from ..animation.controllers.parameters import unknown_path
from ..animation.plan import EvaluationPlan


class Stream(NamedTuple):
    """Handle of one stream: stale once its row was given to another."""

    row: int
    generation: int


Handle = TypeVar("Handle", bound=tuple[int, int])
"""Number and generation of a stream or unique."""


class ControllerAccess(Generic[Handle]):
    """The part of a pool that finds its streams, and reads and sets what controllers do.

    The columns are those of `StreamPool` or `UniquePool`, which this is a part of; a unique's row
    is its number here.
    """

    __slots__ = ()

    _what: ClassVar[str] = "stream"
    _place: ClassVar[str] = "row"
    alive: NDArray[np.bool_]
    bank: ClipBank
    clip: NDArray[np.int64]
    generation: NDArray[np.int32]
    looping: NDArray[np.bool_]
    time: NDArray[np.float64]
    _plan: EvaluationPlan

    def _index(self, handle: Handle) -> int:
        """Row of a live stream; ValueError if the handle is stale or was never this pool's."""
        row, generation = handle
        if not 0 <= row < len(self.alive) or not self.alive[row]:
            raise ValueError(f"{self._what} {row} is not alive")
        if generation != self.generation[row]:
            raise ValueError(
                f"{self._what} {row} was removed and its {self._place} given to another"
            )
        return row

    def controller(self, stream: Handle) -> Controller:
        """The tree of a stream that has one."""
        return self._plan.controller(int(self._tree_rows([self._index(stream)])[0]))

    def set(self, stream: Handle, path: str, value: ArrayLike | str) -> None:
        """Set a parameter of a stream's controller; it counts from the next tick on.

        Parameters
        ----------
        stream
            A stream with a controller.
        path
            Names of the nodes from the root on, then the parameter's: ``"top/amount"``.
        value
            A number, a bool for a trigger, one of ``"fire"``, ``"abort"``, ``"fade_out"`` for a
            request, or several numbers where the parameter has them.

        Raises
        ------
        ValueError
            For an unknown path (near ones are named) or a value that is not allowed.
        """
        self._plan.set(self._tree_rows([self._index(stream)]), path, value)

    def set_many(self, rows: ArrayLike, path: str, values: ArrayLike | str) -> None:
        """Set one parameter of many streams.

        Parameters
        ----------
        rows
            (n,) stream rows with controllers that have the parameter.
        path, values
            As for `set`; one value for all rows, or one for each, (n,) or (n, width).
        """
        self._plan.set(self._tree_rows(rows), path, values)

    def get(self, stream: Handle, path: str) -> Any:
        """Value of a parameter, or of what can only be read (`current` of a state machine, ...)."""
        return self._plan.get(int(self._tree_rows([self._index(stream)])[0]), path)

    def parameters(self, stream: Handle) -> dict[str, Any]:
        """All parameters of a stream's controller by path, with their values."""
        return self._plan.parameters(int(self._tree_rows([self._index(stream)])[0]))

    def travel(self, stream: Handle, path: str, state: str) -> None:
        """Let a state machine go to a state by the fewest transitions, or jump if none lead there.

        Conditions on the way are not asked, but ends of clips are waited for, and each blend is
        finished before the next begins.
        """
        self._plan.travel(int(self._tree_rows([self._index(stream)])[0]), path, state)

    def start_state(self, stream: Handle, path: str, state: str) -> None:
        """Put a state machine into a state at once; the state starts anew and nothing blends."""
        self._plan.start_state(int(self._tree_rows([self._index(stream)])[0]), path, state)

    def machines(self, stream: Handle) -> tuple[str, ...]:
        """Paths of the state machines of a stream's controller."""
        return tuple(self._plan.machines(int(self._tree_rows([self._index(stream)])[0])))

    def machine_states(self, stream: Handle, path: str) -> tuple[str, ...]:
        """Names of the states of a machine; ValueError if there is none at the path."""
        found = self._plan.machines(int(self._tree_rows([self._index(stream)])[0]))
        if path not in found:
            raise unknown_path(path, found, "state machine")
        return found[path]

    def phase(self, rows: ArrayLike) -> NDArray[np.float64]:
        """Phases of streams in their clips, in [0, 1).

        A clip of 2 s at 0.5 s has phase 0.25. Of a tree, the clip that it shows most of counts; a
        clip of no duration, or none, has phase 0.

        Parameters
        ----------
        rows
            (n,) rows of live streams.
        """
        given = self._live_rows(rows)
        out = np.zeros(len(given))
        plain, tree = self.clip[given] >= 0, self._plan.have_trees(given)
        clip, time = self.clip[given[plain]], self.time[given[plain]]
        duration = self.bank.duration[clip]
        share = time / np.where(duration > 0, duration, 1.0)
        looped = np.where(self.looping[given[plain]], np.mod(share, 1.0), share)
        out[plain] = np.where(duration > 0, looped, 0.0)
        if tree.any():
            out[tree] = self._plan.phase(given[tree])
        return np.clip(out, 0.0, np.nextafter(1.0, 0.0))

    def _live_rows(self, rows: ArrayLike) -> NDArray[np.int64]:
        given = np.asarray(rows, np.int64).reshape(-1)
        known = (given >= 0) & (given < len(self.alive))
        wrong = given[~known | ~self.alive[np.where(known, given, 0)]]
        if len(wrong):
            raise ValueError(f"{self._what} {wrong[0]} is not alive")
        return given

    def _tree_rows(self, rows: ArrayLike) -> NDArray[np.int64]:
        given = self._live_rows(rows)
        other = given[~self._plan.have_trees(given)]
        if len(other):
            which = f"{self._what} {other[0]}"
            if self.clip[other[0]] >= 0:
                raise ValueError(f"{which} plays a clip, which has no parameters")
            raise ValueError(f"{which} shows poses that are written, which have no parameters")
        return given


def check_motion(motion: int | str | Controller, bank: ClipBank) -> None:
    """ValueError for a clip that the bank doesn't have."""
    if isinstance(motion, str):
        bank.index(motion)
    elif not isinstance(motion, Controller) and not 0 <= motion < len(bank.clips):
        raise ValueError(f"clip is {motion}, expected 0 to {len(bank.clips) - 1}")


def check_looping(motion: object, looping: bool | None) -> None:
    """ValueError if looping is said of a controller."""
    if isinstance(motion, Controller) and looping is not None:
        raise ValueError("looping is given for a controller; its clips say whether they loop")


def check_finite(**values: float) -> None:
    """ValueError for the first value that is infinite or no number."""
    for name, value in values.items():
        if not np.isfinite(value):
            raise ValueError(f"{name} is {value}, expected a finite number")
