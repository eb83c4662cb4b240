"""Recordings as glTF 2.0: skinned agents with their motion, or the surface of one moment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .gltf_body import (
    add_posed,
    add_skinned,
    add_surface,
    body_meshes,
    worn_triangles,
    worn_vertices,
)
from .gltf_file import KINDS, GltfFile, exact
from .local_motion import SHORT, local_motion
from .morph_targets import morph_targets
from .paints import mix_paints
from .recording import Recording
from .rig import Rig, factors, levers, make_rig, reach
from .shirts import lay_sheet
from .targets import Exported, Progress, check_size, check_target

STILL = 1.5e-5
"""Share of the height by which joints may be off their place, if they need no keys then."""
UNSEEN = 3e-5
"""Share of the height by which skin may be off its place before a bone gets a stretch."""
MOST_NODES = 2_000_000
_MATRICES_AT_ONCE = 100_000

_NEUTRAL = {"translation": (0.0, 0.0, 0.0), "rotation": (0.0, 0.0, 0.0, 1.0), "scale": (1, 1, 1)}


def write_gltf(
    recording: Recording,
    path: str | Path,
    *,
    level: int = 0,
    rigid: bool = False,
    split: bool = False,
    progress: Progress | None = None,
) -> Exported:
    """Write skinned agents to a .glb or .gltf file.

    Agents that wear the same meshes share their vertices; each has a skeleton, its colours, its
    weights of the morph targets and, if the recording has several frames, its keys.

    Parameters
    ----------
    recording, path
        What is written, and where.
    level
        Level of detail of the meshes.
    rigid
        Whether stretch is left out, so that a skeleton has bones only; see docs/export.md.
    split
        Whether each agent has an animation of its own, instead of one that moves all.
    progress
        Called after every agent.

    Returns
    -------
    Exported

    Raises
    ------
    AssetError
        If the file can't be written or would be too large.
    ValueError
        For a level that doesn't exist.
    """
    target = check_target(path, KINDS)
    meshes = body_meshes(recording, level)
    skeleton = recording.character.skeleton
    least = len(recording) * (2 + skeleton.joint_count)
    if least > MOST_NODES:
        raise ValueError(
            f"{len(recording):,} agents need {least:,} nodes, at most {MOST_NODES:,} are written; "
            "export fewer, or their surface (baked)"
        )
    file = GltfFile(recording.character.name)
    targets = morph_targets(recording, meshes)
    paints, chosen = mix_paints(recording, meshes)
    sheet = lay_sheet(recording, meshes)
    file.add_materials(paints, recording.character.materials, sheet)
    primitives = dict(enumerate(add_skinned(file, meshes, targets, sheet)))
    inverse = np.tile(np.eye(4, dtype=np.float32), (skeleton.joint_count, 1, 1))
    inverse[:, :3] = skeleton.inverse_bind
    bind = file.add(inverse.transpose(0, 2, 1), target=None)
    times = np.arange(recording.frames) / recording.fps
    moving = recording.frames > 1
    clock = file.add_keys(times.astype(np.float32), bounds=True) if moving else -1
    far = reach(skeleton, meshes)
    lever = levers(skeleton, far)
    stretched, deviation = 0, 0.0
    animation: dict[str, Any] = {"name": "crowd", "samplers": [], "channels": []}
    step = max(1, _MATRICES_AT_ONCE // (recording.frames * skeleton.joint_count))
    for first in range(0, len(recording), step):
        found = factors(skeleton, recording.palettes[:, first : first + step])
        off = found.deviation(far)
        needs: NDArray[np.bool_] = np.logical_and(off > UNSEEN * recording.height, not rigid)
        deviation = max(deviation, float(np.where(needs, 0.0, off).max()))
        whole = make_rig(skeleton, np.logical_or.reduce(needs))
        still = STILL * recording.height
        motion = local_motion(skeleton, whole, found, lever, still, short=moving)
        stretched += int(needs.any(axis=1).sum())
        # Agents whose bones need the same have the same rig, which is a part of the whole one.
        masks, kind = np.unique(needs, axis=0, return_inverse=True)
        rigs = [(rig := make_rig(skeleton, mask), whole.part(rig)) for mask in masks]
        for place, number in enumerate(kind.ravel().tolist()):
            k, (rig, part) = first + place, rigs[number]
            if split:
                name = f"agent {recording.agents[k]}"
                animation = {"name": name, "samplers": [], "channels": []}
            body = _add_agent(file, recording, k, animation, clock)
            joints = _add_joints(file, rig, motion.of(place, part), animation, clock)
            file.nodes[body]["children"] = joints[rig.parents < 0].tolist()
            file.skins.append({"joints": joints[rig.skin].tolist(), "inverseBindMatrices": bind})
            file.roots.append(body)
            if (mesh := _mesh(recording, k, primitives, chosen[k])) is not None:
                node = {"name": mesh["name"], "mesh": len(file.meshes)}
                node["skin"] = len(file.skins) - 1
                if targets.names:
                    mesh["weights"] = exact(targets.weights[k])
                    mesh["extras"] = {"targetNames": list(targets.names)}
                file.meshes.append(mesh)
                file.roots.append(file.add_node(node))
            if split and animation["channels"]:
                file.animations.append(animation)
            if progress is not None:
                progress("agents", len(file.skins), len(recording))
    if moving and not split:
        if not animation["channels"]:
            # A file needs a channel; one that stays keeps the duration.
            _add_channel(
                file, animation, clock, file.roots[0], "translation", recording.position[:, 0]
            )
        file.animations.append(animation)
    size = file.write(target)
    triangles = worn_triangles(recording, meshes)
    return Exported(target, size, len(recording), recording.frames, triangles, stretched, deviation)


def write_baked_gltf(
    recording: Recording,
    path: str | Path,
    *,
    level: int = 0,
    progress: Progress | None = None,
) -> Exported:
    """Write the surface of agents at one moment to a .glb or .gltf file, without skeletons.

    Triangles, texture coordinates and vertex colours are shared.

    Parameters
    ----------
    recording
        Of one frame.
    path, level, progress
        As for `write_gltf`.

    Raises
    ------
    AssetError
        If the file can't be written or would be too large.
    ValueError
        For several frames, or a level that doesn't exist.
    """
    target = check_target(path, KINDS)
    if recording.frames != 1:
        raise ValueError(
            f"the recording has {recording.frames} frames, but baked glTF holds one moment; "
            "take recording.frame(number), or write USD"
        )
    meshes = body_meshes(recording, level)
    vertices = worn_vertices(recording, meshes)
    check_size(target, vertices * 24, "export fewer agents, or a coarser level")
    file = GltfFile(recording.character.name)
    paints, chosen = mix_paints(recording, meshes)
    sheet = lay_sheet(recording, meshes)
    file.add_materials(paints, recording.character.materials, sheet)
    surfaces = [add_surface(file, mesh, sheet) for mesh in meshes]
    worn = recording.worn(meshes)
    for k in range(len(recording)):
        primitives = {
            number: add_posed(file, surfaces[number], *recording.skinned(meshes[number], k, 0))
            for number in np.flatnonzero(worn[k]).tolist()
        }
        body = _add_agent(file, recording, k, None, -1)
        if (mesh := _mesh(recording, k, primitives, chosen[k])) is not None:
            file.nodes[body]["mesh"] = len(file.meshes)
            file.meshes.append(mesh)
        file.roots.append(body)
        if progress is not None:
            progress("agents", k + 1, len(recording))
    size = file.write(target)
    return Exported(target, size, len(recording), 1, worn_triangles(recording, meshes))


def _mesh(
    recording: Recording,
    k: int,
    primitives: Mapping[int, dict[str, Any]],
    paints: NDArray[np.int64],
) -> dict[str, Any] | None:
    """What an agent wears of some primitives, in its colours; None if that is nothing."""
    own = [
        primitives[number] | {"material": int(paints[number])}
        for number in np.flatnonzero(paints >= 0).tolist()
    ]
    return {"name": f"body {recording.agents[k]}", "primitives": own} if own else None


def _add_agent(
    file: GltfFile,
    recording: Recording,
    k: int,
    animation: dict[str, Any] | None,
    clock: int,
) -> int:
    """The node that places an agent in the stadium."""
    half = 0.5 * recording.yaw[:, k].astype(np.float64)
    turn = np.zeros((recording.frames, 4), np.float32)
    turn[:, 1], turn[:, 3] = np.sin(half), np.cos(half)
    scale = np.repeat(recording.scale[:, k, None], 3, axis=1)
    label = recording.labels[k]
    node: dict[str, Any] = {
        "name": f"agent {recording.agents[k]}",
        "extras": {"agent": int(recording.agents[k]), "seat": label},
    }
    index = file.add_node(node)
    for path, values in (
        ("translation", recording.position[:, k]),
        ("rotation", turn),
        ("scale", scale),
    ):
        _transform(file, [index], path, values[:, None], animation, clock)
    return index


def _add_joints(
    file: GltfFile,
    rig: Rig,
    motion: Mapping[str, NDArray[np.float32]],
    animation: dict[str, Any],
    clock: int,
) -> NDArray[np.int64]:
    """Nodes of a skeleton's joints, which move by (T, R, n) of each path; their indices (R,)."""
    joints = np.arange(len(rig)) + len(file.nodes)
    for name in rig.names:
        file.add_node({"name": name})
    indices = joints.tolist()
    for index, parent in zip(indices, rig.parents.tolist(), strict=True):
        if parent >= 0:
            file.nodes[indices[parent]].setdefault("children", []).append(index)
    for path, values in motion.items():
        _transform(file, indices, path, values, animation, clock)
    return joints


def _transform(
    file: GltfFile,
    nodes: Sequence[int],
    path: str,
    values: NDArray[np.float32],
    animation: dict[str, Any] | None,
    clock: int,
) -> None:
    """Give R nodes a transform (T, R, n): where it begins, and keys if it changes."""
    first, width = values[0], values.shape[2]
    set_off = np.flatnonzero((first != np.array(_NEUTRAL[path], np.float32)).any(axis=1))
    begin = first[set_off]
    if path == "rotation":
        # Rotations that keys hold as integers are not quite of length 1.
        begin = begin / np.linalg.norm(begin, axis=1, keepdims=True)
    numbers = exact(begin.ravel())
    for place, node in enumerate(set_off.tolist()):
        file.nodes[nodes[node]][path] = numbers[place * width : (place + 1) * width]
    if animation is not None:
        for node in np.flatnonzero((values != first).any(axis=(0, 2))).tolist():
            _add_channel(file, animation, clock, nodes[node], path, values[:, node])


def _add_channel(
    file: GltfFile,
    animation: dict[str, Any],
    clock: int,
    node: int,
    path: str,
    values: NDArray[np.float32],
) -> None:
    target = {"node": node, "path": path}
    animation["channels"].append({"sampler": len(animation["samplers"]), "target": target})
    keys = np.rint(values * SHORT).astype(np.int16) if path == "rotation" else values
    animation["samplers"].append({"input": clock, "output": file.add_keys(keys)})
