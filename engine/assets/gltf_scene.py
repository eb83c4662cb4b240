"""The node tree of a glTF file: parents, names, local and model-space transforms.

Nothing here recurses, so that a chain of any length can be read.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .gltf_document import GltfDocument
from .gltf_fields import Fields
from .gltf_transforms import FloatArray, Transforms, decompose

SHEAR_TOLERANCE = 1e-4
"""Relative error of a node's matrix from which its shear is worth a note."""


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """All nodes of a file.

    Parameters
    ----------
    names
        N names; unnamed nodes are called after their index, like ``"node 3"``.
    parents
        N parent indices, -1 for a root.
    local
        Local transforms, (N, ...).
    world
        (N, 4, 4) float64: from each node to the file's scene space.
    order
        All node indices, parents before children.
    shown
        Those that are in the scene, in the same order.
    notes
        What was changed.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    local: Transforms
    world: FloatArray
    order: tuple[int, ...]
    shown: tuple[int, ...]
    notes: tuple[str, ...]


def read_scene(document: GltfDocument) -> Scene:
    """Read the nodes.

    Raises
    ------
    AssetError
        For cycles, nodes with two parents, references to nothing and values that are no transform.
    """
    nodes = document.items("nodes")
    children = [node.indices("children", len(nodes)) for node in nodes]
    parents = [-1] * len(nodes)
    for parent, below in enumerate(children):
        for child in below:
            if parents[child] != -1:
                document.fail(
                    f"nodes[{child}]", f"is a child of nodes {parents[child]} and {parent}"
                )
            parents[child] = parent
    order = _top_down([k for k, parent in enumerate(parents) if parent < 0], children)
    if len(order) < len(nodes):
        missed = min(set(range(len(nodes))) - set(order))
        document.fail(f"nodes[{missed}]", "is its own ancestor")
    reachable = set(_top_down(document.scene_roots, children))
    local, sheared = _local_transforms(nodes)
    return Scene(
        names=tuple(node.text("name") or f"node {k}" for k, node in enumerate(nodes)),
        parents=tuple(parents),
        local=local,
        world=_world_matrices(local, parents, order),
        order=tuple(order),
        shown=tuple(node for node in order if node in reachable),
        notes=tuple(f"The matrix of node {k} has shear, which is not kept." for k in sheared),
    )


def _top_down(roots: list[int], children: list[list[int]]) -> list[int]:
    """Nodes reachable from `roots`, each once, parents first."""
    order = list(dict.fromkeys(roots))
    seen = set(order)
    for node in order:
        fresh = [child for child in children[node] if child not in seen]
        seen.update(fresh)
        order.extend(fresh)
    return order


def _local_transforms(nodes: list[Fields]) -> tuple[Transforms, list[int]]:
    count = len(nodes)
    local = Transforms(np.zeros((count, 4)), np.zeros((count, 3)), np.ones((count, 3)))
    sheared = []
    for k, node in enumerate(nodes):
        if "matrix" in node:
            matrix = node.numbers("matrix", np.eye(4).ravel().tolist()).reshape(4, 4).T
            if np.abs(matrix[3] - (0, 0, 0, 1)).max() > 1e-3:
                node.fail("matrix", "is a projection, not a transform")
            part, missed = decompose(matrix)
            if missed > SHEAR_TOLERANCE:
                sheared.append(k)
        else:
            rotation = node.numbers("rotation", (0, 0, 0, 1))
            length = float(np.linalg.norm(rotation))
            if length < 1e-9:
                node.fail("rotation", "is the zero quaternion")
            part = Transforms(
                rotation / length,
                node.numbers("translation", (0, 0, 0)),
                node.numbers("scale", (1, 1, 1)),
            )
        for target, value in zip(local, part, strict=True):
            target[k] = value
    return local, sheared


def _world_matrices(local: Transforms, parents: list[int], order: list[int]) -> FloatArray:
    world: NDArray[np.float64] = local.matrices()
    for node in order:
        if parents[node] >= 0:
            world[node] = world[parents[node]] @ world[node]
    return world
