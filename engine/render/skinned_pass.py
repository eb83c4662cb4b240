"""Agents close enough for a mesh: instanced, skinned in the vertex shader."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..assets.character import Character, Material, SkinnedMesh
from ..crowd.regions import Regions
from ..gl.buffer import Buffer
from ..gl.program import Program
from ..gl.texture import Texture2D
from ..gl.texture_format import TextureFormat
from ..gl.vertex_array import Primitive, VertexArray
from ..gl.vertex_input import Attribute, VertexInput
from .body_mesh import NORMALISED, VERTEX, Batch, make_batches, split_batch
from .crowd_inputs import CrowdInputs
from .frame import Frame
from .state import opaque

IMAGE_UNIT = 6


@dataclass(frozen=True, slots=True, eq=False)
class _Drawn:
    """A batch on the GPU."""

    program: Program
    vertex_array: VertexArray
    buffers: tuple[Buffer, Buffer]
    image: Texture2D | None
    double_sided: bool


class InstanceList:
    """Ids of the agents that one level draws, as an attribute."""

    def __init__(self) -> None:
        self.buffer = Buffer(4 * 1024, "stream")
        self.count = 0

    def write(self, agents: NDArray[np.uint32]) -> int:
        """Copy the ids; bytes copied."""
        self.count = len(agents)
        if agents.nbytes > self.buffer.nbytes:
            self.buffer.replace(2 * agents.nbytes)
        self.buffer.write(agents, orphan=True)
        return agents.nbytes

    def input(self, divisor: int = 1) -> VertexInput:
        """The attribute ``agent``: one an instance, or one a vertex if `divisor` is 0."""
        layout = [Attribute("agent", 1, np.uint32, integer=True)]
        return VertexInput(self.buffer, layout, divisor=divisor)

    def inputs(self) -> list[VertexInput]:
        """All attributes of an instance."""
        return [self.input()]

    def delete(self) -> None:
        """Delete what is on the GPU."""
        self.buffer.delete()


Draw = tuple[Sequence[SkinnedMesh], InstanceList]


def level_draws(character: Character, lists: Sequence[InstanceList]) -> list[Draw]:
    """A list of agents for each level; missing coarser ones show the coarsest there is."""
    meshes = [character.meshes, *character.lower_levels]
    return [(meshes[min(level, len(meshes) - 1)], agents) for level, agents in enumerate(lists)]


class SkinnedPass:
    """Draws meshes, some for each of several lists of agents.

    Parameters
    ----------
    draws
        Meshes and who is drawn with them; the pass deletes the lists with itself.
    materials
        Of the meshes.
    inputs
        The crowd's, which make the programs.
    switches
        Defined in the programs as well.
    regions
        Where the parts and the patterns of shirts are; None for neither.
    """

    def __init__(
        self,
        draws: Sequence[Draw],
        materials: Sequence[Material],
        inputs: CrowdInputs,
        switches: frozenset[str] = frozenset(),
        regions: Regions | None = None,
    ) -> None:
        self._inputs = inputs
        self._programs: dict[frozenset[str], Program] = {}
        self._regions = regions
        if regions is not None:
            switches |= {"PARTED" if regions.parted else "PATTERNED"}
        self.lists = tuple(agents for _, agents in draws)
        self._draws = tuple(
            tuple(
                self._upload(part, agents, switches | own)
                for batch in make_batches(meshes, materials, inputs.morphs, regions)
                for part, own in _parts(batch, inputs.overridden)
            )
            for meshes, agents in draws
        )

    def draw(self, frame: Frame, inputs: CrowdInputs) -> int:
        """Draw all lists; triangles drawn."""
        triangles = 0
        for program in self._programs.values():
            frame.apply(program)
            inputs.bind(program, frame.tick, frame.alpha, markers=False)
            if self._regions is not None:
                _bind_regions(program, self._regions)
            for batches, agents in zip(self._draws, self.lists, strict=True):
                for batch in batches if agents.count else ():
                    if batch.program is program:
                        triangles += self._draw(batch, agents.count)
        return triangles

    def _draw(self, batch: _Drawn, instances: int) -> int:
        opaque(cull=not batch.double_sided)
        if batch.image is not None:
            batch.image.bind(IMAGE_UNIT)
            batch.program["image"] = IMAGE_UNIT
        batch.vertex_array.draw_instanced(Primitive.TRIANGLES, None, instances)
        return batch.buffers[1].nbytes // 12 * instances

    def _upload(self, batch: Batch, agents: InstanceList, switches: frozenset[str]) -> _Drawn:
        if switches not in self._programs:
            self._programs[switches] = self._inputs.make_program(
                "crowd/skinned.vert.glsl",
                "crowd/skinned.frag.glsl",
                defines=dict.fromkeys(sorted(switches), 1),
            )
        program = self._programs[switches]
        image = None if batch.image is None else _picture(batch.image)
        vertices = Buffer(batch.vertices)
        indices = Buffer(batch.indices)
        vertex_array = VertexArray(
            program,
            [VertexInput(vertices, VERTEX, normalised=NORMALISED), *agents.inputs()],
            indices,
        )
        return _Drawn(program, vertex_array, (vertices, indices), image, batch.double_sided)

    def delete(self) -> None:
        """Delete everything on the GPU."""
        for batches in self._draws:
            for batch in batches:
                batch.vertex_array.delete()
                for buffer in batch.buffers:
                    buffer.delete()
                if batch.image is not None:
                    batch.image.delete()
        for agents in self.lists:
            agents.delete()
        for program in self._programs.values():
            program.delete()


def _bind_regions(program: Program, regions: Regions) -> None:
    """What turns a place in the bind pose into heights of the trunk."""
    scale = 1.0 / regions.trunk
    across = regions.across * scale
    program["trunk_across"] = (float(across[0]), float(across[1]), -regions.middle * scale)
    program["trunk_up"] = (scale, -regions.waist * scale)
    if regions.parted:
        program["tint"] = regions.tint


def _parts(
    batch: Batch, overridden: NDArray[np.bool_] | None
) -> list[tuple[Batch, frozenset[str]]]:
    """A batch, and what its program is switched to; in two where overrides reach some of it.

    Most of a body is not a head: on the processor, code that is jumped over costs as much as code
    that runs.
    """
    switches = frozenset[str]() if batch.image is None else frozenset({"TEXTURED"})
    if overridden is None:
        return [(batch, switches)]
    apart, reached = split_batch(batch, overridden)
    found = [(apart, switches | {"UNTOUCHED"}), (reached, switches)]
    return [(part, kinds) for part, kinds in found if len(part.indices)]


def _picture(image: NDArray[np.uint8]) -> Texture2D:
    height, width = image.shape[:2]
    levels = int(max(width, height)).bit_length()
    texture = Texture2D(
        (width, height), TextureFormat.SRGB8_ALPHA8, levels=levels, filter="linear", wrap="repeat"
    )
    texture.write(image)
    texture.build_mipmaps()
    return texture
