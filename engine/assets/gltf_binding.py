"""One bind pose for all skins and rigid meshes of a glTF file.

A glTF skin says where its mesh's own space lies in each joint's space, and every skin may choose
another mesh space. A `Skeleton` has one inverse bind matrix a joint, from model space. So the
vertices of each mesh are moved, once, by the constant matrix that makes its inverse binds those of
the skeleton; where no such matrix exists, the joint is duplicated.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .gltf_transforms import FloatArray, is_invertible

TOLERANCE = 2e-5
"""Relative difference up to which two places of a mesh in a joint's space are the same."""

MOST_CANDIDATES = 128
"""Joints that compete for the place of a first mesh, those that hold the most weight."""

MOST_SHARED = 16
"""Joints tried to find how a further mesh lies to what is bound, the heaviest first."""


class Hold(NamedTuple):
    """What a mesh, or all meshes of one skin, asks of the joints.

    Parameters
    ----------
    nodes
        (K,) nodes that weigh on some vertex.
    inverse_binds
        (K, 4, 4) float64: mesh space to each node's space.
    mass
        (K,) sum of the weights of each node.
    centroids
        (K, 3) mean position that each node weighs on, in mesh space.
    corners
        (8, 3) of the box around the vertices, in mesh space.
    """

    nodes: NDArray[np.int64]
    inverse_binds: FloatArray
    mass: FloatArray
    centroids: FloatArray
    corners: FloatArray


@dataclass(slots=True, eq=False)
class Joint:
    """A joint in the making: a node, or a copy below it with another inverse bind matrix."""

    node: int
    original: int
    inverse_bind: FloatArray | None = None


@dataclass(slots=True, eq=False)
class Binding:
    """Assigns inverse bind matrices to nodes, one mesh after another.

    Parameters
    ----------
    world
        (N, 4, 4) float64 model-space matrices of the file's nodes at rest.
    nodes
        Nodes that become joints.
    """

    world: FloatArray
    nodes: list[int]
    joints: list[Joint] = field(init=False)
    _of_node: dict[int, list[int]] = field(init=False)

    def __post_init__(self) -> None:
        """Make one joint of every node."""
        self.joints = [Joint(node, row) for row, node in enumerate(self.nodes)]
        self._of_node = {node: [row] for row, node in enumerate(self.nodes)}

    def bind(self, hold: Hold) -> tuple[FloatArray, NDArray[np.int64]]:
        """Bind a mesh.

        Parameters
        ----------
        hold
            Its joints and how it lies in their spaces.

        Returns
        -------
        tuple
            (4, 4) float64 matrix from mesh space to model space of the bind pose, and (K,) the row
            in `joints` for each of the mesh's nodes.
        """
        place = self._place(hold)
        inverse = np.linalg.inv(place)
        rows = np.empty(len(hold.nodes), dtype=np.int64)
        for k, node in enumerate(hold.nodes.tolist()):
            wanted = hold.inverse_binds[k]
            for row in self._of_node[node]:
                joint = self.joints[row]
                if joint.inverse_bind is None:
                    joint.inverse_bind = wanted @ inverse
                if _agree(joint.inverse_bind @ place, wanted, hold.corners):
                    rows[k] = row
                    break
            else:
                rows[k] = len(self.joints)
                self._of_node[node].append(len(self.joints))
                self.joints.append(Joint(node, self._of_node[node][0], wanted @ inverse))
        return place, rows

    def _place(self, hold: Hold) -> FloatArray:
        """Find the matrix that brings the mesh to the bind pose of what is bound already."""
        best: FloatArray | None = None
        most = 0.0
        shared = [
            k
            for k in np.argsort(-hold.mass, kind="stable").tolist()
            if self._is_bound(int(hold.nodes[k]))
        ]
        for k in shared[:MOST_SHARED]:
            for row in self._of_node[int(hold.nodes[k])]:
                bound = self.joints[row].inverse_bind
                if bound is None or not is_invertible(bound):
                    continue
                place: FloatArray = np.linalg.inv(bound) @ hold.inverse_binds[k]
                if not is_invertible(place):
                    continue
                agreeing = self._agreeing_mass(hold, place)
                if agreeing > most:
                    best, most = place, agreeing
                if most > 0.999 * hold.mass.sum():
                    return place
        return self._rest_place(hold) if best is None else best

    def _is_bound(self, node: int) -> bool:
        return any(self.joints[row].inverse_bind is not None for row in self._of_node[node])

    def _agreeing_mass(self, hold: Hold, place: FloatArray) -> float:
        mass = 0.0
        for k, node in enumerate(hold.nodes.tolist()):
            for row in self._of_node[node]:
                bound = self.joints[row].inverse_bind
                if bound is None or _agree(bound @ place, hold.inverse_binds[k], hold.corners):
                    mass += float(hold.mass[k])
                    break
        return mass

    def _rest_place(self, hold: Hold) -> FloatArray:
        """Where most of the mesh lies in the file's rest pose.

        Every joint has an opinion, its rest matrix times its inverse bind; in a rest pose that is
        the bind pose all are equal. Otherwise the medoid is taken: the opinion that moves the
        others' vertices least.
        """
        chosen = np.argsort(-hold.mass, kind="stable")[:MOST_CANDIDATES]
        chosen = np.array(
            [
                k
                for k in chosen.tolist()
                if is_invertible(self.world[hold.nodes[k]] @ hold.inverse_binds[k])
            ],
            dtype=np.int64,
        )
        if len(chosen) == 0:
            return np.eye(4)
        places = self.world[hold.nodes[chosen]] @ hold.inverse_binds[chosen]
        points = np.column_stack([hold.centroids[chosen], np.ones(len(chosen))])
        moved = np.einsum("iab,jb->ija", places[:, :3], points)
        own = moved[np.arange(len(chosen)), np.arange(len(chosen))]
        cost = np.linalg.norm(moved - own, axis=2) @ hold.mass[chosen]
        best: FloatArray = places[int(np.argmin(cost))]
        return best


def _agree(first: FloatArray, second: FloatArray, corners: FloatArray) -> bool:
    """Whether two affine matrices put the corners of a box to the same places."""
    here = corners @ first[:3, :3].T + first[:3, 3]
    there = corners @ second[:3, :3].T + second[:3, 3]
    return bool(np.abs(here - there).max() <= TOLERANCE * np.abs(there).max())
