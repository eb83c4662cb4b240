"""Animation streams: motions that are evaluated once a pose tick and shared by many agents.

*Streams 2017*, 4.1: a stream has a controller, the pose of the current tick and a ring of its last
M poses, so that agents on one stream look different by playing some poses behind its head. Here a
stream is a row of columns, and all running streams are evaluated together: those that just play a
clip are sampled at once, and those with a tree of controllers go through the evaluation plan.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..animation.clip_run import ClipRun
from ..animation.kinematics import Kinematics
from .access import Stream
from .stream_table import StreamTable, bind_positions

__all__ = ["POSE_RATE", "Stream", "StreamPool", "bind_positions"]

POSE_RATE = 30.0
"""Pose ticks a second."""


class StreamPool(StreamTable):
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
    bodies
        Body types beside the skeleton's own; see `add_twin`.

    Attributes
    ----------
    markers
        The joints whose positions are kept.
    twins
        Which streams show others on another body type.
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

    __slots__ = ()

    def evaluate(self, tick: int) -> None:
        """Evaluate all running streams and write their poses into the slice of pose tick `tick`.

        Nobody sees the poses before `commit`.

        Parameters
        ----------
        tick
            Pose tick, one more than at the last call.
        """
        self._pending = self._pending[:0]
        rows = np.flatnonzero(self.running & (self.twins.base < 0))
        if not len(rows):
            return
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
        twins, mirrored = self.twins.following(rows)
        twins, mirrored = twins[self.running[twins]], mirrored[self.running[twins]]
        workspace = self._workspace(len(rows) + len(twins))
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
            self._plan.evaluate(rows[clips:], seconds[clips:], pose[clips : len(rows)])
            self._record_tree_events(tick)
        if len(twins):
            pose[len(rows) :] = pose[mirrored]
            self.twins.fit_poses(pose[len(rows) :], self.twins.kind[twins])
            self._mirror(tick, twins)
            rows = np.concatenate([rows, twins])
        whole = len(rows) == len(self.running) and bool((np.diff(rows) > 0).all())
        target = self.store.ring[self.store.slice_of(tick)]
        workspace.evaluate(pose, target, None if whole else rows)
        if len(twins):
            self.twins.fit_palettes(target, twins, self.twins.kind[twins])
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
            self.store.ring_phase[self.store.slice_of(tick), rows] = self.phase(
                self._mirrored(rows)
            )
            self.store.mark_slice(tick)
            self.store.mark_streams()

    def _mirror(self, tick: int, twins: NDArray[np.int64]) -> None:
        """Let twins have their streams' time and events."""
        base = self.twins.base[twins]
        self.time[twins] = self.time[base]
        self.clip[twins], self.looping[twins] = self.clip[base], self.looping[base]
        self.speed[twins] = self.speed[base]
        self.clip_events.copy(tick, base, twins)

    def _workspace(self, streams: int) -> Kinematics:
        if self._kinematics is None or self._kinematics.streams != streams:
            self._kinematics = Kinematics(self.skeleton, streams)
        return self._kinematics

    def _wrap_time(self, rows: NDArray[np.int64]) -> None:
        """Keep looping controllers within one period, so that hours lose no precision."""
        duration = self.bank.duration[self.clip[rows]]
        wrap = self.looping[rows] & (duration > 0)
        self.time[rows[wrap]] = np.mod(self.time[rows[wrap]], duration[wrap])

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
