"""Draws a part of a crowd: its own meshes and poses, hung on a joint that the crowd's poses move.

A first pass finds the joint's matrix, once for each agent that shows the part, by the functions
that skin the bodies: whatever is blended or laid over there is in it. It stays on the GPU as an
attribute of the instances that the second pass draws. Agents without the part are in no list, so
they cost nothing.
"""

from __future__ import annotations

from dataclasses import replace

from ...components import Attachment, Detail, Level
from ..assets.character import Character
from ..assets.variants import one_look
from ..gl.buffer import Buffer
from ..gl.feedback import capture_into
from ..gl.vertex_array import VertexArray
from ..gl.vertex_input import Attribute, VertexInput
from .crowd_inputs import CrowdColumns, CrowdInputs
from .crowd_renderer import DrawCounts
from .frame import Frame
from .skinned_pass import InstanceList, SkinnedPass, level_draws

_ROWS = 12
"""Numbers of an affine matrix."""


class HookedList(InstanceList):
    """Ids of the agents that show a part at one level, and where it is on each of them."""

    def __init__(self) -> None:
        super().__init__()
        self.hooks = Buffer(4 * _ROWS * 1024, "stream")

    def inputs(self) -> list[VertexInput]:
        """All attributes of an instance."""
        layout = [Attribute("hook", _ROWS)]
        return [self.input(), VertexInput(self.hooks, layout, divisor=1)]

    def delete(self) -> None:
        """Delete what is on the GPU."""
        super().delete()
        self.hooks.delete()


class HookPass:
    """Finds where a part is on each agent of some lists.

    Parameters
    ----------
    attachment
        The part.
    parent
        Inputs of its crowd.
    lists
        Receive the matrices.
    """

    def __init__(
        self, attachment: Attachment, parent: CrowdInputs, lists: tuple[HookedList, ...]
    ) -> None:
        self._attachment = attachment
        self._parent = parent
        self._program = parent.make_program("parts/hook.vert.glsl", feedback=("hook",))
        self._lists = tuple(
            (agents, VertexArray(self._program, [agents.input(divisor=0)])) for agents in lists
        )

    def run(self, tick: int, alpha: float) -> None:
        """Fill the lists' `hooks` for a moment."""
        program = self._program
        self._parent.bind(program, tick, alpha, markers=False)
        program["joint"] = self._attachment.joint
        program["place"] = self._attachment.place.T
        physique = self._parent.physique
        joint = self._attachment.joint
        program["growth"] = physique.morphs.head[joint] if physique and joint >= 0 else 0.0
        for agents, vertex_array in self._lists:
            if agents.count:
                capture_into(agents.hooks, program, vertex_array, agents.count)

    def delete(self) -> None:
        """Delete everything on the GPU but the lists."""
        for _, vertex_array in self._lists:
            vertex_array.delete()
        self._program.delete()


class PartRenderer:
    """GPU copies of a part's columns and poses, and the passes that draw it.

    Parameters
    ----------
    attachment, character, detail
        The part, its meshes, and who shows it at which level; the farthest level is not drawn.
    parent
        Inputs of its crowd, which must be updated before the part.
    columns
        The part's own columns; None for a part that the body's poses skin.
    """

    def __init__(
        self,
        attachment: Attachment,
        character: Character,
        detail: Detail,
        parent: CrowdInputs,
        columns: CrowdColumns | None,
    ) -> None:
        self._attachment = attachment
        self._character = one_look(character)
        self._detail = detail
        self._parent = parent
        self._own = None if columns is None else CrowdInputs(columns, parent)
        self._inputs = parent if self._own is None else self._own
        self._skinned, self._hooks = self._make()
        self._revision = parent.revision
        self.counts = DrawCounts()

    def _make(self) -> tuple[SkinnedPass, HookPass | None]:
        """The passes, with the overrides that the crowd has now."""
        levels = range(len(Level) - 1)
        character, inputs = self._character, self._inputs
        materials = character.materials
        if self._attachment.follows_body:
            own = None if inputs.regions is None else replace(inputs.regions, parted=False)
            plain = level_draws(character, [InstanceList() for _ in levels])
            return SkinnedPass(plain, materials, inputs, regions=own), None
        lists = tuple(HookedList() for _ in levels)
        hooks = HookPass(self._attachment, self._parent, lists)
        draws = level_draws(character, lists)
        return SkinnedPass(draws, materials, inputs, frozenset({"HOOKED"})), hooks

    def _remake(self) -> None:
        made = self._make()
        if self._hooks is not None:
            self._hooks.delete()
        self._skinned.delete()
        self._skinned, self._hooks = made
        self._revision = self._parent.revision

    def update(self, tick: int) -> None:
        """Copy what the simulation changed; nothing while nobody in view shows the part."""
        if self._revision != self._parent.revision:
            self._remake()
        self.counts.uploaded = 0
        visible = False
        for agents, ids in zip(self._skinned.lists, self._detail.agents, strict=False):
            if len(ids):
                self.counts.uploaded += agents.write(ids)
            agents.count = len(ids)
            visible |= len(ids) > 0
        if visible and self._own is not None:
            self.counts.uploaded += self._own.update(tick)

    def draw(self, frame: Frame) -> None:
        """Draw what `update` copied into the bound framebuffer."""
        self.counts.triangles = 0
        if not any(agents.count for agents in self._skinned.lists):
            return
        if self._hooks is not None:
            self._hooks.run(frame.tick, frame.alpha)
        self.counts.triangles = self._skinned.draw(frame, self._inputs)

    def delete(self) -> None:
        """Delete everything on the GPU."""
        if self._hooks is not None:
            self._hooks.delete()
        self._skinned.delete()
        if self._own is not None:
            self._own.delete()
