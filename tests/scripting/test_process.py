"""Ticks and frames, pauses and priorities, deferred calls, groups, scenes, autoloads."""

from __future__ import annotations

import pytest

from tifo import GroupCall, Node, ProcessMode, SceneTree, ScriptError, export

STEP = 1 / 60
Errors = list[ScriptError]


class Counter(Node):
    """Counts its calls and adds up the time."""

    def _prepare(self) -> None:
        super()._prepare()
        self.frames = self.ticks = 0
        self.time = self.tick_time = 0.0

    def _process(self, delta: float) -> None:
        self.frames += 1
        self.time += delta

    def _physics_process(self, delta: float) -> None:
        self.ticks += 1
        self.tick_time += delta


@pytest.fixture
def counter(tree: SceneTree) -> Counter:
    return tree.root.add_child(Counter())


def test_ticks_are_fixed(tree: SceneTree, counter: Counter) -> None:
    for _ in range(30):
        tree.advance(0.01)  # 0.3 s are 18 ticks
    assert (counter.frames, counter.ticks, tree.tick) == (30, 18, 18)
    assert counter.time == pytest.approx(0.3)
    assert counter.tick_time == pytest.approx(0.3)


def test_at_most_four_ticks_are_made_up_for(tree: SceneTree, counter: Counter) -> None:
    tree.advance(10.0)
    assert (counter.frames, counter.ticks) == (1, 4)
    assert counter.time == pytest.approx(4 / 60)
    tree.advance(STEP)
    assert counter.ticks == 5


@pytest.mark.parametrize("delta", [-0.1, float("nan"), float("inf")])
def test_wrong_deltas_are_refused(tree: SceneTree, delta: float) -> None:
    with pytest.raises(ValueError, match="delta"):
        tree.advance(delta)


def test_the_time_scale_changes_deltas_and_not_ticks(tree: SceneTree, counter: Counter) -> None:
    tree.time_scale = 0.25
    tree.run(1.0)
    assert (counter.ticks, counter.frames) == (60, 60)
    assert counter.time == pytest.approx(0.25)
    assert counter.tick_time == pytest.approx(0.25)
    with pytest.raises(ValueError, match="time_scale"):
        tree.time_scale = -1.0


def test_priority_goes_before_tree_order(tree: SceneTree) -> None:
    order: list[str] = []

    class P(Node):
        def _process(self, delta: float) -> None:
            order.append(self.name)

    for name, priority in (("a", 1), ("b", 0), ("c", -2), ("d", 0)):
        tree.root.add_child(P(name=name, process_priority=priority))
    tree.advance(0.0)
    assert order == ["c", "b", "d", "a"]
    order.clear()
    tree.root["a"].process_priority = -5
    tree.root.move_child(tree.root["d"], 0)
    tree.advance(0.0)
    assert order == ["a", "c", "d", "b"]


def test_set_process(tree: SceneTree, counter: Counter) -> None:
    counter.set_process(False)
    tree.advance(STEP)
    counter.set_physics_process(False)
    counter.set_process(True)
    tree.advance(STEP)
    assert (counter.frames, counter.ticks) == (1, 1)


@pytest.mark.parametrize(
    ("mode", "running", "paused"),
    [
        (ProcessMode.INHERIT, True, False),
        (ProcessMode.PAUSABLE, True, False),
        (ProcessMode.WHEN_PAUSED, False, True),
        (ProcessMode.ALWAYS, True, True),
        (ProcessMode.DISABLED, False, False),
    ],
)
def test_process_modes(
    tree: SceneTree, counter: Counter, mode: ProcessMode, running: bool, paused: bool
) -> None:
    counter.process_mode = mode
    tree.advance(STEP)
    assert counter.frames == counter.ticks == int(running)
    tree.paused = True
    tree.advance(STEP)
    assert counter.frames == counter.ticks == int(running) + int(paused)
    assert counter.can_process() is paused
    tree.paused = False
    tree.advance(STEP)
    assert counter.frames == 2 * int(running) + int(paused)


def test_modes_are_inherited_by_who_asks(tree: SceneTree) -> None:
    menu = tree.root.add_child(Node(process_mode=ProcessMode.ALWAYS))
    inside = menu.add_child(Counter())
    off = menu.add_child(Counter(process_mode=ProcessMode.DISABLED))
    below = off.add_child(Counter())
    tree.paused = True
    tree.advance(STEP)
    assert [one.frames for one in (inside, off, below)] == [1, 0, 0]
    menu.process_mode = ProcessMode.PAUSABLE
    tree.advance(STEP)
    assert inside.frames == 1


def test_a_pause_counts_at_once(tree: SceneTree) -> None:
    class Pauser(Node):
        def _process(self, delta: float) -> None:
            self.tree.paused = True

    tree.root.add_child(Pauser())
    after = tree.root.add_child(Counter())
    tree.advance(0.0)
    assert after.frames == 0


def test_deferred_calls_come_after_the_round(tree: SceneTree, errors: Errors) -> None:
    log: list[str] = []

    class D(Node):
        def _process(self, delta: float) -> None:
            log.append(f"{self.name} process")
            self.call_deferred("later", 1)
            self.set_deferred("mark", self.name)

        def later(self, number: int) -> None:
            log.append(f"{self.name} later {number}")
            if number < 3:
                self.call_deferred(self.later, number + 1)

    a, b = tree.root.add_child(D(name="a")), tree.root.add_child(D(name="b"))
    tree.advance(0.0)
    assert log == [
        *("a process", "b process", "a later 1", "b later 1"),
        *("a later 2", "b later 2", "a later 3", "b later 3"),
    ]
    assert a.mark == "a"  # type: ignore[attr-defined]
    log.clear()
    b.call_deferred("later", 9)
    b.free()
    tree.advance(0.0)
    assert log == ["a process", "a later 1", "a later 2", "a later 3"]
    assert errors == []


def test_a_call_that_defers_itself_for_ever_lets_the_frame_end(tree: SceneTree) -> None:
    calls = [0]

    class Endless(Node):
        def again(self) -> None:
            calls[0] += 1
            self.call_deferred("again")

    node = tree.root.add_child(Endless())
    node.again()
    tree.advance(0.0)
    assert 1 < calls[0] < 1000


def test_an_error_in_a_deferred_call_is_reported(tree: SceneTree, errors: Errors) -> None:
    class D(Node):
        def later(self) -> None:
            raise KeyError("x")

    tree.root.add_child(D()).call_deferred("later")
    tree.advance(0.0)
    assert str(errors[0]).startswith("D.later (/root/D) on a deferred call")
    with pytest.raises(ValueError, match="not inside a tree"):
        Node().call_deferred("free")


def test_tree_signals_come_before_the_callbacks(tree: SceneTree) -> None:
    log: list[str] = []
    tree.process_frame.connect(lambda: log.append("frame"))
    tree.physics_frame.connect(lambda: log.append("tick"))

    class P(Node):
        def _process(self, delta: float) -> None:
            log.append("process")

        def _physics_process(self, delta: float) -> None:
            log.append("physics")

    tree.root.add_child(P())
    tree.advance(2 * STEP)
    assert log == ["tick", "physics", "tick", "physics", "frame", "process"]


class Fan(Node):
    """Cheers."""

    cheers: int = 0
    mood: float = export(default=0.0, range=(0, 1))

    def cheer(self, by: int = 1) -> None:
        self.cheers += by
        CHEERS.append(self.name)


CHEERS: list[str] = []


@pytest.fixture
def fans(tree: SceneTree) -> list[Fan]:
    CHEERS.clear()
    made = [Fan(name=name) for name in "xyz"]
    made[1].add_to_group("fans")
    for fan in made:
        tree.root.add_child(fan)
    made[2].add_to_group("fans")
    made[0].add_to_group("fans")
    return made


def test_groups_are_called_in_tree_order(tree: SceneTree, fans: list[Fan], errors: Errors) -> None:
    tree.root.add_child(Node(name="mute")).add_to_group("fans")
    tree.call_group("fans", "cheer", 2)
    tree.call_group("fans", Fan.cheer)
    assert CHEERS == ["x", "y", "z"] * 2
    assert [fan.cheers for fan in fans] == [3, 3, 3]
    assert tree.get_nodes_in_group("fans")[:3] == fans
    assert tree.get_first_node_in_group("fans") is fans[0]
    assert tree.get_first_node_in_group("nobody") is None
    tree.call_group("nobody", "cheer")
    fans[0].remove_from_group("fans")
    fans[1].free()
    assert [node.name for node in tree.get_nodes_in_group("fans")] == ["z", "mute"]
    assert fans[2].groups == ("fans",)
    assert errors == []


def test_group_flags(tree: SceneTree, fans: list[Fan]) -> None:
    tree.call_group_flags(GroupCall.REVERSE, "fans", "cheer")
    assert CHEERS == ["z", "y", "x"]
    CHEERS.clear()
    for _ in range(3):
        tree.call_group_flags(GroupCall.DEFERRED | GroupCall.UNIQUE, "fans", "cheer")
    assert CHEERS == []
    tree.advance(0.0)
    assert CHEERS == ["x", "y", "z"]


def test_set_group_reports_what_is_out_of_range(
    tree: SceneTree, fans: list[Fan], errors: Errors
) -> None:
    tree.set_group("fans", "mood", 0.5)
    assert [fan.mood for fan in fans] == [0.5] * 3
    tree.set_group("fans", "mood", 2.0)
    assert [fan.mood for fan in fans] == [0.5] * 3
    assert len(errors) == 3


def test_members_freed_by_the_call_are_passed_over(
    tree: SceneTree, fans: list[Fan], errors: Errors
) -> None:
    class Killer(Fan):
        def cheer(self, by: int = 1) -> None:
            self.tree.root["z"].free()
            raise ValueError("no")

    killer = tree.root.add_child(Killer())
    killer.add_to_group("fans")
    tree.root.move_child(killer, 0)
    tree.call_group("fans", Fan.cheer)
    assert CHEERS == ["x", "y"]
    assert "on group 'fans'" in str(errors[0])


def test_changing_scenes_at_the_end_of_the_frame(tree: SceneTree) -> None:
    first, second = Counter(name="One"), Counter(name="Two")
    tree.change_scene(first)
    assert tree.current_scene is None
    tree.advance(STEP)
    assert tree.current_scene is first
    assert first.path == "/root/One"
    heard: list[str] = []
    tree.scene_changed.connect(lambda: heard.append(tree.current_scene.name))  # type: ignore[union-attr]
    tree.change_scene(Counter(name="Never"))
    tree.change_scene(second)
    assert first.is_inside_tree()
    tree.advance(STEP)
    assert heard == ["Two"]
    assert first._freed
    assert tree.root.children == (second,)
    for wrong in (second, 3, Node().add_child(Node())):
        with pytest.raises(ValueError, match="scene is"):
            tree.change_scene(wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="not made from a scene file"):
        tree.reload_current_scene()


def test_a_tree_begins_with_its_scene() -> None:
    scene = Counter(name="Main")
    tree = SceneTree(scene)
    assert tree.current_scene is scene
    assert scene.is_node_ready()
    tree.close()


def test_autoloads(tree: SceneTree) -> None:
    scene = Node(name="Main")
    tree.change_scene(scene)
    tree.advance(0.0)
    scores = tree.autoload("scores", Counter())
    assert tree.autoloads.scores is scores
    assert scores.parent is tree.root
    assert scores.name == "scores"
    assert [node.name for node in tree.root.children] == ["scores", "Main"]
    with pytest.raises(ValueError, match="taken"):
        tree.autoload("scores", Node())
    with pytest.raises(AttributeError, match="known: scores"):
        _ = tree.autoloads.score
    tree.change_scene(Node(name="Next"))
    tree.advance(0.0)
    assert [node.name for node in tree.root.children] == ["scores", "Next"]


def test_quit_ends_after_the_frame(tree: SceneTree) -> None:
    class Quitter(Counter):
        def _physics_process(self, delta: float) -> None:
            super()._physics_process(delta)
            self.tree.quit(7)

    quitter = tree.root.add_child(Quitter())
    assert tree.advance(STEP) is False
    assert (quitter.frames, tree.exit_code, tree.run(1.0)) == (1, 7, False)


def test_advance_within_advance_is_refused(tree: SceneTree, errors: Errors) -> None:
    class Meddler(Node):
        def _process(self, delta: float) -> None:
            self.tree.advance(1.0)

    tree.root.add_child(Meddler())
    tree.advance(0.0)
    assert "advance was called by a script" in str(errors[0])
    tree.close()
    with pytest.raises(ValueError, match="closed"):
        tree.advance(0.0)
