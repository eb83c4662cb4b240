"""Casting a crowd and measuring its variety: `engine/crowd/casting.py` over a crowd's columns."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..engine.crowd.casting import Casting, cast
from ..engine.crowd.clones import CloneReport, Features, clone_features, report_clones
from ..engine.crowd.figure import make_figure
from ..engine.crowd.neighbours import neighbour_pairs
from .crowd import Crowd

_HEIGHT = 1.75
_MOST_KINDS = 256


def cast_crowd(crowd: Crowd, rng: np.random.Generator, *, motions: bool = True) -> Casting:
    """Let neighbours who look or move too much alike swap that with others.

    Parameters
    ----------
    crowd
        As drawn: no blend runs yet and no offset changes.
    rng
        Where proposals come from.
    motions
        Whether motions and offsets are swapped too.
    """
    present = crowd.seat.occupied
    kind = crowd.body.kind.astype(np.int64)
    look_class = np.where(present, (crowd.team.side.astype(np.int64) + 1) * _MOST_KINDS + kind, -1)
    motion_class = np.full(len(crowd), -1)
    if crowd.anim is not None and motions:
        shown = crowd.motion.shown.astype(np.int64)
        motion_class = np.where(present, shown * _MOST_KINDS + kind, -1)
    pairs = neighbour_pairs(crowd.plan, present)
    casting = cast(crowd_features(crowd), pairs, look_class, motion_class, rng)
    casting.dress(crowd.appearance)
    if crowd.anim is not None:
        casting.move(crowd.anim)
    return casting


def clone_report(crowd: Crowd) -> CloneReport:
    """How alike the neighbours of a crowd, three seats around, look and move at the moment."""
    pairs = neighbour_pairs(crowd.plan, crowd.seat.occupied)
    return report_clones(crowd_features(crowd), pairs)


def crowd_features(crowd: Crowd) -> Features:
    """What a crowd's agents can share: builds, colours, parts, and the body's stream and offset.

    Motions of a baked crowd count as nobody else's: agents play them at speeds of their own.
    """
    count = len(crowd)
    stream: NDArray[np.int64] = np.full(count, -1, np.int64)
    offset = np.zeros(count, np.float32)
    if crowd.pool is not None and crowd.anim is not None:
        row = crowd.anim.row[0]
        shared = row < crowd.pool.store.stream_rows
        base = crowd.pool.twins.base[row[shared]]
        stream[shared] = np.where(base >= 0, base, row[shared])
        offset = crowd.anim.target[0]
    bits = np.zeros(count, np.uint32)
    for part in crowd.parts.values():
        bits |= part.bits.bits
    scale = crowd.placement.scale
    height = make_figure(crowd.character).height
    return clone_features(
        crowd.body.kind,
        crowd.body.girth * scale,
        scale * np.float32(height / _HEIGHT),
        crowd.appearance,
        stream,
        offset,
        bits=bits,
    )
