"""Crowds to files of other programs, in one call."""

from __future__ import annotations

from pathlib import Path

from ..engine.export.gltf import write_baked_gltf, write_gltf
from ..engine.export.gltf_file import KINDS as GLTF_KINDS
from ..engine.export.recording import Recording
from ..engine.export.targets import Exported, Progress, check_target
from ..engine.export.usd import KINDS as USD_KINDS
from ..engine.export.usd import check_usd, write_usd
from .recording import Agents
from .simulation import Simulation


def export_gltf(
    source: Simulation | Recording,
    path: str | Path,
    *,
    agents: Agents = None,
    start: float = 0.0,
    seconds: float = 0.0,
    fps: float = 30.0,
    baked: bool = False,
    level: int = 0,
    rigid: bool = False,
    split: bool = False,
    progress: Progress | None = None,
) -> Exported:
    """Write agents to a .glb file, or a .gltf with its .bin beside it.

    Parameters
    ----------
    source
        A simulation, in which time passes; or a recording, of which all frames are written.
    path
        Of the file.
    agents
        An id, ids, a mask, or seats such as ``"section 5"``; everybody if None. Of a recording,
        ids.
    start, seconds, fps
        Of a simulation: seconds that pass first, the time that is recorded, and frames a second.
        Without `seconds` it is one moment and the file has no animation.
    baked
        Whether the surface of one moment is written instead of skeletons and skins.
    level
        Level of detail of the meshes, 0 is the finest.
    rigid
        Whether bones are left without stretch; see docs/export.md.
    split
        Whether each agent has an animation of its own, instead of one that moves all.
    progress
        Called as ``progress(what, done, total)``.

    Raises
    ------
    AssetError
        If the file can't be written.
    ValueError
        For agents, times or a level that don't exist, or a baked time range.
    """
    check_target(path, GLTF_KINDS)
    if baked and seconds > 0:
        raise ValueError(f"seconds is {seconds}, but baked glTF holds one moment; use USD, or 0")
    recording = _recording(source, agents, start, seconds, fps, level, progress)
    if baked:
        return write_baked_gltf(recording, path, level=level, progress=progress)
    return write_gltf(recording, path, level=level, rigid=rigid, split=split, progress=progress)


def export_usd(
    source: Simulation | Recording,
    path: str | Path,
    *,
    agents: Agents = None,
    start: float = 0.0,
    seconds: float = 0.0,
    fps: float = 30.0,
    baked: bool = False,
    level: int = 0,
    rigid: bool = False,
    instances: bool = True,
    progress: Progress | None = None,
) -> Exported:
    """Write agents to a .usd, .usda or .usdc file; needs ``pip install 'tifo[usd]'``.

    Parameters
    ----------
    source, path, agents, start, seconds, fps, level, rigid, progress
        As for `export_gltf`.
    baked
        Whether points at each frame are written instead of skeletons and skins.
    instances
        Whether skinned agents are instances, one prototype for each look, which is smallest and
        fastest, with their colours as primvars; else each is a prim of its own with materials bound
        to it, which more programs read.

    Raises
    ------
    AssetError
        If usd-core is missing or the file can't be written.
    ValueError
        For agents, times or a level that don't exist.
    """
    check_target(path, USD_KINDS)
    check_usd(path)
    recording = _recording(source, agents, start, seconds, fps, level, progress)
    return write_usd(
        recording,
        path,
        level=level,
        baked=baked,
        rigid=rigid,
        instances=instances,
        progress=progress,
    )


def _recording(
    source: Simulation | Recording,
    agents: Agents,
    start: float,
    seconds: float,
    fps: float,
    level: int,
    progress: Progress | None,
) -> Recording:
    if isinstance(source, Recording):
        if start or seconds:
            raise ValueError("start and seconds are for simulations; a recording has its frames")
        return source if agents is None else source.select(agents)
    levels = 1 + len(source.crowd.character.lower_levels)
    if not 0 <= level < levels:
        raise ValueError(f"level is {level}, expected 0 to {levels - 1}")
    return source.record(agents, start=start, seconds=seconds, fps=fps, progress=progress)
