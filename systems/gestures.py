"""What machines beside the body's show is laid over what the body does: talking heads, waving arms.

The machine `head` lays its motions over the head while the arms are busy (else the whole body shows
them, see `display`), the machine `arms` always over the arms: whoever is close to a goal's scorer
waves or reaches out whatever the rest of him does (*Streams 2017*, section 5).
"""

from __future__ import annotations

from dataclasses import dataclass

import esper
import numpy as np
from numpy.typing import NDArray

from ..components import Behaviour, Body
from ..components.overlays import NO_MASK
from ..engine.behaviour.compiled import CompiledTable
from ..engine.behaviour.looks import KEEP
from ..engine.behaviour.table import SEATED
from ..engine.crowd.motions import MotionStreams
from ..engine.streams.overlaying import OverlayStage

LAYERS = {"arms": 0, "head": 1}
"""The overlay layer of each machine, whose name is that of its joints' mask."""
BLEND = 9.0
"""Pose ticks in which joints turn to their own motion, and back."""


@dataclass(slots=True, eq=False)
class _Laid:
    """One machine, and per agent (N,) int16 the motion that is laid over; -1 for none."""

    machine: int
    mask: str
    motion: NDArray[np.int16]


class Gestures:
    """What is laid over the bodies of a crowd.

    Parameters
    ----------
    table, count
        The crowd's table, and its number of agents.
    """

    __slots__ = ("_laid", "_shows")

    def __init__(self, table: CompiledTable, count: int) -> None:
        self._laid = tuple(
            _Laid(number, name, np.full(count, KEEP, np.int16))
            for number, name in enumerate(table.table.machines)
            if name in LAYERS
        )
        self._shows = np.array([bool((look.motion != KEEP).any()) for look in table.looks])

    def update(
        self,
        entity: int,
        table: CompiledTable,
        behaviour: Behaviour,
        changed: NDArray[np.int64],
        rng: np.random.Generator,
    ) -> None:
        """Lay over, or take away, what (K,) agents whose states changed show beside their bodies.

        Agents that have an overlay of somebody else in the layer are left alone.
        """
        stage = esper.component_for_entity(entity, OverlayStage)
        for laid in self._laid:
            if laid.mask in stage.masks.names:
                self._update(laid, stage, entity, table, behaviour, changed, rng)

    def _update(
        self,
        laid: _Laid,
        stage: OverlayStage,
        entity: int,
        table: CompiledTable,
        behaviour: Behaviour,
        changed: NDArray[np.int64],
        rng: np.random.Generator,
    ) -> None:
        motion = behaviour.motion[laid.machine, changed]
        # A motion is kept where a state has none; the state says whether it is shown.
        wants = (motion != KEEP) & self._shows[behaviour.state[laid.machine, changed]]
        if laid.mask == "head":
            wants &= behaviour.arms[changed] != 0
        now, layer = laid.motion[changed], LAYERS[laid.mask]
        gone = changed[~wants & (now != KEEP)]
        if len(gone):
            stage.ask(layer, gone, NO_MASK, 0, 0.0, 0.0, BLEND)
            laid.motion[gone] = KEEP
        new = np.flatnonzero(wants & (now != motion))
        is_ours = now[new] != KEEP
        new = new[is_ours | (stage.columns.mask[layer, changed[new]] == NO_MASK)]
        if not len(new):
            return
        ids, form = changed[new], motion[new]
        sits = behaviour.posture[ids] == SEATED
        form = np.where(table.seated[form] == sits, form, table.other_form[form])
        streams = esper.component_for_entity(entity, MotionStreams)
        kind = esper.component_for_entity(entity, Body).kind[ids]
        rows = streams.draw_rows(form.astype(np.int16), kind, rng)
        stage.ask(layer, ids, stage.masks.index(laid.mask), rows, np.nan, 1.0, BLEND)
        laid.motion[ids] = motion[new]
