"""How streams and their controllers are reached: handles, parameters, state machines, phase."""

from __future__ import annotations

from typing import Any, NamedTuple

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


class ControllerAccess:
    """The part of a stream pool that finds streams, and reads and sets what controllers do.

    The columns are those of `StreamPool`, which this is a part of.
    """

    __slots__ = ()

    alive: NDArray[np.bool_]
    bank: ClipBank
    clip: NDArray[np.int64]
    generation: NDArray[np.int32]
    looping: NDArray[np.bool_]
    time: NDArray[np.float64]
    _plan: EvaluationPlan

    def row(self, stream: Stream) -> int:
        """Row of a live stream.

        Raises
        ------
        ValueError
            If the handle is stale or was never this pool's.
        """
        row = stream.row
        if not 0 <= row < len(self.alive) or not self.alive[row]:
            raise ValueError(f"stream {row} is not alive")
        if stream.generation != self.generation[row]:
            raise ValueError(f"stream {row} was removed and its row given to another stream")
        return row

    def controller(self, stream: Stream) -> Controller:
        """The tree of a stream that has one."""
        return self._plan.controller(int(self._tree_rows([self.row(stream)])[0]))

    def set(self, stream: Stream, path: str, value: ArrayLike | str) -> None:
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
        self._plan.set(self._tree_rows([self.row(stream)]), path, value)

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

    def get(self, stream: Stream, path: str) -> Any:
        """Value of a parameter, or of what can only be read (`current` of a state machine, ...)."""
        return self._plan.get(int(self._tree_rows([self.row(stream)])[0]), path)

    def parameters(self, stream: Stream) -> dict[str, Any]:
        """All parameters of a stream's controller by path, with their values."""
        return self._plan.parameters(int(self._tree_rows([self.row(stream)])[0]))

    def travel(self, stream: Stream, path: str, state: str) -> None:
        """Let a state machine go to a state by the fewest transitions, or jump if none lead there.

        Conditions on the way are not asked, but ends of clips are waited for, and each blend is
        finished before the next begins.
        """
        self._plan.travel(int(self._tree_rows([self.row(stream)])[0]), path, state)

    def start_state(self, stream: Stream, path: str, state: str) -> None:
        """Put a state machine into a state at once; the state starts anew and nothing blends."""
        self._plan.start_state(int(self._tree_rows([self.row(stream)])[0]), path, state)

    def machines(self, stream: Stream) -> tuple[str, ...]:
        """Paths of the state machines of a stream's controller."""
        return tuple(self._plan.machines(int(self._tree_rows([self.row(stream)])[0])))

    def machine_states(self, stream: Stream, path: str) -> tuple[str, ...]:
        """Names of the states of a machine; ValueError if there is none at the path."""
        found = self._plan.machines(int(self._tree_rows([self.row(stream)])[0]))
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
        plain = self.clip[given] >= 0
        clip, time = self.clip[given[plain]], self.time[given[plain]]
        duration = self.bank.duration[clip]
        share = time / np.where(duration > 0, duration, 1.0)
        looped = np.where(self.looping[given[plain]], np.mod(share, 1.0), share)
        out[plain] = np.where(duration > 0, looped, 0.0)
        if not plain.all():
            out[~plain] = self._plan.phase(given[~plain])
        return np.clip(out, 0.0, np.nextafter(1.0, 0.0))

    def _live_rows(self, rows: ArrayLike) -> NDArray[np.int64]:
        given = np.asarray(rows, np.int64).reshape(-1)
        known = (given >= 0) & (given < len(self.alive))
        wrong = given[~known | ~self.alive[np.where(known, given, 0)]]
        if len(wrong):
            raise ValueError(f"stream {wrong[0]} is not alive")
        return given

    def _tree_rows(self, rows: ArrayLike) -> NDArray[np.int64]:
        given = self._live_rows(rows)
        plain = given[self.clip[given] >= 0]
        if len(plain):
            raise ValueError(f"stream {plain[0]} plays a clip, which has no parameters")
        return given
