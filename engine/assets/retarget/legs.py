"""The legs of a posed body: where their joints are, and bending them so that feet reach a goal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .figure import Figure
from .humanoid import SIDES
from .turns import Array, across, arc, turned, unit

STRETCH = 0.9995
"""Share of its length to which a leg is stretched by bending; the knee keeps about 4 degrees."""

STRAIGHT = 0.05
"""Distance of the knee from the line of hip and ankle, in thighs, below which the leg counts as
straight and the knee begins to be guided forward."""


class Legs:
    """Joints of the legs of a figure, posed by model-space turns.

    Parameters
    ----------
    figure
        The body.
    turns
        (F, J, 3, 3) float64 model-space turns of all joints; `bend` changes those of the legs.
    """

    def __init__(self, figure: Figure, turns: Array) -> None:
        self.figure = figure
        self.turns = turns
        skeleton = figure.humanoid.skeleton
        self._parents = skeleton.parents.tolist()
        scale = skeleton.rest_scale.astype(np.float64).mean(axis=1)
        for joint, parent in enumerate(self._parents):
            if parent >= 0:
                scale[joint] *= scale[parent]
        above = np.array([1.0 if p < 0 else scale[p] for p in self._parents])
        self._offsets = skeleton.rest_translation.astype(np.float64) * above[:, None]

    def is_detached(self, side: str) -> bool:
        """Whether a foot hangs from elsewhere than the shin, as in some rigs."""
        joint = self.figure.joints[f"{side}_foot"]
        return not self._is_below(joint, self.figure.joints[f"{side}_lower_leg"])

    def place(self, part: str) -> Array:
        """(F, 3) of a part from the hips joint, in model axes."""
        joint = self.figure.joints[part]
        side = part.partition("_")[0]
        if part.endswith("_foot") and self.is_detached(side):
            lower = f"{side}_lower_leg"
            shin = self.figure.joints[lower]
            bone = self.figure.turns[shin].T @ (self.figure.place(part) - self.figure.place(lower))
            return self.place(lower) + turned(self.turns[:, shin], bone)
        hips = self.figure.joints["hips"]
        result = np.zeros((len(self.turns), 3))
        while joint != hips and joint >= 0:
            parent = self._parents[joint]
            if parent >= 0:
                result += turned(self.turns[:, parent], self._offsets[joint])
            joint = parent
        return result

    def middle(self) -> Array:
        """(F, 3) of the middle between the hip joints, from the hips joint."""
        return np.asarray(0.5 * sum((self.place(f"{s}_upper_leg") for s in SIDES), np.zeros(3)))

    def reach(self, side: str) -> float:
        """Length of the stretched leg."""
        upper, lower = self._bones(side)
        return STRETCH * float(
            np.median(np.linalg.norm(upper, axis=1) + np.linalg.norm(lower, axis=1))
        )

    def bend(self, side: str, goal: Array) -> None:
        """Bring the ankle to `goal`, (F, 3) from the hip joint of that leg.

        The knee stays in its plane, which turns with the leg by the shortest arc; a goal out of
        reach is approached. The foot keeps its turn.
        """
        upper, lower = self._bones(side)
        first, second = np.linalg.norm(upper, axis=1), np.linalg.norm(lower, axis=1)
        now = upper + lower
        moved = np.linalg.norm(goal - now, axis=1) > 1e-9
        if not moved.any() or first.min() <= 0 or second.min() <= 0:
            return
        distance = np.linalg.norm(goal, axis=1)
        longest = np.maximum(STRETCH * (first + second), np.linalg.norm(now, axis=1))
        shortest = np.abs(first - second) + 0.02 * (first + second)
        shortest = np.minimum(shortest, np.linalg.norm(now, axis=1))
        target = np.clip(distance, shortest, longest)
        along = unit(np.where(distance[:, None] > 1e-9, goal, now))
        line = unit(now)
        knee = across(upper, line)
        ahead = across(self.frame(f"{side}_upper_leg")[:, :, 2], line)
        bent = np.linalg.norm(knee, axis=1) / (STRAIGHT * first)
        guide = np.clip(1.0 - bent, 0.0, 1.0)[:, None]
        knee = unit(
            turned(arc(line, along), knee + STRAIGHT * first[:, None] * guide * unit(ahead))
        )
        knee = unit(across(knee, along))
        base = (first**2 - second**2 + target**2) / (2 * np.maximum(target, 1e-12))
        rise = np.sqrt(np.maximum(first**2 - base**2, 0.0))
        new_upper = along * base[:, None] + knee * rise[:, None]
        new_lower = along * target[:, None] - new_upper
        still = np.eye(3)
        turn_upper = np.where(moved[:, None, None], arc(upper, new_upper), still)
        turn_lower = np.where(moved[:, None, None], arc(lower, new_lower), still)
        joints = self.figure.joints
        thigh, shin = joints[f"{side}_upper_leg"], joints[f"{side}_lower_leg"]
        foot = joints[f"{side}_foot"]
        for joint in range(len(self._parents)):
            if joint == foot or self._is_below(joint, foot):
                continue
            if joint == shin or self._is_below(joint, shin):
                self.turns[:, joint] = np.matmul(turn_lower, self.turns[:, joint])
            elif joint == thigh or self._is_below(joint, thigh):
                self.turns[:, joint] = np.matmul(turn_upper, self.turns[:, joint])

    def frame(self, part: str) -> Array:
        """(F, 3, 3) anatomical frame of a part."""
        joint = self.figure.joints[part]
        return np.asarray(np.matmul(self.turns[:, joint], self.figure.offset(part)))

    def _bones(self, side: str) -> tuple[Array, Array]:
        hip, knee, ankle = (
            self.place(f"{side}_{part}") for part in ("upper_leg", "lower_leg", "foot")
        )
        return knee - hip, ankle - knee

    def _is_below(self, joint: int, top: int) -> bool:
        joint = self._parents[joint]
        while joint >= 0:
            if joint == top:
                return True
            joint = self._parents[joint]
        return False


def lowered(wanted: Array, reach: NDArray[np.int64] | int) -> Array:
    """A smooth curve that is nowhere above (F,) `wanted`: the running least, then its mean."""
    reach = int(reach)
    if reach < 1 or len(wanted) < 2:
        return wanted
    padded = np.pad(wanted, 2 * reach, mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
    least = windows.min(axis=1)
    return np.asarray(np.lib.stride_tricks.sliding_window_view(least, 2 * reach + 1).mean(axis=1))
