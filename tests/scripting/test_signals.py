"""Connecting, emitting, and what may happen meanwhile; coroutines that await signals."""

from __future__ import annotations

from typing import Any

import pytest

from tifo import FreedError, Node, SceneTree, ScriptError, Signal

STEP = 1 / 60
Errors = list[ScriptError]


class Ball(Node):
    """Has signals of none, one and two arguments."""

    out = Signal[()]()
    bounced = Signal[float]()
    goal_scored = Signal[str, int]()


class Board(Node):
    """Writes down what it hears."""

    def _prepare(self) -> None:
        super()._prepare()
        self.heard: list[Any] = []

    def on_goal(self, team: str, score: int) -> None:
        self.heard.append((team, score))

    def on_more(self, *values: Any) -> None:
        self.heard.append(values)


@pytest.fixture
def ball(tree: SceneTree) -> Ball:
    return tree.root.add_child(Ball())


@pytest.fixture
def board(tree: SceneTree) -> Board:
    return tree.root.add_child(Board())


def test_declarations_know_their_types() -> None:
    assert Ball.goal_scored.types == (str, int)
    assert Ball.out.types == ()
    assert Ball.goal_scored.name == "goal_scored"


def test_emit_calls_in_the_order_of_connecting(ball: Ball) -> None:
    log: list[str] = []
    for name in "cab":
        ball.out.connect(lambda name=name: log.append(name))
    ball.out.emit()
    assert log == ["c", "a", "b"]
    assert Ball().out is not ball.out
    assert ball.out is ball.out


def test_binds_and_one_shot(ball: Ball, board: Board) -> None:
    ball.goal_scored.connect(board.on_more, binds=("x", 3), one_shot=True)
    ball.goal_scored.emit("home", 1)
    ball.goal_scored.emit("away", 2)
    assert board.heard == [("home", 1, "x", 3)]
    assert not ball.goal_scored.is_connected(board.on_more)


def test_a_one_shot_is_gone_before_its_call(ball: Ball) -> None:
    calls: list[int] = []

    def again() -> None:
        calls.append(1)
        if len(calls) < 3:
            ball.out.connect(again, one_shot=True)
            ball.out.emit()

    ball.out.connect(again, one_shot=True)
    ball.out.emit()
    assert len(calls) == 3


def test_deferred_connections(tree: SceneTree, ball: Ball, board: Board) -> None:
    ball.goal_scored.connect(board.on_goal, deferred=True)
    ball.goal_scored.emit("home", 1)
    assert board.heard == []
    tree.advance(0.0)
    assert board.heard == [("home", 1)]
    ball.goal_scored.emit("home", 2)
    board.free()
    tree.advance(0.0)
    assert board.heard == [("home", 1)]


def test_a_deferred_connection_without_a_tree_is_an_error(
    ball: Ball, errors: Errors, caplog: pytest.LogCaptureFixture
) -> None:
    lonely = Ball()
    lonely.out.connect(Board().on_more, deferred=True)
    lonely.out.emit()
    assert "needs a tree" in caplog.text


def test_connecting_during_emit_counts_from_the_next_one(ball: Ball) -> None:
    log: list[str] = []

    def first() -> None:
        log.append("first")
        if not ball.out.is_connected(second):
            ball.out.connect(second)

    def second() -> None:
        log.append("second")

    ball.out.connect(first)
    ball.out.emit()
    assert log == ["first"]
    ball.out.emit()
    assert log == ["first", "first", "second"]


def test_disconnecting_during_emit_counts_at_once(ball: Ball) -> None:
    log: list[str] = []

    def first() -> None:
        log.append("first")
        ball.out.disconnect(second)
        ball.out.disconnect(first)

    def second() -> None:
        log.append("second")

    ball.out.connect(first)
    ball.out.connect(second)
    ball.out.emit()
    ball.out.emit()
    assert log == ["first"]


def test_a_receiver_freed_during_emit_is_not_called(ball: Ball, board: Board) -> None:
    ball.goal_scored.connect(lambda team, score: board.free())
    ball.goal_scored.connect(board.on_goal)
    ball.goal_scored.emit("home", 1)
    assert board.heard == []
    assert len(ball.goal_scored.connections) == 1


def test_a_sender_freed_during_emit_stops(ball: Ball, board: Board) -> None:
    ball.goal_scored.connect(lambda team, score: ball.free())
    ball.goal_scored.connect(board.on_goal)
    ball.goal_scored.emit("home", 1)
    assert board.heard == []
    with pytest.raises(FreedError, match="freed"):
        ball.goal_scored.connect(board.on_goal)
    ball.goal_scored.emit("home", 1)


def test_an_exception_in_a_handler_is_reported_and_the_next_is_called(
    ball: Ball, board: Board, errors: Errors
) -> None:
    def bad(team: str, score: int) -> None:
        raise RuntimeError("no board")

    ball.goal_scored.connect(bad)
    ball.goal_scored.connect(board.on_goal)
    ball.goal_scored.emit("home", 1)
    assert board.heard == [("home", 1)]
    (error,) = errors
    assert error.cause == "signal 'goal_scored' of /root/Ball"
    assert error.line == bad.__code__.co_firstlineno + 1
    assert str(error) == (
        f"bad (/root/Ball) on signal 'goal_scored' of /root/Ball, "
        f"{__file__}:{error.line}: RuntimeError: no board"
    )


def test_a_circle_of_signals_ends_and_is_told_once(ball: Ball, errors: Errors) -> None:
    calls = [0]

    def again() -> None:
        calls[0] += 1
        ball.out.emit()

    def too() -> None:
        ball.out.emit()

    ball.out.connect(again)
    ball.out.connect(too)
    ball.out.emit()
    assert {type(error.error) for error in errors} == {RecursionError}
    assert len(errors) == 2  # one for each handler of the outermost emission
    assert calls[0] < 5000


def test_wrong_use_is_refused(ball: Ball, board: Board) -> None:
    ball.goal_scored.connect(board.on_goal)
    with pytest.raises(ValueError, match="connected to signal 'goal_scored' of /root/Ball already"):
        ball.goal_scored.connect(board.on_goal)
    with pytest.raises(ValueError, match="is not connected"):
        ball.out.disconnect(board.on_goal)
    with pytest.raises(ValueError, match=r"can't take the 1 arguments"):
        ball.bounced.connect(board.on_goal)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="and 3 bound ones"):
        ball.out.connect(board.on_goal, binds=(1, 2, 3))
    with pytest.raises(ValueError, match="callable"):
        ball.out.connect(3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="takes 2 arguments, got 1"):
        ball.goal_scored.emit("home")  # type: ignore[call-arg]


def test_unhashable_and_builtin_slots(ball: Ball) -> None:
    class Odd:
        __hash__ = None  # type: ignore[assignment]

        def __call__(self, height: float) -> None:
            heights.append(-height)

    heights: list[float] = []
    odd = Odd()
    ball.bounced.connect(odd)
    ball.bounced.connect(heights.append)
    ball.bounced.emit(2.0)
    ball.bounced.disconnect(odd)
    ball.bounced.emit(3.0)
    assert heights == [-2.0, 2.0, 3.0]


# Coroutines


class Waiting(Node):
    """Waits for a ball in `_ready`."""

    ball: Any = None

    def _prepare(self) -> None:
        super()._prepare()
        self.log: list[Any] = []

    async def _ready(self) -> None:
        self.log.append("begin")
        try:
            self.log.append(await self.ball.goal_scored)
            self.log.append(await self.ball.bounced)
            self.log.append(await self.ball.out)
        finally:
            self.log.append("end")


def test_awaiting_gives_the_arguments(tree: SceneTree, ball: Ball) -> None:
    node = tree.root.add_child(Waiting(ball=ball))
    assert node.log == ["begin"]
    ball.out.emit()
    ball.goal_scored.emit("home", 3)
    ball.bounced.emit(0.5)
    ball.out.emit()
    assert node.log == ["begin", ("home", 3), 0.5, None, "end"]
    assert tree._tasks == {}
    assert node._tasks == {}


def test_coroutines_of_a_freed_node_are_closed(tree: SceneTree, ball: Ball, errors: Errors) -> None:
    node = tree.root.add_child(Waiting(ball=ball))
    node.free()
    assert node.log == ["begin", "end"]
    assert ball.goal_scored.connections == ()
    ball.goal_scored.emit("home", 3)
    assert node.log == ["begin", "end"]
    assert errors == []


def test_awaiting_a_signal_of_a_freed_node(tree: SceneTree, ball: Ball, errors: Errors) -> None:
    node = tree.root.add_child(Waiting(ball=ball))
    ball.free()
    assert node.log == ["begin"]  # it is told at the next flush
    tree.advance(0.0)
    assert node.log == ["begin", "end"]
    (error,) = errors
    assert isinstance(error.error, FreedError)
    assert error.script == "Waiting._ready"
    late = tree.root.add_child(Waiting(ball=ball))
    tree.advance(0.0)
    assert late.log == ["begin", "end"]
    assert len(errors) == 2


def test_a_script_may_handle_the_loss(tree: SceneTree, ball: Ball, errors: Errors) -> None:
    log: list[str] = []

    async def watch() -> str:
        for _ in range(3):
            try:
                await ball.out
            except FreedError:
                log.append("gone")
        return "done"

    task = tree.root.create_task(watch())
    ball.free()
    tree.advance(0.0)
    assert log == ["gone"] * 3
    assert (task.is_done, task.result) == (True, "done")
    assert errors == []


def test_async_handlers_and_errors_in_them(tree: SceneTree, ball: Ball, errors: Errors) -> None:
    class Keeper(Node):
        async def on_goal(self, team: str, score: int) -> None:
            await self.tree.create_timer(2 * STEP, process_in_physics=True).timeout
            raise RuntimeError(f"late {team}")

    keeper = tree.root.add_child(Keeper())
    ball.goal_scored.connect(keeper.on_goal)
    ball.goal_scored.emit("home", 1)
    tree.run(STEP)
    assert errors == []
    tree.run(STEP)
    (error,) = errors
    assert error.script == "Keeper.on_goal"
    assert error.cause == "signal 'goal_scored' of /root/Ball"
    assert "late home" in str(error)


def test_tasks_await_tasks(tree: SceneTree, ball: Ball, errors: Errors) -> None:
    async def inner(fails: bool) -> int:
        height = await ball.bounced
        if fails:
            raise ValueError("too high")
        return int(height * 2)

    async def outer(fails: bool) -> str:
        task = tree.root.create_task(inner(fails))
        try:
            return f"got {await task} {await task}"
        except ValueError as error:
            return f"caught {error}"

    good, bad = tree.start(outer(False)), tree.start(outer(True))
    assert not good.is_done
    ball.bounced.emit(4.0)
    assert (good.result, bad.result) == ("got 8 8", "caught too high")
    assert errors == []


def test_cancelling(tree: SceneTree, ball: Ball, errors: Errors) -> None:
    log: list[str] = []

    async def wait() -> None:
        try:
            await ball.out
        finally:
            log.append("closed")

    task = tree.start(wait())
    task.cancel()
    task.cancel()
    ball.out.emit()
    assert log == ["closed"]
    assert ball.out.connections == ()
    assert errors == []


def test_a_node_that_frees_itself_in_its_coroutine(
    tree: SceneTree, ball: Ball, errors: Errors
) -> None:
    log: list[str] = []

    class Suicidal(Node):
        async def _ready(self) -> None:
            await ball.out
            self.free()
            log.append("still here")
            await ball.out
            log.append("never")

    tree.root.add_child(Suicidal())
    ball.out.emit()
    ball.out.emit()
    assert log == ["still here"]
    assert errors == []
    assert tree._tasks == {}


def test_foreign_awaitables_are_named(tree: SceneTree, errors: Errors) -> None:
    import asyncio

    async def wrong() -> None:
        await asyncio.sleep(0)

    tree.start(wrong())
    assert "scripts can await signals and tasks" in str(errors[0])
    with pytest.raises(ValueError, match="expected a call of an async def"):
        tree.start(wrong)  # type: ignore[arg-type]


def test_closing_a_tree_closes_its_coroutines(ball: Ball) -> None:
    tree = SceneTree()
    log: list[str] = []

    async def wait() -> None:
        try:
            await ball.out
        finally:
            log.append("closed")

    tree.start(wait())
    tree.close()
    assert log == ["closed"]
