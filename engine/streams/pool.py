"""Animation streams: motions that are evaluated once a pose tick and shared by many agents.

*Streams 2017*, 4.1: a stream has a controller, the pose of the current tick and a ring of its last
M poses, so that agents on one stream look different by playing some poses behind its head. Here a
stream is a row of columns, and all running streams are evaluated together: those that just play a
clip are sampled at once, and those with a tree of controllers go through the evaluation plan.

A stream that stops keeps its head: its agents hold. Running again, a seek or another clip is a
*cut*: `valid` starts again at one, and no pose from before is shown or mixed any more.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..animation.clip_bank import ClipBank
from ..animation.clip_run import ClipRun
from ..animation.controllers import Controller
from ..animation.kinematics import Kinematics
from ..animation.plan import EvaluationPlan
from ..animation.skeleton import Skeleton
from .access import ControllerAccess, Stream, check_finite, check_looping, check_motion
from .clip_events import StreamEvents
from .markers import Markers
from .store import PoseStore

__all__ = ["POSE_RATE", "Stream", "StreamPool", "bind_positions"]

POSE_RATE = 30.0
"""Pose ticks a second."""


class StreamPool(ControllerAccess[Stream]):
    """Streams of one skeleton, with the store of their poses.

    Parameters
    ----------
    skeleton
        All streams animate it.
    bank
        The clips that streams can play.
    capacity
        Stream rows, 1 to 16384. A power of two up to 256 keeps a pool's textures small.
    history
        M, the longest history of any stream in poses, 2 to 254.
    markers
        (K,) joints whose positions the store keeps for the farthest level of detail.
    uniques, slots
        How many uniques and transition slots the store has room for.

    Attributes
    ----------
    markers
        The joints whose positions are kept.
    before_cut
        Called with a stream's row and whether it is removed, before its poses are lost.
    head
        (R,) int64: pose tick of each stream's newest pose.
    valid
        (R,) int32: poses since the last cut, at most the stream's history; 0 before the first.
    history
        (R,) int32: M of each stream.
    history_goal
        (R,) int32: the M that `set_history` asked for; `history` goes down to it only as agents
        leave the poses beyond (`dilation.shrink_histories`).
    generation
        (R,) int32: grows when a row is given to another stream.
    running, alive
        (R,) bool.
    clip, time, speed, looping
        (R,) the clip that a stream plays: index in `bank`, seconds since its start, playback speed,
        whether it wraps. A stream with a controller has clip -1, the seconds that it ran, and a
        speed that scales all time in its tree.
    clip_events
        Which clip events each stream passed at each of its last pose ticks.
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
        free = np.flatnonzero(~self.alive)
        if not len(free):
            raise ValueError(f"all {len(self.alive)} stream rows are in use; remove a stream first")
        row = int(free[0])
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

    def remove(self, stream: Stream) -> None:
        """Give a stream's row back; agents still on it are moved to the bind pose."""
        row = self.row(stream)
        self._tell(row, removed=True)
        self.alive[row] = self.running[row] = False
        self._plan.discard(row)
        self._cut(row)

    def stop(self, stream: Stream) -> None:
        """Stop evaluating a stream; its head freezes and its agents hold."""
        row = self.row(stream)
        self.running[row] = False
        self._drop_pending(row)
        self.store.mark_streams()

    def run(self, stream: Stream) -> None:
        """Run a stopped stream again: a cut, after which it goes on from its controller's time."""
        row = self.row(stream)
        if not self.running[row]:
            self.running[row] = True
            self._cut(row)

    def seek(self, stream: Stream, time: float) -> None:
        """Set the controller's time in seconds: a cut.

        A tree starts anew: state machines in their first state, one-shots idle, and every clip
        `time` seconds after where it begins. Parameters keep their values.
        """
        check_finite(time=time)
        row = self.row(stream)
        self.time[row] = time
        if row in self._plan:
            self._plan.seek(row, time)
        self._cut(row)

    def play(self, stream: Stream, motion: int | str | Controller, *, time: float = 0.0) -> None:
        """Put another clip or tree on a stream: a cut. Parameters begin with the tree's values."""
        row = self.row(stream)
        check_finite(time=time)
        check_motion(motion, self.bank)
        self._assign(row, motion, time)
        self._cut(row)

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

    def evaluate(self, tick: int) -> None:
        """Evaluate all running streams and write their poses into the slice of pose tick `tick`.

        Nobody sees the poses before `commit`.

        Parameters
        ----------
        tick
            Pose tick, one more than at the last call.
        """
        self._pending = self._pending[:0]
        rows = np.flatnonzero(self.running)
        if not len(rows):
            return
        workspace = self._workspace(len(rows))
        # Streams that play a clip first: they are sampled straight into what kinematics reads.
        tree = self.clip[rows] < 0
        clips = len(rows) - int(np.count_nonzero(tree))
        in_order = clips in (0, len(rows))
        if not in_order:
            rows = np.concatenate([rows[~tree], rows[tree]])
        # A stream's first pose after a cut is the pose at its time; later ones have advanced.
        advanced = self.valid[rows] > 0
        seconds = np.where(advanced, self.speed[rows] / POSE_RATE, 0.0)
        before = self.time[rows]
        self.time[rows] += seconds
        pose = workspace.mixed
        self.clip_events.begin(tick, rows)
        if clips:
            plain = rows[:clips]
            self._wrap_time(plain)
            self._record_events(tick, plain, before[:clips], seconds[:clips])
            self.bank.sample(
                self.clip[plain],
                self.time[plain],
                self.looping[plain],
                pose[:clips],
                workspace.scratch[:clips],
            )
        if clips < len(rows):
            self._plan.evaluate(rows[clips:], seconds[clips:], pose[clips:])
            self._record_tree_events(tick)
        whole = in_order and len(rows) == len(self.running)
        target = self.store.ring[self.store.slice_of(tick)]
        workspace.evaluate(pose, target, None if whole else rows)
        if len(self.markers.joints):
            markers = workspace.joint_positions(self.markers.joints)
            self.store.ring_markers[self.store.slice_of(tick), rows, :, :3] = markers
        self._pending = rows

    def commit(self, tick: int) -> None:
        """Make the poses of the last `evaluate` the heads of their streams.

        A stream that was cut, stopped or removed in between has nothing to show for this tick.
        """
        rows, self._pending = self._pending, self._pending[:0]
        if len(rows):
            self.head[rows] = tick
            self.valid[rows] = np.minimum(self.valid[rows] + 1, self.history[rows])
            self.store.ring_phase[self.store.slice_of(tick), rows] = self.phase(rows)
            self.store.mark_slice(tick)
            self.store.mark_streams()

    def _workspace(self, streams: int) -> Kinematics:
        if self._kinematics is None or self._kinematics.streams != streams:
            self._kinematics = Kinematics(self.skeleton, streams)
        return self._kinematics

    def _wrap_time(self, rows: NDArray[np.int64]) -> None:
        """Keep looping controllers within one period, so that hours lose no precision."""
        duration = self.bank.duration[self.clip[rows]]
        wrap = self.looping[rows] & (duration > 0)
        self.time[rows[wrap]] = np.mod(self.time[rows[wrap]], duration[wrap])

    def _tell(self, row: int, *, removed: bool) -> None:
        for hook in self.before_cut:
            hook(row, removed)

    def _record_events(
        self,
        tick: int,
        rows: NDArray[np.int64],
        before: NDArray[np.float64],
        moved: NDArray[np.float64],
    ) -> None:
        clip = self.clip[rows]
        run = ClipRun(
            clip=clip,
            before=before,
            after=self.time[rows],
            moved=moved,
            backwards=self.speed[rows] < 0,
            looping=self.looping[rows],
            duration=self.bank.duration[clip],
            starts=self.valid[rows] == 0,
        )
        self.clip_events.record(tick, rows, run)

    def _record_tree_events(self, tick: int) -> None:
        played, plan = self._plan.played, self._plan
        if played is not None:
            starts = played.run.starts | (self.valid[played.stream] == 0)
            self.clip_events.record(
                tick,
                played.stream,
                played.run._replace(starts=starts),
                lambda some: plan.shares(played.nodes[some]),
            )

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
