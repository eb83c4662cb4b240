"""Which ways out of their states agents take: all states at once, by tables that are filled as met.

What is open to an agent depends on its state, on the event that moves it, and on which conditions
of its state's rules it meets. Few such situations occur in a crowd, so each is worked out once, and
then looked up: the work for a tick depends on how many agents choose, not on how many states they
are in.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .events import KINDS
from .table import RELATIONS

if TYPE_CHECKING:
    from .compiled import CompiledRule

CALM = len(KINDS) * len(RELATIONS)
"""The number, after those of all pairs of kind and relation, of those whom no event moves."""
_MOST_CONDITIONS = 40
_LEAST_ROOM = 64

Condition = tuple[str, float, float] | tuple[str, bool]
"""A limit (name, least, below), or a signal and what it has to be."""


class Choice(NamedTuple):
    """What (K,) agents do next: int16 state, float32 pose ticks of the blend, int32 pieces.

    Those who go to their own state stay there for `least` to `most` pieces.
    """

    target: NDArray[np.int16]
    blend: NDArray[np.float32]
    least: NDArray[np.int32]
    most: NDArray[np.int32]


class Choices:
    """The ways out of the states of one table.

    Parameters
    ----------
    rules
        By state.

    Raises
    ------
    ValueError
        If the rules of one state have more than 40 different conditions.
    """

    def __init__(self, rules: Sequence[Sequence[CompiledRule]]) -> None:
        self._rules = rules
        own = [
            list(dict.fromkeys(condition for rule in out for condition in _conditions(rule)))
            for out in rules
        ]
        for state, conditions in enumerate(own):
            if len(conditions) > _MOST_CONDITIONS:
                raise ValueError(
                    f"state {state} has rules with {len(conditions)} different conditions, "
                    f"expected at most {_MOST_CONDITIONS}"
                )
        self._conditions = list(dict.fromkeys(c for conditions in own for c in conditions))
        self._bit = np.zeros((len(self._conditions), len(rules)), np.int64)
        for state, conditions in enumerate(own):
            for place, condition in enumerate(conditions):
                self._bit[self._conditions.index(condition), state] = 1 << place
        self._is_asked = self._bit != 0
        self._row: dict[int, int] = {}
        most = max(1, *map(len, rules))
        self._width = np.zeros(_LEAST_ROOM, np.int64)
        self._edges = np.full((_LEAST_ROOM, most), np.inf, np.float32)
        # Where no way is open, the first is to stay for another piece.
        self._target = np.zeros((_LEAST_ROOM, most), np.int16)
        self._blend = np.zeros((_LEAST_ROOM, most), np.float32)
        self._least = np.ones((_LEAST_ROOM, most), np.int32)
        self._most = np.ones((_LEAST_ROOM, most), np.int32)

    def draw(
        self,
        state: NDArray[np.int16],
        pair: NDArray[np.integer],
        number: Callable[[str], NDArray[Any]],
        rng: np.random.Generator,
    ) -> Choice:
        """Let agents choose, each way with a chance proportional to 1 / effort.

        Parameters
        ----------
        state
            (K,) of each, 1 or more agents.
        pair
            (K,) ``kind * relations + relation`` of what moves it, or `CALM`.
        number
            Gives (K,) values of what rules ask for, by name.
        rng
            Where choices come from.
        """
        key = state.astype(np.int64)
        key *= CALM + 1
        key += pair
        key <<= _MOST_CONDITIONS
        present = np.flatnonzero(np.bincount(state))
        for place in np.flatnonzero(self._is_asked[:, present].any(axis=1)):
            bit = self._bit[place].take(state)
            bit *= _meets(self._conditions[place], number)
            key |= bit
        keys = np.unique(key)
        rows = np.array([self._find(k) for k in keys.tolist()], np.intp)
        row = rows.take(np.searchsorted(keys, key))
        width = int(self._width.take(rows).max())
        pick = np.zeros(len(state), np.intp)
        if width:
            draw = rng.random(len(state), np.float32)
            for edge in np.ascontiguousarray(self._edges[:, :width].T):
                pick += edge.take(row) <= draw
        pick += row * self._target.shape[1]
        return Choice(
            self._target.ravel().take(pick),
            self._blend.ravel().take(pick),
            self._least.ravel().take(pick),
            self._most.ravel().take(pick),
        )

    def _find(self, key: int) -> int:
        """Row of the tables for a situation; a new one where it is met for the first time."""
        row = self._row.get(key)
        if row is not None:
            return row
        row = self._row[key] = len(self._row)
        if row == len(self._width):
            for name in ("_width", "_edges", "_target", "_blend", "_least", "_most"):
                old = getattr(self, name)
                setattr(self, name, np.concatenate([old, old]))
        state, pair = divmod(key >> _MOST_CONDITIONS, CALM + 1)
        taken = self._bit[:, state]
        met = {c for c, bit in zip(self._conditions, taken, strict=True) if bit and key & int(bit)}
        ways = [
            rule
            for rule in self._rules[state]
            if _is_open(rule, pair) and met.issuperset(_conditions(rule))
        ]
        count = len(ways)
        self._width[row] = count
        self._edges[row] = np.inf  # a draw is below 1, and somebody takes the last way
        self._target[row], self._blend[row] = state, 0.0
        self._least[row] = self._most[row] = 1
        if count:
            edges = np.cumsum([1.0 / rule.effort for rule in ways])
            self._edges[row, : count - 1] = edges[:-1] / edges[-1]
            self._target[row, :count] = [rule.target for rule in ways]
            self._blend[row, :count] = [rule.blend for rule in ways]
            self._least[row, :count] = [rule.pieces[0] for rule in ways]
            self._most[row, :count] = [rule.pieces[1] for rule in ways]
        return row


def _conditions(rule: CompiledRule) -> tuple[Condition, ...]:
    return (*rule.limits, *rule.signals)


def _is_open(rule: CompiledRule, pair: int) -> bool:
    """Whether a rule may be taken by those whom such an event moves."""
    if rule.pairs is not None:
        return pair != CALM and bool(rule.pairs.ravel()[pair])
    return pair == CALM or not rule.calm


def _meets(condition: Condition, number: Callable[[str], NDArray[Any]]) -> NDArray[np.bool_]:
    """(K,) who meets a condition."""
    value = number(condition[0])
    if len(condition) == 2:
        is_set = value.astype(np.bool_)
        return is_set if condition[1] else ~is_set
    _, least, below = condition
    met = np.ones(len(value), np.bool_)
    if isfinite(least):
        met &= value >= least
    if isfinite(below):
        met &= value < below
    return met
