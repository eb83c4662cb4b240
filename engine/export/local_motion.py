"""From what bones do in model space to the local transforms that files hold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..animation.clip import continuous_hemisphere
from ..animation.skeleton import Skeleton
from ..assets.retarget.turns import matrices_of, quaternions_of
from .rig import F64, Factors, Rig

F32 = NDArray[np.float32]
SHORT = 32767.0
"""What 1 is as a normalised 16-bit integer."""


@dataclass(frozen=True, slots=True, eq=False)
class LocalMotion:
    """Local transforms of a rig's joints, for K agents at T moments.

    A channel that stays is exactly the same at all moments.

    Parameters
    ----------
    translation, rotation, scale
        (T, K, R, 3), (T, K, R, 4) xyzw and (T, K, R, 3) float32.
    """

    translation: F32
    rotation: F32
    scale: F32

    def of(self, agent: int, joints: NDArray[np.int64]) -> dict[str, F32]:
        """What some joints (R,) of the k-th agent do: (T, R, n) by glTF's names of the channels."""
        return {
            "translation": self.translation[:, agent, joints],
            "rotation": self.rotation[:, agent, joints],
            "scale": self.scale[:, agent, joints],
        }


def local_motion(
    skeleton: Skeleton,
    rig: Rig,
    found: Factors,
    lever: F64,
    tolerance: float,
    scales: DTypeLike = np.float32,
    *,
    short: bool = False,
) -> LocalMotion:
    """Hang bones on their parents.

    Every joint is placed relative to what its parent does in the file, not to what it should do, so
    that rounding doesn't add up along a limb.

    Parameters
    ----------
    skeleton, rig
        The rig's bones are the skeleton's joints.
    found
        Of the agents.
    lever
        (J,) `levers` of the joints.
    tolerance
        Metres by which a joint may be off its place, if it needs no keys then.
    scales
        The precision in which the file holds scales, as for `factors`.
    short
        Whether the file holds rotations as multiples of 1 / 32767.

    Returns
    -------
    LocalMotion
    """
    frames, count, joints = found.place.shape[:3]
    translation = np.zeros((frames, count, len(rig), 3))
    rotation = np.zeros((frames, count, len(rig), 4))
    rotation[..., 3] = 1.0
    scale = np.ones((frames, count, len(rig), 3))
    # What the bones do in the file.
    place, turn, size = np.empty_like(found.place), np.empty_like(found.turn), found.size
    for joint in range(joints):
        parent = int(skeleton.parents[joint])
        at, turned = found.place[:, :, joint], found.turn[:, :, joint]
        grown = size[:, joint]
        if parent >= 0:
            back = np.swapaxes(turn[:, :, parent], -1, -2)
            at = np.einsum("tkij,tkj->tki", back, at - place[:, :, parent])
            at = at / size[:, parent, None]
            turned = back @ turned
            grown = grown / size[:, parent]
        at = _settled(at, tolerance / (1.0 if parent < 0 else size[:, parent]))
        turned = _held(turned, tolerance / max(float(lever[joint]), 1e-6))
        translation[:, :, joint], scale[:, :, joint] = at, grown[:, None]
        rotation[:, :, joint] = quaternions = _turns(turned, short=short)
        turned = matrices_of(quaternions)
        if parent >= 0:
            at = np.einsum("tkij,tkj->tki", turn[:, :, parent], at * size[:, parent, None])
            at = at + place[:, :, parent]
            turned = turn[:, :, parent] @ turned
        place[:, :, joint], turn[:, :, joint] = at, turned
    for joint in np.flatnonzero(rig.stretched).tolist():
        last = int(rig.skin[joint])
        # What is left of the turn, if the bone's is held.
        missing = np.swapaxes(turn[:, :, joint], -1, -2) @ found.turn[:, :, joint]
        axes = found.axes[:, :, joint]
        rotation[:, :, last] = back = _turns(np.swapaxes(axes, -1, -2), short=short)
        axes = np.swapaxes(matrices_of(back), -1, -2)
        rotation[:, :, last - 1] = _turns(missing @ axes, short=short)
        scale[:, :, last - 1] = found.stretch[:, :, joint]
        if scales == np.float16:
            scale[:, :, last - 1], scale[:, :, last] = in_halves(found.stretch[:, :, joint])
    smooth = continuous_hemisphere(rotation.reshape(frames, -1, 4)).reshape(rotation.shape)
    return LocalMotion(
        translation.astype(np.float32), smooth.astype(np.float32), scale.astype(np.float32)
    )


def in_halves(values: F64) -> tuple[F64, F64]:
    """Factors (..., 3) as products of half-precision ones and a common one, (..., 3) and (..., 1).

    One half is off by up to 1 / 4096. Of 128 common factors the one is taken with which all three
    are nearest, which is some four times as exact.
    """
    best: F64 = values.astype(np.float16).astype(np.float64)
    common: F64 = np.ones((*values.shape[:-1], 1))
    least = np.abs(best - values).max(axis=-1, keepdims=True)
    for step in range(1, 128):
        factor = 1.0 + step / 1024
        tried = (values / factor).astype(np.float16).astype(np.float64)
        off = np.abs(factor * tried - values).max(axis=-1, keepdims=True)
        better = off < least
        least = np.where(better, off, least)
        best, common = np.where(better, tried, best), np.where(better, factor, common)
    return best, common


def _turns(rotations: F64, *, short: bool) -> F64:
    """Quaternions of rotations (T, K, 3, 3), as exactly as the file holds them."""
    exact = quaternions_of(rotations)
    return np.rint(exact * SHORT) / SHORT if short else exact


def _settled(values: F64, tolerance: F64 | float) -> F64:
    """Values (T, K, 3); those of an agent that move less than a tolerance (K,) stay."""
    low, high = values.min(axis=0), values.max(axis=0)
    still = (high - low).max(axis=-1) <= 2.0 * np.broadcast_to(tolerance, low.shape[:1])
    return np.where(still[:, None], 0.5 * (low + high), values)


def _held(turns: F64, tolerance: float) -> F64:
    """Rotations (T, K, 3, 3); those of an agent that turn less than a tolerance stay."""
    middle = turns[len(turns) // 2]
    off = np.linalg.norm(turns - middle, axis=(-1, -2)).max(axis=0) / np.sqrt(2.0)
    return np.where((off <= tolerance)[:, None, None], middle, turns)
