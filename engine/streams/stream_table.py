"""Streams as rows of columns: added and removed, run and stopped, cut, and shown on other bodies.

A stream that stops keeps its head: its agents hold. Running again, a seek or another clip is a
*cut*: `valid` starts again at one, and no pose from before is shown or mixed any more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..animation.body_type import BodyType
from ..animation.clip_bank import ClipBank
from ..animation.controllers import Controller
from ..animation.kinematics import Kinematics
from ..animation.plan import EvaluationPlan
from ..animation.skeleton import Skeleton
from .access import ControllerAccess, Stream, check_finite, check_looping, check_motion
from .clip_events import StreamEvents
from .markers import Markers
from .store import PoseStore
from .twins import Twins

_TWIN_COLUMNS = (
    *("clip", "time", "speed", "looping", "history", "history_goal", "running", "alive"),
)


class StreamTable(ControllerAccess[Stream]):
    """The rows of a pool: which streams live, what they play, and how far they are.

    `StreamPool` evaluates them; parameters and attributes are described there.
    """

    __slots__ = (
        "_kinematics",
        "_longest",
        "_pending",
        "_plan",
        "alive",
        "bank",
        "before_cut",
        "clip",
        "clip_events",
        "generation",
        "head",
        "history",
        "history_goal",
        "looping",
        "markers",
        "running",
        "skeleton",
        "speed",
        "store",
        "time",
        "twins",
        "valid",
    )

    def __init__(
        self,
        skeleton: Skeleton,
        bank: ClipBank,
        *,
        capacity: int = 256,
        history: int = 60,
        markers: NDArray[np.int64] | None = None,
        uniques: int = 0,
        slots: int = 0,
        bodies: Sequence[BodyType] = (),
    ) -> None:
        if not 1 <= capacity <= 16384:
            raise ValueError(f"capacity is {capacity}, expected 1 to 16384 streams")
        self.skeleton = skeleton
        self.bank = bank
        joints = np.zeros(0, np.int64) if markers is None else markers
        self.markers = Markers(joints, bind_positions(skeleton)[joints])
        self.store = PoseStore(
            skeleton.joint_count,
            capacity,
            history,
            uniques=uniques,
            slots=slots,
            markers=len(joints),
        )
        self.store.write_static(0, np.eye(3, 4, dtype=np.float32), self.markers.bind)
        self.twins = Twins(skeleton, bodies, capacity)
        self.before_cut: list[Callable[[int, bool], None]] = []
        self._kinematics: Kinematics | None = None
        self._pending = np.zeros(0, np.int64)
        self._plan = EvaluationPlan(skeleton, bank)
        self._longest = history
        self.head = np.zeros(capacity, np.int64)
        self.valid = np.zeros(capacity, np.int32)
        self.history = np.full(capacity, history, np.int32)
        self.history_goal = self.history.copy()
        self.generation = np.zeros(capacity, np.int32)
        self.running = np.zeros(capacity, np.bool_)
        self.alive = np.zeros(capacity, np.bool_)
        self.clip = np.zeros(capacity, np.int64)
        self.time = np.zeros(capacity, np.float64)
        self.speed = np.ones(capacity, np.float64)
        self.looping = np.ones(capacity, np.bool_)
        self.clip_events = StreamEvents(bank.clips, capacity, self.store.capacity)

    def add(
        self,
        motion: int | str | Controller,
        *,
        time: float = 0.0,
        speed: float = 1.0,
        looping: bool | None = None,
        history: int | None = None,
    ) -> Stream:
        """Start a stream on a free row; its first pose is the motion at `time`, at the next tick.

        Parameters
        ----------
        motion
            Index or name of a clip in the bank, or a tree of controllers.
        time, speed
            Seconds since the start of the clip, or of all clips of the tree, and how fast it plays
            (negative plays backwards).
        looping
            Whether a clip's time wraps at its end; as the clip says if None.
        history
            M of this stream, at most what the pool's ring has room for; the pool's own if None.

        Raises
        ------
        ValueError
            For an unknown clip or joint, a value that is not finite, or when no row is free.
        """
        check_looping(motion, looping)
        check_motion(motion, self.bank)
        check_finite(time=time, speed=speed)
        if history is not None:
            self._check_history(history)
        row = self._free_row()
        self._assign(row, motion, time)
        self.alive[row] = self.running[row] = True
        self.generation[row] += 1
        self.history[row] = self._longest if history is None else history
        self.history_goal[row] = self.history[row]
        self.speed[row] = speed
        if looping is not None:
            self.looping[row] = looping
        self._cut(row)
        return Stream(row, int(self.generation[row]))

    def add_twin(self, stream: Stream, body: str) -> Stream:
        """Show a stream on another body type too, on a row of its own.

        A twin follows its stream in everything: time, controller, parameters, cuts, stop and run.

        Parameters
        ----------
        stream
            A stream, or a twin of it.
        body
            Name of one of the pool's body types.

        Raises
        ------
        ValueError
            For an unknown type, one that the stream is shown on already, or when no row is free.
        """
        base = self._own_row(stream)
        kind = self.twins.kind_of(body)
        if self.twins.table[kind, base] >= 0:
            raise ValueError(f"stream {base} is shown on body type '{body}' already")
        row = self._free_row()
        for name in _TWIN_COLUMNS:
            column = getattr(self, name)
            column[row] = column[base]
        self.generation[row] += 1
        self.twins.add(row, base, kind)
        self._cut(row)
        return Stream(row, int(self.generation[row]))

    def remove(self, stream: Stream) -> None:
        """Give a stream's row back, and its twins'; agents still there get the bind pose."""
        row = self.row(stream)
        for member in reversed(self.twins.family(row)):
            self._tell(member, removed=True)
            self.alive[member] = self.running[member] = False
            self._cut(member)
            self.twins.forget(member)
        self._plan.discard(row)

    def stop(self, stream: Stream) -> None:
        """Stop evaluating a stream; its head freezes and its agents hold."""
        for row in self.twins.family(self.row(stream)):
            self.running[row] = False
            self._drop_pending(row)
        self.store.mark_streams()

    def run(self, stream: Stream) -> None:
        """Run a stopped stream again: a cut, after which it goes on from its controller's time."""
        for row in self.twins.family(self._own_row(stream)):
            if not self.running[row]:
                self.running[row] = True
                self._cut(row)

    def seek(self, stream: Stream, time: float) -> None:
        """Set the controller's time in seconds: a cut.

        A tree starts anew: state machines in their first state, one-shots idle, and every clip
        `time` seconds after where it begins. Parameters keep their values.
        """
        check_finite(time=time)
        row = self._own_row(stream)
        self.time[row] = time
        if row in self._plan:
            self._plan.seek(row, time)
        self._cut_family(row)

    def play(self, stream: Stream, motion: int | str | Controller, *, time: float = 0.0) -> None:
        """Put another clip or tree on a stream: a cut. Parameters begin with the tree's values."""
        row = self._own_row(stream)
        check_finite(time=time)
        check_motion(motion, self.bank)
        self._assign(row, motion, time)
        self._cut_family(row)

    def set_history(self, stream: Stream, history: int) -> None:
        """Let a running stream keep more or fewer poses from now on.

        More: the history fills up tick by tick. Fewer: nobody may jump, so agents that play farther
        behind must first come nearer; `dilation.shrink_histories` does that, and a crowd's systems
        call it.

        Parameters
        ----------
        history
            M, 2 to the ring's capacity less 2.
        """
        row = self.row(stream)
        self._check_history(history)
        self.history_goal[row] = history
        self.history[row] = max(history, int(self.history[row]))

    def row(self, stream: Stream) -> int:
        """Row of a live stream.

        Raises
        ------
        ValueError
            If the handle is stale or was never this pool's.
        """
        return self._index(stream)

    def room(self, rows: NDArray[np.int32]) -> NDArray[np.float64]:
        """(K,) longest offsets in poses at which agents may enter stream rows (K,) now."""
        poses = np.minimum(self.valid[rows], self.history_goal[rows])
        longest: NDArray[np.float64] = np.maximum(poses - 2, 0).astype(np.float64)
        return longest

    def stream(self, row: int) -> Stream:
        """Handle of the stream that lives on a row; ValueError if none does."""
        if not 0 <= row < len(self.alive) or not self.alive[row]:
            raise ValueError(f"stream {row} is not alive")
        return Stream(row, int(self.generation[row]))

    def _tree_rows(self, rows: ArrayLike) -> NDArray[np.int64]:
        """Rows of trees; a twin has its stream's."""
        return super()._tree_rows(self._mirrored(self._live_rows(rows)))

    def _mirrored(self, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """Rows, and instead of twins those of their streams."""
        base = self.twins.base[rows]
        return np.where(base >= 0, base, rows)

    def _own_row(self, stream: Stream) -> int:
        """Row of a stream, or of what its handle is the twin of."""
        row = self.row(stream)
        base = int(self.twins.base[row])
        return row if base < 0 else base

    def _free_row(self) -> int:
        free = np.flatnonzero(~self.alive)
        if not len(free):
            raise ValueError(f"all {len(self.alive)} stream rows are in use; remove a stream first")
        return int(free[0])

    def _tell(self, row: int, *, removed: bool) -> None:
        for hook in self.before_cut:
            hook(row, removed)

    def _check_history(self, history: int) -> None:
        longest = self.store.capacity - 2
        if not 2 <= history <= longest:
            raise ValueError(f"history is {history}, expected 2 to {longest} poses in this pool")

    def _cut(self, row: int) -> None:
        if self.valid[row] > 0:
            self._tell(row, removed=False)
        self.valid[row] = 0
        self._drop_pending(row)
        self.store.mark_streams()

    def _cut_family(self, row: int) -> None:
        for member in self.twins.family(row):
            self._cut(member)

    def _drop_pending(self, row: int) -> None:
        self._pending = self._pending[self._pending != row]

    def _assign(self, row: int, motion: int | str | Controller, time: float) -> None:
        """Give a row what it plays; nothing changes if that can't be evaluated."""
        if isinstance(motion, Controller):
            self._plan.add(row, motion, time)
            self.clip[row], self.looping[row] = -1, False
        else:
            self._plan.discard(row)
            index = self.bank.index(motion) if isinstance(motion, str) else motion
            self.clip[row], self.looping[row] = index, self.bank.looping[index]
        self.time[row] = time


def bind_positions(skeleton: Skeleton) -> NDArray[np.float32]:
    """(J, 3) model-space joint positions of the bind pose, metres."""
    matrices = np.zeros((skeleton.joint_count, 4, 4))
    matrices[:, :3] = skeleton.inverse_bind
    matrices[:, 3, 3] = 1.0
    return np.linalg.inv(matrices)[:, :3, 3].astype(np.float32)
