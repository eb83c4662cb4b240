"""What happens in a tick and in a frame, in this order.

A tick: input (`_input`, `_unhandled_input`), deferred calls, the signal `physics_frame`, timers,
`_physics_process`, deferred calls, timers and tweens of ticks, deferred calls, `queue_free`.

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
    if tree.events:
        events, tree.events = tree.events, []
        for event in events:
            _dispatch(tree, event)
        tree.flush()
    emit_if_made(tree, "physics_frame")
    order = tree.order
    order.refresh()
    for node in order.steps:
        if node._step_on:
            node._step(delta, physics=True)
    for node in order.physics:
        if node._physics_on:
            try:
                result = node._physics_process(delta)
            except Exception as error:
                report(error, node._physics_process, "", node)
            else:
                if result is not None:
                    tree.run_if_coroutine(result, node)
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
    order = tree.order
    order.refresh()
    for node in order.steps:
        if node._step_on:
            node._step(delta, physics=False)
    for node in order.process:
        if node._process_on:
            try:
                result = node._process(delta)
            except Exception as error:
                report(error, node._process, "", node)
            else:
                if result is not None:
                    tree.run_if_coroutine(result, node)
    tree.flush()
    _run_timers(tree, real, physics=False)
    tree.flush()
    tree.change_if_asked()
    _delete_doomed(tree)


def _dispatch(tree: SceneTree, event: InputEvent) -> None:
    tree.order.refresh()
    tree.input.take(event)
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
