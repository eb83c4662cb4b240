"""Where a part hangs on its crowd's agents: *Techniques 2022*, 4.2, its static hook.

A part's model space is that of its meshes. Its transform leads from there to the frame of the
joint that it hangs on; the joint's model matrix then leads to the agent's model space. Joints are
known to drawing by their palettes, joint matrix times inverse bind, so the bind pose of the joint
is put into what `Attachment.place` holds once and for all.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..animation.skeleton import Skeleton

_LEAST_VOLUME = 1e-12


def as_affine(transform: ArrayLike | None) -> NDArray[np.float64]:
    """A transform as (4, 4) float64; the identity if None.

    Parameters
    ----------
    transform
        (4, 4) or (3, 4) column-vector matrix; pyglet's ``Mat4`` must be turned into one.

    Raises
    ------
    ValueError
        If it has another shape, is not affine, or flattens or mirrors the part.
    """
    whole = np.eye(4)
    if transform is None:
        return whole
    given = np.asarray(transform, np.float64)
    if given.shape not in ((4, 4), (3, 4)):
        raise ValueError(f"transform has shape {given.shape}, expected (4, 4) or (3, 4)")
    if not np.isfinite(given).all():
        raise ValueError("transform has values that are not finite")
    if given.shape == (4, 4) and not np.allclose(given[3], (0, 0, 0, 1), atol=1e-6):
        row = ", ".join(f"{value:g}" for value in given[3])
        raise ValueError(
            f"transform is not affine: its last row is ({row}), expected (0, 0, 0, 1); "
            "translations belong in the last column"
        )
    whole[:3] = given[:3]
    volume = float(np.linalg.det(whole[:3, :3]))
    if abs(volume) < _LEAST_VOLUME:
        raise ValueError("transform flattens the part: its linear part has no inverse")
    if volume < 0:
        raise ValueError("transform mirrors the part, which turns its surface inside out")
    return whole


def hook_place(
    skeleton: Skeleton, hook: str | None, transform: ArrayLike | None
) -> tuple[int, NDArray[np.float32]]:
    """Joint that a part hangs on, and its place under that joint's palette.

    Parameters
    ----------
    skeleton
        Of the crowd.
    hook
        Name of a joint; None for the agent's own frame, between its feet.
    transform
        From the part's model space to the joint's frame; see `as_affine`.

    Returns
    -------
    Index of the joint or -1, and (3, 4) float32.

    Raises
    ------
    ValueError
        For an unknown joint, or a transform that can't be used.
    """
    place = as_affine(transform)
    if hook is None:
        return -1, place[:3].astype(np.float32)
    try:
        joint = skeleton.index(hook)
    except ValueError as error:
        raise ValueError(f"hook: {error}") from None
    inverse_bind = np.eye(4)
    inverse_bind[:3] = skeleton.inverse_bind[joint]
    return joint, np.linalg.solve(inverse_bind, place)[:3].astype(np.float32)


def compose(first: NDArray[np.float32], second: NDArray[np.float32]) -> NDArray[np.float32]:
    """(..., 3, 4) affine matrices of `second` and then `first`; leading axes broadcast."""
    out: NDArray[np.float32] = first[..., :3] @ second
    out[..., 3] += first[..., 3]
    return out


def grown(
    place: NDArray[np.float32], growth: NDArray[np.float32], centre: NDArray[np.float32]
) -> NDArray[np.float32]:
    """A place (3, 4) on heads that are larger by `growth` (K,), about their centre: (K, 3, 4)."""
    factor = 1.0 + growth[:, None, None]
    out = np.broadcast_to(place, (len(growth), 3, 4)) * factor
    out[..., 3] += (1.0 - factor[:, 0]) * centre
    return out.astype(np.float32, copy=False)


def check_same_skeleton(part: Skeleton, crowd: Skeleton) -> None:
    """ValueError unless a part's skeleton is its crowd's, so that their poses fit."""
    if part.names != crowd.names or not np.array_equal(part.parents, crowd.parents):
        missing = [name for name in part.names if name not in crowd.names]
        what = f"; it has no joint '{missing[0]}'" if missing else ""
        raise ValueError(
            f"character: its {part.joint_count} joints are not the crowd's "
            f"{crowd.joint_count}{what}; a part with joints of its own needs motion='own'"
        )
    if not np.allclose(part.inverse_bind, crowd.inverse_bind, atol=1e-4):
        raise ValueError("character: its bind pose is not the crowd's, so their poses don't fit")
