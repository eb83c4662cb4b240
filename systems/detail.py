"""Culling and level of detail."""

from __future__ import annotations

import esper

from ..components import Attachment, Detail, PartBits, Placement, Seat, View
from ..engine.clock import Clock
from ..engine.crowd.detail import Bounds, select_detail, select_part
from ..engine.crowd.figure import Figure
from .query import crowds


class DetailSystem(esper.Processor):
    """Chooses which agents are drawn at which level, and which of them with their parts.

    Needs one entity with a `View`.

    Parameters
    ----------
    levels
        Whether distant agents are drawn more coarsely.

    Attributes
    ----------
    coarseness
        Factor on the sizes at which agents change level; see `select_detail`.
    """

    def __init__(self, *, levels: bool = True) -> None:
        self.coarseness = 1.0
        self._levels = levels

    def process(self, clock: Clock) -> None:
        """One frame."""
        views = crowds(View)
        if views:
            self.select(views[0][1][0])

    def select(self, view: View, only: int | None = None) -> None:
        """Choose for a camera: in all crowds, or in `only` one."""
        for entity, (detail, placement, seat) in crowds(Detail, Placement, Seat):
            if only not in (None, entity):
                continue
            figure = esper.component_for_entity(entity, Figure)
            bounds = esper.try_component(entity, Bounds)
            if bounds is None or not bounds.fits(placement):
                bounds = Bounds.of(placement)
                esper.add_component(entity, bounds)
            select_detail(
                detail,
                placement,
                seat.occupied,
                figure.height,
                view,
                levels=self._levels,
                coarseness=self.coarseness,
                bounds=bounds,
            )
        for _, (attachment, detail) in crowds(Attachment, Detail):
            parent = esper.try_component(attachment.parent, Detail)
            bits = esper.try_component(attachment.parent, PartBits)
            if parent is not None and bits is not None:
                select_part(detail, parent, bits, attachment.bit)
