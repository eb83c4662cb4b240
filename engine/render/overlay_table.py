"""The drawing side's copy of overlays: few agents have any, so only theirs are copied.

A small table says for each agent and layer which row of a second one is his, and that one has a
row for each overlay that is seen: mask and weight, and a motion as in the motion table.
"""

from __future__ import annotations

import numpy as np

from ...components import AgentAnimID, Transition
from ...components.overlays import NO_MASK, Overlays
from ..gl.program import Program
from ..gl.texture import Texture2D
from ..gl.texture_format import TextureFormat
from ..streams.markers import Markers
from ..streams.mask_table import MaskTable
from .agent_tables import AGENTS_PER_ROW, table_rows
from .motion_table import pack_streams

INDEX_UNIT, OVERLAY_UNIT, MASK_UNIT = 7, 8, 9
TEXELS = 5


class OverlayTable:
    """Textures with the overlays of a crowd.

    Parameters
    ----------
    agents
        N.
    overlays, masks, markers
        What is copied; the joints of the farthest level get the weights of the joints they mark.
    """

    def __init__(self, agents: int, overlays: Overlays, masks: MaskTable, markers: Markers) -> None:
        self._overlays, self._masks, self._markers = overlays, masks, markers
        self._rows = table_rows(agents)
        self._index = Texture2D((AGENTS_PER_ROW, self._rows), TextureFormat.RG32F)
        self._index.write(np.zeros((self._rows, AGENTS_PER_ROW, 2), np.float32))
        self._entries: Texture2D | None = None
        self._mask_texture: Texture2D | None = None
        self._versions = (0, -1, -1)
        self._mask_count = 0
        self._count = 0

    def update(self, anim: AgentAnimID, transition: Transition, origin: int) -> int:
        """Copy what changed, with ticks from `origin` on; bytes copied."""
        copied = self._update_masks()
        overlays = self._overlays
        versions = (overlays.version, anim.version, origin)
        idle = not self._count and versions[0] == self._versions[0]
        if idle or versions == self._versions:
            return copied
        self._versions = versions
        layer, agent = np.nonzero(overlays.mask != NO_MASK)
        self._count = len(agent)
        index = np.zeros((self._rows * AGENTS_PER_ROW, 2), np.float32)
        index[agent, layer] = np.arange(1, self._count + 1)
        self._index.write(index.reshape(self._rows, AGENTS_PER_ROW, 2))
        copied += index.nbytes
        if not self._count:
            return copied
        rows = table_rows(self._count)
        table = np.zeros((rows * AGENTS_PER_ROW, 4 * TEXELS), np.float32)
        live = table[: self._count]
        at = (layer, agent)
        live[:, 0] = overlays.mask[at]
        live[:, 1] = overlays.start[at]
        live[:, 2] = overlays.target[at]
        live[:, 3] = overlays.begin[at] - origin
        live[:, 4] = overlays.duration[at]
        pack_streams(live[:, 8:], anim, transition, (1 + layer, agent), origin)
        self._resize(rows)
        assert self._entries is not None
        self._entries.write(table.reshape(rows, -1, 4))
        return copied + table.nbytes

    def bind(self, program: Program, *, markers: bool) -> None:
        """Bind the tables for palettes, or for the joints of the farthest level."""
        program["overlaid"] = self._count > 0
        program["overlay_index"] = INDEX_UNIT
        program["overlays"] = OVERLAY_UNIT
        program["masks"] = MASK_UNIT
        if markers:
            program["joint_count"] = self._masks.weights.shape[1]
        self._index.bind(INDEX_UNIT)
        if self._entries is not None:
            self._entries.bind(OVERLAY_UNIT)
        if self._mask_texture is not None:
            self._mask_texture.bind(MASK_UNIT)

    def delete(self) -> None:
        """Delete the textures."""
        for texture in (self._index, self._entries, self._mask_texture):
            if texture is not None:
                texture.delete()

    def _update_masks(self) -> int:
        masks = self._masks
        count = len(masks.names)
        if count == self._mask_count:
            return 0
        self._mask_count = count
        table = np.zeros((count, masks.weights.shape[1] + len(self._markers.joints), 4), np.float32)
        joints = masks.weights.shape[1]
        table[:, :joints, 0], table[:, :joints, 1] = masks.weights, masks.anchors
        table[:, joints:, 0] = masks.weights[:, self._markers.joints]
        if self._mask_texture is not None:
            self._mask_texture.delete()
        self._mask_texture = Texture2D((table.shape[1], count), TextureFormat.RGBA32F)
        self._mask_texture.write(table)
        return table.nbytes

    def _resize(self, rows: int) -> None:
        """Make room, with some to spare."""
        if self._entries is None or self._entries.size[1] < rows:
            if self._entries is not None:
                self._entries.delete()
            size = (AGENTS_PER_ROW * TEXELS, 2 * rows)
            self._entries = Texture2D(size, TextureFormat.RGBA32F)
