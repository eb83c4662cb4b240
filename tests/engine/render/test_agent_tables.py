"""What the tables hand to the shaders: places, sizes, facings and colours, whatever the row."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tifo.components import AgentAnimID, Placement, Transition
from tifo.engine.animation import ClipBank
from tifo.engine.streams import StreamPool

pytestmark = pytest.mark.gl

AGENTS = 65_536 + 300
CHOSEN = (0, 1, 255, 256, 257, 511, 40_000, 65_535, 65_536, 65_537, AGENTS - 1)
SURFACES = ("skin", "hair", "shirt", "trousers", "shoes")


@pytest.fixture
def crowd(shader_crowd: Any, factories: ModuleType) -> Any:
    """A crowd of many with random places and colours, in the bind pose."""
    skeleton, clip = factories.make_slide()
    pool = StreamPool(skeleton, ClipBank(skeleton, [clip]), capacity=1, history=2)
    rng = np.random.default_rng(8)
    placement = Placement(
        rng.uniform(-100, 100, (3, AGENTS)).astype(np.float32),
        rng.uniform(-7, 7, AGENTS).astype(np.float32),
        rng.uniform(0.5, 2.0, AGENTS).astype(np.float32),
    )
    anim = AgentAnimID.allocate(1, AGENTS, pool.store.bind_row)
    made = shader_crowd((pool, anim, Transition.allocate(1, AGENTS)), placement)
    made.update(0)
    return made


def expected_points(placement: Placement, agent: int) -> Any:
    """(4, 3) where an agent's origin and axes are: yaw turns +Z towards +X about +Y."""
    yaw = float(placement.yaw[agent])
    forward, right = (np.sin(yaw), 0, np.cos(yaw)), (np.cos(yaw), 0, -np.sin(yaw))
    axes = np.array([(0, 0, 0), right, (0, 1, 0), forward])
    return placement.position[:, agent] + float(placement.scale[agent]) * axes


def probe(factories: ModuleType) -> Any:
    """One joint's origin and axes, as a mesh."""
    box = factories.make_box(factories.make_slide()[0], np.zeros(3), np.ones(3))
    keep = [0, 1, 2, 4]
    from dataclasses import replace

    fields = ("positions", "normals", "uvs", "colors", "joints", "weights")
    return replace(
        box,
        **{name: getattr(box, name)[keep] for name in fields},
        triangles=np.array([[0, 1, 2]], np.uint32),
    )


def test_places_sizes_and_facings_arrive(crowd: Any, factories: ModuleType) -> None:
    shown = crowd.skinned(probe(factories), CHOSEN, 0, 0.0)
    for agent, points in zip(CHOSEN, shown, strict=True):
        np.testing.assert_allclose(
            points, expected_points(crowd.placement, agent), rtol=0, atol=2e-5
        )


@pytest.mark.parametrize("surface", range(5))
def test_colours_arrive_in_linear_light(crowd: Any, factories: ModuleType, surface: int) -> None:
    shown = crowd.skinned(probe(factories), CHOSEN, 0, 0.0, output="f_tint", surface=surface)
    srgb = getattr(crowd.appearance, SURFACES[surface])[list(CHOSEN), :3] / 255.0
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    # Drivers may decode sRGB to within half a step of 8 bits.
    np.testing.assert_allclose(shown[:, 0], linear, rtol=0, atol=2e-3)


def test_surfaces_that_do_not_vary_are_not_tinted(crowd: Any, factories: ModuleType) -> None:
    shown = crowd.skinned(probe(factories), CHOSEN, 0, 0.0, output="f_tint")
    np.testing.assert_array_equal(shown, 1.0)


def test_changes_arrive_with_the_version(crowd: Any, factories: ModuleType) -> None:
    last = AGENTS - 1
    crowd.placement.position[:, last] = 1.0, 2.0, 3.0
    crowd.appearance.shirt[last] = 255
    assert crowd.update(0) == 16, "only the stream table, unless a version says otherwise"
    crowd.placement.version += 1
    crowd.appearance.version += 1
    copied = crowd.update(0)
    # Whole rows of 256 agents: 48 bytes of place and 24 of colours each, and one stream.
    assert copied == 258 * 256 * (48 + 24) + 16
    (points,) = crowd.skinned(probe(factories), [last], 0, 0.0)
    np.testing.assert_allclose(points[0], [1, 2, 3], rtol=0, atol=1e-6)
    (tints,) = crowd.skinned(probe(factories), [last], 0, 0.0, output="f_tint", surface=2)
    np.testing.assert_allclose(tints, 1.0)


def test_normals_turn_with_the_body(crowd: Any, factories: ModuleType) -> None:
    mesh = probe(factories)
    mesh.normals[:] = 0.0, 0.0, 1.0
    shown = crowd.skinned(mesh, CHOSEN, 0, 0.0, output="f_normal")
    yaw = crowd.placement.yaw[list(CHOSEN)].astype(float)
    forward = np.stack([np.sin(yaw), 0 * yaw, np.cos(yaw)], axis=1)
    np.testing.assert_allclose(shown[:, 0], forward, rtol=0, atol=2e-6)


def test_only_rows_with_people_who_moved_are_copied(crowd: Any, factories: ModuleType) -> None:
    rng = np.random.default_rng(3)
    placement = crowd.placement
    moved = np.array([3, 255, 70 * 256 + 9, AGENTS - 1])
    placement.position[:, moved] = rng.uniform(-50, 50, (3, len(moved)))
    placement.yaw[moved] += 1.0
    placement.touch(moved)
    # Rows 0 and 70 of 256 agents and the 44 of the last row, 48 bytes each, and one stream.
    assert crowd.update(0) == (256 + 256 + 44) * 48 + 16
    assert crowd.update(0) == 16
    chosen = [*moved.tolist(), 4, 300]
    shown = crowd.skinned(probe(factories), chosen, 0, 0.0)
    for agent, points in zip(chosen, shown, strict=True):
        np.testing.assert_allclose(points, expected_points(placement, agent), rtol=0, atol=2e-5)
