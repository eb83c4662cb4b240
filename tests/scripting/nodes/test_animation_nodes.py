"""AnimationTree and AnimationPlayer: Godot's names for a stream of the pool, and nothing beside."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tifo import (
    AnimationPlayer,
    AnimationTree,
    HotReload,
    OneShotRequest,
    SceneTree,
    ScriptError,
    Stadium,
    StateMachinePlayback,
    controllers,
    nodes,
)

Blend2, ClipNode = controllers.Blend2, controllers.ClipNode
STATES = controllers.StateMachine(
    {"sit": ClipNode("sit_idle"), "up": ClipNode("stand_idle"), "cheer": ClipNode("cheer")},
    [
        controllers.Transition("sit", "up", duration=0.2),
        controllers.Transition("up", "cheer", when="excited > 0.5", duration=0.2),
        controllers.Transition("cheer", "sit", trigger="calm", duration=0.2),
    ],
    name="mood",
)
SPACE = controllers.BlendSpace2D(
    [((0, 0), ClipNode("sit_idle")), ((1, 0), ClipNode("clap")), ((0, 1), ClipNode("wave"))],
    name="where",
)
ROOT = controllers.OneShot(
    Blend2(STATES, SPACE, name="mix"), ClipNode("jump"), fadein=0.1, fadeout=0.1
)


@pytest.fixture
def animation(crowd: nodes.Crowd) -> AnimationTree:
    return crowd.add_child(AnimationTree(name="Tree", tree_root=ROOT))


def test_parameters_have_godots_paths(tree: SceneTree, animation: AnimationTree) -> None:
    pool, stream = animation.pool, animation.stream
    animation["parameters/mix/blend_amount"] = 0.25
    assert pool.get(stream, "mix/amount") == 0.25
    pool.set(stream, "mix/amount", 0.75)
    assert animation["parameters/mix/blend_amount"] == animation["parameters/mix/amount"] == 0.75
    animation["parameters/mix/where/blend_position"] = (0.5, 0.25)
    assert pool.get(stream, "mix/where/position") == (0.5, 0.25)
    animation["parameters/mix/mood/conditions/excited"] = 1.0
    assert pool.get(stream, "mix/mood/excited") == 1.0
    assert set(animation.parameters) == {f"parameters/{p}" for p in pool.parameters(stream)}
    animation["parameters/request"] = OneShotRequest.FIRE
    tree.run(4 / 60)
    assert animation["parameters/active"] is animation["parameters/internal_active"] is True
    assert animation["parameters/request"] == OneShotRequest.NONE
    animation["parameters/request"] = OneShotRequest.ABORT
    tree.run(4 / 60)
    assert animation["parameters/active"] is False
    animation.fire()
    tree.run(4 / 60)
    assert animation["parameters/active"] is True
    assert animation["../Tree"] is animation, "other paths are nodes"


def test_paths_that_do_not_exist(animation: AnimationTree) -> None:
    with pytest.raises(KeyError, match=r"no parameter 'parameters/mix/blend_amont'; near: par"):
        animation["parameters/mix/blend_amont"] = 1.0
    with pytest.raises(KeyError, match="no parameter 'parameters/mox'"):
        _ = animation["parameters/mox"]
    with pytest.raises(KeyError, match="can only be read"):
        animation["parameters/active"] = True
    with pytest.raises(KeyError, match="they begin with 'parameters/'"):
        animation["mix/amount"] = 1.0
    with pytest.raises(ValueError, match="0 to 1"):
        animation["parameters/mix/blend_amount"] = 2.0
    with pytest.raises(ValueError, match="no state machine"):
        _ = animation["parameters/mix/playback"]


def test_travelling_and_its_signals(tree: SceneTree, animation: AnimationTree) -> None:
    told: list[tuple[str, str, str]] = []
    animation.state_started.connect(lambda path, state: told.append(("start", path, state)))
    animation.state_finished.connect(lambda path, state: told.append(("end", path, state)))
    playback = animation["parameters/mix/mood/playback"]
    assert isinstance(playback, StateMachinePlayback)
    tree.run(0.1)
    assert (playback.get_current_node(), playback.is_playing()) == ("sit", True)
    playback.travel("cheer")
    tree.run(2 / 60)
    assert (playback.get_current_node(), playback.get_fading_from_node()) == ("up", "sit")
    tree.run(0.3)
    assert (playback.get_current_node(), playback.get_fading_from_node()) == ("cheer", "up")
    tree.run(0.3)
    assert playback.get_fading_from_node() == ""
    assert 0.2 < playback.get_current_play_position() < 0.5
    at = "mix/mood"
    steps = [("start", "up"), ("end", "sit"), ("start", "cheer"), ("end", "up")]
    assert sorted(told) == sorted((what, at, state) for what, state in steps)
    playback.start("sit")
    assert playback.get_current_node() == "sit"
    assert playback.get_current_play_position() == 0.0
    tree.run(2 / 60)
    assert told[4:] == [("end", at, "cheer"), ("start", at, "sit")]
    with pytest.raises(ValueError, match="no state 'site'"):
        playback.travel("site")


def test_a_started_state_shows_its_first_pose(tree: SceneTree, animation: AnimationTree) -> None:
    pool, row = animation.pool, animation.stream.row
    playback = animation["parameters/mix/mood/playback"]
    tree.run(0.7)
    playback.travel("up")
    tree.run(3 / 60)
    playback.start("cheer")
    tree.run(2 / 60)
    fresh = pool.add(ClipNode("cheer"))
    pool.evaluate(tree.tick // 2 + 1)
    ring = pool.store.ring[pool.store.slice_of(tree.tick // 2 + 1)]
    shown = pool.store.ring[pool.store.slice_of(tree.tick // 2), row]
    np.testing.assert_allclose(shown, ring[fresh.row], atol=1e-4)


def test_exports_act_on_the_stream(
    tree: SceneTree, crowd: nodes.Crowd, animation: AnimationTree, tmp_path: Path
) -> None:
    pool, stream = animation.pool, animation.stream
    animation.active = False
    assert not pool.running[stream.row]
    animation.active = True
    animation.speed_scale = 0.5
    assert pool.running[stream.row]
    assert pool.speed[stream.row] == 0.5
    animation.show(crowd.where(row=0), duration=0.0)
    tree.run(4 / 60)
    assert crowd.data.anim is not None
    shown = crowd.data.anim.row[0, crowd.where(row=0)]
    family = pool.twins.family(stream.row)
    assert np.isin(shown, family).all()
    controllers.save_controller(Blend2(ClipNode("clap"), ClipNode("wave")), tmp_path / "a.toml")
    other = crowd.add_child(AnimationTree(controller=str(tmp_path / "a.toml")))
    assert other["parameters/blend_amount"] == 0.0
    alive = int(pool.alive.sum())
    other.free()
    assert int(pool.alive.sum()) == alive - 1, "its row is free again"
    with pytest.raises(ValueError, match="neither a tree_root nor a controller"):
        _ = crowd.add_child(AnimationTree()).stream


def test_streams_run_out_with_a_hint(crowd: nodes.Crowd) -> None:
    for _ in range(200):
        player = crowd.add_child(AnimationPlayer())
        if crowd.data.pool is not None and crowd.data.pool.alive.all():
            break
        player.play("wave")
    with pytest.raises(ValueError, match="no free stream; raise spare_streams of <Stadium"):
        player.play("wave")


def test_a_rebuilt_crowd_gets_a_new_stream(
    tree: SceneTree, stadium: Stadium, animation: AnimationTree
) -> None:
    before = animation.pool
    _ = animation.stream
    stadium.rows = 3
    assert animation.pool is not before
    assert animation["parameters/mix/blend_amount"] == 0.0


def test_a_player_plays_queues_and_ends(
    tree: SceneTree, crowd: nodes.Crowd, errors: list[ScriptError]
) -> None:
    player = crowd.add_child(AnimationPlayer(name="Player"))
    told: list[str] = []
    player.animation_started.connect(lambda name: told.append(f"start {name}"))
    player.animation_finished.connect(lambda name: told.append(f"end {name}"))
    player.animation_changed.connect(lambda old, new: told.append(f"{old} to {new}"))
    assert player.current_animation == ""
    assert not player.is_playing()
    assert player.has_animation("stand_up")
    player.play("stand_up")
    player.queue("wave")
    length = player.current_animation_length
    pool, row = player.pool, player.stream.row
    tree.run(0.5)
    assert player.current_animation_position == pool.time[row]
    assert 0.4 < player.current_animation_position < 0.55
    assert player.is_playing()
    tree.run(length - 0.5 + 0.1)
    assert player.current_animation == "wave"
    assert told == ["start stand_up", "end stand_up", "start wave", "stand_up to wave"]
    tree.run(20.0)
    assert player.is_playing(), "loops don't end"
    assert told[4:] == []

    player.seek(0.5)
    assert player.current_animation_position == 0.5
    player.pause()
    tree.run(0.2)
    assert player.current_animation_position == 0.5
    assert not player.is_playing()
    player.play()
    tree.run(0.2)
    assert player.current_animation_position > 0.5
    player.speed_scale = 2.0
    assert pool.speed[row] == 2.0
    player.stop()
    assert player.current_animation == ""
    assert player.assigned_animation == "wave"
    tree.run(0.1)
    assert player.current_animation_position == 0.0
    player.speed_scale = 1.0
    player.play_backwards("stand_up")
    assert player.current_animation_position == length
    tree.run(length + 0.2)
    assert told[-2:] == ["start stand_up", "end stand_up"]
    assert not errors


def test_wrong_calls_of_a_player(
    tree: SceneTree, crowd: nodes.Crowd, errors: list[ScriptError]
) -> None:
    player = AnimationPlayer(name="Player", autoplay="wafe")
    crowd.add_child(player)
    assert "there is no clip 'wafe'" in str(errors[0])
    with pytest.raises(ValueError, match="has played nothing yet; name a clip"):
        player.play()
    with pytest.raises(ValueError, match="has played nothing yet"):
        player.seek(1.0)
    player.stop()
    assert player.current_animation_length == 0.0


def test_autoplay(tree: SceneTree, crowd: nodes.Crowd) -> None:
    player = crowd.add_child(AnimationPlayer(autoplay="wave"))
    assert player.current_animation == "wave"
    assert player.is_playing()


def test_a_controller_file_that_changes_is_taken_over(
    tree: SceneTree, crowd: nodes.Crowd, tmp_path: Path, errors: list[ScriptError]
) -> None:
    file = tmp_path / "fan.toml"
    controllers.save_controller(Blend2(ClipNode("clap"), ClipNode("wave")), file)
    animation = crowd.add_child(AnimationTree(controller=str(file)))
    assert animation["parameters/blend_amount"] == 0.0
    reload = HotReload(tree)
    space = controllers.BlendSpace1D([(0, ClipNode("clap")), (1, ClipNode("wave"))], position=0.5)
    controllers.save_controller(space, file)
    assert len(reload.check()) == 1
    assert animation["parameters/blend_position"] == 0.5
    file.write_text("nonsense")
    assert reload.check() == []
    assert len(errors) == 1
    assert animation["parameters/blend_position"] == 0.5
