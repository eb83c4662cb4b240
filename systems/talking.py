"""People talk on whatever their arms do: their heads are laid over what the body shows."""

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

LAYER = 1
"""The overlay layer that heads use."""
BLEND = 9.0
"""Pose ticks in which a head turns to its own motion, and back."""


@dataclass(slots=True, eq=False)
class Talking:
    """Per agent (N,) bool: its head is laid over."""

    is_laid: NDArray[np.bool_]

    def update(
        self,
        entity: int,
        table: CompiledTable,
        behaviour: Behaviour,
        changed: NDArray[np.int64],
        rng: np.random.Generator,
    ) -> None:
        """Lay the heads of those over who talk while their arms are busy, of (K,) who changed.

        Agents that have an overlay of somebody else in the layer are left alone.
        """
        stage = esper.component_for_entity(entity, OverlayStage)
        if len(behaviour.state) < 2 or "head" not in stage.masks.names:
            return
        motion = behaviour.motion[1, changed]
        wants = (behaviour.arms[changed] != 0) & (motion != KEEP)
        # A motion of the head machine is kept while it is; its state says whether it talks.
        wants &= table.head[behaviour.state[1, changed]] > 0
        has = self.is_laid[changed]
        new = np.flatnonzero(wants & ~has)
        new = new[stage.columns.mask[LAYER, changed[new]] == NO_MASK]
        if len(new):
            ids = changed[new]
            form = motion[new]
            sits = behaviour.posture[ids] == SEATED
            form = np.where(table.seated[form] == sits, form, table.other_form[form])
            streams = esper.component_for_entity(entity, MotionStreams)
            kind = esper.component_for_entity(entity, Body).kind[ids]
            rows = streams.draw_rows(form.astype(np.int16), kind, rng)
            stage.ask(LAYER, ids, stage.masks.index("head"), rows, np.nan, 1.0, BLEND)
            self.is_laid[ids] = True
        gone = changed[has & ~wants]
        if len(gone):
            stage.ask(LAYER, gone, NO_MASK, 0, 0.0, 0.0, BLEND)
            self.is_laid[gone] = False
