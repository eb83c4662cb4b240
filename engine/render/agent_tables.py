"""The drawing side's copy of a crowd's columns: 256 agents a texture row.

The tables are copied whole when their component's version changed: at 65,000 agents the animation
table is 3 MB, which a driver takes in well under a millisecond, and finding the changed rows would
cost more. Ticks in a table count from an origin that moves along, so that float32 never loses them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components import AgentAnimID, Appearance, BakedAnim, Placement, Transition
from ..gl.program import Program
from ..gl.texture import Texture2D
from ..gl.texture_format import TextureFormat
from ..streams.baked import BakedPoses
from ..streams.pool import POSE_RATE

PLACE_UNIT, LOOKS_UNIT, ANIMATION_UNIT = 3, 4, 5
AGENTS_PER_ROW = 256
REBASE_TICKS = 1 << 14


class AgentTables:
    """Textures with one row of data for each agent of a crowd.

    Parameters
    ----------
    agents
        N.
    animation_texels
        3 for streams, 1 for baked poses.
    """

    def __init__(self, agents: int, animation_texels: int) -> None:
        self.origin = 0
        self._rows = max(-(-agents // AGENTS_PER_ROW), 1)
        self._agents = agents
        self._versions = [-1, -1, -1]
        self._place = self._texture(2, TextureFormat.RGBA32F)
        self._looks = self._texture(5, TextureFormat.SRGB8_ALPHA8)
        self._animation = self._texture(animation_texels, TextureFormat.RGBA32F)
        self._staging = np.zeros(
            (self._rows * AGENTS_PER_ROW, 4 * animation_texels), dtype=np.float32
        )

    def update_place(self, placement: Placement) -> int:
        """Copy places if they changed; bytes copied."""
        if self._versions[0] == placement.version:
            return 0
        self._versions[0] = placement.version
        table = self._empty(8, np.float32)
        table[: self._agents, :3] = placement.position.T
        table[: self._agents, 3] = placement.scale
        table[: self._agents, 4] = np.sin(placement.yaw)
        table[: self._agents, 5] = np.cos(placement.yaw)
        return self._write(self._place, table)

    def update_looks(self, appearance: Appearance) -> int:
        """Copy colours if they changed; bytes copied."""
        if self._versions[1] == appearance.version:
            return 0
        self._versions[1] = appearance.version
        table = self._empty(20, np.uint8)
        parts = ("skin", "hair", "shirt", "trousers", "shoes")
        for number, part in enumerate(parts):
            table[: self._agents, 4 * number : 4 * number + 4] = getattr(appearance, part)
        return self._write(self._looks, table)

    def update_streams(
        self, anim: AgentAnimID, transition: Transition, part: int, tick: int
    ) -> int:
        """Copy streams, offsets and blends if they changed; bytes copied."""
        moved = self._rebase(tick)
        if self._versions[2] == anim.version and not moved:
            return 0
        self._versions[2] = anim.version
        table = self._staging
        live = table[: self._agents]
        for first, columns in ((0, anim), (8, transition)):
            live[:, first] = columns.row[part]
            live[:, first + 1] = columns.start[part]
            live[:, first + 2] = columns.target[part]
            live[:, first + 3] = columns.t0[part] - self.origin
        live[:, 4] = anim.rate[part]
        live[:, 5] = transition.begin[part] - self.origin
        live[:, 6] = transition.duration[part]
        live[:, 7] = transition.rate[part]
        return self._write(self._animation, table)

    def update_baked(self, anim: BakedAnim, baked: BakedPoses, tick: int) -> int:
        """Copy clips, speeds and start times if they changed; bytes copied."""
        moved = self._rebase(tick)
        if self._versions[2] == anim.version and not moved:
            return 0
        self._versions[2] = anim.version
        live = self._staging[: self._agents]
        live[:, 0] = baked.start[anim.clip]
        live[:, 1] = baked.frames[anim.clip]
        live[:, 2] = anim.speed * np.float32(baked.fps / POSE_RATE)
        live[:, 3] = anim.began - self.origin
        return self._write(self._animation, self._staging)

    def bind(self, program: Program, tick: int, alpha: float) -> None:
        """Bind the tables and set the time."""
        self._place.bind(PLACE_UNIT)
        self._looks.bind(LOOKS_UNIT)
        self._animation.bind(ANIMATION_UNIT)
        program["placement"] = PLACE_UNIT
        program["looks"] = LOOKS_UNIT
        program["animation"] = ANIMATION_UNIT
        program["tick"] = float(tick - self.origin)
        program["alpha"] = alpha

    def delete(self) -> None:
        """Delete the textures."""
        for texture in (self._place, self._looks, self._animation):
            texture.delete()

    def _rebase(self, tick: int) -> bool:
        if abs(tick - self.origin) < REBASE_TICKS:
            return False
        self.origin = tick
        return True

    def _texture(self, texels: int, kind: TextureFormat) -> Texture2D:
        return Texture2D((AGENTS_PER_ROW * texels, self._rows), kind)

    def _empty(self, width: int, dtype: type[np.generic]) -> NDArray[np.generic]:
        return np.zeros((self._rows * AGENTS_PER_ROW, width), dtype=dtype)

    def _write(self, texture: Texture2D, table: NDArray[np.generic]) -> int:
        texture.write(table.reshape(self._rows, -1, 4))
        return table.nbytes
