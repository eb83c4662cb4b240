"""A crowd in which people walk: its gaits, its latecomers and its stewards come into being."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import esper
import numpy as np
from numpy.typing import NDArray

from ..components.walk import Errand
from ..engine.animation.clip import Clip
from ..engine.behaviour.gangways import Gangways
from ..engine.behaviour.walkers import Walkers
from ..engine.crowd.cast import Cast
from ..engine.crowd.figure import MARKERS, Figure
from ..engine.crowd.gaits import Gait, Gaits, add_gaits, make_gaits, start_gaits
from ..engine.crowd.motions import MotionLibrary, MotionStreams
from ..engine.crowd.seating import SeatPlan
from ..engine.crowd.spec import CrowdSpec
from ..engine.crowd.walkabout import choose_stewards, draw_latecomers, dress_stewards
from ..engine.crowd.ways import Ways
from ..engine.streams.pool import POSE_RATE, StreamPool
from .crowd import Crowd


@dataclass(frozen=True, slots=True, eq=False)
class Steps:
    """The gaits of a crowd: its library and clips with them, and which are which."""

    gaits: list[Gait]
    table: Gaits
    library: MotionLibrary
    clips: tuple[Clip, ...]
    first_clip: int

    def start(
        self, pool: StreamPool, streams: MotionStreams, ways: Ways | None
    ) -> tuple[MotionStreams, Ways | None]:
        """Start the gaits' streams; the places of all motions, and the ways that know of them."""
        streams = start_gaits(pool, self.gaits, self.first_clip, streams)
        if ways is None:
            return streams, None
        on_foot = np.zeros(len(self.gaits), np.bool_)
        return streams, replace(
            ways,
            begins_seated=np.append(ways.begins_seated, on_foot),
            ends_seated=np.append(ways.ends_seated, on_foot),
        )


def prepare_walking(
    spec: CrowdSpec, clips: Sequence[Clip], figure: Figure, cast: Cast
) -> Steps | None:
    """Gaits for a crowd in which people walk; None for others.

    Raises
    ------
    ValueError
        For a layout, poses or a character that nobody can walk with.
    """
    if not spec.walks:
        return None
    if spec.layout != "bowl":
        raise ValueError(
            f"layout is '{spec.layout}', which has no gangways; walking, latecomers and stewards "
            "need a 'bowl'"
        )
    if spec.poses == "baked":
        raise ValueError("poses is 'baked'; walking, latecomers and stewards need 'streams'")
    gaits = make_gaits(clips, int(figure.joints[MARKERS.index("hips")]))
    library, table = add_gaits(cast.library, gaits, len(cast.clips))
    bank = (*cast.clips, *(gait.clip for gait in gaits))
    return Steps(gaits, table, library, bank, len(cast.clips))


def seats_of_stewards(
    spec: CrowdSpec, plan: SeatPlan, occupied: NDArray[np.bool_]
) -> tuple[NDArray[np.bool_], dict[int, int]]:
    """Who is there beside the stewards, and the gangway of each steward by id.

    Raises
    ------
    ValueError
        For more stewards than half of the seats, or than gangways with a place for them.
    """
    if not spec.stewards:
        return occupied, {}
    if spec.layout != "bowl":
        raise ValueError(f"layout is '{spec.layout}'; stewards need the gangways of a 'bowl'")
    ways = Gangways(plan)
    most = min(ways.count, plan.count // 2)
    if spec.stewards > most:
        raise ValueError(f"stewards is {spec.stewards}, expected at most {most} in this stadium")
    gates = np.arange(spec.stewards) * ways.count // spec.stewards
    posts = np.stack([ways.stairs(int(gate), 0, 0).points[-1] for gate in gates])
    ids, there = choose_stewards(plan, occupied, posts.astype(np.float64))
    return there, dict(zip(ids.tolist(), gates.tolist(), strict=True))


def start_walking(
    crowd: Crowd, steps: Steps, stewards: dict[int, int], rng: np.random.Generator
) -> None:
    """Give a crowd its walkers, and send latecomers and stewards on their way."""
    occupied = crowd.seat.occupied
    late, when = draw_latecomers(crowd.party, occupied, crowd.spec.latecomers, rng)
    yaw, size = crowd.placement.yaw, crowd.placement.scale
    if crowd.physique is not None:
        size = size * crowd.physique.legs[crowd.body.kind]
    walkers = Walkers(crowd.plan, steps.table, crowd.table, yaw, size, occupied, rng)
    crowd.walkers = walkers
    esper.add_component(crowd.entity, walkers)
    occupied[late] = False
    walkers.away[late] = True
    crowd.company.excuse(late, away=True)
    walkers.send(late, Errand.ARRIVE, 1 + np.rint(when * POSE_RATE).astype(np.int64))
    ids = np.array(list(stewards), np.int64)
    if len(ids):
        dress_stewards(ids, crowd.team, crowd.appearance)
        occupied[ids] = True
        walkers.posts.update(stewards)
        crowd.company.excuse(ids, away=True)
        walkers.send(ids, Errand.PATROL, np.ones(len(ids), np.int64))
