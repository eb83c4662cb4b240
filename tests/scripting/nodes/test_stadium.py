"""The stadium's node: building, ticks, pauses, rebuilding, files."""

from __future__ import annotations

from dataclasses import fields
from importlib.resources import files
from pathlib import Path

import esper
import pytest

import tifo
from tifo import (
    CrowdSpec,
    HotReload,
    SceneTree,
    ScriptError,
    Simulation,
    Stadium,
    load_scene,
    nodes,
)
from tifo.engine.behaviour.compiled import CompiledTable
from tifo.scripting import resources


def test_a_tick_of_the_tree_is_a_tick_of_the_simulation(tree: SceneTree, stadium: Stadium) -> None:
    simulation = stadium.simulation
    before = esper.current_world
    tree.run(0.5)
    assert simulation.clock.tick == 30
    tree.advance(0.0)
    assert simulation.clock.tick == 30
    tree.advance(3.5 / 60)
    assert simulation.clock.tick == 33
    # Pictures between two ticks: the tree knows half a tick more than the simulation.
    assert simulation.clock.alpha == pytest.approx((33 % 2 + 0.5) / 2)
    assert esper.current_world == before


def test_it_is_the_same_as_a_simulation_without_nodes(tree: SceneTree, stadium: Stadium) -> None:
    alone = Simulation(stadium.spec)
    for simulation in (stadium.simulation, alone):
        simulation.send(tifo.Goal(side=0))
    tree.run(1.0)
    alone.run(seconds=1.0)
    assert stadium.crowd.state_hash() == alone.crowd.state_hash()
    alone.close()


def test_pauses_and_slow_motion(tree: SceneTree, stadium: Stadium) -> None:
    clock = stadium.simulation.clock
    tree.paused = True
    tree.run(0.2)
    assert clock.tick == 0
    tree.paused, tree.time_scale = False, 0.25
    tree.run(1.0)
    assert clock.tick == 15
    tree.time_scale = 2.0
    tree.run(1.0)
    assert clock.tick == 15 + 120


def test_its_exports_are_those_of_a_spec() -> None:
    names = {"children": "child_share", "old": "old_share"}
    made = Stadium(seats=1234, occupancy=0.5, empty=("rows 0-1",), child_share=0.2, seed=9)
    spec = made.spec
    assert (spec.seats, spec.occupancy, spec.empty, spec.children) == (
        1234,
        0.5,
        ("rows 0-1",),
        0.2,
    )
    exports = tifo.exports_of(Stadium)
    assert {field.name for field in fields(CrowdSpec)} - set(names) < set(exports)
    contradict = {"neutrals", "away_share", "child_share", "old_share"}
    for name, export in exports.items():
        if export.group != "Crowd" or export.range is None:
            continue
        field = {"child_share": "children", "old_share": "old"}.get(name, name)
        for edge, off in zip(export.range, (-1, 1), strict=True):
            if name not in contradict:
                CrowdSpec(**{field: edge})
            with pytest.raises(ValueError, match=field):
                CrowdSpec(**{field: edge + off})


def test_exports_that_contradict_each_other_are_reported_once(
    tree: SceneTree, errors: list[ScriptError]
) -> None:
    tree.root.add_child(Stadium(child_share=0.7, old_share=0.7))
    tree.run(0.1)
    assert len(errors) >= 1
    assert "children + old must be at most 1" in str(errors[0])
    count = len(errors)
    tree.run(0.5)
    assert len(errors) == count, "it isn't tried again and again"


def test_changing_an_export_builds_it_anew(tree: SceneTree, stadium: Stadium) -> None:
    told: list[int] = []
    stadium.rebuilt.connect(lambda: told.append(stadium.rows))
    tree.run(0.1)
    world = stadium.simulation.world
    stadium.rows = 4
    assert told == [4]
    assert world not in esper.list_worlds()
    tree.run(0.1)
    assert len(stadium.crowd) == 60
    assert stadium.simulation.clock.tick == 6
    stadium.position = tifo.Vector3(5, 0, 0)
    assert told == [4], "where it is doesn't change what it is"


def test_freeing_it_deletes_its_world(tree: SceneTree, stadium: Stadium) -> None:
    world = stadium.simulation.world
    assert world in esper.list_worlds()
    tree.root.remove_child(stadium)
    assert world in esper.list_worlds()
    stadium.free()
    assert world not in esper.list_worlds()
    with pytest.raises(ValueError, match="has no simulation any more"):
        _ = stadium.simulation


def test_a_table_that_changes_is_taken_over_and_a_broken_one_is_not(
    tree: SceneTree, tmp_path: Path, errors: list[ScriptError]
) -> None:
    shipped = files("tifo.engine.behaviour") / "tables" / "sport.toml"
    file = tmp_path / "own.toml"
    text = shipped.read_text("utf-8")
    file.write_text(text)
    made = tree.root.add_child(Stadium(behaviour=str(file), layout="stand", rows=3, columns=8))
    reload = HotReload(tree)
    tree.run(0.5)
    made.send(tifo.Goal(side=0))
    tree.run(0.5)
    before = made.simulation
    reacting, old = before.crowd.behaviour.reacting.sum(), before.crowd.table
    assert reacting > 5

    file.write_text(text.replace("pieces = [12, 75]", "pieces = [2, 5]"))
    assert len(reload.check()) == 1
    assert made.simulation is before, "who cheers goes on"
    assert before.crowd.behaviour.reacting.sum() == reacting
    sit = old.number("sit")
    assert (*old.pieces[sit], *before.crowd.table.pieces[sit]) == (12, 75, 2, 5)
    with before.active():
        assert esper.component_for_entity(before.crowd.entity, CompiledTable) is before.crowd.table
    tree.run(0.2)

    file.write_text(text + "nonsense")
    kept = before.crowd.table
    assert reload.check() == []
    assert "own.toml" in str(errors.pop())
    tree.run(0.2)
    assert made.simulation is before
    assert before.crowd.table is kept
    assert made.can_process()

    other = files("tifo.engine.behaviour") / "tables" / "speech.toml"
    file.write_text(other.read_text("utf-8"))
    assert len(reload.check()) == 1
    assert made.simulation is not before, "other states: built anew"
    tree.run(0.2)
    assert not errors


SCENE = """
[[node]]
name = "Match"
type = "Node3D"

[[node]]
name = "Stadium"
parent = "."
type = "Stadium"
[node.exports]
layout = "stand"
rows = 4
columns = 9
streams = 16
history = 14

[[node]]
name = "Crowd"
parent = "Stadium"
type = "Crowd"
[node.exports]
watches = "../Ball"

[[node]]
name = "Ball"
parent = "Stadium"
type = "tifo.Ball"

[[node]]
name = "Camera"
parent = "."
type = "Camera"
[node.exports]
preset = "close"

[[connection]]
signal = "goal"
from = "Stadium/Crowd"
to = "Stadium"
method = "queue_free"
"""


def test_scene_files_know_the_nodes(tmp_path: Path, tree: SceneTree) -> None:
    before = resources._store.root
    tifo.set_resource_root(tmp_path)
    try:
        (tmp_path / "match.toml").write_text(SCENE.partition("[[connection]]")[0])
        tree.change_scene("res://match.toml")
        tree.run(0.2)
        scene = tree.current_scene
        assert scene is not None
        crowd = scene.get_node("Stadium/Crowd", nodes.Crowd)
        assert crowd.watches is scene["Stadium/Ball"]
        assert crowd.data.overrides.overrides[0].name == "watches"
        assert crowd.count == 36
        (tmp_path / "wrong.toml").write_text(SCENE)
        with pytest.raises(tifo.AssetError, match="can't take 1 arguments"):
            load_scene("res://wrong.toml")
        line = SCENE.split("\n").index("rows = 4") + 1
        (tmp_path / "wide.toml").write_text(SCENE.replace("rows = 4", "rows = 40000"))
        with pytest.raises(tifo.AssetError, match=rf"line {line}: Stadium.rows is 40000, exp"):
            load_scene("res://wide.toml")
    finally:
        resources._store.root = before
        resources._store.loaded.clear()


def test_a_games_own_class_goes_before_one_of_tifo(tmp_path: Path) -> None:
    class Player(tifo.Node3D):
        """Called like one of tifo's."""

    (tmp_path / "a.toml").write_text('[[node]]\nname = "A"\ntype = "Player"\n')
    made = load_scene(tmp_path / "a.toml").instantiate()
    assert type(made) is Player
    tifo.save_scene(tifo.Player(name="B", number=7), tmp_path / "b.toml")
    again = load_scene(tmp_path / "b.toml").instantiate()
    assert isinstance(again, tifo.Player)
    assert again.number == 7


TABLES = "sport, rock_concert, classical_concert, speech"


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            'behaviour = "res://concert_nigth.toml"',
            "Stadium.behaviour is 'res://concert_nigth.toml': there is no such file, and no table "
            f"of that name ({TABLES}); did you mean concert_night.toml?",
        ),
        (
            'behaviour = "opera"',
            "Stadium.behaviour is 'opera': there is no such file, and no table of that name "
            f"({TABLES})",
        ),
        (
            'character = "res://fan.glb"',
            "Stadium.character is 'res://fan.glb': there is no such file",
        ),
        (
            'motions = ["res://concert_night.toml", "res://wave.bvh"]',
            "Stadium.motions is 'res://wave.bvh': there is no such file",
        ),
        ('behaviour = "res://../a.toml"', "res://../a.toml: leads out of the resource folder"),
    ],
)
def test_a_scene_that_names_a_file_that_is_not_there(folder: Path, given: str, said: str) -> None:
    (folder / "concert_night.toml").write_text("")
    scene = '[[node]]\nname = "Ground"\ntype = "Stadium"\n[node.exports]\nlayout = "stand"\n'
    (folder / "ground.toml").write_text(scene + given + "\n")
    with pytest.raises(tifo.AssetError) as caught:
        load_scene("res://ground.toml")
    assert str(caught.value) == f"res://ground.toml, line 6: {said}"


def test_a_scene_may_name_tables_and_files_that_are_there(
    folder: Path,
) -> None:
    (folder / "own.toml").write_text("")
    scene = '[[node]]\nname = "A"\ntype = "Stadium"\n[node.exports]\ncharacter = ""\n'
    for number, behaviour in enumerate(("speech", "res://own.toml", str(folder / "own.toml"))):
        path = folder / f"{number}.toml"
        path.write_text(f"{scene}behaviour = '{behaviour}'\n")
        assert load_scene(path).entries[0].values["behaviour"] == behaviour
