"""The tree of a running game: advances nodes, timers, tweens and coroutines in steps of 1/60 s.

It knows neither windows nor OpenGL: `SceneTree.advance` is called by a loop of whatever kind, and
input comes as events through `SceneTree.push_input`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Coroutine
from enum import IntFlag
from pathlib import Path
from typing import Any

from ..engine.clock import BASE_RATE, MAX_CATCH_UP, Clock
from . import frame, lifecycle
from .autoloads import Autoloads
from .deferred import DeferredCalls
from .input_events import InputEvent
from .input_map import InputMap
from .input_state import Input
from .node import Node
from .order import Groups, Order
from .packed_scene import PackedScene, load_scene, scene_root
from .reports import LogReport, Report, ScriptError, freed, report
from .signals import Signal, emit_if_made
from .tasks import Task, as_coroutine
from .timers import SceneTreeTimer
from .tween import Tween


class GroupCall(IntFlag):
    """How `SceneTree.call_group_flags` calls."""

    DEFAULT = 0
    REVERSE = 1
    """In reverse tree order."""
    DEFERRED = 2
    """At the next flush of deferred calls."""
    UNIQUE = 4
    """With DEFERRED: once, however often it is asked for until then."""


class SceneTree:
    """Nodes under one root, and the time that passes for them.

    Parameters
    ----------
    scene
        The current scene at first: its root node, a packed scene, or the path of a scene file.
    report
        Gets the `ScriptError` of every exception in a script; they are logged if it is None.

    Attributes
    ----------
    root
        The node above all: ``/root``.
    current_scene
        Root of the running scene.
    time_scale
        How fast time passes for scripts: what `_process` and `_physics_process` get as `delta` is
        multiplied by it. There are 60 ticks a second all the same.
    input, input_map
        The state of the named actions, and what they are bound to.
    real_delta
        Unscaled seconds of this tick or frame.
    frame_number, in_physics
        Calls of `advance` so far, and whether a tick runs now and not a frame.
    clock
        Counts the ticks.
    report
        What gets the errors.
    is_running
        False after `quit`.
    exit_code
        What `quit` was given.
    """

    process_frame = Signal[()]()
    """Before the `_process` of a frame."""
    physics_frame = Signal[()]()
    """Before the `_physics_process` of a tick."""
    input_taken = Signal[InputEvent]()
    """When an event takes effect in a tick, before `_input`."""
    file_taken = Signal[str]()
    """When a file that changed was taken over by `HotReload`, with its path."""
    node_added = Signal[Node]()
    node_removed = Signal[Node]()
    scene_changed = Signal[()]()
    """After `change_scene`, when the new scene is in the tree."""

    def __init__(
        self, scene: Node | PackedScene | str | Path | None = None, *, report: Report | None = None
    ) -> None:
        self._tree = self
        self.report: Callable[[ScriptError], None] = report or LogReport()
        self.clock = Clock()
        self.input_map = InputMap()
        self.input = Input(self.input_map, self)
        self.autoloads = Autoloads()
        self.root = Node(name="root")
        self.order = Order(self.root)
        self.groups = Groups(self.order)
        self.current_scene: Node | None = None
        self.is_running, self.exit_code = True, 0
        self.frame_number = 0
        self.in_physics = False
        self.real_delta = frame.STEP
        self._time_scale = 1.0
        self._paused = self._advancing = self._closed = False
        self._deferred = DeferredCalls()
        self.doomed: list[Node] = []
        self._unique_calls: set[tuple[Any, ...]] = set()
        self.events: list[InputEvent] = []
        self.before_tick: list[Callable[[], object]] = []
        self.input_handled = False
        self.timers: list[SceneTreeTimer] = []
        self.tweens: list[Tween] = []
        self._tasks: dict[Task, None] = {}
        self._next_scene: Node | None = None
        self.root._tree = self
        self.root._ready_begun, self.root._needs_ready = True, False
        lifecycle.refresh_modes(self.root)
        if scene is not None:
            self._put(scene_root(scene))

    def __repr__(self) -> str:
        """For messages."""
        return f"<SceneTree, tick {self.tick}>"

    # Time

    @property
    def tick(self) -> int:
        """Ticks of 1/60 s since the start."""
        return self.clock.tick

    @property
    def time_scale(self) -> float:
        """How fast time passes for scripts."""
        return self._time_scale

    @time_scale.setter
    def time_scale(self, scale: float) -> None:
        if not math.isfinite(scale) or scale < 0.0:
            raise ValueError(f"time_scale is {scale}, expected a number >= 0")
        self._time_scale = float(scale)

    @property
    def paused(self) -> bool:
        """Whether only nodes run whose process mode says so."""
        return self._paused

    @paused.setter
    def paused(self, paused: bool) -> None:
        if bool(paused) != self._paused:
            self._paused = bool(paused)
            lifecycle.refresh_modes(self.root)

    def advance(self, delta: float) -> bool:
        """Let `delta` seconds pass: the ticks that are due, then a frame.

        At most 4 ticks are made up for; what is beyond is dropped, for `_process` as well.

        Returns
        -------
        bool
            Whether the game goes on: False after `quit`.

        Raises
        ------
        ValueError
            If `delta` is negative or not finite, the tree was closed, or a script called this.
        """
        if self._closed:
            raise ValueError("the tree was closed")
        if self._advancing:
            raise ValueError("advance was called by a script that advance itself is running")
        if not math.isfinite(delta) or delta < 0.0:
            raise ValueError(f"delta is {delta}, expected seconds >= 0")
        delta = min(delta, MAX_CATCH_UP / BASE_RATE)
        self._advancing = True
        try:
            self.frame_number += 1
            for _ in range(self.clock.due(delta)):
                self.clock.advance()
                frame.tick(self)
            frame.frame(self, delta)
        finally:
            self._advancing = self.in_physics = False
        return self.is_running

    def run(self, seconds: float) -> bool:
        """Advance by frames of one tick each, until `seconds` have passed or `quit` was called."""
        for _ in range(round(seconds * BASE_RATE)):
            if not self.advance(frame.STEP):
                break
        return self.is_running

    def quit(self, exit_code: int = 0) -> None:
        """End the game after this frame."""
        self.is_running, self.exit_code = False, exit_code

    def close(self) -> None:
        """Free all nodes and close all coroutines. The tree can't be used afterwards."""
        if self._advancing:
            raise ValueError("a tree can't be closed by a script; use quit")
        if self._closed:
            return
        self._closed, self.is_running = True, False
        if self._next_scene is not None:
            self._next_scene.free()
        for child in reversed(self.root.children):
            child.free()
        for task in [*self._tasks]:
            task.cancel()
        for tween in self.tweens:
            tween.kill()
        self._deferred.clear()
        self.current_scene = None

    # Scenes

    def change_scene(self, to: Node | PackedScene | str | Path) -> None:
        """Free the current scene and go on with another, at the end of this frame.

        Raises
        ------
        ValueError
            If `to` is no scene.
        AssetError
            If it is the path of a file that is none.
        """
        scene = scene_root(to)
        if self._next_scene is not None and self._next_scene is not scene:
            self._next_scene.free()
        self._next_scene = scene

    def reload_current_scene(self) -> None:
        """Begin the current scene anew at the end of this frame, from its file.

        Raises
        ------
        ValueError
            If there is no current scene, or it wasn't made from a file.
        """
        if self.current_scene is None or not self.current_scene.scene_path:
            raise ValueError(f"{self.current_scene!r} was not made from a scene file")
        self.change_scene(load_scene(self.current_scene.scene_path))

    def autoload(self, name: str, node: Node) -> Node:
        """Add `node` under the root, before the current scene, reachable as an autoload."""
        if name in self.autoloads._nodes or self.root.has_node(name):
            raise ValueError(f"name is {name!r}, which is taken")
        node.name = name
        self.autoloads._nodes[name] = node
        self.root.add_child(node)
        if self.current_scene is not None and self.current_scene.parent is self.root:
            self.root.move_child(self.current_scene, -1)
        return node

    # Groups

    def get_nodes_in_group(self, group: str) -> list[Node]:
        """Nodes of a group in tree order."""
        return self.groups.nodes(group)

    def get_first_node_in_group(self, group: str) -> Node | None:
        """The first node of a group in tree order, or None."""
        return next(iter(self.groups.nodes(group)), None)

    def call_group(self, group: str, method: str | Callable[..., object], *args: Any) -> None:
        """Call a method of all nodes of a group; those that don't have it are passed over.

        `method` is a name or a function of a class, ``Fan.cheer``; what a node's own class makes of
        it is called.
        """
        self.call_group_flags(GroupCall.DEFAULT, group, method, *args)

    def call_group_flags(
        self, flags: int, group: str, method: str | Callable[..., object], *args: Any
    ) -> None:
        """The same, in another order or later."""
        name = method if isinstance(method, str) else method.__name__
        if flags & GroupCall.DEFERRED:
            key = (group, name)
            if flags & GroupCall.UNIQUE:
                if key in self._unique_calls:
                    return
                self._unique_calls.add(key)
            self.defer(self._call_members, flags, group, name, args)
        else:
            self._call_members(flags, group, name, args)

    def set_group(self, group: str, attribute: str, value: object) -> None:
        """Set an attribute of all nodes of a group that have it."""
        for node in self.groups.nodes(group):
            if hasattr(node, attribute):
                try:
                    setattr(node, attribute, value)
                except Exception as error:
                    report(error, self.set_group, f"group '{group}'", node)

    def _call_members(self, flags: int, group: str, name: str, args: tuple[Any, ...]) -> None:
        self._unique_calls.discard((group, name))
        nodes = self.groups.nodes(group)
        for node in reversed(nodes) if flags & GroupCall.REVERSE else nodes:
            function = getattr(node, name, None)
            if node._tree is not self or not callable(function):
                continue
            self.call(function, *args, cause=f"group '{group}'", owner=node)

    # Timers, tweens, coroutines, deferred calls

    def create_timer(
        self,
        seconds: float,
        *,
        process_always: bool = True,
        process_in_physics: bool = False,
        ignore_time_scale: bool = False,
    ) -> SceneTreeTimer:
        """A timer that emits `timeout` once: ``await tree.create_timer(1.0).timeout``.

        Parameters
        ----------
        seconds
            How long it takes.
        process_always
            Run in pauses too.
        process_in_physics
            Count ticks, not frames: needed where runs must be repeatable at any frame rate.
        ignore_time_scale
            Count unscaled seconds.
        """
        timer = SceneTreeTimer(self, seconds, process_always, process_in_physics, ignore_time_scale)
        self.timers.append(timer)
        return timer

    def create_tween(self) -> Tween:
        """A tween that is bound to no node; it begins at the next frame."""
        tween = Tween(self)
        self.tweens.append(tween)
        return tween

    def start(
        self, coroutine: Coroutine[Any, Any, Any], *, owner: Any = None, cause: str = ""
    ) -> Task:
        """Run a coroutine to its first await; signals resume it.

        Parameters
        ----------
        coroutine
            Of an ``async def``; it can await signals and tasks.
        owner
            The node with which it ends.
        cause
            Why it runs, for reports.
        """
        found = as_coroutine(coroutine)
        if found is None:
            raise ValueError(f"coroutine is {coroutine!r}, expected a call of an async def")
        if freed(owner) or self._closed:
            found.close()
            raise ValueError(f"{owner if owner is not None else self!r} can't run coroutines")
        task = Task(self, found, owner, cause)
        self._tasks[task] = None
        if isinstance(owner, Node):
            owner._tasks[task] = None
        task.step()
        return task

    def forget_task(self, task: Task, owner: Any) -> None:
        """A task has ended."""
        self._tasks.pop(task, None)
        if isinstance(owner, Node):
            owner._tasks.pop(task, None)

    def defer(
        self, function: Callable[..., object], *args: Any, cause: str = "", owner: Any = None
    ) -> None:
        """Call a function after this round of callbacks, unless its node is freed before."""
        if not callable(function):
            raise ValueError(f"function is {function!r}, expected something callable")
        self._deferred.add(function, args, cause, owner if owner is not None else self)

    def call(
        self, function: Callable[..., object], *args: Any, cause: str = "", owner: Any = None
    ) -> None:
        """Call a script's function now: errors are reported, a coroutine is run."""
        try:
            result = function(*args)
        except Exception as error:
            report(error, function, cause, owner if owner is not None else self)
        else:
            if result is not None:
                self.run_if_coroutine(result, getattr(function, "__self__", None) or owner)

    def run_if_coroutine(self, result: object, owner: Any) -> None:
        """Run what a callback returned, if it is a coroutine."""
        coroutine = as_coroutine(result)
        if coroutine is None:
            return
        if freed(owner) or self._closed:
            coroutine.close()
            return
        self.start(coroutine, owner=owner)

    def queue_delete(self, node: Node) -> None:
        """Free a node at the end of this tick or frame."""
        self.doomed.append(node)

    # Input

    def push_input(self, event: InputEvent) -> None:
        """Something was pressed, moved or released; it takes effect at the next tick."""
        if not isinstance(event, InputEvent):
            raise ValueError(f"event is {event!r}, expected an InputEvent")
        self.events.append(event)

    def at_next_tick(self, function: Callable[[], object]) -> None:
        """Call a function once when the next tick begins, before its input."""
        self.before_tick.append(function)

    def set_input_as_handled(self) -> None:
        """Called in `_input` or `_unhandled_input`: no other node gets this event."""
        self.input_handled = True

    # The end of a frame

    def flush(self) -> None:
        """Make the deferred calls."""
        self._deferred.flush(self.run_if_coroutine)

    def change_if_asked(self) -> None:
        """Make the change of scenes that `change_scene` asked for, if it did."""
        scene, self._next_scene = self._next_scene, None
        if scene is None:
            return
        if self.current_scene is not None and not self.current_scene._freed:
            self.current_scene.free()
        self._put(scene)
        emit_if_made(self, "scene_changed")

    def _put(self, scene: Node) -> None:
        self.current_scene = scene
        self.root.add_child(scene)
