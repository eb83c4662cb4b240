"""What a crowd does, as time series: shares of states, channels and feelings by team and section.

Samples are counts, so that a whole match of 65,000 people takes some megabytes.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ..engine.behaviour.applause import CLAPPING
from ..engine.behaviour.display import channel_values
from ..engine.behaviour.table import POSTURES
from ..engine.streams.pool import POSE_RATE
from .observing import CrowdObserver, Observers

if TYPE_CHECKING:
    from .crowd import Crowd

Grouping = Literal["all", "team", "section"]
Channel = Literal["state", "posture", "arms", "head"]
FEELINGS = ("excitement", "embarrassment", "mood", "fatigue")
FLAGS = ("clapping", "reacting")
"""Who the applause has got hold of, whatever they show; whom an event moves."""


class StateRecorder(CrowdObserver):
    """Time series of what a crowd does; `Crowd.watch` makes one.

    Only people who are there are counted. The columns of a group axis G are ``["all"]``, the sides
    of the crowd (-1 neutral, 0 home, ...), or the names of the sections; see `groups`.

    Parameters
    ----------
    crowd
        Whom it counts.
    every
        Seconds from sample to sample, at least one pose tick.
    by
        What it can be asked for later; fewer groupings take less memory.
    observers
        Where it was added, for `stop`.

    Raises
    ------
    ValueError
        For seconds that are not finite or below 0, or an unknown grouping.
    """

    def __init__(
        self,
        crowd: Crowd,
        *,
        every: float = 1.0,
        by: Sequence[Grouping] = ("team", "section"),
        observers: Observers | None = None,
    ) -> None:
        if not isfinite(every) or every < 0.0:
            raise ValueError(f"every is {every}, expected seconds from 0 on")
        for one in by:
            if one not in get_args(Grouping):
                allowed = ", ".join(f"'{name}'" for name in get_args(Grouping))
                raise ValueError(f"by names {one!r}, expected some of {allowed}")
        self._crowd, self._observers = crowd, observers
        self._every = max(round(every * POSE_RATE), 1)
        self._names: dict[str, tuple[str, ...]] = {
            "state": crowd.table.names,
            "posture": POSTURES,
            "arms": crowd.table.arms_names,
            "head": crowd.table.head_names,
        }
        self._groups: dict[str, list[Any]] = {"all": ["all"]}
        columns = [np.zeros(len(crowd), np.int64)]
        if "team" in by:
            sides, column = np.unique(crowd.team.side, return_inverse=True)
            self._groups["team"] = [int(side) for side in sides]
            columns.append(column.astype(np.int64))
        if "section" in by:
            self._groups["section"] = [name for name, _, _ in crowd.plan.sections]
            columns.append(crowd.seat.section.astype(np.int64))
        self._place_groups(columns)
        self._ticks: list[int] = []
        self._people: list[NDArray[np.int32]] = []
        self._counts: dict[str, list[NDArray[np.int32]]] = {
            name: [] for name in (*self._names, *FLAGS)
        }
        self._sums: dict[str, list[NDArray[np.float64]]] = {name: [] for name in FEELINGS}

    def __len__(self) -> int:
        """Number of samples."""
        return len(self._ticks)

    def see(self, tick: int) -> None:
        """Take a sample, if one is due at pose tick `tick`."""
        if not self._ticks or tick - self._ticks[-1] >= self._every:
            self.take(tick)

    def take(self, tick: int) -> None:
        """Take a sample now, at pose tick `tick`.

        Raises
        ------
        ValueError
            If one of that tick or a later one was taken.
        """
        if self._ticks and tick <= self._ticks[-1]:
            raise ValueError(f"tick is {tick}, expected one after {self._ticks[-1]}")
        crowd = self._crowd
        who = np.flatnonzero(crowd.seat.occupied)
        cell = self._cell.take(who)
        self._ticks.append(tick)
        self._people.append(self._count(cell, cell * 0, 1)[:, 0])
        behaviour = crowd.behaviour
        states = sum(
            self._count(cell, row.take(who).astype(np.int64), len(self._names["state"]))
            for row in behaviour.state
        )
        self._counts["state"].append(np.asarray(states, np.int32))
        channels = channel_values(crowd.table, behaviour, crowd.guidance, who)
        for name, shown in zip(("posture", "arms", "head"), channels, strict=True):
            named = len(self._names[name])
            # What an order demands may have no name; it is the last column, and left out.
            values = np.where(shown < 0, named, shown).astype(np.int64)
            self._counts[name].append(self._count(cell, values, named + 1)[:, :named])
        clapping = crowd.company.applause.state.take(who) == CLAPPING
        for name, flag in (("clapping", clapping), ("reacting", behaviour.reacting.take(who))):
            self._counts[name].append(self._count(cell, flag.astype(np.int64), 2)[:, 1])
        for name in FEELINGS:
            felt = getattr(crowd.emotion, name).take(who)
            sums = np.bincount(cell, felt, minlength=self._cells)
            self._sums[name].append(self._member @ sums)

    def stop(self) -> None:
        """See no more; what was taken stays."""
        if self._observers is not None:
            self._observers.remove(self)

    @property
    def times(self) -> NDArray[np.float64]:
        """(T,) seconds of the simulation at which samples were taken."""
        return np.array(self._ticks, np.float64) / POSE_RATE

    def groups(self, by: Grouping = "all") -> list[Any]:
        """What the columns of axis G are; ValueError for a grouping that wasn't recorded."""
        self._slice(by)
        return list(self._groups[by])

    def names(self, channel: Channel = "state") -> tuple[str, ...]:
        """What the columns of axis V are: the values of a channel, or the states of all machines.

        Raises
        ------
        ValueError
            For an unknown channel.
        """
        if channel not in self._names:
            raise ValueError(
                f"channel is {channel!r}, expected one of {', '.join(map(repr, self._names))}"
            )
        return self._names[channel]

    def people(self, by: Grouping = "all") -> NDArray[np.int32]:
        """(T, G) people who are there."""
        return self._stack(self._people, ())[:, self._slice(by)]

    def counts(self, channel: Channel = "state", by: Grouping = "all") -> NDArray[np.int32]:
        """(T, G, V) how many people are in each state, or show each value of a channel.

        States of all machines are beside each other, so everybody counts once in each machine.
        """
        names = self.names(channel)
        return self._stack(self._counts[channel], (len(names),))[:, self._slice(by)]

    def shares(self, channel: Channel = "state", by: Grouping = "all") -> NDArray[np.float64]:
        """(T, G, V) the same as shares of the people there; NaN where nobody is."""
        return _ratio(self.counts(channel, by), self.people(by)[:, :, None])

    def share(
        self, value: str, by: Grouping = "all", *, channel: Channel = "state"
    ) -> NDArray[np.float64]:
        """(T, G) share of those in one state, or showing one value of a channel.

        Raises
        ------
        ValueError
            For an unknown name.
        """
        names = self.names(channel)
        if value not in names:
            raise ValueError(f"{channel} has no value {value!r}; there are {', '.join(names)}")
        return self.shares(channel, by)[:, :, names.index(value)]

    def count(
        self, flag: Literal["clapping", "reacting"], by: Grouping = "all"
    ) -> NDArray[np.int32]:
        """(T, G) how many clap, or react to an event; ValueError for something else."""
        if flag not in FLAGS:
            raise ValueError(f"flag is {flag!r}, expected 'clapping' or 'reacting'")
        return self._stack(self._counts[flag], ())[:, self._slice(by)]

    def mean(self, feeling: str, by: Grouping = "all") -> NDArray[np.float64]:
        """(T, G) mean of excitement, embarrassment, mood or fatigue; NaN where nobody is."""
        if feeling not in FEELINGS:
            raise ValueError(f"feeling is {feeling!r}, expected one of {', '.join(FEELINGS)}")
        sums = self._stack(self._sums[feeling], ())[:, self._slice(by)]
        return _ratio(sums, self.people(by))

    def _place_groups(self, columns: list[NDArray[np.int64]]) -> None:
        """Cells are the combinations of groups that occur; groups are sums of cells."""
        sizes = [len(groups) for groups in self._groups.values()]
        code = np.zeros_like(columns[0])
        for column, size in zip(columns, sizes, strict=True):
            code = code * size + column
        _, first, self._cell = np.unique(code, return_index=True, return_inverse=True)
        self._cells = len(first)
        self._member = np.zeros((sum(sizes), self._cells))
        self._start: dict[str, slice] = {}
        start = 0
        for name, column, size in zip(self._groups, columns, sizes, strict=True):
            self._member[start + column[first], np.arange(self._cells)] = 1.0
            self._start[name] = slice(start, start + size)
            start += size

    def _count(
        self, cell: NDArray[np.int64], value: NDArray[np.int64], values: int
    ) -> NDArray[np.int32]:
        """(all groups, values) how many of some people, by cell and value (K,)."""
        found = np.bincount(cell * values + value, minlength=self._cells * values)
        return (self._member @ found.reshape(self._cells, values)).astype(np.int32)

    def _slice(self, by: str) -> slice:
        if by not in self._start:
            raise ValueError(f"by is {by!r}, recorded was {', '.join(map(repr, self._start))}")
        return self._start[by]

    def _stack(self, samples: list[NDArray[Any]], shape: tuple[int, ...]) -> NDArray[Any]:
        if not samples:
            return np.zeros((0, len(self._member), *shape))
        return np.stack(samples)


def _ratio(part: NDArray[Any], whole: NDArray[Any]) -> NDArray[np.float64]:
    with np.errstate(invalid="ignore"):
        share: NDArray[np.float64] = part / np.where(whole > 0, whole, np.nan)
    return share
