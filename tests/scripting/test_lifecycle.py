"""Entering, getting ready, leaving and ending, in the order that Godot documents."""

from __future__ import annotations

import gc
import weakref
from typing import Any

import pytest

from tifo import (
    FreedError,
    InputEventKey,
    Node,
    SceneTree,
    ScriptError,
    Signal,
    Timer,
    is_instance_valid,
)

STEP = 1 / 60
Errors = list[ScriptError]


class Logged(Node):
    """Writes down its callbacks."""

    log: Any = None

    def note(self, what: str) -> None:
        self.log.append(f"{self.name}.{what}")

    def _enter_tree(self) -> None:
        self.note("enter")

    def _ready(self) -> None:
        self.note("ready")

    def _process(self, delta: float) -> None:
        self.note("process")

    def _physics_process(self, delta: float) -> None:
        self.note("physics")

    def _exit_tree(self) -> None:
        self.note("exit")


def family(log: list[str]) -> Logged:
    """A with children B (with child C) and D."""
    a = Logged(name="A", log=log)
    b = a.add_child(Logged(name="B", log=log))
    b.add_child(Logged(name="C", log=log))
    a.add_child(Logged(name="D", log=log))
    return a


def test_order_of_callbacks(tree: SceneTree) -> None:
    log: list[str] = []
    a = family(log)
    assert log == []
    tree.root.add_child(a)
    assert log == [
        "A.enter",
        "B.enter",
        "C.enter",
        "D.enter",
        "C.ready",
        "B.ready",
        "D.ready",
        "A.ready",
    ]
    log.clear()
    tree.advance(STEP)
    assert log == [
        *(f"{name}.physics" for name in "ABCD"),
        *(f"{name}.process" for name in "ABCD"),
    ]
    log.clear()
    tree.root.remove_child(a)
    assert log == ["D.exit", "C.exit", "B.exit", "A.exit"]
    log.clear()
    tree.root.add_child(a)
    assert log == ["A.enter", "B.enter", "C.enter", "D.enter"]  # ready is once in a life


def test_request_ready(tree: SceneTree) -> None:
    log: list[str] = []
    a = family(log)
    tree.root.add_child(a)
    tree.root.remove_child(a)
    a.request_ready()
    log.clear()
    tree.root.add_child(a)
    assert log == ["A.enter", "B.enter", "C.enter", "D.enter", "A.ready"]


def test_signals_of_the_life(tree: SceneTree) -> None:
    heard: list[str] = []
    node = Node(name="N")
    for name in ("tree_entered", "ready", "tree_exiting", "tree_exited", "renamed"):
        getattr(node, name).connect(lambda name=name: heard.append(name))
    tree.node_added.connect(lambda node: heard.append(f"added {node.name}"))
    tree.node_removed.connect(lambda node: heard.append(f"removed {node.name}"))
    tree.root.add_child(node)
    node.name = "M"
    tree.root.remove_child(node)
    assert heard == [
        *("tree_entered", "added N", "ready", "renamed"),
        *("tree_exiting", "removed M", "tree_exited"),
    ]


def test_children_added_in_enter_and_ready_are_ready_at_once(tree: SceneTree) -> None:
    log: list[str] = []

    class Maker(Logged):
        def _enter_tree(self) -> None:
            super()._enter_tree()
            self.add_child(Logged(name="early", log=self.log))

        def _ready(self) -> None:
            super()._ready()
            late = self.add_child(Logged(name="late", log=self.log))
            assert late.is_node_ready()

    tree.root.add_child(Maker(name="M", log=log))
    assert log == ["M.enter", "early.enter", "early.ready", "M.ready", "late.enter", "late.ready"]


def test_a_child_may_add_a_sibling_in_ready(tree: SceneTree) -> None:
    log: list[str] = []

    class Adder(Logged):
        def _ready(self) -> None:
            super()._ready()
            assert self.parent is not None
            self.parent.add_child(Logged(name="S", log=self.log))

    a = Logged(name="A", log=log)
    a.add_child(Adder(name="X", log=log))
    tree.root.add_child(a)
    assert log == ["A.enter", "X.enter", "X.ready", "S.enter", "S.ready", "A.ready"]


def test_reparenting_in_ready(tree: SceneTree, errors: Errors) -> None:
    log: list[str] = []

    class Mover(Logged):
        def _ready(self) -> None:
            super()._ready()
            self.reparent(self.tree.root.get_node("Other"))

    tree.root.add_child(Node(name="Other"))
    a = Logged(name="A", log=log)
    mover = a.add_child(Mover(name="M", log=log))
    a.add_child(Logged(name="B", log=log))
    tree.root.add_child(a)
    assert log == [
        "A.enter",
        "M.enter",
        "B.enter",
        "M.ready",
        "M.exit",
        "M.enter",
        "B.ready",
        "A.ready",
    ]
    assert mover.path == "/root/Other/M"
    log.clear()
    tree.advance(STEP)
    assert log.count("M.process") == 1
    assert errors == []


def test_removing_oneself_in_enter(tree: SceneTree, errors: Errors) -> None:
    log: list[str] = []

    class Shy(Logged):
        def _enter_tree(self) -> None:
            super()._enter_tree()
            assert self.parent is not None
            self.parent.remove_child(self)

    a = Logged(name="A", log=log)
    shy = a.add_child(Shy(name="S", log=log))
    shy.add_child(Logged(name="below", log=log))
    tree.root.add_child(a)
    assert log == ["A.enter", "S.enter", "S.exit", "A.ready"]
    assert shy.parent is None
    assert not shy.is_inside_tree()
    assert errors == []


def test_freeing_during_iteration(tree: SceneTree, errors: Errors) -> None:
    log: list[str] = []

    class Killer(Logged):
        def _process(self, delta: float) -> None:
            super()._process(delta)
            victim = self.get_node_or_none("../V")
            if victim is not None:
                victim.free()
            self.queue_free()
            self.queue_free()

    tree.root.add_child(Killer(name="K", log=log))
    victim = tree.root.add_child(Logged(name="V", log=log))
    tree.root.add_child(Logged(name="W", log=log))
    log.clear()
    tree.advance(0.0)  # a frame without a tick
    assert log == ["K.process", "V.exit", "W.process", "K.exit"]
    assert not is_instance_valid(victim)
    log.clear()
    tree.advance(0.0)
    assert log == ["W.process"]
    assert errors == []


def test_queue_free_happens_at_the_end_of_the_tick(tree: SceneTree) -> None:
    log: list[str] = []

    class Brief(Logged):
        def _physics_process(self, delta: float) -> None:
            self.queue_free()
            log.append(str(self.is_queued_for_deletion()))

    tree.root.add_child(Brief(name="B", log=[]))
    tree.advance(3 * STEP)
    assert log == ["True"]


def test_nodes_added_in_process_begin_with_the_next_frame(tree: SceneTree) -> None:
    log: list[str] = []

    class Spawner(Logged):
        def _process(self, delta: float) -> None:
            self.tree.root.add_child(Logged(name="new", log=log))

    tree.root.add_child(Spawner(name="S", log=[]))
    tree.advance(0.0)
    assert log == ["new.enter", "new.ready"]
    tree.advance(0.0)
    assert log.count("new.process") == 1


def test_a_freed_node_cannot_be_used(tree: SceneTree) -> None:
    parent = tree.root.add_child(Node(name="P"))
    child = parent.add_child(Node(name="C"))
    parent.free()
    parent.free()  # twice is nothing
    assert not is_instance_valid(child)
    for wrong in (lambda: tree.root.add_child(child), lambda: child.add_child(Node())):
        with pytest.raises(FreedError, match="C"):
            wrong()
    with pytest.raises(ValueError, match="root"):
        tree.root.free()


def test_wrong_children_are_refused(tree: SceneTree) -> None:
    a, b = Node(name="A"), Node(name="B")
    a.add_child(b)
    for parent, child, cause in (
        (b, a, "part of itself"),
        (a, a, "part of itself"),
        (tree.root, b, "has a parent"),
        (a, "B", "expected a node"),
    ):
        with pytest.raises(ValueError, match=cause):
            parent.add_child(child)  # type: ignore[type-var]
    with pytest.raises(ValueError, match="no child"):
        b.remove_child(a)


def test_adding_what_is_leaving_is_refused_and_reported(tree: SceneTree, errors: Errors) -> None:
    class Clinger(Node):
        def _exit_tree(self) -> None:
            self.reparent(self.tree.root)

    a = tree.root.add_child(Node(name="A"))
    a.add_child(Clinger(name="C"))
    a.free()
    (error,) = errors
    assert "leaving the tree" in str(error)


class Boom(Node):
    """Fails in the callback that it is told."""

    where: str = ""
    boom = Signal[()]()

    def fail(self, where: str) -> None:
        if where == self.where:
            raise ZeroDivisionError(f"in {where}")

    def _enter_tree(self) -> None:
        self.fail("_enter_tree")

    def _ready(self) -> None:
        self.fail("_ready")

    def _process(self, delta: float) -> None:
        self.fail("_process")

    def _physics_process(self, delta: float) -> None:
        self.fail("_physics_process")

    def _input(self, event: object) -> None:
        self.fail("_input")

    def _unhandled_input(self, event: object) -> None:
        self.fail("_unhandled_input")

    def _exit_tree(self) -> None:
        self.fail("_exit_tree")


CALLBACKS = (
    *("_enter_tree", "_ready", "_process", "_physics_process"),
    *("_input", "_unhandled_input", "_exit_tree"),
)


@pytest.mark.parametrize("callback", CALLBACKS)
def test_an_exception_in_any_callback_is_reported_and_the_rest_runs(
    tree: SceneTree, errors: Errors, callback: str
) -> None:
    log: list[str] = []
    tree.root.add_child(Boom(name="B", where=callback))
    tree.root.add_child(Logged(name="L", log=log))
    tree.push_input(InputEventKey("A"))
    assert tree.advance(STEP)
    assert {"L.enter", "L.ready", "L.process", "L.physics"} <= set(log)
    tree.root.get_node("B").free()
    (error,) = errors
    assert (error.script, error.node) == (f"Boom.{callback}", "/root/B")
    assert error.file == __file__
    with open(__file__, encoding="utf-8") as file:
        assert "raise ZeroDivisionError" in file.read().splitlines()[error.line - 1]
    assert str(error) == (
        f"Boom.{callback} (/root/B), {__file__}:{error.line}: ZeroDivisionError: in {callback}"
    )


def test_wrong_parameters_of_a_callback_point_at_it(tree: SceneTree, errors: Errors) -> None:
    class Wrong(Node):
        def _process(self) -> None:  # type: ignore[override]
            pass

    tree.root.add_child(Wrong())
    tree.advance(0.0)
    (error,) = errors
    assert error.file == __file__
    assert error.line == Wrong._process.__code__.co_firstlineno


def test_system_exit_passes(tree: SceneTree) -> None:
    class Leaver(Node):
        def _process(self, delta: float) -> None:
            raise SystemExit(3)

    tree.root.add_child(Leaver())
    with pytest.raises(SystemExit):
        tree.advance(0.0)


def test_trees_may_be_very_deep(tree: SceneTree, errors: Errors) -> None:
    top = node = Logged(name="N", log=[])
    for _ in range(5000):
        child = Logged(name="N", log=[])
        child._parent, child._name = node, "N"  # add_child looks up the whole way each time
        node._children["N"] = child
        node = child
    tree.root.add_child(top)
    assert node.log == ["N.enter", "N.ready"]
    tree.advance(0.0)
    assert node.log[-1] == "N.process"
    top.free()
    assert node.log[-1] == "N.exit"
    assert errors == []


def test_nothing_is_kept_of_freed_nodes(tree: SceneTree) -> None:
    node = tree.root.add_child(Timer(name="T"))
    node.add_to_group("g")
    node.timeout.connect(tree.quit)
    tree.advance(STEP)
    gone = weakref.ref(node)
    node.queue_free()
    del node
    tree.advance(STEP)
    tree.advance(STEP)
    gc.collect()
    assert gone() is None


def test_names_of_node_are_protected() -> None:
    with pytest.raises(ValueError, match="'parent' is a name that Node uses"):

        class Wrong(Node):
            parent: int = 3  # type: ignore[assignment]

    with pytest.raises(ValueError, match="'ready'"):

        class AlsoWrong(Node):
            ready = Signal[int]()  # type: ignore[assignment]


def test_a_constructor_of_ones_own_needs_no_super(tree: SceneTree) -> None:
    class Own(Node):
        def __init__(self, size: int) -> None:
            self.size = size

    own = tree.root.add_child(Own(4))
    assert (own.size, own.name, own.is_inside_tree()) == (4, "Own", True)
