"""How a program that owns its window and its esper world runs and draws a crowd."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import esper

from ..engine.clock import Clock
from ..engine.crowd.spec import CrowdSpec

if TYPE_CHECKING:
    from .render_embedded import CrowdMirrors, DrawCounts


class DrawingCalls:
    """Calls of a `Crowd` that add it to other programs."""

    __slots__ = ()

    entity: int
    spec: CrowdSpec
    world: str
    mirrors: list[CrowdMirrors]

    def systems(self) -> list[esper.Processor]:
        """The processors that the crowd's world still lacks, to be added to it.

        One `Schedule`, which runs all crowds of the world, so that ``esper.process(delta)`` once a
        frame is all there is to do; nothing if the world has its systems already.

        Examples
        --------
        >>> for system in crowd.systems():
        ...     esper.add_processor(system)
        """
        from .history import HistorySystem
        from .schedule import Schedule, tick_systems

        with self._active():
            if esper.get_processor(Schedule) or esper.get_processor(HistorySystem):
                return []
        return [Schedule(Clock(), tick_systems(self.spec.seed))]

    def draw(
        self,
        view: Any,
        projection: Any,
        *,
        world_from_crowd: Any = None,
        size: tuple[int, int] | None = None,
        restore_state: bool = True,
    ) -> DrawCounts:
        """Draw the spectators into the framebuffer that is bound, in the current GL context.

        Everything else is yours: the window, the camera, clearing, what stands around. Depth is
        tested and written as in any opaque pass (less or equal, 0 near). Framebuffers, viewport,
        scissor, stencil and depth range are used as they are. A framebuffer that encodes sRGB gets
        linear light, one of floating point numbers too, and any other gets sRGB bytes. The first
        call in a context uploads the crowd to it.

        Parameters
        ----------
        view, projection
            World to camera, and camera to clip space: (4, 4) NumPy matrices for column vectors, or
            16 numbers column by column, such as pyglet's ``Mat4``. The projection is a perspective
            one.
        world_from_crowd
            Where the crowd stands in your world: rotation, translation and uniform scale; as it is
            if None.
        size
            Pixels (width, height) of the viewport; asked from GL if None.
        restore_state
            Leave OpenGL exactly as it was. Without it the program, the vertex array, buffers,
            textures, samplers and switches are not put back, which saves about half a
            millisecond.

        Returns
        -------
        DrawCounts
            Triangles drawn and bytes copied.

        Raises
        ------
        ValueError
            For matrices that can't be used.
        GraphicsError
            If no GL context is current.
        """
        from .render_embedded import CrowdMirrors

        if not self.mirrors:
            self.mirrors.append(CrowdMirrors(self.entity, self.spec.lod))
        with self._active():
            clock = esper.try_component(self.entity, Clock) or Clock()
            return self.mirrors[0].draw(
                clock, view, projection, world_from_crowd, size, restore_state
            )

    def release_graphics(self) -> None:
        """Delete what drawing made: in the current context now, in others when current again.

        Closing a window needs no call; this is for crowds that are not drawn any more.
        """
        while self.mirrors:
            self.mirrors.pop().release()

    @contextmanager
    def _active(self) -> Iterator[None]:
        before = esper.current_world
        esper.switch_world(self.world)
        try:
            yield
        finally:
            esper.switch_world(before)
