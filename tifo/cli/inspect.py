"""Say what is in a glTF or BVH file: joints, clips, meshes, materials, and what was left out.

Exit code 1 if a file can't be used.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..engine.animation.clip import Clip
from ..engine.animation.skeleton import Skeleton
from ..engine.assets.character import Character, Material, SkinnedMesh
from ..engine.assets.load import load_character
from ..engine.assets.retarget import humanoid
from ..engine.assets.variants import one_look, variant_groups
from ..engine.errors import AssetError
from .text import printable

if TYPE_CHECKING:
    from rich.console import Console

_WORDS = {"clip", "mesh", "material", "colour", "texture", "sides", "loops", "part", "joint"}
"""Headers of columns that hold no numbers."""

_FORMATS = {".glb": "glTF, binary", ".gltf": "glTF", ".bvh": "BVH"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of ``tifo inspect``."""
    parser.add_argument("files", nargs="+", metavar="FILE", help="a .glb, .gltf or .bvh file")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--tree", action="store_true", help="show the tree of joints too")
    parser.add_argument(
        "--scale",
        type=float,
        metavar="METRES",
        help="metres a unit of BVH files, guessed if absent",
    )


def run(options: argparse.Namespace) -> int:
    """Describe every file; the exit code."""
    described: list[dict[str, Any]] = []
    failed = False
    for path in options.files:
        try:
            entry = describe(path, options.scale)
        except AssetError as error:
            failed = True
            print(printable(f"tifo: {error}"), file=sys.stderr)
            entry = {"file": path, "error": str(error)}
        else:
            if not options.json:
                _print_description(entry, tree=options.tree)
        described.append(entry)
    if options.json:
        print(json.dumps({"ok": not failed, "files": described}, allow_nan=False))
    return int(failed)


def describe(path: str | Path, scale: float | None = None) -> dict[str, Any]:
    """What is in a file, as JSON knows it: numbers in metres and seconds.

    Parameters
    ----------
    path
        A .glb, .gltf or .bvh file.
    scale
        Metres a unit of a BVH file; guessed if None.

    Raises
    ------
    AssetError
        If the file can't be used.
    ValueError
        If `scale` is out of range.
    """
    character = load_character(path, scale)
    suffix = Path(path).suffix.lower()
    unit = "metres, as glTF says"
    if suffix == ".bvh":
        unit = "guessed, see the notes" if scale is None else f"{scale:g} m, as --scale says"
    skeleton = character.skeleton
    return {
        "file": str(path),
        "format": _FORMATS[suffix],
        "unit": unit,
        "size": _size(character),
        "skeleton": {
            "joints": skeleton.joint_count,
            "roots": int((skeleton.parents < 0).sum()),
            "levels": len(skeleton.levels),
            "names": list(skeleton.names),
            "parents": skeleton.parents.tolist(),
        },
        "humanoid": _humanoid(skeleton),
        "vertices": sum(len(mesh.positions) for mesh in character.meshes),
        "triangles": character.triangle_count,
        "meshes": [_mesh(mesh, character.materials) for mesh in character.meshes],
        "lower_levels": [
            sum(len(mesh.triangles) for mesh in level) for level in character.lower_levels
        ],
        "variants": {
            group: [variant.choice for variant in choices]
            for group, choices in variant_groups(character).items()
        },
        "materials": [_material(material) for material in character.materials],
        "clips": [_clip(clip) for clip in character.clips],
        "notes": list(character.notes),
    }


def _humanoid(skeleton: Skeleton) -> dict[str, Any]:
    """Which joints are which parts of a human body, for retargeting, or why it is none."""
    try:
        body = humanoid(skeleton)
    except ValueError as error:
        return {"is_humanoid": False, "cause": str(error)}
    return {
        "is_humanoid": True,
        "found_by": body.found_by,
        "joints": {part: skeleton.names[joint] for part, joint in body.joints.items()},
        "missing": list(body.missing),
        "unmapped": list(body.unmapped),
    }


def _size(character: Character) -> list[float]:
    """Width, height and depth of the most detailed level in the bind pose."""
    corners = [mesh.positions for mesh in one_look(character).meshes if len(mesh.positions)]
    if not corners:
        return [0.0, 0.0, 0.0]
    size: list[float] = np.ptp(np.concatenate(corners), axis=0).tolist()
    return [round(side, 4) for side in size]


def _mesh(mesh: SkinnedMesh, materials: tuple[Material, ...]) -> dict[str, Any]:
    influences = (mesh.weights > 0).sum(axis=1)
    return {
        "name": mesh.name,
        "vertices": len(mesh.positions),
        "triangles": len(mesh.triangles),
        "influences": int(influences.max(initial=0)),
        "joints": len(np.unique(mesh.joints[mesh.weights > 0])),
        "material": materials[mesh.material].name,
    }


def _material(material: Material) -> dict[str, Any]:
    image = material.image
    return {
        "name": material.name,
        "base_color": [round(float(value), 4) for value in material.base_color],
        "texture": None if image is None else [image.shape[1], image.shape[0]],
        "double_sided": material.double_sided,
    }


def _clip(clip: Clip) -> dict[str, Any]:
    return {
        "name": clip.name,
        "duration": round(clip.duration, 6),
        "keys": clip.frame_count,
        "key_rate": round((clip.frame_count - 1) / clip.duration, 3) if clip.duration else 0.0,
        "looping": clip.looping,
        "resampling_error": float(clip.resampling_error),
    }


def _print_description(entry: dict[str, Any], *, tree: bool) -> None:
    from rich.console import Console
    from rich.padding import Padding

    console = Console(highlight=False, markup=False, emoji=False)
    console.print(printable(entry["file"]), style="bold", soft_wrap=True)
    for name, text in _summary(entry):
        console.print(f"  {name:10}{text}")
    if tree:
        _print_tree(console, entry["skeleton"])
    joints = entry["humanoid"].get("joints", {})
    _print_table(console, ("part", "joint"), iter(joints.items()))
    _print_table(
        console,
        ("clip", "seconds", "keys", "keys/s", "loops", "error mm"),
        (
            (
                clip["name"],
                f"{clip['duration']:.2f}",
                str(clip["keys"]),
                f"{clip['key_rate']:.1f}",
                "yes" if clip["looping"] else "no",
                f"{1000 * clip['resampling_error']:.2f}",
            )
            for clip in entry["clips"]
        ),
    )
    _print_table(
        console,
        ("mesh", "triangles", "vertices", "joints", "influences", "material"),
        (
            (
                mesh["name"],
                f"{mesh['triangles']:,}",
                f"{mesh['vertices']:,}",
                str(mesh["joints"]),
                str(mesh["influences"]),
                mesh["material"],
            )
            for mesh in entry["meshes"]
        ),
    )
    _print_table(
        console,
        ("material", "colour", "texture", "sides"),
        (
            (
                material["name"],
                " ".join(f"{value:.2f}" for value in material["base_color"]),
                "x".join(map(str, material["texture"])) if material["texture"] else "none",
                "both" if material["double_sided"] else "front",
            )
            for material in entry["materials"]
        ),
    )
    for note in entry["notes"]:
        console.print(Padding(printable(f"note: {note}"), (0, 0, 0, 1)), style="yellow")
    console.print()


def _summary(entry: dict[str, Any]) -> Iterator[tuple[str, str]]:
    skeleton = entry["skeleton"]
    width, height, depth = entry["size"]
    yield "format", entry["format"]
    yield "unit", entry["unit"]
    yield "size", f"{height:.3f} m high, {width:.3f} m wide, {depth:.3f} m deep in the bind pose"
    roots = skeleton["roots"]
    yield (
        "skeleton",
        f"{_count(skeleton['joints'], 'joint')} in {_count(skeleton['levels'], 'level')}, "
        f"{_count(roots, 'root')}",
    )
    yield (
        "body",
        f"{_count(entry['triangles'], 'triangle')}, "
        f"{entry['vertices']:,} {'vertex' if entry['vertices'] == 1 else 'vertices'}",
    )
    if entry["lower_levels"]:
        coarser = ", ".join(f"{count:,}" for count in entry["lower_levels"])
        yield "lower", f"{coarser} triangles in the coarser levels"
    for group, choices in entry["variants"].items():
        yield printable(group), printable(f"one of {', '.join(choices)}")
    body = entry["humanoid"]
    if body["is_humanoid"]:
        missing = f"; missing {', '.join(body['missing'])}" if body["missing"] else ""
        unmapped = body["unmapped"]
        rests = ", ".join(unmapped[:6]) + (", ..." if len(unmapped) > 6 else "")
        yield "humanoid", f"by {body['found_by']}{missing}"
        if unmapped:
            yield "unmapped", printable(f"{_count(len(unmapped), 'joint')}: {rests}")
    else:
        yield "humanoid", printable(body["cause"].removeprefix("is "))
    seconds = sum(clip["duration"] for clip in entry["clips"])
    yield "motion", f"{_count(len(entry['clips']), 'clip')}, {seconds:.2f} s in all"


def _count(number: int, noun: str) -> str:
    return f"{number:,} {noun}" if number == 1 else f"{number:,} {noun}s"


def _print_table(
    console: Console, headers: tuple[str, ...], rows: Iterator[tuple[str, ...]]
) -> None:
    """A table whose first column is a name; nothing if there are no rows."""
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for place, header in enumerate(headers):
        numeric = header not in _WORDS
        table.add_column(
            header, justify="right" if numeric else "left", overflow="fold", no_wrap=place > 0
        )
    for row in rows:
        table.add_row(*(Text(printable(cell)) for cell in row))
    if table.row_count:
        console.print(table)


def _print_tree(console: Console, skeleton: dict[str, Any]) -> None:
    from rich.text import Text
    from rich.tree import Tree

    top = Tree("joints")
    branches: list[Tree] = []
    for name, parent in zip(skeleton["names"], skeleton["parents"], strict=True):
        label = Text(printable(name))
        branches.append((top if parent < 0 else branches[parent]).add(label))
    console.print(top)
