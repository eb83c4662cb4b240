"""Reads the skeleton and the clips of a glTF file that has no skinned mesh.

Libraries of animations are often shipped as bare nodes with channels, for any character of the same
rig or for retargeting.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..animation.clip import Clip
from ..animation.skeleton import Skeleton, breadth_first_order
from .gltf_clips import animated_nodes, read_clips, unique_names
from .gltf_document import GltfDocument
from .gltf_scene import read_scene
from .gltf_transforms import Transforms, is_invertible

MOST_JOINTS = 65535


def has_skinned_mesh(path: str | Path) -> bool:
    """Whether any node of a glTF file puts a mesh on a skin.

    Raises
    ------
    AssetError
        If the file can't be read.
    """
    return any("skin" in node and "mesh" in node for node in GltfDocument(path).items("nodes"))


def load_gltf_motion(path: str | Path) -> tuple[Skeleton, tuple[Clip, ...], tuple[str, ...]]:
    """Skeleton, clips and notes of a glTF file, whatever its meshes are.

    The skeleton has the nodes that any clip moves and the joints of skins, with all nodes above
    them; its bind pose is the rest pose.

    Raises
    ------
    AssetError
        If the file can't be read, contradicts the format or moves nothing.
    """
    with np.errstate(all="ignore"):
        return _load(GltfDocument(path))


def _load(document: GltfDocument) -> tuple[Skeleton, tuple[Clip, ...], tuple[str, ...]]:
    scene = read_scene(document)
    count = len(scene.names)
    wanted = animated_nodes(document)
    if not wanted:
        document.fail("", "has no animation of nodes")
    for skin in document.items("skins"):
        wanted |= set(skin.indices("joints", count))
    kept: set[int] = set()
    for start in sorted(wanted):
        node = start
        while node >= 0 and node not in kept:
            kept.add(node)
            node = scene.parents[node]
    if len(kept) > MOST_JOINTS:
        document.fail("nodes", f"{len(kept)} joints are more than {MOST_JOINTS}")
    nodes = sorted(kept)
    row = {node: k for k, node in enumerate(nodes)}
    parents = [row.get(scene.parents[node], -1) for node in nodes]
    order = breadth_first_order(parents)
    place = np.empty(len(order) + 1, dtype=np.int64)
    place[order] = np.arange(len(order))
    place[-1] = -1
    chosen = np.array(nodes)[order]
    rest = Transforms(*(part[chosen].copy() for part in scene.local))
    inverse_bind = np.stack(
        [
            np.linalg.inv(world)[:3] if is_invertible(world) else np.eye(3, 4)
            for world in scene.world[chosen]
        ]
    )
    columns = [part.astype(np.float32) for part in (*rest, inverse_bind)]
    if not all(np.isfinite(part).all() for part in columns):
        document.fail("nodes", "have transforms too large to compute with")
    names = unique_names([scene.names[node] for node in chosen.tolist()])
    skeleton = Skeleton(tuple(names), place[np.array(parents)[order]].astype(np.int32), *columns)
    notes = list(scene.notes)
    joint_of_node = {int(node): k for k, node in enumerate(chosen)}
    clips = read_clips(document, skeleton, rest, joint_of_node, notes)
    return skeleton, clips, tuple(dict.fromkeys(notes))
