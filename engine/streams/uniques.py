"""Uniques: motions that are not shared, so they need no history (*Streams 2017*, 4.1).

A unique plays a clip or a tree of controllers, or shows poses that the application writes every
tick, such as motion that is recorded live. It keeps two rows of the pose store, its previous and
its current pose, which agents mix as they mix two slices of a stream: smooth at any frame rate, and
one tick late like streams. An unwritten tick holds the pose, and the next one written is blended to
from there.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..animation.clip_bank import ClipBank
from ..animation.controllers import Controller
from ..animation.kinematics import Kinematics
from ..animation.plan import EvaluationPlan
from ..animation.pose import CHANNELS, ROTATION, SCALE
from .access import ControllerAccess, check_finite, check_looping, check_motion
from .pool import POSE_RATE, StreamPool

_NOTHING, _LOCAL, _PALETTES = 0, 1, 2


class Unique(NamedTuple):
    """Handle of one unique: stale once its place was given to another."""

    number: int
    generation: int


class UniquePool(ControllerAccess[Unique]):
    """Uniques of one skeleton, in the store of a stream pool.

    The parameters of their controllers are set and read as those of streams; where streams are
    given by their rows, uniques are by their numbers.

    Parameters
    ----------
    pool
        Has the skeleton, the clips, and the store, whose `uniques` says how many there may be.

    Attributes
    ----------
    alive, running
        (U,) bool.
    generation
        (U,) int32: grows when a place is given to another unique.
    clip, time, speed, looping
        (U,) the clip that is played, as in `StreamPool`; the clip is -1 where a tree is played or
        poses are written.
    before_cut
        Called with the unified row and whether the unique is removed, before its poses are lost.
    """

    __slots__ = (
        "_evaluated",
        "_kinematics",
        "_palettes",
        "_pending",
        "_plan",
        "_poses",
        "_written",
        "_written_palettes",
        "alive",
        "bank",
        "before_cut",
        "clip",
        "generation",
        "kind",
        "looping",
        "pool",
        "running",
        "speed",
        "time",
    )

    _what: ClassVar[str] = "unique"
    _place: ClassVar[str] = "place"

    def __init__(self, pool: StreamPool) -> None:
        count, joints = pool.store.uniques, pool.skeleton.joint_count
        self.pool = pool
        self.bank: ClipBank = pool.bank
        self._plan = EvaluationPlan(pool.skeleton, pool.bank)
        self.alive = np.zeros(count, np.bool_)
        self.running = np.zeros(count, np.bool_)
        self.generation = np.zeros(count, np.int32)
        self.kind = np.zeros(count, np.uint8)
        self.clip = np.full(count, -1, np.int64)
        self.time = np.zeros(count, np.float64)
        self.speed = np.ones(count, np.float64)
        self.looping = np.ones(count, np.bool_)
        self.before_cut: list[Callable[[int, bool], None]] = []
        self._written = np.zeros(count, np.int8)
        self._poses = np.zeros((count, CHANNELS, joints), np.float32)
        self._written_palettes = np.zeros((count, joints, 3, 4), np.float32)
        self._kinematics: Kinematics | None = None
        self._palettes = np.zeros((0, joints, 3, 4), np.float32)
        self._evaluated = self._pending = np.zeros(0, np.int64)

    def add(
        self,
        motion: int | str | Controller | None = None,
        *,
        time: float = 0.0,
        speed: float = 1.0,
        looping: bool | None = None,
        body: str | None = None,
    ) -> Unique:
        """Take a free place.

        Parameters
        ----------
        motion
            Index or name of a clip in the bank, or a tree of controllers, to play; None shows what
            `write` is given.
        time, speed
            Seconds since the start of the clip, or of all clips of the tree, and how fast it plays.
        looping
            Whether a clip's time wraps at its end; as the clip says if None.
        body
            Name of the pool's body type that it is for, unless that is the skeleton's own. Palettes
            that are written are shown as they are.

        Raises
        ------
        ValueError
            For an unknown body type, clip or joint, a value that is not finite, or when no place is
            free.
        """
        check_looping(motion, looping)
        if motion is not None:
            check_motion(motion, self.bank)
        check_finite(time=time, speed=speed)
        kind = 0 if body is None else self.pool.twins.kind_of(body)
        free = np.flatnonzero(~self.alive)
        if not len(free):
            raise ValueError(
                f"all {len(self.alive)} uniques are in use; remove one first, or make the crowd "
                "with more"
            )
        k = int(free[0])
        self._assign(k, motion, time)
        self.alive[k] = True
        self.generation[k] += 1
        self.speed[k] = speed
        self.kind[k] = kind
        if looping is not None:
            self.looping[k] = looping
        self._forget(k)
        return Unique(k, int(self.generation[k]))

    def remove(self, unique: Unique) -> None:
        """Give a unique's place back; agents still on it are moved to the bind pose."""
        k = self._index(unique)
        self._tell(k, removed=True)
        self.alive[k] = self.running[k] = False
        self._plan.discard(k)
        self._forget(k)

    def stop(self, unique: Unique) -> None:
        """Stop a clip or tree; the agents on it hold."""
        self.running[self._index(unique)] = False

    def run(self, unique: Unique) -> None:
        """Let a stopped clip or tree go on."""
        k = self._index(unique)
        self.running[k] = self.clip[k] >= 0 or k in self._plan

    def seek(self, unique: Unique, time: float) -> None:
        """Set the time in seconds: a cut, across which no poses are mixed.

        A tree starts anew, as that of a stream does (`StreamPool.seek`).
        """
        check_finite(time=time)
        k = self._index(unique)
        self._tell(k, removed=False)
        self.time[k] = time
        if k in self._plan:
            self._plan.seek(k, time)
        self._forget(k)

    def play(
        self, unique: Unique, motion: int | str | Controller | None, *, time: float = 0.0
    ) -> None:
        """Play another clip or tree, or show what is written: a cut. It runs, at its old speed.

        Raises
        ------
        ValueError
            For a stale handle, an unknown clip or joint, or a time that is not finite; nothing
            changes then.
        """
        k = self._index(unique)
        check_finite(time=time)
        if motion is not None:
            check_motion(motion, self.bank)
        self._assign(k, motion, time)
        self._tell(k, removed=False)
        self._forget(k)

    def write(self, unique: Unique, pose: NDArray[np.float32]) -> None:
        """Set the pose that the next pose tick shows.

        Parameters
        ----------
        unique
            One without a clip or controller.
        pose
            (10, J) local pose (`tifo.engine.animation.pose`), its quaternions of any length, or
            (J, 3, 4) palettes.

        Raises
        ------
        ValueError
            If the handle is stale or plays something, or the pose has another shape, values that
            are not finite, or a quaternion of no length.
        """
        k = self._index(unique)
        if self.clip[k] >= 0 or k in self._plan:
            what = "a clip" if self.clip[k] >= 0 else "a controller"
            raise ValueError(f"unique {k} plays {what}, its poses can't be written")
        joints = self.pool.skeleton.joint_count
        given = np.asarray(pose)
        if given.shape not in ((CHANNELS, joints), (joints, 3, 4)):
            raise ValueError(
                f"pose has shape {given.shape}, expected a local pose ({CHANNELS}, {joints}) "
                f"or palettes ({joints}, 3, 4)"
            )
        if not np.isfinite(given).all():
            raise ValueError("pose has values that are not finite")
        if given.ndim == 3:
            self._written_palettes[k] = given
            self._written[k] = _PALETTES
            return
        if (np.abs(given[ROTATION]).max(axis=0) < 1e-6).any():
            raise ValueError("pose has a rotation quaternion of no length")
        self._poses[k] = given
        self._written[k] = _LOCAL

    def row(self, unique: Unique) -> int:
        """Unified pose index of a live unique; ValueError if the handle is stale."""
        return self.pool.store.first_unique + 2 * self._index(unique)

    def evaluate(self, tick: int) -> None:
        """Evaluate running clips, trees and written poses together; `commit` shows them."""
        self._evaluated = self._pending = np.zeros(0, np.int64)
        running = np.flatnonzero(self.running)
        playing, trees = running[self.clip[running] >= 0], running[self.clip[running] < 0]
        local = np.flatnonzero(self._written == _LOCAL)
        count = len(running) + len(local)
        if count:
            workspace = self._workspace(count)
            self._play_on(playing, trees, workspace)
            workspace.mixed[len(running) : count] = self._poses[local]
            self._evaluated = np.concatenate([playing, trees, local])
            self._fit(workspace)
        self._pending = np.flatnonzero(self._written == _PALETTES)

    def commit(self, tick: int) -> None:
        """Make what was evaluated and written the current poses of pose tick `tick`."""
        for who, palettes in (
            (self._evaluated, self._palettes[: len(self._evaluated)]),
            (self._pending, self._written_palettes[self._pending]),
        ):
            kept = (who >= 0) & (self.running[who] | (self._written[who] != _NOTHING))
            if kept.any():
                self._show(who[kept], palettes[kept], tick)
        self._written[:] = _NOTHING
        self._evaluated = self._pending = np.zeros(0, np.int64)

    def _show(self, who: NDArray[np.int64], palettes: NDArray[np.float32], tick: int) -> None:
        store = self.pool.store
        store.unique_newest[who] ^= 1
        store.unique_head[who] = tick
        store.unique_valid[who] = np.minimum(store.unique_valid[who] + 1, 2)
        rows = 1 + 2 * who + store.unique_newest[who]
        store.write_static(rows, palettes, self.pool.markers.places(palettes))
        store.mark_streams()

    def _play_on(
        self, playing: NDArray[np.int64], trees: NDArray[np.int64], workspace: Kinematics
    ) -> None:
        """Let clips and trees go on, and put their poses first.

        The first pose after a cut is the one at their time; later ones have advanced.
        """
        who = np.concatenate([playing, trees])
        advanced = self.pool.store.unique_valid[who] > 0
        seconds = np.where(advanced, self.speed[who] / POSE_RATE, 0.0)
        self.time[who] += seconds
        split = len(playing)
        if len(trees):
            self._plan.evaluate(trees, seconds[split:], workspace.mixed[split : len(who)])
        if len(playing):
            clip, looping = self.clip[playing], self.looping[playing]
            duration = self.bank.duration[clip]
            wrap = looping & (duration > 0)
            self.time[playing[wrap]] = np.mod(self.time[playing[wrap]], duration[wrap])
            self.bank.sample(
                clip,
                self.time[playing],
                looping,
                workspace.mixed[:split],
                workspace.scratch[:split],
            )

    def _fit(self, workspace: Kinematics) -> None:
        """Make the palettes, on the bones of the body types that the uniques are for."""
        kind = self.kind[self._evaluated]
        other = np.flatnonzero(kind)
        if len(other):
            poses = workspace.mixed[other]
            self.pool.twins.fit_poses(poses, kind[other])
            workspace.mixed[other] = poses
        workspace.evaluate(workspace.mixed, self._palettes)
        if len(other):
            self.pool.twins.fit_palettes(self._palettes, other, kind[other])

    def _workspace(self, count: int) -> Kinematics:
        """Room for at least `count` poses; what is beyond them is evaluated in vain."""
        if self._kinematics is None or self._kinematics.streams < count:
            room = min(1 << (count - 1).bit_length(), len(self.alive))
            self._kinematics = Kinematics(self.pool.skeleton, room)
            self._kinematics.mixed[...] = 0.0
            self._kinematics.mixed[:, [ROTATION.stop - 1, *range(SCALE.start, SCALE.stop)]] = 1.0
            self._palettes = np.zeros((room, *self._palettes.shape[1:]), np.float32)
        return self._kinematics

    def _assign(self, k: int, motion: int | str | Controller | None, time: float) -> None:
        """Give a place what it plays; nothing changes if that can't be evaluated."""
        if isinstance(motion, Controller):
            self._plan.add(k, motion, time)
            self.clip[k], self.looping[k] = -1, False
        else:
            self._plan.discard(k)
            index = self.bank.index(motion) if isinstance(motion, str) else motion
            self.clip[k] = -1 if index is None else index
            self.looping[k] = index is not None and self.bank.looping[index]
        self.time[k] = time
        self.running[k] = motion is not None

    def _tell(self, k: int, *, removed: bool) -> None:
        for hook in self.before_cut:
            hook(self.pool.store.first_unique + 2 * k, removed)

    def _forget(self, k: int) -> None:
        """No pose from before is shown or mixed any more."""
        self.pool.store.unique_valid[k] = 0
        self._written[k] = _NOTHING
        self._evaluated[self._evaluated == k] = -1
        self._pending[self._pending == k] = -1
        self.pool.store.mark_streams()
