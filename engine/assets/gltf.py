"""The glTF 2.0 reader: one character out of a .glb or .gltf file.

What a viewer shows of the file is what the character's skeleton, meshes and clips give, in the
file's scene space. `Character.notes` says what was left out.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..animation.skeleton import Skeleton, breadth_first_order
from .character import Character, SkinnedMesh
from .gltf_binding import Binding
from .gltf_clips import animated_nodes, read_clips, unique_names
from .gltf_document import GltfDocument
from .gltf_material import MaterialReader
from .gltf_parts import Part, PartReader, Surface
from .gltf_scene import Scene, read_scene
from .gltf_transforms import FloatArray, Transforms

MOST_JOINTS = 65535
"""Joints that a vertex's uint16 indices can tell apart."""


def load_gltf(path: str | Path) -> Character:
    """Load a character from a glTF 2.0 file.

    Parameters
    ----------
    path
        A .glb file, or a .gltf file with its buffers and images inline or beside it.

    Returns
    -------
    Character
        Its skeleton has the joints of all skins, the nodes of rigid meshes and all nodes above
        them up to the root of the scene, so model space is the file's scene space. Every joint's
        palette is its model matrix times its inverse bind matrix, whatever the file's skins did.
        A file that animates nodes without a skin loads as a rigid character. Clips have keys at
        uniform times, 60 to 120 a second.

    Raises
    ------
    AssetError
        If the file can't be read, contradicts the format, requires an extension that is not
        supported, or has no mesh that a skin or an animation moves.
    """
    # Numbers from files may overflow or divide by zero; all results are checked to be finite.
    with np.errstate(all="ignore"):
        return _load(GltfDocument(path))


def _load(document: GltfDocument) -> Character:
    notes: list[str] = []
    scene = read_scene(document)
    notes += scene.notes
    materials = MaterialReader(document)
    animated = animated_nodes(document)
    parts = PartReader(document, scene, materials, notes).read(animated)
    nodes = _with_ancestors(scene, parts)
    if not parts:
        document.fail("", "has no triangles to show")
    if animated.isdisjoint(nodes) and not any(part.skinned for part in parts):
        document.fail("", "has no skin and no animation of nodes, so nothing in it can move")

    binding = Binding(scene.world, nodes)
    places = [binding.bind(part.hold()) for part in parts]
    if len(binding.joints) > MOST_JOINTS:
        document.fail("nodes", f"{len(binding.joints)} joints are more than {MOST_JOINTS}")
    skeleton, rest, row_of_joint = _skeleton(document, scene, binding)
    meshes = [
        mesh
        for part, (place, rows) in zip(parts, places, strict=True)
        for mesh in _meshes(part, place, row_of_joint[rows])
    ]
    for mesh in meshes:
        for array in (mesh.positions, mesh.normals, mesh.uvs, mesh.colors):
            if not np.isfinite(array).all():
                document.fail(f"mesh '{mesh.name}'", "has numbers too large to compute with")
    names = unique_names([mesh.name for mesh in meshes])
    originals = {node: int(row_of_joint[k]) for k, node in enumerate(binding.nodes)}
    clips = read_clips(document, skeleton, rest, originals, notes)
    notes += materials.notes
    return Character(
        name=document.path.stem,
        skeleton=skeleton,
        meshes=tuple(replace(mesh, name=name) for name, mesh in zip(names, meshes, strict=True)),
        materials=tuple(materials.materials),
        clips=clips,
        notes=tuple(dict.fromkeys(notes)),
    )


def _with_ancestors(scene: Scene, parts: list[Part]) -> list[int]:
    """Nodes of all parts and all nodes above them, in the file's order."""
    found: set[int] = set()
    for part in parts:
        for start in part.nodes.tolist():
            node = start
            while node >= 0 and node not in found:
                found.add(node)
                node = scene.parents[node]
    return sorted(found)


def _skeleton(
    document: GltfDocument, scene: Scene, binding: Binding
) -> tuple[Skeleton, Transforms, NDArray[np.int64]]:
    """Make the skeleton, its rest pose in float64 and the new row of each joint of the binding."""
    row_of_node = {node: row for row, node in enumerate(binding.nodes)}
    parents = [
        row_of_node.get(scene.parents[joint.node], -1) if joint.original == row else joint.original
        for row, joint in enumerate(binding.joints)
    ]
    order = breadth_first_order(parents)
    new_row = np.empty(len(order) + 1, dtype=np.int64)
    new_row[order] = np.arange(len(order))
    new_row[-1] = -1
    nodes = np.array([joint.node for joint in binding.joints])[order]
    rest = Transforms(*(part[nodes].copy() for part in scene.local))
    inverse_bind = np.repeat(np.eye(3, 4)[None], len(order), axis=0)
    for row, joint in enumerate(binding.joints):
        if joint.original != row:
            identity = ((0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
            for target, value in zip(rest, identity, strict=True):
                target[new_row[row]] = value
        if joint.inverse_bind is not None:
            inverse_bind[new_row[row]] = joint.inverse_bind[:3]
    columns = [part.astype(np.float32) for part in (*rest, inverse_bind)]
    if not all(np.isfinite(part).all() for part in columns):
        document.fail("nodes", "have transforms too large to compute with")
    names = unique_names([scene.names[node] for node in nodes.tolist()])
    parents_in_order = new_row[np.array(parents)[order]].astype(np.int32)
    return Skeleton(tuple(names), parents_in_order, *columns), rest, new_row[:-1]


def _meshes(part: Part, place: FloatArray, rows: NDArray[np.int64]) -> list[SkinnedMesh]:
    """Merge the primitives of a part by material and variant and bring them to the bind pose."""
    joint_of_index = np.zeros(len(part.nodes), dtype=np.uint16)
    joint_of_index[part.used()] = rows
    groups: dict[tuple[int, str], list[Surface]] = {}
    for surface in part.surfaces:
        variant = surface.variant
        choice = "" if variant is None else f"{variant.group}/{variant.choice}"
        groups.setdefault((surface.material, choice), []).append(surface)
    return [_merged(members, place, joint_of_index) for members in groups.values()]


def _merged(
    members: list[Surface],
    place: FloatArray,
    joint_of_index: NDArray[np.uint16],
) -> SkinnedMesh:
    """One mesh out of primitives that follow the same joints."""
    primitives = [surface.primitive for surface in members]
    linear = place[:3, :3]
    offsets = np.cumsum([0, *(len(primitive.positions) for primitive in primitives)])
    triangles = np.concatenate(
        [
            primitive.triangles + offset
            for primitive, offset in zip(primitives, offsets[:-1], strict=True)
        ]
    )
    if np.linalg.det(linear) < 0:
        triangles = triangles[:, ::-1]
    normals = np.concatenate([primitive.normals for primitive in primitives])
    normals = normals @ np.linalg.inv(linear)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    positions = np.concatenate([primitive.positions for primitive in primitives])
    joints = [primitive.joints for primitive in primitives if primitive.joints is not None]
    weights = [primitive.weights for primitive in primitives if primitive.weights is not None]
    return SkinnedMesh(
        name=members[0].name,
        positions=(positions @ linear.T + place[:3, 3]).astype(np.float32),
        normals=normals.astype(np.float32),
        uvs=np.concatenate([primitive.uvs for primitive in primitives]).astype(np.float32),
        colors=np.concatenate([primitive.colors for primitive in primitives]).astype(np.float32),
        joints=joint_of_index[np.concatenate(joints)],
        weights=np.concatenate(weights).astype(np.float32),
        triangles=np.ascontiguousarray(triangles, dtype=np.uint32),
        material=members[0].material,
        variant=members[0].variant,
    )
