"""Tweens: changes over time, written as a list of steps.

.. code:: python

    tween = node.create_tween().set_trans(Trans.BACK).set_ease(Ease.OUT)
    tween.tween_property(node, "position:y", 2.0, 0.5)
    tween.parallel().tween_property(node, "scale", (2, 2, 2), 0.5)
    tween.tween_interval(1.0)
    tween.tween_callback(node.queue_free)
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Self, TypeVar

from .easing import Ease, Trans
from .reports import freed, report
from .signals import Signal
from .tweeners import (
    CallbackTweener,
    IntervalTweener,
    MethodTweener,
    PropertyTweener,
    SubtweenTweener,
    Tweener,
)

if TYPE_CHECKING:
    from .node import Node
    from .tree import SceneTree

A = TypeVar("A", bound=Tweener)
MOST_LOOPS = 1000
"""How many loops a tween makes within one frame at most."""


class TweenPause(IntEnum):
    """What a tween does while the tree is paused."""

    BOUND = 0
    """What its node does; like STOP without a node."""
    STOP = 1
    PROCESS = 2


class Tween:
    """A list of steps that run one after the other; made by `create_tween` of a node or the tree.

    It begins by itself at the next frame, and can't be used again once it has finished. A step
    consists of one tweener or several that run at the same time.
    """

    finished = Signal[()]()
    """After the last step of the last loop."""
    loop_finished = Signal[int]()
    """After each loop but the last, with how many are done."""
    step_finished = Signal[int]()
    """After each step, with its number from 0."""

    def __init__(self, tree: SceneTree) -> None:
        self._tree = tree
        self._steps: list[list[Tweener]] = []
        self.trans, self.ease = Trans.LINEAR, Ease.IN_OUT
        self.bound_node: Node | None = None
        self._default_parallel = self._parallel = False
        self._pause = TweenPause.BOUND
        self._physics = self._unscaled = False
        self._loops, self._speed = 1, 1.0
        self._running, self._started, self._dead = True, False, False
        self._inner = False
        self._current, self._loops_done = 0, 0

    # What it does

    def tween_property(
        self, target: object, attribute: str, final: Any, seconds: float
    ) -> PropertyTweener:
        """Bring an attribute to `final`; a part of a vector is named ``"position:x"``."""
        return self._add(PropertyTweener(self, target, attribute, final, seconds))

    def tween_method(
        self, method: Callable[[Any], object], initial: Any, final: Any, seconds: float
    ) -> MethodTweener:
        """Call `method` in every frame with a value between `initial` and `final`."""
        return self._add(MethodTweener(self, method, initial, final, seconds))

    def tween_callback(self, callback: Callable[[], object]) -> CallbackTweener:
        """Call `callback` once."""
        return self._add(CallbackTweener(self, callback))

    def tween_interval(self, seconds: float) -> IntervalTweener:
        """Wait."""
        return self._add(IntervalTweener(self, seconds))

    def tween_subtween(self, inner: Tween) -> SubtweenTweener:
        """Run another tween as a step; it doesn't run by itself any more."""
        if inner is self or inner._started or inner._loops <= 0:
            raise ValueError("a tween can't contain itself, a running or an endless one")
        inner._inner = True
        return self._add(SubtweenTweener(self, inner))

    def parallel(self) -> Self:
        """Put the next tweener into the step of the last one."""
        self._parallel = True
        return self

    def set_parallel(self, parallel: bool = True) -> Self:
        """Put all further tweeners into one step, but for those after `chain`."""
        self._default_parallel = self._parallel = parallel
        return self

    def chain(self) -> Self:
        """Begin a new step with the next tweener, after `set_parallel`."""
        self._parallel = False
        return self

    # How it does it

    def set_trans(self, trans: Trans) -> Self:
        """Transition of tweeners that have none of their own."""
        self.trans = Trans(trans)
        return self

    def set_ease(self, ease: Ease) -> Self:
        """Easing of tweeners that have none of their own."""
        self.ease = Ease(ease)
        return self

    def set_loops(self, loops: int = 0) -> Self:
        """Play all steps that many times; 0 for ever."""
        if loops < 0:
            raise ValueError(f"loops is {loops}, expected 0 or more")
        self._loops = loops
        return self

    def set_speed_scale(self, speed: float) -> Self:
        """Play that much faster."""
        if not 0.0 <= speed < 1e6:
            raise ValueError(f"speed is {speed}, expected 0 to 1e6")
        self._speed = speed
        return self

    def set_process_in_physics(self, physics: bool = True) -> Self:
        """Move in ticks and not in frames."""
        self._physics = physics
        return self

    def set_ignore_time_scale(self, ignore: bool = True) -> Self:
        """Count unscaled seconds."""
        self._unscaled = ignore
        return self

    def set_pause_mode(self, mode: TweenPause) -> Self:
        """What it does while the tree is paused."""
        self._pause = TweenPause(mode)
        return self

    def bind_node(self, node: Node) -> Self:
        """Stand still outside the tree and while `node` does; end when it is freed."""
        self.bound_node = node
        return self

    # Control

    def play(self) -> None:
        """Go on after `pause`, or begin after `stop`."""
        if self._dead:
            raise ValueError("the tween has finished; stop() makes it ready to begin again")
        self._running = True

    def pause(self) -> None:
        """Stand still."""
        self._running = False

    def stop(self) -> None:
        """Stand still, at the beginning."""
        self._running = self._started = self._dead = False

    def kill(self) -> None:
        """End at once, without `finished`."""
        self._running, self._dead = False, True

    def is_running(self) -> bool:
        """Whether it plays."""
        return self._running and not self._dead

    def is_valid(self) -> bool:
        """Whether it hasn't ended and isn't a step of another one."""
        return not self._dead and not self._inner

    def custom_step(self, seconds: float) -> bool:
        """Let time pass for this tween alone; whether it goes on."""
        running, self._running = self._running, True
        self.run_for(seconds)
        self._running = self._running and running
        return not self._dead

    # Called by the tree

    def tree_step(self, real: float, *, physics: bool) -> None:
        """A tick or frame of unscaled seconds has passed."""
        if self._dead or physics is not self._physics or not self._may_run():
            return
        if self._running:
            self.run_for(real if self._unscaled else real * self._tree.time_scale)

    def run_for(self, delta: float) -> float | None:
        """Play for `delta` seconds: None while it goes on, else the seconds that were left."""
        if freed(self.bound_node):
            self.kill()
        if self._dead:
            return delta
        if not self._steps:
            self.kill()
            error = ValueError("a tween began without tweeners")
            report(error, self.play, "a tween", self.bound_node or self)
            return delta
        if not self._started:
            self._started, self._current, self._loops_done = True, 0, 0
            self._start_step()
        left = delta * self._speed
        loops_here, idle_loops, at_loop = 0, 0, left
        while self._running and not self._dead:
            rests = []
            for tweener in self._steps[self._current]:
                try:
                    rests.append(tweener.step(left))
                except Exception as error:
                    report(error, tweener.step, "a tween", self.bound_node or self)
                    self.kill()
                    return None
            if self._dead or not self._started or any(rest is None for rest in rests):
                return None
            left = min(rest for rest in rests if rest is not None)
            self.step_finished.emit(self._current)
            self._current += 1
            if self._current == len(self._steps):
                self._loops_done += 1
                if self._loops_done == self._loops:
                    self.kill()
                    self.finished.emit()
                    return left
                self.loop_finished.emit(self._loops_done)
                self._current = 0
                loops_here += 1
                idle_loops = idle_loops + 1 if left == at_loop else 0
                at_loop = left
            if self._dead or not self._started:
                return None  # a handler stopped or killed it
            self._start_step()
            # Loops that take no time, or nearly none, go on in the next frame.
            if idle_loops > 1 or loops_here >= MOST_LOOPS:
                return None
        return None

    def _may_run(self) -> bool:
        node = self.bound_node
        if node is not None and not freed(node):
            if not node.is_inside_tree():
                return False
            if self._pause is TweenPause.BOUND:
                return node.can_process()
        return not self._tree.paused or self._pause is TweenPause.PROCESS

    def _start_step(self) -> None:
        for tweener in self._steps[self._current]:
            tweener.start()

    def _add(self, tweener: A) -> A:
        if self._started or self._dead:
            raise ValueError("nothing can be added to a tween that has begun; use stop() first")
        if self._parallel and self._steps:
            self._steps[-1].append(tweener)
        else:
            self._steps.append([tweener])
        self._parallel = self._default_parallel
        return tweener
