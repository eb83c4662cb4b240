"""Two-bone inverse kinematics for arms and legs, in closed form."""

from __future__ import annotations

import numpy as np

from .rotations import Array, across, between_frames, unit

_STRAIGHTEST = 0.9995
"""Share of a limb's length that it reaches at most, so that its bend never turns over."""


def bend_limb(
    start: Array,
    target: Array,
    pole: Array,
    bind: tuple[Array, Array, Array],
    bind_pole: Array,
    ease: float,
) -> tuple[Array, Array, Array]:
    """Turn both bones of a limb so that its end comes to a target.

    Parameters
    ----------
    start
        (F, 3) where the limb begins.
    target
        (F, 3) where its end shall be; beyond its reach the limb points there.
    pole
        (F, 3) or (3,) unit vectors: which way the middle joint sticks out.
    bind
        Bind-pose positions (3,) of the limb's first, middle and last joint.
    bind_pole
        (3,) which way the middle joint of the bind pose sticks out, or would.
    ease
        Share of the limb's length over which it gives way before it is straight. Without, a limb
        that a target draws out straight snaps; with it, the end lags a little behind the target.

    Returns
    -------
    upper, lower
        (F, 4) model-space turns of the two bones from the bind pose.
    end
        (F, 3) where the limb ends.
    """
    first, middle, last = bind
    length0 = float(np.linalg.norm(middle - first))
    length1 = float(np.linalg.norm(last - middle))
    line = unit(target - start)
    reach = np.linalg.norm(target - start, axis=1)
    reach = np.maximum(reach, abs(length0 - length1) + 1e-3)
    longest = _STRAIGHTEST * (length0 + length1)
    if ease > 0:
        # The last stretch is approached exponentially, with no kink where that begins.
        give = ease * longest
        beyond = np.maximum(reach - (longest - give), 0.0)
        reach = np.minimum(reach, longest - give) + give * (1 - np.exp(-beyond / give))
    reach = np.minimum(reach, longest)[:, None]
    out = across(np.broadcast_to(pole, line.shape), line)
    # Law of cosines: how far along the line, and out of it, the middle joint lies.
    along = (reach**2 + length0**2 - length1**2) / (2 * reach)
    aside = np.sqrt(np.maximum(length0**2 - along**2, 0.0))
    elbow = start + along * line + aside * out
    end = start + reach * line
    hinge = np.cross(out, line)
    turns = []
    for from_bind, to_bind, begin, finish in (
        (first, middle, start, elbow),
        (middle, last, elbow, end),
    ):
        direction0 = unit(to_bind - from_bind)
        hinge0 = np.cross(across(bind_pole, direction0), direction0)
        turns.append(between_frames(direction0, hinge0, unit(finish - begin), hinge))
    return turns[0], turns[1], end
