"""Everything that draws one crowd."""

from __future__ import annotations

from dataclasses import dataclass

from ...components import Level
from ..assets.character import Character
from .crowd_inputs import CrowdColumns, CrowdInputs
from .figure_pass import FigurePass
from .frame import Frame
from .skinned_pass import SkinnedPass
from .variant_lists import VariantLists


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
        self._character = character
        self._columns = columns
        self.inputs = CrowdInputs(columns)
        self._revision = self.inputs.revision
        self._skinned: SkinnedPass | None = None
        self._lists: list[VariantLists] = []
        self._figures = FigurePass(height, self.inputs.defines)
        self.counts = DrawCounts()

    def update(self, tick: int) -> None:
        """Copy what the simulation changed.

        Raises
        ------
        GraphicsError
            For an override that does not compile.
        """
        uploaded = self.inputs.update(tick)
        self._current()
        *near, far = self._columns.detail.agents
        body = self._columns.body
        for lists, ids in zip(self._lists, near, strict=True):
            uploaded += lists.write(ids, None if body is None else body.choice)
        uploaded += self._figures.agents.write(far)
        self.counts.uploaded = uploaded

    def draw(self, frame: Frame) -> None:
        """Draw what `update` copied into the bound framebuffer."""
        self.counts.triangles = self._current().draw(frame, self.inputs)
        self.counts.triangles += self._figures.draw(frame, self.inputs)

    def delete(self) -> None:
        """Delete everything on the GPU."""
        self.inputs.delete()
        if self._skinned is not None:
            self._skinned.delete()
        self._figures.delete()

    def _current(self) -> SkinnedPass:
        """The pass whose programs have the overrides that there are now."""
        if self._skinned is None or self._revision != self.inputs.revision:
            levels = range(len(Level) - 1)
            self._lists = [VariantLists(self._character, level) for level in levels]
            draws = [draw for lists in self._lists for draw in lists.draws]
            made = SkinnedPass(
                draws, self._character.materials, self.inputs, regions=self.inputs.regions
            )
            if self._skinned is not None:
                self._skinned.delete()
            self._skinned, self._revision = made, self.inputs.revision
        return self._skinned
