"""Forward kinematics of many streams at once: local poses to skinning palettes.

Palettes are equation 1 of *Streams 2017* without the weights, ``P_j = M_j inverse_bind_j`` with
``M_j = M_parent L_j``, as affine 3x4 matrices. The work goes level by level of the joint tree: a
level of all streams is a few hundred kilobytes, so its local matrices, its model matrices and its
palettes are made while it is in cache, and only model matrices of one level back are read again.
Every array view that a tick needs is made once, in the constructor: making views costs as much as
multiplying a small block.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .pose import CHANNELS, ROTATION, SCALE, TRANSLATION
from .skeleton import Skeleton

Array = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class _Level:
    """Views of one level of j joints and S streams."""

    joints: slice
    parents: NDArray[np.int64] | None
    parent_model: Array
    """(3, 4, j, S): the parents' model matrices, gathered."""
    rotation: tuple[Array, ...]
    """x, y, z, w of the local rotation, (j, S) each."""
    pose: Array
    """(10, j, S): the local poses, streams inner."""
    vector: Array
    """(3, j, S): x, y, z of the local rotation."""
    quaternion: Array
    translation: Array
    scale: Array
    local: Array
    local_rows: tuple[tuple[Array, ...], ...]
    local_linear: Array
    model: Array
    term: Array
    squares: Array
    square_terms: tuple[Array, ...]
    products: Array
    product_terms: tuple[Array, ...]
    factor: Array
    model_rows: Array
    """(3, j, S, 4) view of `model`: rows of matrices, for the product with the inverse bind."""
    inverse_bind: Array
    """(j, 4, 4)"""


class Kinematics:
    """Workspace that turns S local poses of one skeleton into palettes.

    Parameters
    ----------
    skeleton
        The joint tree.
    streams
        How many poses are evaluated together, S.
    """

    __slots__ = (
        "_joints",
        "_levels",
        "_palettes",
        "mixed",
        "scratch",
        "streams",
    )

    def __init__(self, skeleton: Skeleton, streams: int) -> None:
        self.streams = streams
        self.mixed = np.empty((streams, CHANNELS, skeleton.joint_count), dtype=np.float32)
        self.scratch = np.empty_like(self.mixed)
        self._palettes: Array | None = None
        self._joints = skeleton.joint_count
        self._levels = _make_levels(skeleton, streams)

    def evaluate(self, pose: Array, palettes: Array, rows: NDArray[np.int64] | None = None) -> None:
        """Write the palettes of S poses.

        Parameters
        ----------
        pose
            (S, 10, J) float32 local poses; rotations need not be normalised.
        palettes
            (R, J, 3, 4) float32, written in place.
        rows
            (S,) which row of `palettes` each pose goes to; the first S rows if None.
        """
        previous: Array | None = None
        target = palettes[: self.streams] if rows is None else self._own_palettes()
        for level in self._levels:
            level.pose[...] = pose[:, :, level.joints].transpose(1, 2, 0)
            _local_matrices(level)
            if previous is not None and level.parents is not None:
                np.take(previous, level.parents, axis=2, out=level.parent_model, mode="clip")
                _multiply(level.parent_model, level.local, level.model, level.term)
            # One small matrix product a joint, written where the palettes are wanted: half the
            # time of multiplying planes and then turning them round.
            into = target[:, level.joints].transpose(2, 1, 0, 3)
            np.matmul(level.model_rows, level.inverse_bind, out=into)
            previous = level.model
        if rows is not None:
            palettes[rows] = target

    def _own_palettes(self) -> Array:
        if self._palettes is None:
            self._palettes = np.empty((self.streams, self._joints, 3, 4), dtype=np.float32)
        return self._palettes

    def joint_positions(self, joints: NDArray[np.int64]) -> Array:
        """Model-space positions of some joints after `evaluate`.

        Parameters
        ----------
        joints
            (K,) joint indices.

        Returns
        -------
        (S, K, 3) float32, metres.
        """
        out = np.empty((self.streams, len(joints), 3), dtype=np.float32)
        for level in self._levels:
            inside = np.flatnonzero((joints >= level.joints.start) & (joints < level.joints.stop))
            if len(inside):
                local = joints[inside] - level.joints.start
                out[:, inside] = level.model[:, 3, local].transpose(2, 1, 0)
        return out


def _make_levels(skeleton: Skeleton, streams: int) -> tuple[_Level, ...]:
    widest = max(level.stop - level.start for level in skeleton.levels)
    buffers = {
        name: np.empty(planes * widest * streams, dtype=np.float32)
        for name, planes in (
            ("pose", CHANNELS),
            ("parent", 12),
            ("local", 12),
            ("term", 12),
            ("squares", 4),
            ("products", 6),
            ("factor", 1),
        )
    }
    made = []
    for number, joints in enumerate(skeleton.levels):
        j = joints.stop - joints.start

        def plane(
            name: str, *shape: int, width: int = j, buffers: dict[str, Array] = buffers
        ) -> Array:
            full = (*shape, width, streams)
            return buffers[name][: int(np.prod(full))].reshape(full)

        block = plane("pose", CHANNELS)
        model = np.empty((3, 4, j, streams), dtype=np.float32)
        local = model if number == 0 else plane("local", 3, 4)
        squares, products = plane("squares", 4), plane("products", 6)
        inverse_bind = np.zeros((j, 4, 4), dtype=np.float32)
        inverse_bind[:, :3] = skeleton.inverse_bind[joints]
        inverse_bind[:, 3, 3] = 1.0
        parents = None
        if number > 0:
            parents = (skeleton.parents[joints] - skeleton.levels[number - 1].start).astype(
                np.int64
            )
        made.append(
            _Level(
                joints=joints,
                parents=parents,
                parent_model=plane("parent", 3, 4),
                rotation=(block[0], block[1], block[2], block[3]),
                vector=block[:3],
                pose=block,
                quaternion=block[ROTATION],
                translation=block[TRANSLATION],
                scale=block[SCALE],
                local=local,
                local_rows=tuple(tuple(local[r, c] for c in range(4)) for r in range(3)),
                local_linear=local[:, :3],
                model=model,
                term=plane("term", 3, 4),
                squares=squares,
                square_terms=tuple(squares),
                products=products,
                product_terms=tuple(products),
                factor=plane("factor"),
                model_rows=model.transpose(0, 2, 3, 1),
                inverse_bind=inverse_bind,
            )
        )
    return tuple(made)


def _local_matrices(level: _Level) -> None:
    """T R S of a level; R from a quaternion of any length."""
    _, y, z, w = level.rotation
    squares, products, factor = level.squares, level.products, level.factor
    np.multiply(level.quaternion, level.quaternion, out=squares)
    qx, qy, qz, qw = level.square_terms
    np.add(qx, qy, out=factor)
    np.add(factor, qz, out=factor)
    np.add(factor, qw, out=factor)
    np.divide(2.0, factor, out=factor)
    # 2/|q|^2 times wx wy wz, xy xz yz; the squares' buffer then holds 2/|q|^2 times xx yy zz.
    np.multiply(level.vector, factor, out=level.term[0, :3])
    doubled = level.term[0]
    np.multiply(doubled[:3], w, out=products[:3])
    np.multiply(doubled[0], y, out=products[3])
    np.multiply(doubled[:2], z, out=products[4:6])
    np.multiply(squares[:3], factor, out=squares[:3])
    wx, wy, wz, xy, xz, yz = level.product_terms
    (r00, r01, r02, _), (r10, r11, r12, _), (r20, r21, r22, _) = level.local_rows
    np.add(qy, qz, out=factor)
    np.subtract(1.0, factor, out=r00)
    np.add(qx, qz, out=factor)
    np.subtract(1.0, factor, out=r11)
    np.add(qx, qy, out=factor)
    np.subtract(1.0, factor, out=r22)
    np.subtract(xy, wz, out=r01)
    np.add(xy, wz, out=r10)
    np.add(xz, wy, out=r02)
    np.subtract(xz, wy, out=r20)
    np.subtract(yz, wx, out=r12)
    np.add(yz, wx, out=r21)
    np.multiply(level.local_linear, level.scale, out=level.local_linear)
    level.local[:, 3] = level.translation


def _multiply(a: Array, b: Array, out: Array, term: Array) -> None:
    """Affine product over planes, (3, 4, j, S) each."""
    np.multiply(a[:, 0, None], b[None, 0], out=out)
    np.multiply(a[:, 1, None], b[None, 1], out=term)
    np.add(out, term, out=out)
    np.multiply(a[:, 2, None], b[None, 2], out=term)
    np.add(out, term, out=out)
    np.add(out[:, 3], a[:, 3], out=out[:, 3])
