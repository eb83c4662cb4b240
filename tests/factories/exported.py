"""Readers of exported files that share nothing with what wrote them, and what a crowd shows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pygltflib
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from tifo.engine.crowd.morphs import morphed_positions
from tifo.engine.crowd.physique import seat_lift

Array = NDArray[Any]

_TYPES = {5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class GltfFile:
    """A file as pygltflib reads it, animated and skinned by the rules of the specification."""

    def __init__(self, path: Path) -> None:
        self.gltf: Any = pygltflib.GLTF2().load(str(path))
        uri = self.gltf.buffers[0].uri
        self.binary: bytes = (
            self.gltf.binary_blob() if uri is None else path.with_name(uri).read_bytes()
        )

    def array(self, index: int) -> Array:
        """The values of an accessor (N, n); normalised integers as floats."""
        accessor = self.gltf.accessors[index]
        view = self.gltf.bufferViews[accessor.bufferView]
        dtype = np.dtype(_TYPES[accessor.componentType])
        width = _WIDTH[accessor.type]
        start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
        values = np.frombuffer(self.binary, dtype, accessor.count * width, start)
        values = values.reshape(-1, width)
        return values / float(np.iinfo(dtype).max) if accessor.normalized else values

    def worlds(self, time: float | None = None) -> Array:
        """(nodes, 4, 4) matrices at a time of all animations; None is the file at rest."""
        nodes = self.gltf.nodes
        state = [
            {
                "translation": np.array(node.translation or [0, 0, 0], float),
                "rotation": np.array(node.rotation or [0, 0, 0, 1], float),
                "scale": np.array(node.scale or [1, 1, 1], float),
            }
            for node in nodes
        ]
        if time is not None:
            for animation in self.gltf.animations:
                for channel in animation.channels:
                    sampler = animation.samplers[channel.sampler]
                    assert sampler.interpolation in (None, "LINEAR")
                    times = self.array(sampler.input)[:, 0]
                    keys = self.array(sampler.output).astype(float)
                    at = np.clip(time, times[0], times[-1])
                    first = min(int(np.searchsorted(times, at, "right")) - 1, len(times) - 2)
                    pair = keys[first : first + 2]
                    share = (at - times[first]) / (times[first + 1] - times[first])
                    if channel.target.path == "rotation":
                        value = Slerp([0.0, 1.0], Rotation.from_quat(pair))(share).as_quat()
                    else:
                        value = pair[0] + share * (pair[1] - pair[0])
                    state[channel.target.node][channel.target.path] = value
        worlds = np.empty((len(nodes), 4, 4))

        def visit(index: int, above: Array) -> None:
            local = np.eye(4)
            own = state[index]
            local[:3, :3] = Rotation.from_quat(own["rotation"]).as_matrix() * own["scale"]
            local[:3, 3] = own["translation"]
            worlds[index] = above @ local
            for child in nodes[index].children or []:
                visit(child, worlds[index])

        for root in self.gltf.scenes[0].nodes:
            visit(root, np.eye(4))
        return worlds

    def points(self, name: str, time: float | None = None) -> Array:
        """Vertices of all primitives of the node called `name`, in the scene."""
        return self.all_points([name], time)[0]

    def all_points(self, names: list[str], time: float | None = None) -> list[Array]:
        """The same for several nodes."""
        worlds = self.worlds(time)
        return [self._points(name, worlds) for name in names]

    def _points(self, name: str, worlds: Array) -> Array:
        index = next(k for k, node in enumerate(self.gltf.nodes) if node.name == name)
        node = self.gltf.nodes[index]
        found = []
        mesh = self.gltf.meshes[node.mesh]
        for primitive in mesh.primitives:
            places = self.array(primitive.attributes.POSITION).astype(float)
            for weight, target in zip(mesh.weights or [], primitive.targets or [], strict=True):
                places = places + weight * self.array(target["POSITION"])
            places = np.column_stack([places, np.ones(len(places))])
            if node.skin is None:
                found.append((places @ worlds[index].T)[:, :3])
                continue
            skin = self.gltf.skins[node.skin]
            inverse = self.array(skin.inverseBindMatrices).reshape(-1, 4, 4).transpose(0, 2, 1)
            matrices = np.array([worlds[j] @ i for j, i in zip(skin.joints, inverse, strict=True)])
            joints = self.array(primitive.attributes.JOINTS_0)
            weights = self.array(primitive.attributes.WEIGHTS_0).astype(float)
            blended = np.einsum("vk,vkij->vij", weights, matrices[joints])
            found.append(np.einsum("vij,vj->vi", blended, places)[:, :3])
        return np.concatenate(found)

    def colors(self, name: str) -> dict[str, Array]:
        """Linear RGB of each material of a node's mesh, by the material's name."""
        node = next(node for node in self.gltf.nodes if node.name == name)
        materials = [
            self.gltf.materials[primitive.material]
            for primitive in self.gltf.meshes[node.mesh].primitives
        ]
        return {m.name: np.array(m.pbrMetallicRoughness.baseColorFactor[:3]) for m in materials}


def check_gltf(path: Path) -> None:
    """Assert what the specification asks of buffers and accessors."""
    file = GltfFile(path)
    gltf = file.gltf
    assert gltf.buffers[0].byteLength <= len(file.binary)
    for view in gltf.bufferViews:
        assert view.byteOffset + view.byteLength <= gltf.buffers[0].byteLength
    bounded = {s.input for a in gltf.animations for s in a.samplers}
    for mesh in gltf.meshes:
        targets = {len(primitive.targets or []) for primitive in mesh.primitives}
        assert len(targets) == 1
        for primitive in mesh.primitives:
            bounded.add(primitive.attributes.POSITION)
            bounded |= {target["POSITION"] for target in primitive.targets or []}
            weights = file.array(primitive.attributes.WEIGHTS_0) if _skinned(primitive) else None
            if weights is not None:
                np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-5)
            normals = file.array(primitive.attributes.NORMAL)
            np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-4)
            count = len(file.array(primitive.attributes.POSITION))
            assert file.array(primitive.indices).max() < count
    for index, accessor in enumerate(gltf.accessors):
        view = gltf.bufferViews[accessor.bufferView]
        size = np.dtype(_TYPES[accessor.componentType]).itemsize
        offset = accessor.byteOffset or 0
        assert (view.byteOffset + offset) % size == 0
        assert offset % size == 0
        assert offset + accessor.count * _WIDTH[accessor.type] * size <= view.byteLength
        values = file.array(index)
        if accessor.min:
            np.testing.assert_array_equal(values.min(axis=0), np.float32(accessor.min))
            np.testing.assert_array_equal(values.max(axis=0), np.float32(accessor.max))
        else:
            assert index not in bounded
    for node in gltf.nodes:
        if node.rotation is not None:
            assert abs(np.linalg.norm(node.rotation) - 1.0) < 1e-5


def _skinned(primitive: Any) -> bool:
    return primitive.attributes.WEIGHTS_0 is not None


def worn_meshes(crowd: Any, agent: int, level: int = 0) -> list[Any]:
    """Meshes of a level that an agent of a crowd wears, by what the columns are said to be."""
    choices: dict[str, list[str]] = {}
    for mesh in crowd.character.meshes:
        if mesh.variant is not None:
            known = choices.setdefault(mesh.variant.group, [])
            if mesh.variant.choice not in known:
                known.append(mesh.variant.choice)
    own = {
        group: (known + [None] * 255)[crowd.body.choice[row, agent]]
        for row, (group, known) in enumerate(choices.items())
    }
    return [
        mesh
        for mesh in (crowd.character.meshes, *crowd.character.lower_levels)[level]
        if mesh.variant is None or own[mesh.variant.group] == mesh.variant.choice
    ]


def shown_points(crowd: Any, agent: int, tick: int, alpha: float, level: int = 0) -> Array:
    """Where a crowd's rules put an agent's vertices, in the stadium."""
    ids = np.array([agent])
    palettes = crowd.palettes(ids, tick, alpha)[0].astype(float)
    body, place = crowd.body, crowd.placement
    physique = crowd.physique
    origin = place.position[:, agent].astype(float)
    if physique.seats is not None:
        hips = palettes[physique.hips, 1] @ np.append(physique.hips_bind, 1.0)
        legs = physique.legs[body.kind[ids]]
        origin[1] += seat_lift(np.array([hips]), place.scale[ids], legs, physique.seats)[0]
    yaw, scale = float(place.yaw[agent]), float(place.scale[agent])
    turn = Rotation.from_rotvec([0.0, yaw, 0.0]).as_matrix()
    found = []
    for mesh in worn_meshes(crowd, agent, level):
        bind = morphed_positions(
            mesh, physique.morphs, float(body.girth[agent]), float(body.head[agent])
        )
        rows = np.einsum("vk,vkij->vij", mesh.weights.astype(float), palettes[mesh.joints])
        model = np.einsum("vij,vj->vi", rows[..., :3], bind.astype(float)) + rows[..., 3]
        found.append(origin + scale * model @ turn.T)
    return np.concatenate(found)
