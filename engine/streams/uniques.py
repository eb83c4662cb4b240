"""Uniques: motions that are not shared, so they need no history (*Streams 2017*, 4.1).

A unique plays a clip, or shows poses that the application writes every tick, such as motion that is
recorded live. It keeps two rows of the pose store, its previous and its current pose, which agents
mix as they mix two slices of a stream: smooth at any frame rate, and one tick late like streams. An
unwritten tick holds the pose, and the next one written is blended to from there.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..animation.kinematics import Kinematics
from ..animation.pose import CHANNELS, ROTATION, SCALE
from .pool import POSE_RATE, StreamPool

_NOTHING, _LOCAL, _PALETTES = 0, 1, 2


class Unique(NamedTuple):
    """Handle of one unique: stale once its place was given to another."""

    number: int
    generation: int


class UniquePool:
    """Uniques of one skeleton, in the store of a stream pool.

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
        (U,) the clip controller as in `StreamPool`; the clip is -1 where poses are written.
    before_cut
        Called with the unified row and whether the unique is removed, before its poses are lost.
    """

    __slots__ = (
        "_evaluated",
        "_kinematics",
        "_palettes",
        "_pending",
        "_poses",
        "_written",
        "_written_palettes",
        "alive",
        "before_cut",
        "clip",
        "generation",
        "looping",
        "pool",
        "running",
        "speed",
        "time",
    )

    def __init__(self, pool: StreamPool) -> None:
        count, joints = pool.store.uniques, pool.skeleton.joint_count
        self.pool = pool
        self.alive = np.zeros(count, np.bool_)
        self.running = np.zeros(count, np.bool_)
        self.generation = np.zeros(count, np.int32)
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
        clip: int | str | None = None,
        *,
        time: float = 0.0,
        speed: float = 1.0,
        looping: bool | None = None,
    ) -> Unique:
        """Take a free place.

        Parameters
        ----------
        clip
            Index or name in the bank of the clip to play; None shows what `write` is given.
        time, speed, looping
            Of the clip; looping as the clip says if None.

        Raises
        ------
        ValueError
            For an unknown clip, a value that is not finite, or when no place is free.
        """
        bank = self.pool.bank
        index = bank.index(clip) if isinstance(clip, str) else -1 if clip is None else clip
        if clip is not None and not 0 <= index < len(bank.clips):
            raise ValueError(f"clip is {clip}, expected 0 to {len(bank.clips) - 1}")
        for name, value in (("time", time), ("speed", speed)):
            if not np.isfinite(value):
                raise ValueError(f"{name} is {value}, expected a finite number")
        free = np.flatnonzero(~self.alive)
        if not len(free):
            raise ValueError(
                f"all {len(self.alive)} uniques are in use; remove one first, or make the crowd "
                "with more"
            )
        k = int(free[0])
        self.alive[k] = True
        self.running[k] = index >= 0
        self.generation[k] += 1
        self.clip[k], self.time[k], self.speed[k] = index, time, speed
        self.looping[k] = (index >= 0 and bank.looping[index]) if looping is None else looping
        self._forget(k)
        return Unique(k, int(self.generation[k]))

    def remove(self, unique: Unique) -> None:
        """Give a unique's place back; agents still on it are moved to the bind pose."""
        k = self._index(unique)
        self._tell(k, removed=True)
        self.alive[k] = self.running[k] = False
        self._forget(k)

    def stop(self, unique: Unique) -> None:
        """Stop a clip; the agents on it hold."""
        self.running[self._index(unique)] = False

    def run(self, unique: Unique) -> None:
        """Let a stopped clip go on."""
        k = self._index(unique)
        self.running[k] = self.clip[k] >= 0

    def seek(self, unique: Unique, time: float) -> None:
        """Set the clip's time in seconds: a cut, across which no poses are mixed."""
        if not np.isfinite(time):
            raise ValueError(f"time is {time}, expected a finite number")
        k = self._index(unique)
        self._tell(k, removed=False)
        self.time[k] = time
        self._forget(k)

    def write(self, unique: Unique, pose: NDArray[np.float32]) -> None:
        """Set the pose that the next pose tick shows.

        Parameters
        ----------
        unique
            One without a clip.
        pose
            (10, J) local pose (`tifo.engine.animation.pose`), its quaternions of any length, or
            (J, 3, 4) palettes.

        Raises
        ------
        ValueError
            If the handle is stale or plays a clip, or the pose has another shape, values that are
            not finite, or a quaternion of no length.
        """
        k = self._index(unique)
        if self.clip[k] >= 0:
            raise ValueError(f"unique {k} plays a clip, its poses can't be written")
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
        """Evaluate running clips and written poses together; nobody sees them before `commit`."""
        playing = np.flatnonzero(self.running)
        local = np.flatnonzero(self._written == _LOCAL)
        self._pending = np.flatnonzero(self._written == _PALETTES)
        self._evaluated = np.concatenate([playing, local])
        count = len(self._evaluated)
        if not count:
            return
        workspace = self._workspace(count)
        if len(playing):
            self._advance(playing)
            split = len(playing)
            self.pool.bank.sample(
                self.clip[playing],
                self.time[playing],
                self.looping[playing],
                workspace.mixed[:split],
                workspace.scratch[:split],
            )
        workspace.mixed[len(playing) : count] = self._poses[local]
        workspace.evaluate(workspace.mixed, self._palettes)

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

    def _advance(self, who: NDArray[np.int64]) -> None:
        """A clip's first pose after a cut is the pose at its time; later ones have advanced."""
        advanced = self.pool.store.unique_valid[who] > 0
        self.time[who] += np.where(advanced, self.speed[who] / POSE_RATE, 0.0)
        duration = self.pool.bank.duration[self.clip[who]]
        wrap = self.looping[who] & (duration > 0)
        self.time[who[wrap]] = np.mod(self.time[who[wrap]], duration[wrap])

    def _workspace(self, count: int) -> Kinematics:
        """Room for at least `count` poses; what is beyond them is evaluated in vain."""
        if self._kinematics is None or self._kinematics.streams < count:
            room = min(1 << (count - 1).bit_length(), len(self.alive))
            self._kinematics = Kinematics(self.pool.skeleton, room)
            self._kinematics.mixed[...] = 0.0
            self._kinematics.mixed[:, [ROTATION.stop - 1, *range(SCALE.start, SCALE.stop)]] = 1.0
            self._palettes = np.zeros((room, *self._palettes.shape[1:]), np.float32)
        return self._kinematics

    def _index(self, unique: Unique) -> int:
        k = unique.number
        if not 0 <= k < len(self.alive) or not self.alive[k]:
            raise ValueError(f"unique {k} is not alive")
        if unique.generation != self.generation[k]:
            raise ValueError(f"unique {k} was removed and its place given to another")
        return k

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
