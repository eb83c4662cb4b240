"""The drawing side's copy of who plays what: 256 agents a texture row.

The table is copied whole when the columns' version changed: at 65,000 agents it is 3 MB, which a
driver takes in well under a millisecond, and finding the changed rows would cost more. Ticks in it
count from an origin that moves along, so that float32 never loses them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...components import AgentAnimID, BakedAnim, Transition
from ..gl.program import Program
from ..gl.texture import Texture2D
from ..gl.texture_format import TextureFormat
from ..streams.baked import BakedPoses
from ..streams.pool import POSE_RATE
from .agent_tables import AGENTS_PER_ROW, table_rows

ANIMATION_UNIT = 5
REBASE_TICKS = 1 << 14


class MotionTable:
    """A texture with the streams, offsets and blends of each agent, or its baked clip.

    Parameters
    ----------
    agents
        N.
    texels
        3 for streams, 1 for baked poses.

    Attributes
    ----------
    origin
        Pose tick that the ticks in the table count from.
    """

    def __init__(self, agents: int, texels: int) -> None:
        self.origin = 0
        self._agents = agents
        self._version = -1
        self._rows = table_rows(agents)
        self._texture = Texture2D((AGENTS_PER_ROW * texels, self._rows), TextureFormat.RGBA32F)
        self._staging = np.zeros((self._rows * AGENTS_PER_ROW, 4 * texels), dtype=np.float32)

    def update_streams(
        self, anim: AgentAnimID, transition: Transition, part: int, tick: int
    ) -> int:
        """Copy streams, offsets and blends if they changed; bytes copied."""
        moved = self._rebase(tick)
        if self._version == anim.version and not moved:
            return 0
        self._version = anim.version
        pack_streams(
            self._staging[: self._agents], anim, transition, (part, slice(None)), self.origin
        )
        return self._write()

    def update_baked(self, anim: BakedAnim, baked: BakedPoses, tick: int) -> int:
        """Copy clips, speeds and start times if they changed; bytes copied."""
        moved = self._rebase(tick)
        if self._version == anim.version and not moved:
            return 0
        self._version = anim.version
        live = self._staging[: self._agents]
        live[:, 0] = baked.start[anim.clip]
        live[:, 1] = baked.frames[anim.clip]
        live[:, 2] = anim.speed * np.float32(baked.fps / POSE_RATE)
        live[:, 3] = anim.began - self.origin
        return self._write()

    def bind(self, program: Program, tick: int, alpha: float) -> None:
        """Bind the table and set the time."""
        self._texture.bind(ANIMATION_UNIT)
        program["animation"] = ANIMATION_UNIT
        program["tick"] = float(tick - self.origin)
        program["alpha"] = alpha

    def delete(self) -> None:
        """Delete the texture."""
        self._texture.delete()

    def _rebase(self, tick: int) -> bool:
        if abs(tick - self.origin) < REBASE_TICKS:
            return False
        self.origin = tick
        return True

    def _write(self) -> int:
        self._texture.write(self._staging.reshape(self._rows, -1, 4))
        return self._staging.nbytes


def pack_streams(
    out: NDArray[np.float32],
    anim: AgentAnimID,
    transition: Transition,
    at: tuple[int | NDArray[np.int64], slice | NDArray[np.int64]],
    origin: int,
) -> None:
    """Write streams, offsets and blends as the shaders read them.

    Parameters
    ----------
    out
        (K, 12) float32: row, start, target, t0; rate, begin, duration, source's rate; source's row,
        start, target, t0.
    anim, transition, at
        The columns, and which K entries of them.
    origin
        Pose tick that the ticks count from.
    """
    for first, columns in ((0, anim), (8, transition)):
        out[:, first] = columns.row[at]
        out[:, first + 1] = columns.start[at]
        out[:, first + 2] = columns.target[at]
        out[:, first + 3] = columns.t0[at] - origin
    out[:, 4] = anim.rate[at]
    out[:, 5] = transition.begin[at] - origin
    out[:, 6] = transition.duration[at]
    out[:, 7] = transition.rate[at]
