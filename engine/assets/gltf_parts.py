"""Which meshes of a glTF file belong to the character, and what each of them follows."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .character import Variant
from .gltf_accessor import read_floats
from .gltf_binding import Hold
from .gltf_document import GltfDocument
from .gltf_material import MaterialReader
from .gltf_mesh import Primitive, read_primitive
from .gltf_scene import Scene
from .gltf_transforms import FloatArray
from .variants import read_variant


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """A primitive, the node's name, the row of its material, and whom it is drawn on."""

    name: str
    material: int
    primitive: Primitive
    variant: Variant | None = None


@dataclass(slots=True, eq=False)
class Part:
    """Primitives that follow the same joints: all meshes of a skin, or one rigid mesh.

    Parameters
    ----------
    nodes
        (K,) nodes that the primitives' joint indices refer to.
    inverse_binds
        (K, 4, 4) float64: the primitives' space to each node's space.
    skinned
        False for a rigid mesh.
    surfaces
        The primitives; all have influences.
    """

    nodes: NDArray[np.int64]
    inverse_binds: FloatArray
    skinned: bool
    surfaces: list[Surface] = field(default_factory=list)

    def used(self) -> NDArray[np.int64]:
        """Which of the K nodes weigh on some vertex."""
        return np.unique(np.concatenate([joints.ravel() for _, joints, _ in self._influences()]))

    def hold(self) -> Hold:
        """What the used nodes carry."""
        count = len(self.nodes)
        mass, sums = np.zeros(count), np.zeros((count, 3))
        for positions, joints, weights in self._influences():
            mass += np.bincount(joints.ravel(), weights.ravel(), count)
            for axis in range(3):
                moments = weights * positions[:, axis, None]
                sums[:, axis] += np.bincount(joints.ravel(), moments.ravel(), count)
        everything = np.concatenate([positions for positions, _, _ in self._influences()])
        low, high = everything.min(axis=0), everything.max(axis=0)
        corners = np.array(
            [np.where([k & 1, k & 2, k & 4], high, low) for k in range(8)], dtype=np.float64
        )
        used = self.used()
        return Hold(
            nodes=self.nodes[used],
            inverse_binds=self.inverse_binds[used],
            mass=mass[used],
            centroids=sums[used] / np.maximum(mass[used], 1e-30)[:, None],
            corners=corners,
        )

    def _influences(self) -> list[tuple[FloatArray, NDArray[np.int64], FloatArray]]:
        return [
            (primitive.positions, primitive.joints, primitive.weights)
            for primitive in (surface.primitive for surface in self.surfaces)
            if primitive.joints is not None and primitive.weights is not None
        ]


class PartReader:
    """Collects the parts of the shown nodes.

    Parameters
    ----------
    document
        The file.
    scene
        Its nodes.
    materials
        Takes the materials that the parts use.
    notes
        Takes what was dropped.
    """

    def __init__(
        self, document: GltfDocument, scene: Scene, materials: MaterialReader, notes: list[str]
    ) -> None:
        """Start with nothing read."""
        self._document = document
        self._scene = scene
        self._materials = materials
        self._notes = notes
        self._primitives: dict[int, list[tuple[int, Primitive]]] = {}

    def read(self, animated: set[int]) -> list[Part]:
        """Read all parts, skinned ones first.

        Parameters
        ----------
        animated
            Nodes that a clip moves.

        Returns
        -------
        list of Part
            In a file with skins, unskinned meshes that are neither on nor below a joint or an
            animated node are left out: they are stages and ground planes. In a file without skins
            everything that is shown belongs to the character.

        Raises
        ------
        AssetError
            For anything that contradicts the format, and for joint indices out of range.
        """
        skins = {
            index: self._read_skin(index) for index in range(len(self._document.items("skins")))
        }
        rigid: dict[int, Part] = {}
        for node in self._scene.shown:
            fields = self._document.items("nodes")[node]
            mesh = fields.index("mesh", len(self._document.items("meshes")))
            skin = fields.index("skin", len(skins))
            if mesh is None:
                continue
            variant = read_variant(fields) or read_variant(self._document.items("meshes")[mesh])
            for material, primitive in self._mesh(mesh):
                name = fields.text("name") or self._mesh_name(mesh)
                if skin is not None and primitive.joints is not None:
                    self._check_joints(mesh, skins[skin], primitive)
                    skins[skin].surfaces.append(Surface(name, material, primitive, variant))
                else:
                    part = rigid.setdefault(node, Part(np.array([node]), np.eye(4)[None], False))
                    part.surfaces.append(Surface(name, material, _rigid(primitive), variant))
        skinned = [part for part in skins.values() if part.surfaces]
        joints = {node for part in skinned for node in part.nodes.tolist()}
        return skinned + self._kept(rigid, joints | animated if joints else set(rigid))

    def _kept(self, rigid: dict[int, Part], moving: set[int]) -> list[Part]:
        """Rigid parts on or below a moving node."""
        moved = set(moving)
        for node in self._scene.order:
            if self._scene.parents[node] in moved:
                moved.add(node)
        for node, part in rigid.items():
            if node not in moved:
                self._notes.append(
                    f"Mesh '{part.surfaces[0].name}' is neither skinned nor below a joint and is "
                    "left out."
                )
        return [part for node, part in rigid.items() if node in moved]

    def _read_skin(self, index: int) -> Part:
        fields = self._document.items("skins")[index]
        nodes = fields.indices("joints", len(self._document.items("nodes")))
        if not nodes:
            fields.fail("joints", "is empty, but a skin needs joints")
        accessor = fields.index("inverseBindMatrices", len(self._document.items("accessors")))
        inverse_binds = np.repeat(np.eye(4)[None], len(nodes), axis=0)
        if accessor is not None:
            values = read_floats(self._document, accessor, "MAT4")
            if len(values) < len(nodes):
                fields.fail(
                    "inverseBindMatrices", f"has {len(values)} matrices for {len(nodes)} joints"
                )
            inverse_binds = values[: len(nodes)].reshape(-1, 4, 4).transpose(0, 2, 1)
            if np.abs(inverse_binds[:, 3] - (0, 0, 0, 1)).max() > 1e-3:
                fields.fail("inverseBindMatrices", "has a projection, not a transform")
        return Part(np.array(nodes, dtype=np.int64), inverse_binds, True)

    def _mesh(self, index: int) -> list[tuple[int, Primitive]]:
        """Row of the material and primitive, for each primitive that can be drawn."""
        if index not in self._primitives:
            found = []
            for fields in self._document.items("meshes")[index].children("primitives"):
                material = fields.index("material", len(self._document.items("materials")))
                coordinates = self._materials.coordinates(material)
                primitive = read_primitive(self._document, fields, coordinates, self._notes)
                if primitive is not None:
                    found.append((self._materials.row(material), primitive))
            self._primitives[index] = found
        return self._primitives[index]

    def _mesh_name(self, index: int) -> str:
        return self._document.items("meshes")[index].text("name") or f"mesh {index}"

    def _check_joints(self, mesh: int, skin: Part, primitive: Primitive) -> None:
        if primitive.joints is not None and primitive.joints.max() >= len(skin.nodes):
            self._document.fail(
                f"meshes[{mesh}]",
                f"a vertex follows joint {primitive.joints.max()}, but its skin has "
                f"{len(skin.nodes)} joints",
            )


def _rigid(primitive: Primitive) -> Primitive:
    """Return the primitive with all vertices on one joint."""
    count = len(primitive.positions)
    return Primitive(
        positions=primitive.positions,
        normals=primitive.normals,
        uvs=primitive.uvs,
        colors=primitive.colors,
        joints=np.zeros((count, 4), dtype=np.int64),
        weights=np.tile((1.0, 0.0, 0.0, 0.0), (count, 1)),
        triangles=primitive.triangles,
    )
