"""State machines and one-shots: hand-made runs, and random ones against the naive evaluator."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from trees import CLIPS, STATES, states, transitions

from tifo.engine.animation.controllers import (
    Blend2,
    ClipNode,
    Controller,
    OneShot,
    OneShotRequest,
    StateMachine,
    Transition,
)
from tifo.engine.streams import Stream, StreamPool


class Run:
    """One stream, tick by tick."""

    def __init__(self, stage: Any, controller: Controller) -> None:
        self.pool: StreamPool = stage.pool(capacity=1)
        self.stream: Stream = self.pool.add(controller)
        self.next_tick = 0

    def tick(self, count: int = 1) -> None:
        for _ in range(count):
            self.pool.evaluate(self.next_tick)
            self.pool.commit(self.next_tick)
            self.next_tick += 1

    def get(self, path: str) -> Any:
        return self.pool.get(self.stream, path)

    def set(self, path: str, value: Any) -> None:
        self.pool.set(self.stream, path, value)

    def weights(self) -> list[float]:
        """Shares of the root's children."""
        tables = self.pool._plan.tables
        columns = tables.nodes
        count = int(columns["child_count"][0])
        start = int(columns["child_start"][0])
        nodes = tables.children["node"][start : start + count]
        return [round(float(w), 6) for w in columns["weight"][nodes]]


def machine(*ways: Transition, states: str = "abcd", **options: Any) -> StateMachine:
    nodes = {state: ClipNode(CLIPS[2 * k % 6]) for k, state in enumerate(states)}
    return StateMachine(nodes, ways, **options)


def test_a_trigger_is_used_up_by_the_transition_that_it_starts(stage: Any) -> None:
    run = Run(
        stage, machine(Transition("a", "b", trigger="go"), Transition("b", "c", trigger="go"))
    )
    run.set("go", True)
    assert run.get("go") == 1
    run.tick()
    assert (run.get("current"), run.get("go")) == ("b", 0)
    run.tick(3)
    assert run.get("current") == "b"


def test_a_trigger_waits_for_a_transition_that_uses_it(stage: Any) -> None:
    ways = Transition("a", "b", when="ready"), Transition("b", "c", trigger="go")
    run = Run(stage, machine(*ways))
    run.set("go", True)
    run.tick(2)
    assert (run.get("current"), run.get("go")) == ("a", 1)
    run.set("ready", 1)
    run.tick(2)
    assert (run.get("current"), run.get("go")) == ("c", 0)


@pytest.mark.parametrize(("curve", "expected"), [("linear", 0.25), ("smooth", 0.15625)])
def test_a_blend_follows_its_curve(stage: Any, curve: str, expected: float) -> None:
    run = Run(stage, machine(Transition("a", "b", trigger="go", duration=4 / 30, curve=curve)))
    run.tick(3)
    run.set("go", True)
    run.tick()
    assert run.weights() == [1, 0, 0, 0]
    assert (run.get("current"), run.get("fading_from"), run.get("position")) == ("b", "a", 0.0)
    run.tick()
    assert run.weights() == [1 - expected, expected, 0, 0]
    run.tick(3)
    assert (run.weights(), run.get("fading_from")) == ([0, 1, 0, 0], None)
    assert run.get("position") == pytest.approx(4 / 30)


@pytest.mark.parametrize(
    ("rule", "second"), [("any", "cd"), ("none", "bb"), ("priority", "bd")], ids=lambda x: str(x)
)
def test_interruption_rules(stage: Any, rule: str, second: str) -> None:
    """While a blend of priority 1 runs, one of 2 and one of 0 are asked for."""
    found = ""
    for asked in ("later", "sooner"):
        run = Run(
            stage,
            machine(
                Transition("a", "b", trigger="go", duration=1.0, priority=1, interrupt=rule),
                Transition("b", "c", trigger="later", duration=1.0, priority=2),
                Transition("b", "d", trigger="sooner", duration=1.0, priority=0),
            ),
        )
        run.set("go", True)
        run.tick(3)
        run.set(asked, True)
        run.tick()
        found += run.get("current")
    assert found == second


def test_an_interrupted_blend_fades_out_as_a_whole_without_a_jump(stage: Any) -> None:
    ways = (
        Transition("a", "b", trigger="go", duration=10 / 30, curve="linear"),
        Transition("b", "c", trigger="on", duration=10 / 30, curve="linear"),
        Transition("c", "b", trigger="back", duration=10 / 30, curve="linear"),
    )
    run = Run(stage, machine(*ways))
    run.set("go", True)
    run.tick(5)
    assert run.weights() == [0.6, 0.4, 0, 0]
    run.set("on", True)
    run.tick()
    assert run.weights() == [0.6, 0.4, 0, 0]
    run.tick(5)
    assert run.weights() == [0.3, 0.2, 0.5, 0]
    run.set("back", True)
    run.tick(6)
    assert run.weights() == [0.15, 0.6, 0.25, 0]


def test_priority_then_order_decides_between_transitions(stage: Any) -> None:
    ways = [
        Transition("a", "b", when="not off", priority=3),
        Transition("a", "c", when="x >= 0.5", priority=2),
        Transition("a", "d", when="x >= 0.5", priority=2),
    ]
    for x, expected in ((0.4, "b"), (0.5, "c")):
        run = Run(stage, machine(*ways, parameters={"x": x}))
        run.tick()
        assert run.get("current") == expected


def test_the_end_of_a_clip(stage: Any) -> None:
    # "move 1" lasts 0.9 s and stays at its end, which it shows at tick 27.
    tree = StateMachine(
        {"once": ClipNode("move 1"), "then": ClipNode("move 0")},
        [Transition("once", "then", at_end=True)],
    )
    run = Run(stage, tree)
    run.tick(28)
    assert run.get("current") == "once"
    run.tick()
    assert run.get("current") == "then"


def test_a_state_starts_anew_at_its_first_pose(stage: Any) -> None:
    run = Run(stage, machine(Transition("a", "b", trigger="go", duration=0.2)))
    run.tick(7)
    run.set("go", True)
    run.tick(2)
    nodes = run.pool._plan.tables.nodes
    assert nodes["time"][2] == 0.0
    run.tick()
    assert nodes["time"][2] == pytest.approx(1 / 30)


def test_phase_synchronisation(stage: Any) -> None:
    # "move 2" lasts 1.5 s, "move 4" 2 s: 0.5 s into the one is 2/3 s into the other.
    tree = StateMachine(
        {"a": ClipNode("move 2"), "b": Blend2(ClipNode("move 4"), ClipNode("move 0"), 0.5)},
        [Transition("a", "b", trigger="go", sync=True)],
    )
    run = Run(stage, tree)
    run.tick(16)
    run.set("go", True)
    run.tick()
    nodes = run.pool._plan.tables.nodes
    assert nodes["time"][3:5].tolist() == pytest.approx([2 / 3, 0.4 / 3])
    assert run.pool.phase([0]) == pytest.approx([1 / 3])


def test_a_machine_may_synchronise_in_its_first_tick(stage: Any) -> None:
    first = Blend2(ClipNode("move 0"), ClipNode("move 0", phase=0.5), 0.75)
    ways = [Transition("a", "b", trigger="go", sync=True)]
    run = Run(stage, StateMachine({"a": first, "b": ClipNode("move 2")}, ways))
    run.set("go", True)
    run.tick()
    assert run.pool.phase([0]) == pytest.approx([0.5])


def test_travel_takes_the_shortest_way_and_asks_no_conditions(stage: Any) -> None:
    ways = (
        Transition("a", "b", trigger="x", duration=2 / 30),
        Transition("b", "c", when="y", duration=2 / 30),
        Transition("c", "d", duration=2 / 30),
        Transition("b", "d", duration=2 / 30),
    )
    run = Run(stage, machine(*ways))
    run.pool.travel(run.stream, "", "d")
    passed = []
    for _ in range(8):
        run.tick()
        passed.append(run.get("current"))
    assert "".join(passed) == "bbdddddd"


def test_travel_without_a_way_jumps(stage: Any) -> None:
    run = Run(stage, machine(Transition("a", "b", duration=1.0)))
    run.tick(2)
    run.pool.travel(run.stream, "", "d")
    run.tick()
    assert (run.get("current"), run.weights()) == ("d", [0, 0, 0, 1])
    run.pool.travel(run.stream, "", "d")
    run.tick(3)
    assert (run.get("current"), run.get("position")) == ("d", pytest.approx(0.1))


def test_a_one_shot_fades_in_and_ends_with_its_clip(stage: Any) -> None:
    # "move 1" lasts 27 ticks.
    tree = OneShot(ClipNode("move 0"), ClipNode("move 1"), fadein=4 / 30, fadeout=5 / 30)
    run = Run(stage, tree)
    run.tick(3)
    assert run.weights() == [1, 0]
    run.set("request", "fire")
    shares = []
    for _ in range(32):
        run.tick()
        shares.append(run.weights()[1])
        assert run.get("active") == (shares[-1] > 0 or len(shares) == 1)
    assert run.get("request") == OneShotRequest.NONE
    # Fired at 0, first shown at 1 with its first pose, so its end would be shown at 28.
    expected = [min(n / 4, 1, max(28 - n, 0) / 5) for n in range(32)]
    assert shares == pytest.approx(expected, abs=1e-5)


def test_a_shot_that_fades_out_all_along_begins_in_full(stage: Any) -> None:
    run = Run(stage, OneShot(ClipNode("move 0"), ClipNode("move 1"), fadein=1e-6, fadeout=0.9))
    run.set("request", "fire")
    run.tick(2)
    assert run.weights() == [0, 1]
    run.tick(9)
    assert run.weights() == pytest.approx([1 / 3, 2 / 3], abs=1e-5)


def test_a_one_shot_can_be_ended_and_fired_again(stage: Any) -> None:
    tree = OneShot(ClipNode("move 0"), ClipNode("move 4"), fadein=4 / 30, fadeout=4 / 30)
    run = Run(stage, tree)
    run.set("request", OneShotRequest.FIRE)
    run.tick(3)
    assert run.weights()[1] == 0.5
    run.set("request", "fade_out")
    run.tick()
    assert run.weights()[1] == 0.75
    run.tick()
    assert run.weights()[1] == 0.5
    run.set("request", "fire")
    run.tick()
    assert run.weights()[1] == 0.25
    run.tick()
    assert run.weights()[1] == 0.5
    run.set("request", "abort")
    run.tick()
    assert (run.weights(), run.get("active")) == ([1, 0], False)


def test_a_seek_starts_machines_and_one_shots_anew_and_keeps_parameters(stage: Any) -> None:
    inner = machine(Transition("a", "b", trigger="go"), parameters={"x": 0.0})
    run = Run(stage, OneShot(inner, ClipNode("move 1")))
    run.set("base/x", 3.0)
    run.set("base/go", True)
    run.tick()
    run.set("request", "fire")
    run.tick()
    assert (run.get("base/current"), run.get("active")) == ("b", True)
    run.pool.seek(run.stream, 0.1)
    assert (run.get("base/current"), run.get("active"), run.get("base/x")) == ("a", False, 3.0)


@settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(data=st.data())
def test_random_machines_are_as_the_definitions_say(data: st.DataObject, stage: Any) -> None:
    pool = stage.pool(capacity=3)
    pairs = []
    for _ in range(data.draw(st.integers(1, 3))):
        nodes = {state: data.draw(states()) for state in STATES}
        inner = StateMachine(nodes, data.draw(transitions()), parameters={"x": 0.0}, name="m")
        outer: Controller = inner
        if data.draw(st.booleans()):
            outer = Blend2(inner, ClipNode("move 3"), 0.3)
        if data.draw(st.booleans()):
            pair = {"one": outer, "two": inner}
            ways = [Transition("one", "two", trigger="t", duration=0.1), Transition("two", "one")]
            outer = StateMachine(pair, ways, name="o")
        pairs.append((pool.add(outer), stage.reference(outer)))
    for tick in range(data.draw(st.integers(5, 25))):
        for stream, reference in pairs:
            _change(data, pool, stream, reference)
        pool.evaluate(tick)
        pool.commit(tick)
        for stream, reference in pairs:
            expected = stage.palettes(reference.tick(1 / 30))
            _compare_states(pool, stream, reference)
            assume(reference.closest > 1e-3)
            np.testing.assert_allclose(
                pool.store.ring[tick % pool.store.capacity, stream.row], expected, atol=1e-4
            )


def _change(data: st.DataObject, pool: StreamPool, stream: Stream, reference: Any) -> None:
    machines = [node for node in reference.root.below() if isinstance(node.kind, StateMachine)]
    what = data.draw(st.sampled_from(["nothing", "nothing", "set", "set", "travel"]))
    if what == "set":
        kinds = ("request", "/t", "/u", "/x", "/y")
        paths = sorted(path for path in reference.values if path.endswith(kinds))
        path = data.draw(st.sampled_from(paths))
        value = data.draw(st.integers(0, 3 if path.endswith("request") else 1))
        pool.set(stream, path, value)
        reference.values[path] = value
    elif what == "travel":
        node = data.draw(st.sampled_from(machines))
        state = data.draw(st.sampled_from(list(node.kind.states)))
        pool.travel(stream, node.path, state)
        node.goal = list(node.kind.states).index(state)


def _compare_states(pool: StreamPool, stream: Stream, reference: Any) -> None:
    for node in reference.root.below():
        if isinstance(node.kind, StateMachine):
            names = list(node.kind.states)
            assert pool.get(stream, f"{node.path}/current") == names[node.state]
            fading = None if node.source is None else names[node.source]
            assert pool.get(stream, f"{node.path}/fading_from") == fading
            assert pool.get(stream, f"{node.path}/position") == pytest.approx(node.time)
            for name in node.kind.triggers():
                path = f"{node.path}/{name}"
                assert pool.get(stream, path) == reference.values[path]
        elif isinstance(node.kind, OneShot):
            assert pool.get(stream, f"{node.path}/active") == node.on
