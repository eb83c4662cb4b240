"""Where a simulation is drawn: a framebuffer of our own, offscreen and in windows alike."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..engine.errors import GraphicsError
from ..engine.gl.context import create_offscreen_context, describe_context
from ..engine.gl.framebuffer import Framebuffer
from ..engine.render.crowd_renderer import DrawCounts
from ..engine.render.placed_view import placed_view
from ..engine.render.present import present
from ..systems.render import RenderSystem
from ..systems.render_embedded import SOFTWARE_COARSENESS
from ..systems.simulation import Simulation

Matrix = NDArray[np.float32]


class Viewpoint(Protocol):
    """What can be drawn from: a `FreeCamera`, a `Camera` node, or a camera of your own."""

    def view(self) -> Matrix:
        """(4, 4) from the world to camera space."""

    def projection(self, size: tuple[int, int]) -> Matrix:
        """(4, 4) from camera to clip space for a picture of `size` pixels."""


class Stage:
    """A picture of a simulation, drawn in the current GL context.

    Parameters
    ----------
    simulation
        What is drawn; its stadium's geometry is built if it wasn't yet.
    size
        Pixels (width, height).
    samples
        Samples a pixel, fewer if the driver has fewer.

    Raises
    ------
    GraphicsError
        If there is no GL context, or the picture is larger than the driver can draw.
    """

    def __init__(self, simulation: Simulation, size: tuple[int, int], *, samples: int = 4) -> None:
        self.simulation = simulation
        self._limits = describe_context()
        self._samples = min(samples, self._limits.max_samples)
        self._system = RenderSystem(size)
        self._framebuffer = self._make(size)
        if self._limits.is_software:
            simulation.detail.coarseness = SOFTWARE_COARSENESS
        simulation.build_mesh()
        simulation.schedule.frame_systems.append(self._system)

    @classmethod
    def offscreen(cls, simulation: Simulation, size: tuple[int, int], *, samples: int = 4) -> Stage:
        """A stage with a GL context of its own that needs no display."""
        create_offscreen_context()
        return cls(simulation, size, samples=samples)

    @property
    def size(self) -> tuple[int, int]:
        """Pixels (width, height)."""
        return self._framebuffer.size

    @property
    def counts(self) -> DrawCounts:
        """What the last picture cost."""
        return self._system.counts

    @property
    def is_software(self) -> bool:
        """Whether the processor draws, which takes seconds for large near crowds."""
        return self._limits.is_software

    def resize(self, size: tuple[int, int]) -> None:
        """Draw pictures of another size from now on."""
        if size != self.size:
            self._framebuffer.delete()
            self._framebuffer = self._make(size)

    def draw(self, camera: Viewpoint, delta: float = 0.0) -> None:
        """Let `delta` seconds pass and draw what `camera` sees."""
        self._begin(camera, None)
        self.simulation.advance(delta)

    def show(self, camera: Viewpoint, world_from_stadium: Any = None) -> None:
        """Draw what `camera` sees of a simulation that somebody else lets run.

        Parameters
        ----------
        camera
            In the world.
        world_from_stadium
            (4, 4) place of the stadium in the world, with a uniform scale; as it is if None.
        """
        self._begin(camera, world_from_stadium)
        with self.simulation.active():
            self.simulation.schedule.frame()

    def pixels(self) -> NDArray[np.uint8]:
        """The last picture: (H, W, 3) uint8 sRGB, top row first."""
        return np.ascontiguousarray(self._framebuffer.resolve().read_pixels()[..., :3])

    def present(self, size: tuple[int, int]) -> None:
        """Copy the last picture to the window's framebuffer of `size` pixels."""
        present(self._framebuffer, size)

    def close(self) -> None:
        """Delete everything on the GPU."""
        self.simulation.schedule.frame_systems.remove(self._system)
        self._system.delete()
        self._framebuffer.delete()

    def _begin(self, camera: Viewpoint, world_from_stadium: Any) -> None:
        width, height = self.size
        view, projection = placed_view(
            camera.view(), camera.projection((width, height)), world_from_stadium
        )
        self.simulation.look(view, projection, height)
        self._framebuffer.bind()
        self._framebuffer.clear((0.0, 0.0, 0.0, 1.0))

    def _make(self, size: tuple[int, int]) -> Framebuffer:
        most = self._limits.max_texture_size
        if not all(1 <= side <= most for side in size):
            raise GraphicsError(
                f"a picture of {size[0]}x{size[1]} pixels can't be drawn; "
                f"this driver draws 1x1 to {most}x{most}"
            )
        self._system.size = size
        return Framebuffer(size, samples=self._samples)
