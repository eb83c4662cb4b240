"""The evaluation plan: the controllers of all streams as one dependency graph.

*Streams 2017*, 4.4: nodes of the graph are the active controllers, links are poses that one needs
of another. Here the graph is laid out in columns, one row a node of a stream, and a tick goes
through it twice. On the way down nodes get their weight and, level by level, their time; what
weighs nothing is left out and stands still. On the way up their poses are made. Each step takes all
nodes of one kind on one level of all trees in one call, so a tick costs as many calls as there are
levels and kinds, and as much arithmetic as there are active nodes.

Groups are changed where a stream comes or goes, never built anew.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..clip_bank import ClipBank
from ..controllers.nodes import Controller
from ..controllers.parameters import Parameter, unknown_path
from ..controllers.program import Kind, Program, compile_controller
from ..pose import Array
from ..skeleton import Skeleton
from .customs import Customs
from .evaluate import MAKE, WORK_OF, Work, advance_clips
from .groups import Groups, Members, members_by
from .machines import clip_phases, enter_state
from .mixing import PoseMixer
from .played import PlayedClips, played_clips, shares, tagged_clips
from .tables import Offsets, Tables
from .weights import BY_LEVEL, STEPS, step_level

Ints = NDArray[np.int64]

_LEVEL = -1
"""Second key of the group of all nodes of a level, which is before those of its kinds."""

_FIRST = -1
"""First key of the groups of nodes that weigh their children by parameters alone: before levels."""


@dataclass(slots=True, eq=False)
class _Shared:
    """A program, where its constants are, and the groups that its nodes belong to."""

    program: Program
    offsets: Offsets
    number: int
    down: Members = field(init=False)
    up: Members = field(init=False)
    streams: int = 0

    def __post_init__(self) -> None:
        columns = self.program.columns
        kind, depth, height = columns["kind"], columns["depth"], columns["height"]
        below = {
            (level, _LEVEL): nodes
            for (level, _), nodes in members_by(depth, np.zeros_like(depth)).items()
            if level > 0
        }
        steps = members_by(np.where(np.isin(kind, BY_LEVEL), depth, _FIRST), kind)
        self.down = below | {key: nodes for key, nodes in steps.items() if key[1] != Kind.CLIP}
        self.up = members_by(height, WORK_OF[kind])


class EvaluationPlan:
    """All trees of one skeleton's streams.

    Parameters
    ----------
    skeleton, bank
        What the trees animate, and the clips that they play.

    Attributes
    ----------
    played
        The clips with tags that were seen at the last tick, and how they moved; None if there
        were none.
    """

    __slots__ = (
        "_base",
        "_customs",
        "_down",
        "_mixer",
        "_numbers",
        "_program_number",
        "_shared",
        "_up",
        "_values",
        "played",
        "tables",
    )

    def __init__(self, skeleton: Skeleton, bank: ClipBank) -> None:
        self.tables = Tables(skeleton, bank)
        self._mixer = PoseMixer(bank)
        self._customs = Customs()
        self._down = Groups()
        self._up = Groups()
        self._shared: dict[int, _Shared] = {}
        self._numbers = count()
        self.played: PlayedClips | None = None
        # By stream row: first node (-1 without a tree), first value, and number of the program.
        self._base = np.zeros(0, np.int64)
        self._values = np.zeros(0, np.int64)
        self._program_number = np.zeros(0, np.int64)

    def __contains__(self, stream: int) -> bool:
        """Whether a stream row has a tree."""
        return stream < len(self._base) and bool(self._base[stream] >= 0)

    def have_trees(self, streams: Ints) -> NDArray[np.bool_]:
        """(n,) whether each of some stream rows has a tree."""
        base = np.append(self._base, -1)
        return base[np.minimum(streams, len(self._base))] >= 0

    def add(self, stream: int, controller: Controller, time: float = 0.0) -> None:
        """Give a stream row a tree, instead of the one that it may have.

        Raises
        ------
        ValueError
            If the controller can't be compiled (see `compile_controller`); nothing changes then.
        """
        shared = next(
            (s for s in self._shared.values() if s.program.controller is controller), None
        )
        if shared is None:
            program = compile_controller(controller, self.tables.skeleton, self.tables.bank)
            shared = _Shared(program, self.tables.store_constants(program), next(self._numbers))
        self.discard(stream)
        self._shared[shared.number] = shared
        shared.streams += 1
        base, values = self.tables.store_nodes(shared.program, shared.offsets, stream)
        self._grow(stream + 1)
        self._base[stream], self._values[stream] = base, values
        self._program_number[stream] = shared.number
        self._down.add(shared.down, base)
        self._up.add(shared.up, base)
        self._customs.add(shared.program, base)
        self.seek(stream, time)

    def _grow(self, streams: int) -> None:
        missing = max(streams, 2 * len(self._base)) - len(self._base)
        if streams > len(self._base):
            more = np.full(missing, -1, np.int64)
            self._base = np.concatenate([self._base, more])
            self._values = np.concatenate([self._values, more])
            self._program_number = np.concatenate([self._program_number, more])

    def discard(self, stream: int) -> None:
        """Take a stream row's tree away, if it has one."""
        if stream not in self:
            return
        shared, base = self._of(stream), int(self._base[stream])
        stop = base + shared.program.size
        self._down.discard(shared.down, base, stop)
        self._up.discard(shared.up, base, stop)
        self._customs.discard(base, shared.program.size)
        self.tables.nodes["active"][base:stop] = False
        self.tables.release_nodes(shared.program, base, int(self._values[stream]))
        self._base[stream] = self._values[stream] = self._program_number[stream] = -1
        shared.streams -= 1
        if shared.streams == 0:
            del self._shared[shared.number]
            self.tables.release_constants(shared.offsets)

    def controller(self, stream: int) -> Controller:
        """The controller of a stream row that has a tree."""
        return self._of(stream).program.controller

    def _of(self, stream: int) -> _Shared:
        return self._shared[int(self._program_number[stream])]

    def seek(self, stream: int, time: float) -> None:
        """Start a tree anew, with all its clips `time` seconds after where they begin."""
        base, columns = int(self._base[stream]), self.tables.nodes
        nodes = np.arange(base, base + self._of(stream).program.size)
        self.tables.restart(nodes)
        columns["time"][nodes[columns["kind"][nodes] == Kind.CLIP]] += time

    def evaluate(self, streams: Ints, seconds: NDArray[np.float64], out: Array) -> None:
        """Let some trees go on and write their poses.

        Parameters
        ----------
        streams
            (n,) stream rows with trees, none twice.
        seconds
            (n,) how far each goes on.
        out
            (n, 10, J) float32, written in place; rotations have length 1.

        Raises
        ------
        ValueError
            If a user's own controller fails.
        """
        tables, columns, mixer = self.tables, self.tables.nodes, self._mixer
        roots = self._base[streams]
        self.played = None
        active = columns["active"]
        active[: columns.end] = False
        active[roots] = True
        columns["delta"][roots] = np.where(columns["restarted"][roots], 0.0, seconds)
        for (_, kind), group in self._down.in_order():
            if kind == _LEVEL:
                step_level(tables, group)
            else:
                STEPS[kind](tables, group)
        clips = self._up.get((0, Work.SAMPLE))
        if clips is not None:
            tagged = tagged_clips(tables, clips)
            before = columns["time"][tagged]
            advance_clips(tables, clips)
            if len(tagged):
                self.played = played_clips(tables, tagged, before)
        mixer.clear()
        for (_, work), group in self._up.in_order():
            MAKE[work](tables, mixer, group, self._customs)
        columns["restarted"][: columns.end] &= ~active[: columns.end]
        np.take(mixer.poses, columns["row"][roots], axis=0, out=out, mode="clip")

    def shares(self, nodes: Ints) -> NDArray[np.float64]:
        """Shares (n,) of nodes, seen at the last tick, in the poses of their trees."""
        return shares(self.tables, nodes)

    def phase(self, streams: Ints) -> NDArray[np.float64]:
        """Phase, 0 to 1, of the clip that each tree shows most of; 0 where that is no clip."""
        clips, _ = self.tables.leading_clips(self._base[streams])
        phases = clip_phases(self.tables, np.maximum(clips, 0))
        return np.where(clips >= 0, phases, 0.0)

    def parameters(self, stream: int) -> dict[str, Any]:
        """All parameters of a tree by path, with their values."""
        return {path: self.get(stream, path) for path in self._of(stream).program.parameters}

    def get(self, stream: int, path: str) -> Any:
        """Value of a parameter, or of what can only be read.

        Raises
        ------
        ValueError
            If there is no such path; near ones are named.
        """
        program = self._of(stream).program
        if path in program.readings:
            return self._reading(stream, path)
        parameter = _parameter(program, path)
        first = self._values[stream] + parameter.offset
        values = self.tables.values["value"][first : first + parameter.width].tolist()
        return values[0] if parameter.width == 1 else tuple(values)

    def _reading(self, stream: int, path: str) -> Any:
        program = self._of(stream).program
        number, what = program.readings[path]
        columns, node = self.tables.nodes, self._base[stream] + number
        if what == "position":
            return float(columns["time"][node])
        if what == "active":
            return bool(columns["state"][node] == 1)
        states = program.machines[program.tree.paths[number]]
        state = int(columns["state" if what == "current" else "source"][node])
        return states[state] if state >= 0 else None

    def set(self, streams: Ints, path: str, values: ArrayLike | str) -> None:
        """Set a parameter of some trees.

        Parameters
        ----------
        streams
            (n,) stream rows with trees.
        path
            The parameter; the trees may differ otherwise.
        values
            One value for all, or (n,) values; (width,) or (n, width) for a parameter of several
            numbers.

        Raises
        ------
        ValueError
            For an unknown path, a path that can only be read, a wrong number of values, or one out
            of range; nothing changes then.
        """
        if not len(streams):
            return
        numbers, which = np.unique(self._program_number[streams], return_inverse=True)
        found = [_parameter(self._shared[int(k)].program, path) for k in numbers]
        first = found[0]
        if any((p.width, p.range) != (first.width, first.range) for p in found):
            raise ValueError(f"'{path}' is not the same parameter in all of these streams")
        given = first.values(values)
        if given.ndim == 1:
            given = given[:, None] if first.width == 1 else given[None]
        shape = (len(streams), first.width)
        rows_fit = given.ndim == 2 and given.shape[0] in (1, shape[0])
        if not (rows_fit and given.shape[1] == shape[1]) and (given.ndim or first.width > 1):
            raise ValueError(
                f"'{path}' got values of shape {np.shape(values)}, expected "
                + (f"({shape[1]},) or {shape}" if shape[1] > 1 else f"one or {shape[0]}")
            )
        offset = np.array([parameter.offset for parameter in found])[which.reshape(-1)]
        entry = (self._values[streams] + offset)[:, None] + np.arange(first.width)
        self.tables.values["value"][entry] = given

    def travel(self, stream: int, path: str, state: str) -> None:
        """Let a state machine go to a state by the fewest transitions.

        Conditions on the way are not asked, but ends of clips are waited for, and a blend is
        finished before the next. Where no way leads to the state, the machine jumps into it.

        Raises
        ------
        ValueError
            If there is no such machine or state.
        """
        node, number = self._state(stream, path, state)
        self.tables.nodes["goal"][node] = number

    def start_state(self, stream: int, path: str, state: str) -> None:
        """Put a state machine into a state at once; the state starts anew and nothing blends.

        Raises
        ------
        ValueError
            If there is no such machine or state.
        """
        node, number = self._state(stream, path, state)
        enter_state(self.tables, np.array([node]), np.array([number]))

    def machines(self, stream: int) -> Mapping[str, tuple[str, ...]]:
        """Names of the states of each state machine of a tree, by its path."""
        return self._of(stream).program.machines

    def _state(self, stream: int, path: str, state: str) -> tuple[int, int]:
        program = self._of(stream).program
        if path not in program.machines:
            raise unknown_path(path, program.machines, "state machine")
        states = program.machines[path]
        if state not in states:
            raise unknown_path(state, states, "state")
        return int(self._base[stream]) + program.tree.paths.index(path), states.index(state)


def _parameter(program: Program, path: str) -> Parameter:
    if path in program.readings:
        raise ValueError(f"'{path}' can only be read")
    if path not in program.parameters:
        raise unknown_path(path, (*program.parameters, *program.readings))
    return program.parameters[path]
