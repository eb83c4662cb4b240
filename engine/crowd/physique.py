"""What drawing and measuring need to know of how a crowd's agents are built."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..animation.body_type import BodyType
from ..animation.clip_bank import ClipBank
from ..animation.kinematics import Kinematics
from ..animation.skeleton import Skeleton
from ..streams.pool import bind_positions
from .body_types import leg_factors
from .figure import MARKERS, Figure
from .morphs import MorphWeights, morph_weights
from .motions import MotionLibrary
from .ways import seated_motions


@dataclass(frozen=True, slots=True, eq=False)
class SeatHeights:
    """Where hips are in the character's own motions, and how high the crowd's seats are.

    Parameters
    ----------
    sitting, standing
        Height of the hips in model space.
    seat
        Metres above an agent's place at which everybody's hips sit.
    """

    sitting: float
    standing: float
    seat: float


@dataclass(frozen=True, slots=True, eq=False)
class Physique:
    """Proportions of a crowd.

    Parameters
    ----------
    morphs
        Of the character's meshes.
    hips
        The joint.
    hips_bind
        (3,) float32 its place in the bind pose, model space.
    legs
        (T,) float32 for each body type, height of its hips as a factor on the character's.
    seats
        None where nobody sits.
    """

    morphs: MorphWeights
    hips: int
    hips_bind: NDArray[np.float32]
    legs: NDArray[np.float32]
    seats: SeatHeights | None


def seat_lift(
    hips: NDArray[np.float32],
    scale: NDArray[np.float32],
    legs: NDArray[np.float32],
    seats: SeatHeights,
) -> NDArray[np.float32]:
    """How far agents are moved up so that they sit on their seat and not in it.

    Seats are equally high for all, so the smaller an agent is, the more it is lifted while it sits,
    and its feet hang. Between sitting and standing the lift follows the height of the hips.

    Parameters
    ----------
    hips
        (K,) height of the hips in model space, as shown.
    scale, legs
        (K,) uniform scale, and the leg factor of the body type.

    Returns
    -------
    (K,) float32 metres

    Examples
    --------
    A child of scale 0.7 whose hips would sit 0.35 m high is lifted by 0.15 m to a seat of 0.5 m.
    """
    low, high = seats.sitting * legs, seats.standing * legs
    seated = np.clip((high - hips) / (high - low), 0.0, 1.0)
    share = seated * seated * (3.0 - 2.0 * seated)
    lift = share * (seats.seat - scale * low)
    return lift.astype(np.float32, copy=False)


def measure(
    skeleton: Skeleton,
    figure: Figure,
    types: tuple[BodyType, ...],
    bank: ClipBank,
    library: MotionLibrary,
    adult: float,
) -> Physique:
    """Find a crowd's proportions in its character and motions.

    Parameters
    ----------
    skeleton, figure
        Of the character.
    types
        Body types that have streams.
    bank, library
        The clips, and which of them the crowd uses for what.
    adult
        Uniform scale of an adult of mean size.
    """
    hips = int(figure.joints[MARKERS.index("hips")])
    calm = library.innate > 0
    sits = seated_motions(library.names)
    seats = None
    if (calm & sits).any() and (calm & ~sits).any():
        heights = _hips_heights(skeleton, bank, library.clips, hips)
        sitting, standing = (
            float(np.median(heights[calm & sits])),
            float(heights[calm & ~sits].max()),
        )
        if standing > 1.05 * sitting > 0:
            seats = SeatHeights(sitting, standing, adult * sitting)
    most = max(len(types), 2)
    legs = np.ones(1 + most, np.float32)
    legs[: 1 + len(types)] = leg_factors(types, figure)
    return Physique(
        morphs=morph_weights(skeleton, figure),
        hips=hips,
        hips_bind=bind_positions(skeleton)[hips],
        legs=legs,
        seats=seats,
    )


def _hips_heights(
    skeleton: Skeleton, bank: ClipBank, clips: NDArray[np.int64], hips: int
) -> NDArray[np.float32]:
    """(K,) height of the hips at the start of each clip."""
    kinematics = Kinematics(skeleton, len(clips))
    palettes = np.empty((len(clips), skeleton.joint_count, 3, 4), np.float32)
    poses = np.stack([bank.sample_one(int(clip), 0.0)[0] for clip in clips])
    kinematics.evaluate(poses, palettes)
    return kinematics.joint_positions(np.array([hips]))[:, 0, 1]
