"""Timers: a node, and the one that `SceneTree.create_timer` gives."""

from __future__ import annotations

import math
from enum import IntEnum
from typing import TYPE_CHECKING

from .exports import export
from .node import Node
from .signals import Signal

if TYPE_CHECKING:
    from .tree import SceneTree

# Sixty steps of 1/60 s are a hair less or more than a second.
_HAIR = 1e-9


class ProcessCallback(IntEnum):
    """Whether ticks or frames are counted."""

    PHYSICS = 0
    IDLE = 1


class Timer(Node):
    """Emits `timeout` after a time, again and again or once.

    It stands still outside a tree, while its process mode stops it, and when `paused` is set. A
    time shorter than a frame gives one timeout a frame.

    Attributes
    ----------
    wait_time
        Seconds, at least 0.001.
    one_shot
        Stop at the first timeout.
    autostart
        Start when it gets ready.
    process_callback
        Count frames, or ticks, which makes runs repeatable at any frame rate.
    ignore_time_scale
        Count unscaled seconds.
    paused
        Stand still.
    """

    wait_time: float = export(default=1.0, range=(0.001, 1e9))
    one_shot: bool = export(default=False)
    autostart: bool = export(default=False)
    process_callback: ProcessCallback = export(default=ProcessCallback.IDLE)
    ignore_time_scale: bool = export(default=False)

    timeout = Signal[()]()

    def _prepare(self) -> None:
        super()._prepare()
        self.paused = False
        self._left = 0.0
        self._started = False

    @property
    def time_left(self) -> float:
        """Seconds to the next timeout; 0 when stopped."""
        return max(self._left, 0.0) if self._started else 0.0

    def is_stopped(self) -> bool:
        """Whether it doesn't run."""
        return not self._started

    def start(self, seconds: float | None = None) -> None:
        """Run from the beginning; `seconds`, if given, becomes the wait time.

        ValueError outside a tree.
        """
        if self._tree is None:
            raise ValueError(f"{self!r} can't start outside a tree; use autostart")
        if seconds is not None:
            self.wait_time = seconds
        self._left, self._started = self.wait_time, True

    def stop(self) -> None:
        """Stop without a timeout."""
        self._started = False

    def _made_ready(self) -> None:
        if self.autostart:
            self.start()

    def _step(self, delta: float, *, physics: bool) -> None:
        if not self._started or self.paused:
            return
        if physics is not (self.process_callback is ProcessCallback.PHYSICS):
            return
        if self.ignore_time_scale:
            delta = self.tree.real_delta
        self._left -= delta
        if self._left <= _HAIR:
            if self.one_shot:
                self._started = False
            else:
                self._left = max(self._left + self.wait_time, 0.0)
            self.timeout.emit()


class SceneTreeTimer:
    """Emits `timeout` once.

    Attributes
    ----------
    time_left
        Seconds to go; may be set.
    """

    timeout = Signal[()]()

    def __init__(
        self, tree: SceneTree, seconds: float, always: bool, physics: bool, unscaled: bool
    ) -> None:
        if not math.isfinite(seconds) or seconds < 0.0:
            raise ValueError(f"seconds is {seconds}, expected a number >= 0")
        self._tree = tree
        self.time_left = float(seconds)
        self._always, self._physics, self._unscaled = always, physics, unscaled
        self.is_done = False

    def step(self, real: float, *, physics: bool) -> None:
        """Called by the tree once a tick and once a frame, with unscaled seconds."""
        if self.is_done or physics is not self._physics:
            return
        if self._tree.paused and not self._always:
            return
        self.time_left -= real if self._unscaled else real * self._tree.time_scale
        if self.time_left <= _HAIR:
            self.time_left, self.is_done = 0.0, True
            self.timeout.emit()
