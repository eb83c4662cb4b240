"""Draws a part of a crowd: its own meshes and poses, hung on a joint that the crowd's poses move.

A first pass finds the joint's matrix, once for each agent that shows the part, by the functions
that skin the bodies: whatever is blended or laid over there is in it. It stays on the GPU as an
attribute of the instances that the second pass draws. Agents without the part are in no list, so
they cost nothing.
"""

from __future__ import annotations

from ...components import Attachment, Detail, Level
from ..assets.character import Character
from ..gl.buffer import Buffer
from ..gl.feedback import capture_into
from ..gl.program import Program
from ..gl.vertex_array import VertexArray
from ..gl.vertex_input import Attribute, VertexInput
from .crowd_inputs import CrowdColumns, CrowdInputs
from .crowd_renderer import DrawCounts
from .frame import Frame
from .skinned_pass import InstanceList, SkinnedPass

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
        self._program = Program("parts/hook.vert.glsl", defines=parent.defines, feedback=("hook",))
        self._lists = tuple(
            (agents, VertexArray(self._program, [agents.input(divisor=0)])) for agents in lists
        )

    def run(self, tick: int, alpha: float) -> None:
        """Fill the lists' `hooks` for a moment."""
        program = self._program
        self._parent.bind(program, tick, alpha, markers=False)
        program["joint"] = self._attachment.joint
        program["place"] = self._attachment.place.T
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
        self._detail = detail
        self._own = None if columns is None else CrowdInputs(columns, parent)
        self._inputs = parent if self._own is None else self._own
        self._hooks: HookPass | None = None
        levels = range(len(Level) - 1)
        defines = self._inputs.defines
        if attachment.follows_body:
            self._skinned = SkinnedPass(character, defines, [InstanceList() for _ in levels])
        else:
            lists = tuple(HookedList() for _ in levels)
            self._skinned = SkinnedPass(character, {**defines, "HOOKED": 1}, lists)
            self._hooks = HookPass(attachment, parent, lists)
        self.counts = DrawCounts()

    def update(self, tick: int) -> None:
        """Copy what the simulation changed; nothing while nobody in view shows the part."""
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
