"""One-shots, many at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..controllers.parameters import OneShotRequest
from .groups import Group
from .tables import Tables

_DONE = 1e-9


def step_one_shots(tables: Tables, group: Group) -> None:
    """Let the active one-shots of a group answer their requests, and weigh base and shot."""
    columns = tables.nodes
    nodes = group.nodes[columns["active"][group.nodes]]
    if not len(nodes):
        return
    base, shot = tables.child(nodes, 0), tables.child(nodes, 1)
    shots = tables.constants["shots"]
    fadein, fadeout = (shots[name][columns["constant"][nodes]] for name in ("fadein", "fadeout"))
    on = columns["state"][nodes] == 1
    time, fade = columns["time"][nodes], columns["fade"][nodes]
    seconds = np.abs(columns["delta"][nodes])
    # A shot that wasn't seen yet shows its beginning now.
    passed = np.where(columns["restarted"][shot], 0.0, seconds)
    time = np.where(on, time + seconds, time)
    fade = np.where(on, fade - seconds, fade)
    left = _seconds_left(tables, shot) - passed
    ends = on & np.isinf(fade) & (left <= fadeout + _DONE)
    fade = np.where(ends, np.maximum(left, 0.0), fade)

    place = columns["parameter"][nodes]
    request = tables.values["value"][place]
    tables.values["value"][place] = 0.0
    share = _share(time, fade, fadein, fadeout, on)
    fades_out = (request == OneShotRequest.FADE_OUT) & on
    fade = np.where(fades_out, np.minimum(fade, share * fadeout), fade)
    fire = request == OneShotRequest.FIRE
    time, fade = np.where(fire, share * fadein, time), np.where(fire, np.inf, fade)
    on = ((on & (fade > _DONE)) | fire) & (request != OneShotRequest.ABORT)
    tables.restart(tables.subtrees(shot[fire])[0])

    columns["time"][nodes], columns["fade"][nodes] = time, fade
    columns["state"][nodes] = on
    share = _share(time, fade, fadein, fadeout, on)
    columns["weight"][base] = 1.0 - share
    columns["weight"][shot] = share


def _share(
    time: NDArray[np.float64],
    fade: NDArray[np.float64],
    fadein: NDArray[np.float64],
    fadeout: NDArray[np.float64],
    on: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Weight of the shot: the lesser of fading in and fading out."""
    rising = np.where(fadein > 0, time / np.where(fadein > 0, fadein, 1.0), 1.0)
    falling = np.where(fadeout > 0, fade / np.where(fadeout > 0, fadeout, 1.0), fade > _DONE)
    return np.where(on, np.clip(np.minimum(rising, falling), 0.0, 1.0), 0.0)


def _seconds_left(tables: Tables, shot: NDArray[np.int64]) -> NDArray[np.float64]:
    """Seconds until the leading clips end, as they play; infinite without a clip."""
    clip, speed = tables.leading_clips(shot)
    columns = tables.nodes
    node = np.maximum(clip, 0)
    duration = tables.bank.duration[columns["clip"][node]]
    time = columns["time"][node]
    left = np.where(speed >= 0, duration - time, time)
    moves = (clip >= 0) & (speed != 0)
    return np.where(moves, left / np.where(moves, np.abs(speed), 1.0), np.inf)
