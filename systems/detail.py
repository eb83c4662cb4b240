"""Culling and level of detail."""

from __future__ import annotations

import esper

from ..components import Detail, Placement, Seat, View
from ..engine.clock import Clock
from ..engine.crowd.detail import select_detail
from ..engine.crowd.figure import Figure
from .query import crowds


class DetailSystem(esper.Processor):
    """Chooses which agents are drawn at which level; needs one entity with a `View`.

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
            select_detail(
                detail,
                placement,
                seat.occupied,
                figure.height,
                view,
                levels=self._levels,
                coarseness=self.coarseness,
            )
