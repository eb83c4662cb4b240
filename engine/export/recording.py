"""What some agents show at one or more moments, kept so that it can be written to files.

A recording is apart from the crowd that it was taken from: the simulation may go on, and several
files can be written from one recording.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..assets.character import Character, SkinnedMesh
from ..assets.variants import MOST_CHOICES, default_choices, variant_groups
from ..crowd.kits import PATTERNS
from ..crowd.morphs import MorphWeights, morphed_positions
from ..crowd.regions import SURFACES, Regions

_SHIRT = SURFACES.index("shirt")
_BYTES_OF_JOINT = 48


def recorded_bytes(frames: int, agents: int, joints: int) -> int:
    """Memory that the palettes of a recording take."""
    return frames * agents * joints * _BYTES_OF_JOINT


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """K agents at T moments.

    Parameters
    ----------
    character
        Skeleton, meshes and materials of all of them.
    agents
        (K,) int64 ids.
    labels
        The seat of each, such as ``"12|345"``.
    fps
        Frames a second; frame f is f / fps seconds after the first.
    palettes
        (T, K, J, 3, 4) float32 as `Crowd.palettes` has them.
    position
        (T, K, 3) float32 metres in the stadium's frame, lifted onto the seat.
    yaw, scale
        (T, K) float32 radians about +Y, and uniform scale.
    girth, head
        (K,) float32 of the bind pose's morphs.
    colors
        (K, 5, 3) uint8 sRGB of `SURFACES`.
    second, pattern
        (K, 3) uint8 sRGB and (K,) uint8, of shirts, as `Appearance` has them; plain if they aren't
        given.
    regions
        Where the patterns lie; None leaves them out.
    morphs
        How meshes take part in girth and head; None if they don't.
    choice
        (G, K) uint8 as `Body.choice` has them: what each has of the character's variants. What
        `default_choices` says if it isn't given or has no rows.

    Raises
    ------
    ValueError
        For columns of other shapes, choices that the character has not, or no frame or agent.
    """

    character: Character
    agents: NDArray[np.int64]
    labels: tuple[str, ...]
    fps: float
    palettes: NDArray[np.float32]
    position: NDArray[np.float32]
    yaw: NDArray[np.float32]
    scale: NDArray[np.float32]
    girth: NDArray[np.float32]
    head: NDArray[np.float32]
    colors: NDArray[np.uint8]
    morphs: MorphWeights | None = None
    choice: NDArray[np.uint8] = None  # type: ignore[assignment]
    second: NDArray[np.uint8] = None  # type: ignore[assignment]
    pattern: NDArray[np.uint8] = None  # type: ignore[assignment]
    regions: Regions | None = None

    def __post_init__(self) -> None:
        """Check the shapes, and fill in what nobody chose."""
        frames, count = self.yaw.shape
        joints = self.character.skeleton.joint_count
        if not frames or not count:
            raise ValueError(f"a recording of {count} agents at {frames} moments is empty")
        if not self.fps > 0:
            raise ValueError(f"fps is {self.fps}, expected more than 0")
        groups = variant_groups(self.character)
        if self.choice is None or not len(self.choice):
            chosen = np.array(list(default_choices(self.character).values()), np.uint8)
            object.__setattr__(self, "choice", np.repeat(chosen[:, None], count, axis=1))
        if self.second is None:
            object.__setattr__(self, "second", self.colors[:, _SHIRT].copy())
        if self.pattern is None:
            object.__setattr__(self, "pattern", np.zeros(count, np.uint8))
        for name, shape in (
            ("agents", (count,)),
            ("palettes", (frames, count, joints, 3, 4)),
            ("position", (frames, count, 3)),
            ("scale", (frames, count)),
            ("girth", (count,)),
            ("head", (count,)),
            ("colors", (count, len(SURFACES), 3)),
            ("choice", (len(groups), count)),
            ("second", (count, 3)),
            ("pattern", (count,)),
        ):
            found = getattr(self, name).shape
            if found != shape:
                raise ValueError(f"{name} has shape {found}, expected {shape}")
        if len(self.labels) != count:
            raise ValueError(f"labels are {len(self.labels)}, expected {count}")
        for row, (group, choices) in zip(self.choice, groups.items(), strict=True):
            wrong = row[(row >= len(choices)) & (row != MOST_CHOICES)]
            if len(wrong):
                raise ValueError(
                    f"choice has {wrong[0]} for '{group}', expected 0 to {len(choices) - 1}, "
                    f"or {MOST_CHOICES} for none"
                )
        if count and (most := int(self.pattern.max())) >= len(PATTERNS):
            raise ValueError(f"pattern has {most}, expected 0 to {len(PATTERNS) - 1}")

    def __len__(self) -> int:
        """Number of agents K."""
        return len(self.agents)

    @property
    def frames(self) -> int:
        """Number of moments T."""
        return len(self.yaw)

    @property
    def seconds(self) -> float:
        """Time from the first to the last frame."""
        return (self.frames - 1) / self.fps

    @property
    def height(self) -> float:
        """Height of the character's bind pose in model space."""
        tops = [np.ptp(mesh.positions[:, 1]) for mesh in self.character.meshes if len(mesh.joints)]
        return max(float(max(tops, default=1.0)), 1e-6)

    def meshes(self, level: int) -> tuple[SkinnedMesh, ...]:
        """Meshes of a level of detail that have triangles and that somebody wears.

        Raises
        ------
        ValueError
            If there is no such level.
        """
        levels = (self.character.meshes, *self.character.lower_levels)
        if not 0 <= level < len(levels):
            raise ValueError(f"level is {level}, expected 0 to {len(levels) - 1}")
        drawn = tuple(mesh for mesh in levels[level] if len(mesh.triangles))
        worn = self.worn(drawn)
        return tuple(mesh for column, mesh in enumerate(drawn) if worn[:, column].any())

    def worn(self, meshes: Sequence[SkinnedMesh]) -> NDArray[np.bool_]:
        """(K, meshes) who wears which of some meshes: those of no variant, and those chosen."""
        groups = variant_groups(self.character)
        places = {
            (group, variant.choice): (row, number)
            for row, (group, variants) in enumerate(groups.items())
            for number, variant in enumerate(variants)
        }
        worn = np.ones((len(self), len(meshes)), np.bool_)
        for column, mesh in enumerate(meshes):
            if mesh.variant is not None:
                row, number = places[mesh.variant.group, mesh.variant.choice]
                worn[:, column] = self.choice[row] == number
        return worn

    @property
    def patterned(self) -> NDArray[np.bool_]:
        """(K,) whose shirt shows two colours."""
        differs: NDArray[np.bool_] = (self.second != self.colors[:, _SHIRT]).any(axis=1)
        return differs & (self.pattern > 0) & (self.regions is not None)

    def select(self, agents: int | ArrayLike) -> Recording:
        """The same moments of some of the agents, by id; ValueError for ids that aren't in it."""
        ids = np.atleast_1d(np.asarray(agents))
        if ids.ndim != 1 or ids.dtype.kind not in "iu" or not len(ids):
            raise ValueError(f"agents is {agents!r}, expected an id or ids")
        place = {int(agent): k for k, agent in enumerate(self.agents)}
        missing = [int(agent) for agent in ids if int(agent) not in place]
        if missing:
            raise ValueError(f"agents: agent {missing[0]} was not recorded")
        k = np.array([place[int(agent)] for agent in ids])
        return replace(
            self,
            agents=self.agents[k],
            labels=tuple(self.labels[i] for i in k),
            palettes=self.palettes[:, k],
            position=self.position[:, k],
            yaw=self.yaw[:, k],
            scale=self.scale[:, k],
            girth=self.girth[k],
            head=self.head[k],
            colors=self.colors[k],
            choice=self.choice[:, k],
            second=self.second[k],
            pattern=self.pattern[k],
        )

    def frame(self, number: int) -> Recording:
        """One moment; ValueError if there is no such frame."""
        if not 0 <= number < self.frames:
            raise ValueError(f"frame is {number}, expected 0 to {self.frames - 1}")
        one = slice(number, number + 1)
        return replace(
            self,
            palettes=self.palettes[one],
            position=self.position[one],
            yaw=self.yaw[one],
            scale=self.scale[one],
        )

    def skinned(
        self, mesh: SkinnedMesh, agent: int, frame: int
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """A mesh as the k-th agent shows it, before it is placed in the stadium.

        Parameters
        ----------
        mesh
            One of `meshes`.
        agent, frame
            k and f, not an id.

        Returns
        -------
        tuple
            (V, 3) float32 positions and normals in model space.
        """
        bind = mesh.positions
        if self.morphs is not None:
            girth, head = float(self.girth[agent]), float(self.head[agent])
            bind = morphed_positions(mesh, self.morphs, girth, head)
        palettes = self.palettes[frame, agent]
        matrices = np.einsum("vk,vkij->vij", mesh.weights, palettes[mesh.joints])
        places = np.einsum("vij,vj->vi", matrices[..., :3], bind) + matrices[..., 3]
        normals = np.einsum("vij,vj->vi", matrices[..., :3], mesh.normals)
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        normals = np.where(length > 1e-12, normals / np.maximum(length, 1e-12), [0.0, 1.0, 0.0])
        return places.astype(np.float32), normals.astype(np.float32)
