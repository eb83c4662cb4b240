"""What happens in a tick and in a frame, in this order.

A tick: changed files, input (`_input`, `_unhandled_input`), deferred calls, the signal
`physics_frame`, timer nodes, `_physics_process`, deferred calls, timers and tweens of ticks,
`queue_free`.

A frame: the signal `process_frame`, deferred calls, timer nodes, `_process`, deferred calls, timers
and tweens, deferred calls, the change of scenes, `queue_free`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..engine.clock import BASE_RATE
from .input_events import InputEvent
from .reports import report
from .signals import emit_if_made

if TYPE_CHECKING:
    from .tree import SceneTree

STEP = 1.0 / BASE_RATE
"""Seconds of a tick."""


def tick(tree: SceneTree) -> None:
    """Input, then the `_physics_process` of all nodes, then what waits for it."""
    delta = STEP * tree.time_scale
    tree.real_delta = STEP
    tree.in_physics = True
    if tree.before_tick:
        functions, tree.before_tick = tree.before_tick, []
        for function in functions:
            tree.call(function)
    if tree.events:
        events, tree.events = tree.events, []
        for event in events:
            _dispatch(tree, event)
        tree.flush()
    emit_if_made(tree, "physics_frame")
    _round(tree, delta, physics=True)
    tree.flush()
    _run_timers(tree, STEP, physics=True)
    _delete_doomed(tree)
    tree.in_physics = False


def frame(tree: SceneTree, real: float) -> None:
    """The `_process` of all nodes, then what waits for it; `real` is in unscaled seconds."""
    delta = real * tree.time_scale
    tree.real_delta = real
    emit_if_made(tree, "process_frame")
    tree.flush()
    _round(tree, delta, physics=False)
    tree.flush()
    _run_timers(tree, real, physics=False)
    tree.flush()
    tree.change_if_asked()
    _delete_doomed(tree)


def _round(tree: SceneTree, delta: float, *, physics: bool) -> None:
    """The `_physics_process` or `_process` of all nodes, and before them what tifo's own do."""
    order = tree.order
    order.begin()
    for node in order.steps:
        if node._step_on:
            node._step(delta, physics=physics)
    calls, flag = (order.physics, "_physics_on") if physics else (order.process, "_process_on")
    resting = order.resting
    for node, call in calls:
        if resting and node in resting and not getattr(node, flag):
            continue
        try:
            result = call(delta)
        except Exception as error:
            report(error, call, "", node)
        else:
            if result is not None:
                tree.run_if_coroutine(result, node)


def _dispatch(tree: SceneTree, event: InputEvent) -> None:
    tree.order.refresh()
    tree.input.take(event)
    emit_if_made(tree, "input_taken", event)
    tree.input_handled = False
    inputs, unhandled = tree.order.inputs, tree.order.unhandled
    # As a flag and a name, so that callbacks that switch nodes off are heeded at once.
    for nodes, flag, callback in (
        (inputs, "_input_on", "_input"),
        (unhandled, "_unhandled_on", "_unhandled_input"),
    ):
        for node in nodes:
            if tree.input_handled:
                return
            if getattr(node, flag):
                tree.call(getattr(node, callback), event, owner=node)


def _run_timers(tree: SceneTree, real: float, *, physics: bool) -> None:
    if tree.timers:
        for timer in [*tree.timers]:
            timer.step(real, physics=physics)
        tree.timers = [timer for timer in tree.timers if not timer.is_done]
    if tree.tweens:
        for tween in [*tree.tweens]:
            tween.tree_step(real, physics=physics)
        tree.tweens = [tween for tween in tree.tweens if tween.is_valid()]


def _delete_doomed(tree: SceneTree) -> None:
    # What a node queues while it leaves is freed as well.
    while tree.doomed:
        doomed, tree.doomed = tree.doomed, []
        for node in doomed:
            if not node._freed:
                node.free()
