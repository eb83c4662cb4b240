"""Tweens: curves at points computed by hand, and the order and time of their steps."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tifo import (
    Ease,
    Node,
    Node3D,
    Quaternion,
    SceneTree,
    ScriptError,
    Trans,
    TweenPause,
    Vector3,
    ease,
    export,
)

STEP = 1 / 60
ROOT = math.sqrt(0.5)

# At a quarter, a half and three quarters of the time, computed by hand from Penner's equations.
# 2^-7.5 = 0.0055243, 2^-5 = 0.03125, 2^-2.5 = 0.1767767.
IN: dict[Trans, tuple[float, float, float]] = {
    Trans.LINEAR: (0.25, 0.5, 0.75),
    Trans.SINE: (1 - math.cos(math.pi / 8), 1 - ROOT, 1 - math.sin(math.pi / 8)),
    Trans.QUAD: (1 / 16, 1 / 4, 9 / 16),
    Trans.CUBIC: (1 / 64, 1 / 8, 27 / 64),
    Trans.QUART: (1 / 256, 1 / 16, 81 / 256),
    Trans.QUINT: (1 / 1024, 1 / 32, 243 / 1024),
    Trans.EXPO: (0.0055243 - 0.001, 0.03125 - 0.001, 0.1767767 - 0.001),
    # The sine's argument is 2 pi (t - 1.075) / 0.3: -990, -690, -390 degrees.
    Trans.ELASTIC: (-0.0055243, -0.03125 / 2, 0.1767767 / 2),
    Trans.CIRC: (1 - math.sqrt(15 / 16), 1 - math.sqrt(3 / 4), 1 - math.sqrt(7 / 16)),
    # 1 - out(0.75), out(0.5), out(0.25); the ball is in its second, second and first hop.
    Trans.BOUNCE: (
        1 - (7.5625 * (0.75 - 2.25 / 2.75) ** 2 + 0.9375),
        1 - (7.5625 * (0.5 - 1.5 / 2.75) ** 2 + 0.75),
        1 - 7.5625 / 16,
    ),
    Trans.BACK: (
        (2.70158 / 4 - 1.70158) / 16,
        (2.70158 / 2 - 1.70158) / 4,
        (2.70158 * 0.75 - 1.70158) * 9 / 16,
    ),
    Trans.SPRING: (
        1 - (math.sin(0.75 * math.pi * (0.2 + 2.5 * 0.421875)) * 0.25**2.2 + 0.75) * 1.3,
        1 - (math.sin(0.5 * math.pi * 0.5125) * 0.5**2.2 + 0.5) * 1.6,
        1 - (math.sin(0.25 * math.pi * (0.2 + 2.5 * 0.015625)) * 0.75**2.2 + 0.25) * 1.9,
    ),
}


@pytest.mark.parametrize("trans", Trans)
def test_curves_at_hand_computed_points(trans: Trans) -> None:
    for t, value in zip((0.25, 0.5, 0.75), IN[trans], strict=True):
        assert ease(t, trans, Ease.IN) == pytest.approx(value, abs=1e-6)


@pytest.mark.parametrize("trans", [trans for trans in Trans if trans is not Trans.EXPO])
def test_out_is_in_from_the_other_end(trans: Trans) -> None:
    for t, value in zip((0.75, 0.5, 0.25), IN[trans], strict=True):
        assert ease(t, trans, Ease.OUT) == pytest.approx(1 - value, abs=1e-6)


def test_curves_with_equations_of_their_own() -> None:
    assert ease(0.25, Trans.EXPO, Ease.OUT) == pytest.approx(1.001 * (1 - 0.1767767), abs=1e-6)
    assert ease(0.25, Trans.EXPO, Ease.IN_OUT) == pytest.approx(0.03125 / 2 - 0.0005)
    assert ease(0.75, Trans.EXPO, Ease.IN_OUT) == pytest.approx(0.50025 * (2 - 0.03125))
    # (2t - 1 - 0.1125) 2 pi / 0.45 at t = 1/4 is -490 degrees, whose sine is -sin 130.
    elastic = -0.5 * 0.03125 * -math.sin(math.radians(130))
    assert ease(0.25, Trans.ELASTIC, Ease.IN_OUT) == pytest.approx(elastic, abs=1e-9)
    # At 3/4 it is 310 degrees.
    elastic = 0.5 * 0.03125 * math.sin(math.radians(310)) + 1
    assert ease(0.75, Trans.ELASTIC, Ease.IN_OUT) == pytest.approx(elastic, abs=1e-9)
    overshoot = 1.70158 * 1.525
    back = 0.25 * ((overshoot + 1) * 0.5 - overshoot) / 2
    assert ease(0.25, Trans.BACK, Ease.IN_OUT) == pytest.approx(back)
    assert ease(0.75, Trans.BACK, Ease.IN_OUT) == pytest.approx(1 - back)


@pytest.mark.parametrize("trans", Trans)
def test_out_in_is_a_half_of_each(trans: Trans) -> None:
    if trans is Trans.LINEAR:
        return
    assert ease(0.25, trans, Ease.OUT_IN) == pytest.approx(ease(0.5, trans, Ease.OUT) / 2)
    assert ease(0.75, trans, Ease.OUT_IN) == pytest.approx(0.5 + ease(0.5, trans, Ease.IN) / 2)
    if trans not in (Trans.EXPO, Trans.ELASTIC, Trans.BACK):
        assert ease(0.125, trans, Ease.IN_OUT) == pytest.approx(IN[trans][0] / 2, abs=1e-6)


@given(st.sampled_from(Trans), st.sampled_from(Ease))
def test_all_go_from_0_to_1(trans: Trans, how: Ease) -> None:
    # Of Godot's exponential curve the end of an IN, and of its half in OUT_IN, lack a thousandth.
    slack = 0.0011 if trans is Trans.EXPO else 1e-12
    assert ease(0.0, trans, how) == pytest.approx(0.0, abs=slack)
    assert ease(1.0, trans, how) == pytest.approx(1.0, abs=slack)
    for wrong in (-0.1, 1.1, float("nan")):
        with pytest.raises(ValueError, match="t is"):
            ease(wrong, trans, how)


class Thing(Node3D):
    """Has values to change."""

    level: float = export(default=0.0, range=(-1, 1))
    count: int = 0
    size: float = 0.0

    def _prepare(self) -> None:
        super()._prepare()
        self.array = np.zeros(2)
        self.seen: list[Any] = []


@pytest.fixture
def thing(tree: SceneTree) -> Thing:
    return tree.root.add_child(Thing())


def test_a_property_goes_there_and_stays(tree: SceneTree, thing: Thing) -> None:
    tween = thing.create_tween()
    tween.tween_property(thing, "size", 10, 1.0)
    tree.run(0.5)
    assert thing.size == pytest.approx(5.0)
    tree.run(0.5)
    assert thing.size == 10.0
    assert not tween.is_valid()
    thing.size = 3.0
    tree.run(0.1)
    assert thing.size == 3.0
    assert tree.tweens == []


def test_parts_of_vectors_rotations_arrays_and_whole_numbers(tree: SceneTree, thing: Thing) -> None:
    quarter = Quaternion.from_axis_angle((0, 1, 0), math.pi / 2)
    tween = thing.create_tween().set_parallel()
    tween.tween_property(thing, "position:x", 2.0, 1.0)
    tween.tween_property(thing, "position:z", -2.0, 1.0)
    tween.tween_property(thing, "rotation", quarter, 1.0)
    tween.tween_property(thing, "scale", (3, 3, 3), 1.0)
    tween.tween_property(thing, "array", [1.0, 2.0], 1.0)
    tween.tween_property(thing, "count", 5, 1.0)
    tree.run(0.5)
    assert thing.position == pytest.approx(Vector3(1.0, 0.0, -1.0))
    half = Quaternion.from_axis_angle((0, 1, 0), math.pi / 4)
    assert thing.rotation == pytest.approx(half)
    assert thing.scale == pytest.approx(Vector3(2.0, 2.0, 2.0))
    assert thing.array == pytest.approx([0.5, 1.0])
    assert thing.count == 2  # round(2.5), to the even one
    assert thing.global_position == pytest.approx(thing.position)


def test_steps_and_parallels_and_signals(tree: SceneTree, thing: Thing) -> None:
    log: list[tuple[str, int]] = []

    def note(what: str) -> None:
        log.append((what, tree.tick))

    tween = thing.create_tween()
    tween.tween_interval(0.1)
    tween.tween_callback(lambda: note("called"))
    tween.tween_property(thing, "size", 1.0, 0.2)
    tween.parallel().tween_callback(lambda: note("delayed")).set_delay(0.1)
    tween.tween_callback(lambda: note("last"))
    tween.step_finished.connect(lambda number: note(f"step {number}"))
    tween.finished.connect(lambda: note("finished"))
    tree.run(1.0)
    assert log == [
        *(("step 0", 6), ("called", 6), ("step 1", 6), ("delayed", 12), ("step 2", 18)),
        *(("last", 18), ("step 3", 18), ("finished", 18)),
    ]


def test_set_parallel_and_chain(tree: SceneTree, thing: Thing) -> None:
    tween = thing.create_tween().set_parallel()
    tween.tween_property(thing, "size", 1.0, 0.1)
    tween.tween_property(thing, "level", 1.0, 0.1)
    tween.chain().tween_property(thing, "size", 0.0, 0.1)
    tree.run(0.1)
    assert (thing.size, thing.level) == (1.0, 1.0)
    tree.run(0.1)
    assert (thing.size, thing.level) == (0.0, 1.0)


def test_loops_keep_their_time(tree: SceneTree, thing: Thing) -> None:
    log: list[int] = []
    tween = thing.create_tween().set_loops(3)
    tween.tween_callback(lambda: log.append(tree.tick)).set_delay(0.25)
    loops: list[int] = []
    tween.loop_finished.connect(loops.append)
    tree.run(2.0)
    assert log == [15, 30, 45]
    assert loops == [1, 2]


def test_endless_loops_without_time_let_the_frame_end(tree: SceneTree, thing: Thing) -> None:
    calls = [0]

    def call() -> None:
        calls[0] += 1

    thing.create_tween().set_loops().tween_callback(call)
    brief = thing.create_tween().set_loops()
    brief.tween_interval(1e-9)
    tree.advance(STEP)
    assert 1 <= calls[0] <= 5
    assert brief.is_running()


def test_from_and_relative(tree: SceneTree, thing: Thing) -> None:
    thing.size = 4.0
    tween = thing.create_tween()
    tween.tween_property(thing, "size", 1.0, 0.1).from_(2.0)
    tween.tween_property(thing, "size", 1.0, 0.1).as_relative()
    tween.tween_property(thing, "size", 1.0, 0.1).as_relative()
    tree.run(0.05)
    assert thing.size == pytest.approx(1.5)
    tree.run(0.05)
    assert thing.size == 1.0
    tree.run(0.2)
    assert thing.size == pytest.approx(3.0)
    late = thing.create_tween()
    late.tween_property(thing, "size", 0.0, 0.1).from_current()
    thing.size = 9.0
    tree.run(0.05)
    assert thing.size == pytest.approx(1.5)


def test_methods_transitions_and_speed(tree: SceneTree, thing: Thing) -> None:
    tween = thing.create_tween().set_trans(Trans.QUAD).set_ease(Ease.IN).set_speed_scale(2.0)
    tween.tween_method(thing.seen.append, 0.0, 8.0, 1.0)
    tween.tween_method(thing.seen.append, 0.0, 8.0, 1.0).set_ease(Ease.OUT)
    tree.run(0.25)
    assert thing.seen[-1] == pytest.approx(2.0)
    tree.run(0.5)
    assert thing.seen[-1] == pytest.approx(6.0)
    tree.run(0.25)
    assert thing.seen[-1] == 8.0


def test_pause_stop_kill_and_custom_steps(tree: SceneTree, thing: Thing) -> None:
    tween = thing.create_tween()
    tween.tween_property(thing, "size", 1.0, 1.0)
    tree.run(0.5)
    tween.pause()
    tree.run(0.5)
    assert thing.size == pytest.approx(0.5)
    tween.custom_step(0.25)
    assert thing.size == pytest.approx(0.75)
    tween.stop()
    thing.size = 0.0
    tween.play()
    tree.run(0.5)
    assert thing.size == pytest.approx(0.5)
    with pytest.raises(ValueError, match="has begun"):
        tween.tween_interval(1.0)
    tween.kill()
    tree.run(1.0)
    assert thing.size == pytest.approx(0.5)
    with pytest.raises(ValueError, match="has finished"):
        tween.play()


def test_a_tween_lives_and_rests_with_its_node(tree: SceneTree, thing: Thing) -> None:
    other = tree.root.add_child(Thing())
    bound = thing.create_tween()
    bound.tween_property(other, "size", 1.0, 1.0)
    free = tree.create_tween().set_pause_mode(TweenPause.PROCESS)
    free.tween_property(other, "level", 1.0, 1.0)
    tree.paused = True
    tree.run(0.5)
    assert (other.size, other.level) == (0.0, pytest.approx(0.5))
    tree.paused = False
    tree.run(0.25)
    tree.root.remove_child(thing)
    tree.run(0.25)
    assert other.size == pytest.approx(0.25)
    thing.free()
    tree.run(0.25)
    assert other.size == pytest.approx(0.25)
    assert tree.tweens == []


def test_a_step_on_something_freed_is_over(
    tree: SceneTree, thing: Thing, errors: list[ScriptError]
) -> None:
    other = tree.root.add_child(Thing())
    tween = thing.create_tween()
    tween.tween_property(other, "size", 1.0, 9.0)
    tween.tween_property(thing, "size", 1.0, 0.1)
    tree.advance(STEP)
    other.free()
    tree.run(0.1)
    assert thing.size == 1.0
    assert errors == []


def test_errors_in_tweens_are_reported(
    tree: SceneTree, thing: Thing, errors: list[ScriptError]
) -> None:
    tween = thing.create_tween()
    tween.tween_callback(lambda: 1 / 0)
    tween.tween_property(thing, "level", 1.0, 1.0).set_trans(Trans.BACK).set_ease(Ease.OUT)
    tree.run(1.0)
    assert "on a tween" in str(errors[0])
    assert "ZeroDivisionError" in str(errors[0])
    assert "expected a number from -1 to 1" in str(errors[1])  # it went beyond on its way
    assert len(errors) == 2
    assert thing.level <= 1.0
    thing.create_tween()
    tree.advance(STEP)
    assert "without tweeners" in str(errors[2])


def test_wrong_steps_are_refused(thing: Thing) -> None:
    tween = thing.create_tween()
    with pytest.raises(ValueError, match="sise"):
        tween.tween_property(thing, "sise", 1.0, 1.0)
    with pytest.raises(ValueError, match=r"can.t go from 0\.0 to"):
        tween.tween_property(thing, "size", "x", 1.0)
    with pytest.raises(ValueError, match="seconds is -1"):
        tween.tween_property(thing, "size", 1.0, -1)
    with pytest.raises(ValueError, match="callable"):
        tween.tween_callback(3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="contain itself"):
        tween.tween_subtween(tween)
    with pytest.raises(ValueError, match="loops"):
        tween.set_loops(-1)


def test_subtweens(tree: SceneTree, thing: Thing) -> None:
    inner = thing.create_tween()
    inner.tween_property(thing, "size", 1.0, 0.2)
    inner.tween_property(thing, "size", 0.0, 0.2)
    outer = thing.create_tween().set_loops(2)
    outer.tween_subtween(inner).set_delay(0.1)
    outer.tween_callback(lambda: thing.seen.append(tree.tick))
    tree.run(0.3)
    assert thing.size == pytest.approx(1.0)
    tree.run(1.0)
    assert thing.seen == [30, 60]


def test_a_script_can_wait_for_a_tween(tree: SceneTree) -> None:
    log: list[int] = []

    class Waiter(Node):
        async def _ready(self) -> None:
            tween = self.create_tween()
            tween.tween_interval(0.5)
            await tween.finished
            log.append(self.tree.tick)

    tree.root.add_child(Waiter())
    tree.run(1.0)
    assert log == [30]
