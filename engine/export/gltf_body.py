"""Meshes of exported agents in glTF: what all of them share, and what each has of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..assets.character import SkinnedMesh
from .gltf_file import ELEMENT_BUFFER, GltfFile
from .morph_targets import MorphTargets
from .paints import has_coordinates
from .recording import Recording
from .shirts import Sheet


def body_meshes(recording: Recording, level: int) -> tuple[SkinnedMesh, ...]:
    """Meshes that the agents wear; ValueError if there are none."""
    meshes = recording.meshes(level)
    if not meshes:
        name = recording.character.name
        raise ValueError(f"level is {level}, but '{name}' has no triangles there to export")
    return meshes


def worn_triangles(recording: Recording, meshes: Sequence[SkinnedMesh]) -> int:
    """Triangles of all agents together."""
    return int((recording.worn(meshes) @ np.array([len(mesh.triangles) for mesh in meshes])).sum())


def worn_vertices(recording: Recording, meshes: Sequence[SkinnedMesh]) -> int:
    """Vertices of all agents together."""
    return int((recording.worn(meshes) @ np.array([len(mesh.positions) for mesh in meshes])).sum())


def add_surface(file: GltfFile, mesh: SkinnedMesh, sheet: Sheet | None) -> dict[str, Any]:
    """Write what doesn't move of a mesh: triangles, texture coordinates and vertex colours.

    Coordinates on the sheet of patterns come after the mesh's own.

    Returns
    -------
    dict
        A primitive without positions and material.
    """
    attributes: dict[str, int] = {}
    if has_coordinates(mesh):
        attributes["TEXCOORD_0"] = file.add(mesh.uvs.astype(np.float32))
    if sheet is not None and sheet.covers(mesh):
        # The first row of a picture is its highest, and glTF counts from there.
        left, up = sheet.coordinates(mesh).T
        places = np.stack([left, np.float32(1.0) - up], axis=1)
        attributes[f"TEXCOORD_{len(attributes)}"] = file.add(places)
    if not (mesh.colors == 1).all():
        if mesh.colors.min() >= 0 and mesh.colors.max() <= 1:
            shorts = np.rint(mesh.colors * 65535).astype(np.uint16)
            attributes["COLOR_0"] = file.add(shorts, normalized=True)
        else:
            attributes["COLOR_0"] = file.add(mesh.colors.astype(np.float32))
    # 0xFFFF would restart the primitive, so it is not used as an index.
    small = len(mesh.positions) <= 0xFFFF
    indices = mesh.triangles.reshape(-1).astype(np.uint16 if small else np.uint32)
    return {"attributes": attributes, "indices": file.add(indices, target=ELEMENT_BUFFER)}


def add_skinned(
    file: GltfFile,
    meshes: Sequence[SkinnedMesh],
    targets: MorphTargets,
    sheet: Sheet | None,
) -> list[dict[str, Any]]:
    """Write meshes in the bind pose with weights and targets; primitives without material."""
    primitives = []
    for mesh, offsets in zip(meshes, targets.offsets, strict=True):
        primitive = add_surface(file, mesh, sheet)
        few = int(mesh.joints.max()) < 256
        primitive["attributes"] |= {
            "POSITION": file.add(mesh.positions.astype(np.float32), bounds=True),
            "NORMAL": file.add(_unit(mesh.normals)),
            "JOINTS_0": file.add(mesh.joints.astype(np.uint8 if few else np.uint16)),
            "WEIGHTS_0": file.add(mesh.weights.astype(np.float32)),
        }
        if offsets:
            primitive["targets"] = [{"POSITION": file.add(o, bounds=True)} for o in offsets]
        primitives.append(primitive)
    return primitives


def add_posed(
    file: GltfFile,
    surface: dict[str, Any],
    places: NDArray[np.float32],
    normals: NDArray[np.float32],
) -> dict[str, Any]:
    """Write one agent's vertices over a surface that agents share; a primitive without material."""
    own = {"POSITION": file.add(places, bounds=True), "NORMAL": file.add(normals)}
    return {**surface, "attributes": surface["attributes"] | own}


def _unit(normals: NDArray[np.float32]) -> NDArray[np.float32]:
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    unit = np.where(length > 1e-12, normals / np.maximum(length, 1e-12), [0.0, 1.0, 0.0])
    return unit.astype(np.float32)
