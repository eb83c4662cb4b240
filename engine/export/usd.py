"""Recordings as USD: skinned agents that share meshes and skeletons, or points at each frame."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..assets.character import SkinnedMesh
from ..crowd.regions import SURFACES
from ..errors import AssetError
from .gltf import STILL, UNSEEN
from .gltf_body import body_meshes, worn_triangles, worn_vertices
from .local_motion import local_motion
from .morph_targets import MorphTargets, morph_targets
from .pixels import to_linear
from .recording import Recording
from .rig import Rig, factors, levers, make_rig, reach
from .targets import Exported, Progress, check_size, check_target, replacing
from .usd_body import (
    add_material,
    add_mesh,
    add_skeleton,
    add_skinned_mesh,
    bind_joints,
    bind_shades,
    joint_paths,
    primvar_of,
    set_display_color,
    set_points,
    split_by_shade,
    write_images,
)
from .usd_layer import KINDS, Layer, identifiers, import_pxr
from .usd_shirts import ShirtMaterials

__all__ = ["KINDS", "check_usd", "write_usd"]

ROOT = "/Crowd"
PROTOTYPES = "/Prototypes"
_MATERIALS = f"{PROTOTYPES}/Materials"
_MATRICES_AT_ONCE = 100_000
_OPERATIONS = ("xformOp:translate", "xformOp:rotateY", "xformOp:scale")


def check_usd(path: str | Path) -> None:
    """AssetError if usd-core is missing."""
    try:
        import_pxr()
    except ImportError as error:
        raise AssetError(
            path, "", "can't be written without usd-core; pip install 'tifo[usd]'"
        ) from error


def write_usd(
    recording: Recording,
    path: str | Path,
    *,
    level: int = 0,
    baked: bool = False,
    rigid: bool = False,
    instances: bool = True,
    progress: Progress | None = None,
) -> Exported:
    """Write agents to a .usd, .usda or .usdc file.

    Parameters
    ----------
    recording, path
        What is written, and where; pictures of materials and patterns are written beside
        the file.
    level
        Level of detail of the meshes.
    baked
        Whether points at each frame are written instead of skeletons and skins.
    rigid
        Whether stretch is left out, so that a skeleton has bones only; see docs/export.md.
    instances
        Whether skinned agents are instances of their look's prototype, with colours as primvars.
    progress
        Called after every agent.

    Returns
    -------
    Exported

    Raises
    ------
    AssetError
        If usd-core is missing, or the file can't be written or would be too large.
    ValueError
        For a level that doesn't exist.
    """
    target = check_target(path, KINDS)
    check_usd(path)
    meshes = body_meshes(recording, level)
    writer = _Writer(recording, meshes, target, progress)
    stretched, deviation = 0, 0.0
    if baked:
        size = recording.frames * worn_vertices(recording, meshes) * 24
        check_size(target, size, "export fewer agents, a shorter time, or a coarser level")
        writer.add_baked()
    else:
        stretched, deviation = writer.add_skinned(rigid=rigid, instances=instances)
    with replacing(target) as part:
        writer.layer.write(part)
        size = part.stat().st_size
    images = (*writer.images.values(), *writer.shirts.images.values())
    size += sum((target.parent / name).stat().st_size for name in images)
    triangles = worn_triangles(recording, meshes)
    count, frames = len(recording), recording.frames
    return Exported(target, size, count, frames, triangles, stretched, deviation)


class _Writer:
    """One file that is being written."""

    def __init__(
        self,
        recording: Recording,
        meshes: tuple[SkinnedMesh, ...],
        path: Path,
        progress: Progress | None,
    ) -> None:
        self.recording, self.meshes = recording, meshes
        self.layer = Layer(recording.fps, recording.frames)
        self.images = write_images(
            path, recording.character.materials, {mesh.material for mesh in meshes}
        )
        self.shirts = ShirtMaterials(self.layer, f"{ROOT}/Shirts", recording, meshes, path)
        self._names = identifiers(tuple(mesh.name for mesh in meshes))
        self._worn = recording.worn(meshes)
        # Shirts of one look are all plain, or have each a pattern of their own.
        shirts = np.array([self.shirts.covers(mesh) for mesh in meshes], np.bool_)
        self._patterned: NDArray[np.bool_] = recording.patterned & self._worn[:, shirts].any(axis=1)
        own = np.column_stack([self._worn, self._patterned])
        _, looks = np.unique(own, axis=0, return_inverse=True)
        self._looks: NDArray[np.intp] = looks.ravel()
        self._progress = progress
        root = self.layer.prim(ROOT, "Xform")
        root.kind = "assembly"
        self.layer.layer.defaultPrim = ROOT.lstrip("/")
        self.layer.prim(PROTOTYPES, "Scope", abstract=True)

    def add_skinned(self, *, rigid: bool, instances: bool) -> tuple[int, float]:
        """Write agents with skeletons; how many can stretch, and the largest deviation."""
        recording, skeleton = self.recording, self.recording.character.skeleton
        targets = morph_targets(recording, self.meshes)
        far = reach(skeleton, self.meshes)
        lever = levers(skeleton, far)
        step = max(1, _MATRICES_AT_ONCE // (recording.frames * skeleton.joint_count))
        starts = range(0, len(recording), step)
        chunks = [recording.palettes[:, first : first + step] for first in starts]
        off = np.concatenate(
            [factors(skeleton, chunk, np.float16).deviation(far) for chunk in chunks]
        )
        needs = np.logical_and(off > UNSEEN * recording.height, not rigid)
        # Two skeletons: one for those whose bones are enough, one in which bones can stretch.
        stretched: NDArray[np.bool_] = np.any(needs, axis=1)
        union: NDArray[np.bool_] = np.any(needs, axis=0)
        rigs = {
            False: make_rig(skeleton, np.zeros(skeleton.joint_count, np.bool_)),
            True: make_rig(skeleton, union),
        }
        self._add_shared(targets, own_colors=instances)
        for can in sorted(set(stretched.tolist())):
            self._add_rig(can, rigs[can])
        # A prototype is a look: all who wear the same meshes over the same skeleton share it.
        for look, can in sorted(set(zip(self._looks.tolist(), stretched.tolist(), strict=True))):
            self._add_prototype(look, can, own_colors=instances)
        self.layer.prim(f"{ROOT}/Motions", "Scope")
        for first, chunk in zip(starts, chunks, strict=True):
            found = factors(skeleton, chunk, np.float16)
            for can, rig in rigs.items():
                members = np.flatnonzero(stretched[first : first + step] == can)
                if not len(members):
                    continue
                motion = local_motion(
                    skeleton,
                    rig,
                    found.of(members),
                    lever,
                    STILL * recording.height,
                    np.float16,
                )
                for place, member in enumerate(members):
                    k = first + int(member)
                    channels = (motion.translation, motion.rotation, motion.scale)
                    one = tuple(channel[:, place] for channel in channels)
                    self._add_agent(k, can, rig, one, targets, instances=instances)
        left = np.where(stretched[:, None] & union, 0.0, off)
        return int(stretched.sum()), float(left.max())

    def add_baked(self) -> None:
        """Write agents as points."""
        layer, recording = self.layer, self.recording
        folder = f"{PROTOTYPES}/Body"
        layer.prim(folder, "Xform")
        self._add_materials(f"{ROOT}/Materials", own_colors=False)
        for name, mesh in zip(self._names, self.meshes, strict=True):
            self.shirts.add_coordinates(add_mesh(layer, f"{folder}/{name}", mesh), mesh)
        for k in range(len(recording)):
            path = self._agent_path(k)
            prim = layer.prim(path, "Xform")
            self._place(prim, k)
            for number in np.flatnonzero(self._worn[k]).tolist():
                name, mesh = self._names[number], self.meshes[number]
                body = layer.prim(f"{path}/{name}", "Mesh", apis=("MaterialBindingAPI",))
                layer.refer(body, f"{folder}/{name}")
                frames = [recording.skinned(mesh, k, f) for f in range(recording.frames)]
                points, normals = (np.stack(part) for part in zip(*frames, strict=True))
                set_points(layer, body, points, normals)
                self._paint(body, k, number)
            self._count(k)

    def _add_shared(self, targets: MorphTargets, *, own_colors: bool) -> None:
        """Write the meshes of all looks over the skeleton without stretch, and the materials."""
        layer = self.layer
        materials = _MATERIALS if own_colors else f"{ROOT}/Materials"
        self._add_materials(materials, own_colors=own_colors)
        layer.prim(_meshes(False), "Scope")
        for number, (name, mesh) in enumerate(zip(self._names, self.meshes, strict=True)):
            path = f"{_meshes(False)}/{name}"
            body = add_skinned_mesh(layer, path, mesh, targets.names, targets.offsets[number])
            self.shirts.add_coordinates(body, mesh)
            if own_colors:
                material = self.recording.character.materials[mesh.material]
                set_display_color(layer, body, mesh, np.array(material.base_color[:3]))
                split_by_shade(layer, path, mesh)

    def _add_rig(self, can: bool, rig: Rig) -> None:
        """Write a skeleton, and the meshes over it if it has further joints."""
        layer = self.layer
        add_skeleton(layer, _skeleton(can), self.recording.character.skeleton, rig)
        if not can:
            return
        layer.prim(_meshes(can), "Scope")
        for name, mesh in zip(self._names, self.meshes, strict=True):
            prim = layer.prim(f"{_meshes(can)}/{name}", "Mesh")
            layer.refer(prim, f"{_meshes(False)}/{name}")
            bind_joints(layer, prim, rig.skin[mesh.joints])

    def _add_prototype(self, look: int, can: bool, *, own_colors: bool) -> None:
        layer, path = self.layer, _prototype(look, can)
        prim = layer.prim(path, "SkelRoot", apis=("SkelBindingAPI",))
        layer.relate(prim, "skel:skeleton", f"{path}/Skeleton")
        layer.set(prim, "extent", "float3[]", layer.extent(self._reachable))
        layer.refer(layer.prim(f"{path}/Skeleton", "Skeleton"), _skeleton(can))
        if own_colors:
            layer.refer(layer.prim(f"{path}/Materials", "Scope"), _MATERIALS)
        wearer = int(np.flatnonzero(self._looks == look)[0])
        for number in np.flatnonzero(self._worn[wearer]).tolist():
            name, mesh = self._names[number], self.meshes[number]
            prim = layer.prim(f"{path}/{name}", "Mesh")
            layer.refer(prim, f"{_meshes(can)}/{name}")
            if own_colors:
                light, dark = (
                    f"{path}/{one.removeprefix(f'{PROTOTYPES}/')}"
                    for one in self._material(_MATERIALS, mesh)
                )
                # What each wearer's prim is bound to counts where nothing below it is.
                own = self._patterned[wearer] and self.shirts.covers(mesh)
                bind_shades(layer, f"{path}/{name}", mesh, None if own else light, dark)

    @cached_property
    def _reachable(self) -> NDArray[np.float32]:
        """Corners of a box in which agents stay: the palettes' effect on the bind pose's box."""
        points = np.concatenate([mesh.positions for mesh in self.meshes])
        low, high = points.min(axis=0), points.max(axis=0)
        middle, radius = 0.5 * (low + high), 0.75 * float(np.linalg.norm(high - low))
        places = self.recording.palettes[..., 3] + np.einsum(
            "tkjab,b->tkja", self.recording.palettes[..., :3], middle
        )
        corners = [places.min(axis=(0, 1, 2)) - radius, places.max(axis=(0, 1, 2)) + radius]
        return np.stack(corners).astype(np.float32)

    def _add_materials(self, folder: str, *, own_colors: bool) -> None:
        """Write the materials of all meshes, and for own colours those of dark faces."""
        self.layer.prim(folder, "Scope")
        materials = self.recording.character.materials
        for number in sorted({mesh.material for mesh in self.meshes}):
            material, image = materials[number], self.images.get(number)
            own = own_colors and material.name in SURFACES and image is None
            primvar = primvar_of(material.name) if own else "displayColor"
            path = f"{folder}/{self._material_name(number)}"
            add_material(self.layer, path, material, primvar, image)
            if own:
                add_material(self.layer, f"{path}_dark", material, "displayColor", None)

    def _material(self, folder: str, mesh: SkinnedMesh) -> tuple[str, str]:
        """Paths of a mesh's material for light and for dark faces."""
        path = f"{folder}/{self._material_name(mesh.material)}"
        dark = f"{path}_dark"
        return path, dark if self.layer.layer.GetPrimAtPath(dark) is not None else path

    def _material_name(self, number: int) -> str:
        names = tuple(material.name for material in self.recording.character.materials)
        return identifiers(names)[number]

    def _add_agent(
        self,
        k: int,
        can: bool,
        rig: Rig,
        motion: tuple[NDArray[np.float32], ...],
        targets: MorphTargets,
        *,
        instances: bool,
    ) -> None:
        layer, path = self.layer, self._agent_path(k)
        moves = f"{ROOT}/Motions/{path.rpartition('/')[2]}"
        animation = layer.prim(moves, "SkelAnimation")
        layer.set(animation, "joints", "token[]", layer.tokens(joint_paths(rig)), uniform=True)
        translation, rotation, scale = motion
        shifts = [layer.vectors(frame) for frame in translation]
        layer.animate(animation, "translations", "float3[]", shifts)
        layer.animate(animation, "rotations", "quatf[]", [layer.turns(f) for f in rotation])
        sizes = [layer.vectors(frame.astype(np.float16)) for frame in scale]
        layer.animate(animation, "scales", "half3[]", sizes)
        if targets.names:
            layer.set(
                animation, "blendShapes", "token[]", layer.tokens(targets.names), uniform=True
            )
            weights = layer.floats(targets.weights[k])
            layer.set(animation, "blendShapeWeights", "float[]", weights)
        own = instances and bool(self._patterned[k])
        apis = ("SkelBindingAPI", *(("MaterialBindingAPI",) if own else ()))
        prim = layer.prim(path, "SkelRoot", apis=apis)
        layer.refer(prim, _prototype(int(self._looks[k]), can), instance=instances)
        layer.relate(prim, "skel:animationSource", moves)
        self._place(prim, k)
        if own:
            layer.relate(prim, "material:binding", self.shirts.material(k))
        if instances:
            for surface, rgb in zip(SURFACES, self.recording.colors[k], strict=True):
                color = layer.pxr.Gf.Vec3f(*to_linear(rgb).tolist())
                layer.primvar(prim, primvar_of(surface), "color3f", color, "constant")
        else:
            for number in np.flatnonzero(self._worn[k]).tolist():
                self._paint(layer.over(f"{path}/{self._names[number]}"), k, number)
        self._count(k)

    def _paint(self, prim: Any, k: int, number: int) -> None:
        """Give one mesh of an agent its colours and material."""
        mesh = self.meshes[number]
        material = self.recording.character.materials[mesh.material]
        rgb = np.array(material.base_color[:3])
        if material.name in SURFACES:
            rgb = to_linear(self.recording.colors[k, SURFACES.index(material.name)])
        set_display_color(self.layer, prim, mesh, rgb)
        if self._patterned[k] and self.shirts.covers(mesh):
            path = self.shirts.material(k)
        else:
            path, _ = self._material(f"{ROOT}/Materials", mesh)
        self.layer.relate(prim, "material:binding", path)

    def _agent_path(self, k: int) -> str:
        return f"{ROOT}/agent_{self.recording.agents[k]}"

    def _place(self, prim: Any, k: int) -> None:
        """Place an agent in the stadium."""
        layer, recording = self.layer, self.recording
        gf = layer.pxr.Gf
        places = [gf.Vec3d(*map(float, p)) for p in recording.position[:, k]]
        turns = [float(angle) for angle in np.degrees(recording.yaw[:, k], dtype=np.float64)]
        sizes = [gf.Vec3f(float(s)) for s in recording.scale[:, k]]
        layer.animate(prim, _OPERATIONS[0], "double3", places)
        layer.animate(prim, _OPERATIONS[1], "float", turns)
        layer.animate(prim, _OPERATIONS[2], "float3", sizes)
        order = layer.tokens(_OPERATIONS)
        layer.set(prim, "xformOpOrder", "token[]", order, uniform=True)
        seat = {"agent": int(recording.agents[k]), "seat": recording.labels[k]}
        for name, value in seat.items():
            prim.customData[name] = value

    def _count(self, k: int) -> None:
        if self._progress is not None:
            self._progress("agents", k + 1, len(self.recording))


def _prototype(look: int, can: bool) -> str:
    """Path of a look's prototype whose bones can stretch, or can't."""
    return f"{PROTOTYPES}/{'StretchedBody' if can else 'Body'}_{look}"


def _meshes(can: bool) -> str:
    return f"{PROTOTYPES}/{'StretchedMeshes' if can else 'Meshes'}"


def _skeleton(can: bool) -> str:
    return f"{PROTOTYPES}/{'StretchedSkeleton' if can else 'Skeleton'}"
