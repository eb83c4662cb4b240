"""Controllers to TOML and back, and what is said about files that are wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from tifo.engine.animation.controllers import (
    Additive,
    Blend2,
    BlendN,
    BlendSpace1D,
    BlendSpace2D,
    ClipNode,
    Controller,
    Custom,
    Mask,
    Masked,
    OneShot,
    Overlay,
    StateMachine,
    TimeScale,
    Transition,
    controller_from_toml,
    controller_to_toml,
    load_controller,
    save_controller,
)
from tifo.engine.errors import AssetError


def everything() -> Controller:
    clap = ClipNode("clap", speed=1.5, loop=False, phase=0.25, name='a "quoted" name\x7f\n')
    space = BlendSpace1D([(1.0, clap), (-2, ClipNode("walk"))], 0.5, name="pace")
    plane = BlendSpace2D([((0, 0), clap), ((1.5, 2), ClipNode("sit"))], (1e-7, 1e8))
    ways = [
        Transition("rest", "wild", "go", "x > 1.5", True, 0.3, "linear", True, 2, "none"),
        Transition("*", "rest", when="not x"),
    ]
    machine = StateMachine({"rest": space, "wild": plane}, ways, "wild", {"x": 2.0})
    masked = Masked(machine, [Overlay(clap, Mask({"hand_l": 0.5, "é": 1}, descendants=False), 0.1)])
    mean = BlendN([masked, TimeScale(Blend2(clap, TimeScale(clap), 0.3), -2.0)], [1, 0.25])
    return OneShot(Additive(mean, clap, 0.5, "sit", 0.2), clap, 0.1, 0.2, name="top")


def test_a_round_trip_keeps_every_field_and_sharing(tmp_path: Path) -> None:
    tree = everything()
    save_controller(tree, tmp_path / "tree.toml")
    again = load_controller(tmp_path / "tree.toml")
    text = controller_to_toml(tree)
    assert controller_to_toml(again) == text
    assert text.count('clip = "clap"') == 1
    assert isinstance(again, OneShot)
    assert isinstance(again.base, Additive)
    assert again.shot is again.base.add
    assert (again.fadein, again.fadeout, again.base.reference_time) == (0.1, 0.2, 0.2)
    mean = again.base.base
    assert isinstance(mean, BlendN)
    assert tuple(mean.weights) == (1, 0.25)
    masked = mean.nodes[0]
    assert isinstance(masked, Masked)
    assert masked.layers[0].mask == Mask({"hand_l": 0.5, "é": 1}, descendants=False)
    machine = masked.base
    assert isinstance(machine, StateMachine)
    assert isinstance(tree, OneShot)
    assert machine.transitions[0] == Transition(
        "rest", "wild", "go", "x > 1.5", True, 0.3, "linear", True, 2, "none"
    )
    assert (machine.start, machine.parameters) == ("wild", {"x": 2.0})
    assert [at for at, _ in machine.states["wild"].points] == [(0, 0), (1.5, 2)]  # type: ignore[attr-defined]
    clap = again.shot
    assert isinstance(clap, ClipNode)
    assert (clap.speed, clap.loop, clap.phase, clap.name) == (
        *(1.5, False, 0.25),
        'a "quoted" name\x7f\n',
    )


def test_a_deep_tree(tmp_path: Path) -> None:
    tree: Controller = ClipNode("clap")
    for _ in range(500):
        tree = TimeScale(tree, 1.5)
    again = controller_from_toml(controller_to_toml(tree))
    for _ in range(500):
        assert isinstance(again, TimeScale)
        again = again.node
    assert isinstance(again, ClipNode)


def test_code_is_not_saved() -> None:
    class Still:
        def evaluate(self, context: object) -> None: ...

    with pytest.raises(ValueError, match="blend tree node 'b': a Custom node can't be saved"):
        controller_to_toml(Blend2(ClipNode("clap"), Custom(Still())))


CLIP = '[nodes.a]\ntype = "ClipNode"\nclip = "clap"\n'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("root = ", "is no TOML"),
        ('root = "a"', "expected the keys 'root' and 'nodes'"),
        (CLIP + 'root = "b"', "there is no node None; near: a"),
        ('root = "b"\n' + CLIP, "root: there is no node 'b'; near: a"),
        ('root = "a"\n[nodes.a]\ntype = "Clip"\n', "nodes.a: type is 'Clip', expected one of"),
        ('root = "a"\n[nodes.a]\ntype = "ClipNode"\n', "missing 1 required positional argument"),
        ('root = "a"\n' + CLIP + "sped = 2\n", "unexpected keyword argument 'sped'"),
        ('root = "a"\n' + CLIP + "phase = 2\n", "phase is 2, expected 0 to 1"),
        ('root = "a"\n' + CLIP + CLIP.replace(".a", ".b"), "nodes.b: is no part of the tree"),
        (
            'root = "a"\n[nodes.a]\ntype = "TimeScale"\nnode = "b"\n'
            '[nodes.b]\ntype = "TimeScale"\nnode = "a"\n',
            "nodes.a: it contains itself: a > b > a",
        ),
        (
            'root = "a"\n[nodes.a]\ntype = "TimeScale"\nnode = ["b"]\n',
            r"nodes.a: there is no node \['b'\]",
        ),
        (
            'root = "b"\n[nodes.b]\ntype = "Masked"\nbase = "a"\noverlays = [{node = "a"}]\n'
            + CLIP,
            "nodes.b: 'mask' is missing",
        ),
        (
            'root = "b"\n[nodes.b]\ntype = "StateMachine"\nstates = {x = "a"}\n'
            'transitions = [{source = "x", target = "y"}]\n' + CLIP,
            "nodes.b: .*transition target is 'y', expected a state: x",
        ),
        ('root = "b"\n[nodes.b]\ntype = "BlendSpace1D"\npoints = [3]\n', "a point is 3, expected"),
        ('root = "b"\n[nodes.b]\ntype = "StateMachine"\nstates = 4\n', "nodes.b"),
        ('root = "b"\n[nodes.b]\ntype = "BlendN"\nnodes = 4\n', "nodes.b"),
    ],
)
def test_wrong_files_are_named_with_place_and_cause(
    text: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "tree.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(AssetError, match=message) as caught:
        load_controller(path)
    assert str(caught.value).startswith(str(path))


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(AssetError, match="can't be read"):
        load_controller(tmp_path / "none.toml")
