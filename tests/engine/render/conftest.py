"""What the tests of drawing share: shaders run for their numbers, and pictures to compare with."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import AgentAnimID, Appearance, BakedAnim, Detail, Placement, Transition
from tifo.engine.assets.character import Material, SkinnedMesh
from tifo.engine.overrides import OverrideSet
from tifo.engine.streams import StreamPool
from tifo.engine.streams.baked import BakedPoses

GOLDEN = Path(__file__).resolve().parents[2] / "golden"

Array = NDArray[Any]
Streamed = tuple[StreamPool, AgentAnimID, Transition]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--regenerate-golden",
        action="store_true",
        help="write what is drawn now to tests/golden instead of comparing with it",
    )


def probe_mesh(joints: int) -> SkinnedMesh:
    """Four vertices a joint, at the origin and one metre along each axis, moved by it alone.

    Where they end up tells the joint's whole affine palette.
    """
    count = 4 * joints
    owner = np.zeros((count, 4), np.uint16)
    owner[:, 0] = np.repeat(np.arange(joints), 4)
    weights = np.zeros((count, 4), np.float32)
    weights[:, 0] = 1.0
    points = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    return SkinnedMesh(
        name="probes",
        positions=np.tile(points, (joints, 1)).astype(np.float32),
        normals=np.tile(np.array([0, 1, 0], np.float32), (count, 1)),
        uvs=np.zeros((count, 2), np.float32),
        colors=np.ones((count, 4), np.float32),
        joints=owner,
        weights=weights,
        triangles=np.arange(count - count % 3, dtype=np.uint32).reshape(-1, 3),
    )


def place_agents(agents: int) -> Placement:
    """Everybody at the origin, unturned, in natural size."""
    zeros = np.zeros(agents, np.float32)
    return Placement(np.zeros((3, agents), np.float32), zeros, zeros + np.float32(1.0))


def paint_agents(agents: int, rng: np.random.Generator) -> Appearance:
    """Random colours."""
    colours = rng.integers(0, 256, (5, agents, 4), dtype=np.uint8)
    return Appearance(*colours)


@dataclass
class ShaderCrowd:
    """Runs the crowd's vertex shaders over the real tables and textures.

    Parameters
    ----------
    poses
        What `CrowdColumns.poses` holds.
    placement, appearance, overlays, overrides, body, physique
        Of the agents.
    """

    poses: Streamed | tuple[BakedPoses, BakedAnim]
    placement: Placement
    appearance: Appearance
    overlays: Any = None
    overrides: OverrideSet | None = None
    body: Any = None
    physique: Any = None

    def __post_init__(self) -> None:
        from tifo.engine.render.crowd_inputs import CrowdColumns, CrowdInputs

        columns = CrowdColumns(
            self.placement,
            self.appearance,
            Detail(),
            self.poses,
            self.overlays,
            self.overrides,
            self.body,
            self.physique,
        )
        self.inputs = CrowdInputs(columns)

    def update(self, tick: int) -> int:
        """Copy what changed; bytes copied."""
        return self.inputs.update(tick)

    def skinned(
        self,
        mesh: SkinnedMesh,
        agents: Sequence[int] | Array,
        tick: int,
        alpha: float,
        *,
        output: str = "f_place",
        surface: int = 255,
    ) -> NDArray[np.float32]:
        """(K, V, ...) output of the skinning shader for K agents and V vertices."""
        from tifo.engine.gl import Buffer, VertexArray, VertexInput, capture
        from tifo.engine.render.body_mesh import NORMALISED, VERTEX, make_batches

        (batch,) = make_batches((mesh,), (Material("probe"),), self.inputs.morphs)
        vertices = batch.vertices.copy()
        vertices["surface"] = surface
        program = self.inputs.make_program("crowd/skinned.vert.glsl", feedback=(output,))
        buffer = Buffer(vertices)
        ids = self._ids(agents)
        array = VertexArray(
            program, [VertexInput(buffer, VERTEX, normalised=NORMALISED), ids.input()]
        )
        self.inputs.bind(program, tick, alpha, markers=False)
        program["view"] = program["projection"] = np.eye(4, dtype=np.float32)
        out = capture(program, array, None, len(agents))[output]
        for thing in (array, buffer, ids.buffer, program):
            thing.delete()
        return np.asarray(out, np.float32)

    def palettes(
        self, agents: Sequence[int] | Array, tick: int, alpha: float
    ) -> NDArray[np.float32]:
        """(K, J, 3, 4) palettes that the shader skins with, for agents that stand at the origin."""
        joints = (
            self.poses[0].skeleton.joint_count
            if len(self.poses) == 3
            else self.poses[0].palettes.shape[1]
        )
        places = self.skinned(probe_mesh(joints), agents, tick, alpha)
        points = places.reshape(len(agents), joints, 4, 3)
        columns = np.concatenate([points[:, :, 1:] - points[:, :, :1], points[:, :, :1]], axis=2)
        return np.ascontiguousarray(columns.swapaxes(2, 3))

    def _ids(self, agents: Sequence[int] | Array) -> Any:
        from tifo.engine.render.skinned_pass import InstanceList

        ids = InstanceList()
        ids.write(np.asarray(agents, np.uint32))
        return ids

    def delete(self) -> None:
        """Delete everything on the GPU."""
        self.inputs.delete()


@pytest.fixture(name="probe_mesh")
def probe_mesh_fixture() -> Callable[[int], SkinnedMesh]:
    """Make meshes whose skinned vertices tell palettes; see `probe_mesh`."""
    return probe_mesh


@pytest.fixture
def shader_crowd(gl: Any) -> Iterator[Any]:
    """Make crowds whose vertex shaders can be run for their numbers; see `ShaderCrowd`."""
    made: list[ShaderCrowd] = []

    def make(
        poses: Streamed | tuple[BakedPoses, BakedAnim],
        placement: Placement | None = None,
        appearance: Appearance | None = None,
        overlays: Any = None,
        overrides: OverrideSet | None = None,
        body: Any = None,
        physique: Any = None,
    ) -> ShaderCrowd:
        if len(poses) == 3:
            agents = poses[1].row.shape[1]
        else:
            agents = len(poses[1].clip)
        crowd = ShaderCrowd(
            poses,
            place_agents(agents) if placement is None else placement,
            paint_agents(agents, np.random.default_rng(0)) if appearance is None else appearance,
            overlays,
            overrides,
            body,
            physique,
        )
        made.append(crowd)
        return crowd

    yield make
    for crowd in made:
        crowd.delete()


CLEAR = 24
"""Levels of 255 that a channel may be off before its pixel counts as different."""


class Golden:
    """Compares pictures with those of ``tests/golden``, or writes them there.

    Only the software rasteriser draws the same picture everywhere, so elsewhere nothing is
    compared: the test then checks no more than what it asserts of the picture itself.
    """

    def __init__(self, regenerate: bool, comparable: bool) -> None:
        self._regenerate = regenerate
        self._comparable = comparable

    def check(
        self, name: str, picture: NDArray[np.uint8], *, mean: float = 1.5, share: float = 0.02
    ) -> None:
        """Fail if (H, W, 3) uint8 `picture` is not the one called `name`.

        Parameters
        ----------
        name, picture
            File name without suffix, and what was drawn.
        mean
            Levels of 255 that all channels may be off in the mean.
        share
            Share of pixels that may be clearly different.
        """
        from PIL import Image

        path = GOLDEN / f"{name}.png"
        if self._regenerate:
            GOLDEN.mkdir(exist_ok=True)
            Image.fromarray(picture).save(path, optimize=True)
        if not self._comparable:
            return
        assert path.is_file(), f"{path} is missing; draw it with --regenerate-golden and look at it"
        with Image.open(path) as file:
            wanted = np.asarray(file.convert("RGB"))
        assert wanted.shape == picture.shape, f"{name} is {picture.shape}, not {wanted.shape}"
        off = np.abs(picture.astype(int) - wanted)
        different = float((off.max(axis=2) > CLEAR).mean())
        files = [GOLDEN / "diffs" / f"{name}-{kind}.png" for kind in ("actual", "difference")]
        if off.mean() <= mean and different <= share:
            for stale in files:
                stale.unlink(missing_ok=True)
            return
        files[0].parent.mkdir(exist_ok=True)
        Image.fromarray(picture).save(files[0])
        # Small differences are made visible.
        strong = ((off / 255.0) ** 0.25 * 255.0).astype(np.uint8)
        Image.fromarray(strong).save(files[1])
        pytest.fail(
            f"{name} is off by {off.mean():.2f} levels in the mean (at most {mean}) and clearly "
            f"in {different:.1%} of the pixels (at most {share:.1%}); see {files[1]}"
        )


@pytest.fixture
def golden(gl: Any, request: pytest.FixtureRequest) -> Golden:
    """Compares pictures with golden ones."""
    from tifo.engine.gl import describe_context

    regenerate = request.config.getoption("--regenerate-golden", default=False)
    return Golden(bool(regenerate), "llvmpipe" in describe_context().renderer.lower())
