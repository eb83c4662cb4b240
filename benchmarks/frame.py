"""What a picture costs: tick, upload and drawing of a stadium, from each camera."""

from __future__ import annotations

from typing import Any

from ..engine.crowd.cameras import camera_presets
from ..engine.crowd.spec import CrowdSpec
from ..engine.gl.api import gl
from ..engine.gl.context import describe_context
from ..scripting.camera import FreeCamera
from ..scripting.stage import Stage
from ..systems.simulation import Simulation
from .measure import environment, spread, time_calls


def frame(
    *, agents: int, streams: int, history: int, size: tuple[int, int], runs: int, seed: int = 1
) -> dict[str, Any]:
    """Time pictures of the built-in spectators, each one pose tick after the one before.

    Absolute times mean something on a GPU only; a software rasteriser's are for comparing.

    Parameters
    ----------
    agents, streams, history
        Size of the crowd.
    size
        Pixels of the picture.
    runs
        Pictures that are timed from each camera.
    seed
        Of the crowd.
    """
    simulation = Simulation(
        CrowdSpec(seats=agents, sides=2, streams=streams, history=history, seed=seed)
    )
    stage = Stage.offscreen(simulation, size)
    cameras: dict[str, Any] = {}
    every: list[float] = []
    for name, (eye, target) in camera_presets(simulation.plan).items():
        camera = FreeCamera.looking(eye, target)

        def picture(_: int, camera: FreeCamera = camera) -> None:
            stage.draw(camera, 2 / 60)
            gl.glFinish()

        seconds = time_calls(picture, runs, warm_up=2)
        every += seconds
        cameras[name] = {
            **spread(seconds),
            "triangles": stage.counts.triangles,
            "uploaded_bytes": stage.counts.uploaded,
            "agents_at_level": [len(ids) for ids in simulation.crowd.detail.agents],
        }
    info = describe_context()
    stage.close()
    return {
        "benchmark": "frame",
        "agents": agents,
        "streams": streams,
        "width_pixels": size[0],
        "height_pixels": size[1],
        **spread(every),
        "cameras": cameras,
        "environment": {**environment(), "renderer": info.renderer, "software": info.is_software},
    }
