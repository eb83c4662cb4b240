"""Resources: loading once, root folder, scripts, files of resources."""

from __future__ import annotations

from pathlib import Path

import pytest

from tifo import (
    AssetError,
    Node,
    Resource,
    add_loader,
    export,
    load,
    load_scene,
    resource_root,
    save_resource,
    set_resource_root,
)
from tifo.scripting import resources


class ShirtKit(Resource):
    """Colour and number."""

    colour: str = export(default="red")
    number: int = export(default=10, range=(1, 99))


class ShirtOwner(Node):
    """Has one."""

    kit: ShirtKit | None = export(default=None)


KIT = '[resource]\ntype = "ShirtKit"\n\n[exports]\nnumber = 7\n'


def test_a_resource_is_loaded_once(folder: Path) -> None:
    (folder / "kit.toml").write_text(KIT)
    kit = load("res://kit.toml")
    assert isinstance(kit, ShirtKit)
    assert (kit.colour, kit.number, kit.resource_path) == ("red", 7, "res://kit.toml")
    assert load("res://kit.toml") is kit
    assert load("res://kit.toml", fresh=True) is not kit
    assert kit.duplicate().resource_path == ""
    assert resource_root() == folder.resolve()


def test_saving_and_sharing_in_scenes(folder: Path) -> None:
    kit = ShirtKit(colour="blue")
    save_resource(kit, "res://blue.toml")
    assert load("res://blue.toml") is kit
    text = '[[node]]\nname = "A"\ntype = "ShirtOwner"\n[node.exports]\nkit = "res://blue.toml"\n'
    (folder / "s.toml").write_text(text)
    scene = load_scene("res://s.toml")
    owners = [scene.instantiate(), scene.instantiate()]
    assert all(isinstance(owner, ShirtOwner) and owner.kit is kit for owner in owners)
    (folder / "s.toml").write_text(text.replace("blue", "gone"))
    with pytest.raises(
        AssetError, match=r"s.toml, line 5: .*no such file; did you mean .*blue.toml"
    ):
        load("res://s.toml", fresh=True)


@pytest.mark.parametrize(
    ("text", "place", "cause"),
    [
        (KIT.replace("Shirt", "Shrt"), "line 2", r"no resource type 'ShrtKit'; did you mean Shirt"),
        (KIT.replace("7", "0"), "line 5", "ShirtKit.number is 0, expected a whole number from 1"),
        (KIT.replace("number", "numbr"), "line 5", r"has no export 'numbr'; did you mean number\?"),
        ("[resource]\n", "line 1", r"expected \[resource\] with a type"),
    ],
)
def test_mistakes_in_resource_files(folder: Path, text: str, place: str, cause: str) -> None:
    (folder / "k.toml").write_text(text)
    with pytest.raises(AssetError, match=cause) as caught:
        load("res://k.toml")
    assert caught.value.place == place


@pytest.mark.parametrize(
    ("path", "cause"),
    [
        ("res://none.toml", "there is no such file"),
        ("res://../x.toml", "leads out of the resource folder"),
        ("res://a.xyz", "files that end in '.xyz' can't be loaded; .bvh, .glb, .gltf, .py, .toml"),
    ],
)
def test_what_cannot_be_loaded(folder: Path, path: str, cause: str) -> None:
    (folder / "a.xyz").write_text("x")
    with pytest.raises(AssetError, match=cause):
        load(path)
    with pytest.raises(ValueError, match="no folder"):
        set_resource_root(folder / "nothing")


def test_loaders_of_ones_own(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(resources._store, "loaders", dict(resources._store.loaders))
    add_loader(".xyz", lambda path, file: file.read_text().upper())
    (folder / "a.xyz").write_text("hi")
    assert load("res://a.xyz") == "HI"
    with pytest.raises(ValueError, match="suffix"):
        add_loader("xyz", lambda path, file: None)


SCRIPT = """\
from __future__ import annotations

from tifo import Node, export


class Keeper(Node):
    reach: float = export(default=2.0, range=(0, 3))
"""


def test_scripts_bring_node_types(folder: Path) -> None:
    (folder / "keeper.py").write_text(SCRIPT)
    scene = '[[node]]\nname = "K"\ntype = "res://keeper.py"\n[node.exports]\nreach = 3\n'
    (folder / "k.toml").write_text(scene)
    node = load_scene("res://k.toml").instantiate()
    assert type(node) is load("res://keeper.py").Keeper
    assert node.reach == 3.0  # type: ignore[attr-defined]
    (folder / "k.toml").write_text(scene.replace("keeper.py", "keeper.py:Keper"))
    with pytest.raises(AssetError, match=r"line 3: .*no node type 'Keper'; did you mean Keeper"):
        load("res://k.toml", fresh=True)


def test_a_script_that_fails_names_its_line(folder: Path) -> None:
    (folder / "bad.py").write_text("x = 1\ny = 1 / 0\n")
    with pytest.raises(AssetError, match=r"res://bad.py, line 2: ZeroDivisionError"):
        load("res://bad.py")
    (folder / "worse.py").write_text("x = 1\ndef\n")
    with pytest.raises(AssetError, match=r"res://worse.py, line 2: SyntaxError"):
        load("res://worse.py")
    (folder / "none.py").write_text("x = 1\n")
    (folder / "s.toml").write_text('[[node]]\nname = "K"\ntype = "res://none.py"\n')
    with pytest.raises(AssetError, match=r"line 3: 'res://none.py' has none"):
        load("res://s.toml")
