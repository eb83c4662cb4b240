"""Timers: nodes, and those of the tree."""

from __future__ import annotations

import pytest

from tifo import ProcessCallback, ProcessMode, SceneTree, ScriptError, Timer

STEP = 1 / 60


def rings(timer: Timer) -> list[int]:
    """Ticks at which a timer rings, as they come."""
    heard: list[int] = []
    timer.timeout.connect(lambda: heard.append(timer.tree.tick))
    return heard


@pytest.mark.parametrize("callback", [*ProcessCallback])
def test_a_timer_rings_in_time_without_drift(tree: SceneTree, callback: ProcessCallback) -> None:
    timer = Timer(wait_time=0.1, autostart=True, process_callback=callback)
    heard = rings(tree.root.add_child(timer))
    tree.run(1.0)
    assert heard == [6, 12, 18, 24, 30, 36, 42, 48, 54, 60]


def test_one_shot_start_and_stop(tree: SceneTree) -> None:
    timer = tree.root.add_child(Timer(wait_time=0.1, one_shot=True))
    heard = rings(timer)
    tree.run(0.2)
    assert heard == []
    timer.start(0.05)
    assert (timer.wait_time, timer.time_left) == (0.05, 0.05)
    tree.run(0.2)
    assert heard == [15]
    assert timer.is_stopped()
    timer.start()
    timer.stop()
    tree.run(0.2)
    assert heard == [15]
    with pytest.raises(ValueError, match="outside a tree"):
        Timer().start()
    with pytest.raises(ValueError, match=r"Timer.wait_time is 0, expected a number from 0.001"):
        Timer(wait_time=0)


def test_pauses(tree: SceneTree) -> None:
    timer = tree.root.add_child(Timer(wait_time=0.1, autostart=True))
    free = tree.root.add_child(
        Timer(wait_time=0.1, autostart=True, process_mode=ProcessMode.ALWAYS)
    )
    heard, always = rings(timer), rings(free)
    tree.paused = True
    tree.run(0.2)
    assert (heard, always) == ([], [6, 12])
    tree.paused = False
    timer.paused = True
    tree.run(0.1)
    assert heard == []
    timer.paused = False
    tree.run(0.1)
    assert heard == [24]


def test_time_scale(tree: SceneTree) -> None:
    tree.time_scale = 0.5
    slow = rings(tree.root.add_child(Timer(wait_time=0.1, autostart=True)))
    real = rings(tree.root.add_child(Timer(wait_time=0.1, autostart=True, ignore_time_scale=True)))
    tree.run(0.2)
    assert (slow, real) == ([12], [6, 12])


def test_a_time_shorter_than_a_frame_rings_once_a_frame(tree: SceneTree) -> None:
    heard = rings(tree.root.add_child(Timer(wait_time=0.001, autostart=True)))
    tree.run(3 * STEP)
    assert heard == [1, 2, 3]


def test_tree_timers(tree: SceneTree) -> None:
    heard: list[tuple[str, int]] = []

    def ring(name: str) -> None:
        heard.append((name, tree.tick))

    for name, settings in {
        "plain": {},
        "stops": {"process_always": False},
        "ticks": {"process_in_physics": True},
        "real": {"ignore_time_scale": True},
    }.items():
        tree.create_timer(0.1, **settings).timeout.connect(ring, binds=(name,))
    zero = tree.create_timer(0.0)
    zero.timeout.connect(ring, binds=("zero",))
    tree.time_scale = 0.5
    tree.run(0.1)
    tree.paused = True
    tree.run(0.2)
    tree.paused = False
    tree.run(0.2)
    assert heard == [("zero", 1), ("real", 6), ("ticks", 12), ("plain", 12), ("stops", 24)]
    assert zero.time_left == 0.0
    assert tree.timers == []
    with pytest.raises(ValueError, match="seconds is -1"):
        tree.create_timer(-1)


def test_a_script_can_sleep(tree: SceneTree, errors: list[ScriptError]) -> None:
    log: list[int] = []

    async def script() -> None:
        for _ in range(3):
            await tree.create_timer(0.5).timeout
            log.append(tree.tick)

    tree.start(script())
    tree.run(2.0)
    assert log == [30, 60, 90]
    assert errors == []
