"""The overrides of one crowd, the values that its agents have for them, and what they do."""

from __future__ import annotations

import difflib

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.placement import Placement
from ..animation.skeleton import Skeleton
from .chains import Step, bind_pivots, find_chains, find_steps
from .override import JointOverride
from .posed_joints import Bodies, OverriddenJoints

Array = NDArray[np.float32]

MOST_OVERRIDES = 16
FLATTEST = 1e-3
"""Share of the volume of its edges' box that a palette must have to be overridden."""


class OverrideSet:
    """Overrides in the order in which they are applied at a joint.

    Parameters
    ----------
    skeleton
        Of the crowd.
    agents
        N.

    Attributes
    ----------
    overrides
        In order of registration.
    steps, chains, pivots
        What they do where; see `tifo.engine.overrides.chains`.
    values
        (N, overrides, 4) float32.
    revision
        Grows whenever an override comes or goes.
    version
        Grows with every change of the values.
    """

    def __init__(self, skeleton: Skeleton, agents: int) -> None:
        self.skeleton = skeleton
        self.overrides: tuple[JointOverride, ...] = ()
        self.steps: tuple[Step, ...] = ()
        self.chains: tuple[tuple[int, ...], ...] = find_chains(skeleton, ())
        self.pivots: Array = np.zeros((0, 3), np.float32)
        self.values: Array = np.zeros((agents, 0, 4), np.float32)
        self.revision = 0
        self.version = 0

    def add(self, override: JointOverride) -> None:
        """Apply an override from the next picture on.

        Raises
        ------
        ValueError
            For a name that another one has, a joint that doesn't exist, or too many.
        """
        if any(other.name == override.name for other in self.overrides):
            raise ValueError(f"{override} is there already; remove it first")
        if len(self.overrides) == MOST_OVERRIDES:
            raise ValueError(f"{override} is one too many, expected at most {MOST_OVERRIDES}")
        first = np.broadcast_to(override.values, (len(self.values), 1, 4))
        try:
            self._change((*self.overrides, override), np.concatenate([self.values, first], axis=1))
        except ValueError as error:
            raise ValueError(f"{override}: {error}") from None

    def remove(self, name: str) -> None:
        """Take an override away; ValueError if there is none of that name."""
        number = self.number(name)
        left = (*self.overrides[:number], *self.overrides[number + 1 :])
        self._change(left, np.delete(self.values, number, axis=1))

    def number(self, name: str) -> int:
        """Place of an override in the order; ValueError names near ones."""
        names = [override.name for override in self.overrides]
        if name not in names:
            near = difflib.get_close_matches(name, names, 3) or names
            hint = f"; near: {', '.join(near)}" if near else ""
            raise ValueError(f"this crowd has no override '{name}'{hint}")
        return names.index(name)

    def set_values(self, name: str, agents: NDArray[np.int64], values: ArrayLike) -> None:
        """Set what agents have for an override.

        Parameters
        ----------
        name
            Of the override.
        agents
            (K,) ids.
        values
            (4,) numbers for all of them, or (K, 4).
        """
        number = self.number(name)
        given = np.asarray(values, np.float32)
        if given.shape not in ((4,), (len(agents), 4)) or not np.isfinite(given).all():
            raise ValueError(
                f"values of shape {given.shape}, expected finite numbers (4,) or ({len(agents)}, 4)"
            )
        self.values[agents, number] = given
        self.version += 1

    def apply(self, palettes: Array, agents: NDArray[np.int64], placement: Placement) -> None:
        """Change palettes as the skinning shaders do.

        Parameters
        ----------
        palettes
            (K, J, 3, 4) float32, what is animated; changed in place.
        agents
            (K,) ids.
        placement
            Of all agents.

        Raises
        ------
        ValueError
            For an override without a Python form, or one that returns something else than
            (K, 4, 4).
        """
        for override in self.overrides:
            if override.python is None:
                raise ValueError(
                    f"{override} has no Python form, so what agents show can't be evaluated on the "
                    "CPU; give it one, or remove it"
                )
        yaw = placement.yaw[agents]
        turn = np.stack([np.sin(yaw), np.cos(yaw)], axis=1)
        body = Bodies(placement.position[:, agents].T, placement.scale[agents], turn)
        for number, step in enumerate(self.steps):
            self._take(step, self.pivots[number], palettes, agents, body)

    def _take(
        self,
        step: Step,
        pivot: Array,
        palettes: Array,
        agents: NDArray[np.int64],
        body: Bodies,
    ) -> None:
        override = self.overrides[step.override]
        assert override.python is not None
        pose = np.zeros((len(agents), 4, 4), np.float32)
        pose[:, :3] = palettes[:, step.joint]
        pose[:, 3, 3] = 1.0
        solid = ~_flat(pose[:, :3, :3])
        # Flat ones are left as they are; a harmless pose stands in for them.
        pose[~solid] = np.eye(4, dtype=np.float32)
        joints = OverriddenJoints(
            pose=pose,
            pivot=pose[:, :3, :3] @ pivot + pose[:, :3, 3],
            bind_pivot=pivot,
            body=body,
            values=self.values[agents, step.override],
            joint=step.joint,
            order=step.order,
        )
        posed = np.asarray(override.python(joints, override.uniforms))
        if posed.shape != pose.shape or posed.dtype.kind != "f":
            raise ValueError(
                f"{override}: python returned {posed.dtype} of shape {posed.shape}, expected "
                f"floats of shape {pose.shape}"
            )
        moved = (posed @ np.linalg.inv(pose.astype(np.float64)))[:, None, :3]
        below = np.flatnonzero([self._is_below(joint, step.joint) for joint in range(self._joints)])
        at = np.ix_(np.flatnonzero(solid), below)
        old = palettes[at].astype(np.float64)
        new = moved[solid, ..., :3] @ old
        new[..., 3] += moved[solid, ..., 3]
        palettes[at] = new

    @property
    def _joints(self) -> int:
        return self.skeleton.joint_count

    def _is_below(self, joint: int, above: int) -> bool:
        while joint > above:
            joint = int(self.skeleton.parents[joint])
        return joint == above

    def _change(self, overrides: tuple[JointOverride, ...], values: Array) -> None:
        steps = find_steps(self.skeleton, overrides)
        self.pivots = bind_pivots(self.skeleton, steps)
        self.overrides, self.steps = overrides, steps
        self.chains = find_chains(self.skeleton, steps)
        self.values = np.ascontiguousarray(values)
        self.revision += 1
        self.version += 1


def _flat(matrix: Array) -> NDArray[np.bool_]:
    """Which of (K, 3, 3) matrices squeeze space so flat that they have no useful inverse."""
    volume = np.abs(np.linalg.det(matrix))
    edges = np.linalg.norm(matrix, axis=2).prod(axis=1)
    flat: NDArray[np.bool_] = ~(volume > FLATTEST * edges)
    return flat
