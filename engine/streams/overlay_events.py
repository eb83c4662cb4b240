"""Clip events of whole agents: of their bodies' motions, and of what is laid over them."""

from __future__ import annotations

import numpy as np

from ...components.animation import AgentAnimID, Transition
from ...components.overlays import NO_MASK
from .event_delivery import Delivered, deliver
from .overlaying import OverlayStage, layer_weights
from .pool import StreamPool

BODY = 0


def deliver_whole(
    pool: StreamPool,
    anim: AgentAnimID,
    transition: Transition,
    overlays: OverlayStage | None,
    tick: int,
) -> Delivered:
    """Events that agents play past in pose tick `tick`, overlays included.

    An overlay's events carry its weight; the body's keep theirs, since an overlay moves only some
    of its joints.

    Parameters
    ----------
    pool, anim, transition, overlays
        The crowd's streams, columns and overlays.
    tick
        The pose tick that was just committed.
    """
    found = [deliver(pool, anim, transition, BODY, tick)]
    columns = None if overlays is None else overlays.columns
    for layer in range(0 if columns is None else len(columns.mask)):
        assert columns is not None
        if not (columns.mask[layer] != NO_MASK).any():
            continue
        agents, bits, weights = deliver(pool, anim, transition, 1 + layer, tick)
        weights = weights * layer_weights(columns, layer, agents, float(tick))
        seen = weights > 0
        found.append(Delivered(agents[seen], bits[seen], weights[seen]))
    if len(found) == 1:
        return found[0]
    agents, bits, weights = (np.concatenate(column) for column in zip(*found, strict=True))
    order = np.argsort(agents, kind="stable")
    return Delivered(agents[order], bits[order], weights[order])
