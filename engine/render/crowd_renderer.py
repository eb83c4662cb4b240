"""Everything that draws one crowd."""

from __future__ import annotations

from dataclasses import dataclass

from ...components import Level
from ..assets.character import Character
from .crowd_inputs import CrowdColumns, CrowdInputs
from .figure_pass import FigurePass
from .frame import Frame
from .skinned_pass import InstanceList, SkinnedPass


@dataclass(slots=True)
class DrawCounts:
    """What the last picture cost."""

    triangles: int = 0
    uploaded: int = 0


class CrowdRenderer:
    """GPU copies of one crowd's columns and poses, and the passes that draw it.

    Parameters
    ----------
    character
        Meshes and materials.
    height
        Height of the character in metres.
    columns
        The crowd's columns; read at every draw.

    Attributes
    ----------
    inputs
        What the crowd's shaders read, for whatever else is drawn of its agents.
    counts
        Of the last picture.
    """

    def __init__(self, character: Character, height: float, columns: CrowdColumns) -> None:
        self._columns = columns
        self.inputs = CrowdInputs(columns)
        lists = [InstanceList() for _ in range(len(Level) - 1)]
        self._skinned = SkinnedPass(character, self.inputs.defines, lists)
        self._figures = FigurePass(height, self.inputs.defines)
        self.counts = DrawCounts()

    def update(self, tick: int) -> None:
        """Copy what the simulation changed."""
        uploaded = self.inputs.update(tick)
        lists = (*self._skinned.lists, self._figures.agents)
        for agents, ids in zip(lists, self._columns.detail.agents, strict=True):
            uploaded += agents.write(ids)
        self.counts.uploaded = uploaded

    def draw(self, frame: Frame) -> None:
        """Draw what `update` copied into the bound framebuffer."""
        self.counts.triangles = self._skinned.draw(frame, self.inputs)
        self.counts.triangles += self._figures.draw(frame, self.inputs)

    def delete(self) -> None:
        """Delete everything on the GPU."""
        self.inputs.delete()
        self._skinned.delete()
        self._figures.delete()
