"""The drawing side's copy of where agents are and what they wear: 256 agents a texture row.

The tables are copied whole when their component's version changed, which is seldom; of people who
walk about, only the rows they are in.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components import Appearance, Body, Placement
from ...components.placement import GROUP
from ..crowd.physique import Physique
from ..gl.program import Program
from ..gl.texture import Texture2D
from ..gl.texture_format import TextureFormat

PLACE_UNIT, LOOKS_UNIT = 3, 4
AGENTS_PER_ROW = GROUP


def table_rows(agents: int) -> int:
    """Texture rows of a table of so many agents."""
    return max(-(-agents // AGENTS_PER_ROW), 1)


class AgentTables:
    """Textures with one row of data for each agent of a crowd.

    Parameters
    ----------
    agents
        N.
    """

    def __init__(self, agents: int) -> None:
        self._rows = table_rows(agents)
        self._agents = agents
        self._versions = [(-1, -1), (-1, -1)]
        self._touches = 0
        self._place = self._texture(3, TextureFormat.RGBA32F)
        self._looks = self._texture(6, TextureFormat.SRGB8_ALPHA8)

    def update_place(
        self, placement: Placement, body: Body | None = None, physique: Physique | None = None
    ) -> int:
        """Copy places and builds if they changed; bytes copied."""
        versions = (placement.version, -1 if body is None else body.version)
        touches, self._touches = self._touches, placement.touches
        if self._versions[0] == versions:
            copied = 0
            if touches != placement.touches:
                for row in np.flatnonzero(placement.touched > touches):
                    some = slice(
                        row * AGENTS_PER_ROW, min((row + 1) * AGENTS_PER_ROW, self._agents)
                    )
                    table = _places(placement, body, physique, some)
                    self._place.write(table.reshape(1, -1, 4), y=int(row))
                    copied += table.nbytes
            return copied
        self._versions[0] = versions
        whole = self._empty(12, np.float32)
        everyone = slice(0, self._agents)
        whole[everyone] = _places(placement, body, physique, everyone)
        return self._write(self._place, whole)

    def update_looks(self, appearance: Appearance) -> int:
        """Copy colours if they changed; bytes copied."""
        versions = (appearance.version, -1)
        if self._versions[1] == versions:
            return 0
        self._versions[1] = versions
        table = self._empty(24, np.uint8)
        parts = ("skin", "hair", "shirt", "trousers", "shoes", "second")
        for number, part in enumerate(parts):
            table[: self._agents, 4 * number : 4 * number + 4] = getattr(appearance, part)
        # Alpha is the one channel that is not decoded to linear light.
        table[: self._agents, 23] = appearance.pattern
        return self._write(self._looks, table)

    def bind(self, program: Program) -> None:
        """Bind the tables."""
        self._place.bind(PLACE_UNIT)
        self._looks.bind(LOOKS_UNIT)
        program["placement"] = PLACE_UNIT
        program["looks"] = LOOKS_UNIT

    def delete(self) -> None:
        """Delete the textures."""
        self._place.delete()
        self._looks.delete()

    def _texture(self, texels: int, kind: TextureFormat) -> Texture2D:
        return Texture2D((AGENTS_PER_ROW * texels, self._rows), kind)

    def _empty(self, width: int, dtype: type[np.generic]) -> NDArray[np.generic]:
        return np.zeros((self._rows * AGENTS_PER_ROW, width), dtype=dtype)

    def _write(self, texture: Texture2D, table: NDArray[np.generic]) -> int:
        texture.write(table.reshape(self._rows, -1, 4))
        return table.nbytes


def _places(
    placement: Placement, body: Body | None, physique: Physique | None, some: slice
) -> NDArray[np.float32]:
    """(n, 12) what the table of places holds for some agents."""
    yaw = placement.yaw[some]
    table = np.zeros((len(yaw), 12), np.float32)
    table[:, :3] = placement.position[:, some].T
    table[:, 3] = placement.scale[some]
    table[:, 4], table[:, 5] = np.sin(yaw), np.cos(yaw)
    table[:, 10] = 1.0
    if body is not None and physique is not None:
        table[:, 8], table[:, 9] = body.girth[some], body.head[some]
        table[:, 10] = physique.legs[body.kind[some]]
    return table
