"""Draws one crowd into whatever another program has bound, and leaves OpenGL as it was."""

from __future__ import annotations

from typing import Any
from weakref import WeakKeyDictionary

from ..components import View
from ..engine.clock import Clock
from ..engine.gl.api import require_context
from ..engine.gl.context import describe_context
from ..engine.gl.objects import collect, context_exists
from ..engine.gl.saved_state import SavedState, prepare_state
from ..engine.gl.state import DrawTarget, takes_srgb_bytes
from ..engine.render.crowd_renderer import DrawCounts
from ..engine.render.frame import Frame
from ..engine.render.placed_view import placed_view
from .detail import DetailSystem
from .render import RenderSystem

__all__ = ["SOFTWARE_COARSENESS", "CrowdMirrors", "DrawCounts"]

SOFTWARE_COARSENESS = 2.0
"""How much sooner coarser meshes are used where the processor draws: it pays for every vertex."""


class _Mirror:
    """What a crowd has in one GL context."""

    def __init__(self, levels: bool) -> None:
        self.render = RenderSystem((1, 1))
        self.detail = DetailSystem(levels=levels)
        if describe_context().is_software:
            self.detail.coarseness = SOFTWARE_COARSENESS


class CrowdMirrors:
    """The copies that GL contexts have of one crowd: one in each, made when it is drawn there.

    Parameters
    ----------
    entity
        The crowd; its esper world must be the current one in every call.
    levels
        Whether distant agents are drawn more coarsely.
    """

    def __init__(self, entity: int, levels: bool) -> None:
        self._entity, self._levels = entity, levels
        self._mirrors: WeakKeyDictionary[Any, _Mirror] = WeakKeyDictionary()

    def draw(
        self,
        clock: Clock,
        view: Any,
        projection: Any,
        world_from_crowd: Any,
        size: tuple[int, int] | None,
        restore_state: bool,
    ) -> DrawCounts:
        """Draw into the bound framebuffer; see `Crowd.draw`."""
        seen, lens = placed_view(view, projection, world_from_crowd)
        context = require_context()
        self._forget_closed()
        before = SavedState() if restore_state else None
        try:
            prepare_state()
            mirror = self._mirrors.get(context)
            if mirror is None:
                mirror = self._mirrors[context] = _Mirror(self._levels)
            size = size or DrawTarget.current().viewport[2:]
            mirror.detail.select(View(seen, lens, size[1]), only=self._entity)
            frame = Frame(seen, lens, size, clock.pose_tick, clock.alpha, encode=takes_srgb_bytes())
            mirror.render.draw(frame, only=self._entity)
            return mirror.render.counts
        finally:
            if before is not None:
                before.restore()

    def release(self) -> None:
        """Delete everything: in the current context now, in others when they are current again."""
        for mirror in list(self._mirrors.values()):
            mirror.render.delete()
        self._mirrors.clear()
        collect()

    def _forget_closed(self) -> None:
        for context in list(self._mirrors):
            if not context_exists(context):
                self._mirrors.pop(context).render.delete()
