"""Patterns and parts on the GPU, against the rules in NumPy."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import AgentAnimID, Appearance, Detail, Placement, Transition
from tifo.engine.animation import ClipBank
from tifo.engine.assets.character import Character, Material, SkinnedMesh
from tifo.engine.crowd.hsb import from_hsb, to_hsb
from tifo.engine.crowd.kits import PATTERNS, second_share
from tifo.engine.crowd.regions import Regions
from tifo.engine.streams import StreamPool
from tifo.scripting.camera import look_at, perspective

pytestmark = pytest.mark.gl

Array = NDArray[Any]
SIZE = (400, 100)
HIGH = 1.0
"""Metres in the picture, from y = 0 to 1."""
SPACING = 0.8
WAIST, NECK = 0.2, 0.8
MIDDLE = 0.053


def board(joint: int, uvs: float = 0.5) -> SkinnedMesh:
    """An upright board of 0.7 by 1 m that faces the viewer, in two triangles."""
    points = np.array([(-0.35, 0, 0), (0.35, 0, 0), (0.35, 1, 0), (-0.35, 1, 0)], np.float32)
    joints = np.full((4, 4), joint, np.uint16)
    return SkinnedMesh(
        name="board",
        positions=points,
        normals=np.tile(np.array([0, 0, 1], np.float32), (4, 1)),
        uvs=np.full((4, 2), uvs, np.float32),
        colors=np.ones((4, 4), np.float32),
        joints=joints,
        weights=np.tile(np.array([1, 0, 0, 0], np.float32), (4, 1)),
        triangles=np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
    )


def colours(*rgb: tuple[int, int, int], count: int = 5) -> Array:
    """(count, 4) of one colour, or of as many as given."""
    out = np.full((count, 4), 255, np.uint8)
    out[:, :3] = np.array(rgb)
    return out


Draw = Callable[..., Array]


@pytest.fixture
def draw(gl: Any, factories: ModuleType) -> Draw:
    """Draws five boards in a row as the agents of a crowd."""
    from tifo.engine.gl import Framebuffer
    from tifo.engine.render.crowd_renderer import CrowdColumns, CrowdRenderer
    from tifo.engine.render.frame import Frame

    skeleton, clip = factories.make_slide()
    pool = StreamPool(skeleton, ClipBank(skeleton, [clip]), capacity=1, history=2)

    def picture(looks: Appearance, material: Material, regions: Regions | None) -> Array:
        anim = AgentAnimID.allocate(1, 5, pool.store.bind_row)
        position = np.zeros((3, 5), np.float32)
        position[0] = (np.arange(5) - 2) * SPACING
        zeros = np.zeros(5, np.float32)
        place = Placement(position, zeros, zeros + np.float32(1.0))
        nobody = np.zeros(0, np.uint32)
        columns = CrowdColumns(
            place,
            looks,
            Detail((np.arange(5, dtype=np.uint32), nobody, nobody, nobody)),
            (pool, anim, Transition.allocate(1, 5)),
            regions=regions,
        )
        character = Character("board", skeleton, (board(0),), (material,), (clip,))
        renderer = CrowdRenderer(character, 1.0, columns)
        target = Framebuffer(SIZE, samples=1)
        view = look_at(np.array([0.0, 0.5, 50.0]), np.array([0.0, 0.5, 0.0]))
        projection = perspective(2 * np.arctan(HIGH / 2 / 50.0), SIZE[0] / SIZE[1], 1.0, 100.0)
        with target:
            target.clear((0.0, 0.0, 0.0, 1.0))
            renderer.update(0)
            renderer.draw(Frame(view, projection, SIZE, 0, 0.0))
        pixels = target.read_pixels()[..., :3].astype(int)
        target.delete()
        renderer.delete()
        return pixels

    return picture


def places() -> tuple[Array, Array, Array]:
    """For each pixel: its agent, -1 where there is none, and its place on the board, metres."""
    width, height = SIZE
    x = (np.arange(width) + 0.5 - width / 2) * HIGH / height
    y = 1.0 - (np.arange(height) + 0.5) * HIGH / height
    across, up = np.meshgrid(x, y)
    agent = np.round(across / SPACING).astype(int) + 2
    across = across - (agent - 2) * SPACING
    return np.where(np.abs(across) < 0.34, agent, -1), across, up


def regions(*, parted: bool, tint: float = 1.0) -> Regions:
    ahead = np.array([1, 0], np.float32)
    return Regions(WAIST, NECK, ahead, MIDDLE, parted, np.zeros(1, np.bool_), tint)


def plain(colour: tuple[int, int, int]) -> Appearance:
    return Appearance(*(colours(colour) for _ in range(5)))


def test_every_pattern_is_where_numpy_has_it(draw: Draw) -> None:
    looks = plain((200, 20, 20))
    looks.second = colours((20, 20, 200))
    looks.pattern = np.arange(5, dtype=np.uint8)
    assert len(PATTERNS) == 5
    picture = draw(looks, Material("shirt"), regions(parted=False))
    agent, across, up = places()
    trunk, pixel = NECK - WAIST, HIGH / SIZE[1]
    share = second_share(
        agent, (across - MIDDLE) / trunk, (up - WAIST) / trunk, (pixel / trunk, pixel / trunk)
    )
    red, blue = (picture[..., 0] > picture[..., 2] + 60), (picture[..., 2] > picture[..., 0] + 60)
    for number in range(5):
        mine = agent == number
        first, second = mine & (share < 1e-3), mine & (share > 1 - 1e-3)
        assert red[first].all(), PATTERNS[number]
        assert blue[second].all(), PATTERNS[number]
        assert first.sum() > 1500
        assert (second.sum() > 600) == (number > 0)
        mixed = mine & ~first & ~second
        if number:
            # The two colours mix in linear light, and the picture's curve is steep at its foot.
            ends = picture[first].mean(axis=0)[0], picture[second].mean(axis=0)[0]
            values = picture[mixed, 0]
            assert (values <= ends[0] + 1).all()
            assert (values >= ends[1] - 1).all()
            assert mixed.sum() > 50
            if np.ptp(share[mixed]) > 0.1:
                assert np.corrcoef(share[mixed], -values)[0, 1] > 0.8


def test_without_regions_shirts_are_plain(draw: Draw) -> None:
    looks = plain((200, 20, 20))
    looks.second = colours((20, 20, 200))
    looks.pattern = np.arange(5, dtype=np.uint8)
    np.testing.assert_array_equal(
        draw(looks, Material("shirt"), None),
        draw(plain((200, 20, 20)), Material("shirt"), regions(parted=False)),
    )


def test_other_surfaces_have_no_pattern(draw: Draw) -> None:
    looks = plain((200, 20, 20))
    looks.second = colours((20, 20, 200))
    looks.pattern = np.arange(5, dtype=np.uint8)
    picture = draw(looks, Material("trousers"), regions(parted=False))
    assert len(np.unique(picture[places()[0] >= 0], axis=0)) <= 4


def dyed(own: Array, colour: Array, usual: float, least: float) -> Array:
    """What shaders/lib/tint.glsl makes of a material of one colour; (3,) sRGB in [0, 1]."""
    mine, theirs = to_hsb(own), to_hsb(colour)
    saturation = 0.2 * mine[1] + 0.8 * theirs[1]
    brightness = mine[2] * min(least + (1.0 - least) * theirs[2] / usual, 1.4)
    return from_hsb([theirs[0], saturation, min(brightness, 1.0)])


def linear(srgb: Array) -> Array:
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


@pytest.mark.parametrize(
    ("own", "skin_like"),
    # A green cloth, and skin of a middle tone; both as bright as they come.
    [((0.30, 0.62, 0.40), False), ((0.86, 0.62, 0.48), True)],
)
@pytest.mark.parametrize("pictured", [False, True])
def test_parts_by_height_are_dyed_as_in_numpy(
    draw: Draw, own: tuple[float, float, float], skin_like: bool, pictured: bool
) -> None:
    """Every part is drawn in one more way: in the colour that NumPy gives, on a named material."""
    srgb = np.round(255 * np.array(own)) / 255
    given = {
        "skin": (150, 96, 66),
        "hair": (92, 62, 38),
        "shirt": (36, 84, 176),
        "trousers": (96, 88, 76),
    }
    looks = plain((0, 0, 0))
    for name, rgb in given.items():
        setattr(looks, name, colours(rgb))
    if pictured:
        image = np.full((4, 4, 4), 255, np.uint8)
        image[..., :3] = np.round(255 * srgb)
        material = Material("body", image=image)
    else:
        material = Material("body", base_color=(*linear(srgb), 1.0))
    shown = draw(looks, material, regions(parted=True))
    agent, _, up = places()
    bands = {"trousers": up < WAIST - 0.02, "hair": up > NECK + 0.02}
    bands["shirt"] = (up > WAIST + 0.02) & (up < NECK - 0.02)
    for name, band in bands.items():
        colour = np.array(given["skin" if skin_like else name]) / 255
        usual, least = (0.95, 0.0) if skin_like else ((0.5 if name == "hair" else 0.75), 0.3)
        rgb = np.round(255 * dyed(srgb, colour, usual, least)).astype(int)
        wanted = draw(plain(tuple(rgb.tolist())), Material("shirt"), None)
        inside = band & (agent >= 0)
        assert inside.sum() > 2000
        np.testing.assert_allclose(shown[inside], wanted[inside], rtol=0, atol=3)


def test_a_pattern_on_a_part_and_greys_above_the_neck(draw: Draw) -> None:
    looks = plain((200, 30, 30))
    looks.second = colours((30, 30, 200))
    looks.pattern[:] = 3
    metal = Material("metal", base_color=(0.4, 0.4, 0.4, 1.0))
    shown = draw(looks, metal, regions(parted=True))
    agent, across, up = places()
    trunk = (agent >= 0) & (up > WAIST + 0.02) & (up < NECK - 0.02)
    left, right = trunk & (across > MIDDLE + 0.03), trunk & (across < MIDDLE - 0.03)
    assert (shown[left, 2] > shown[left, 0] + 40).all()
    assert (shown[right, 0] > shown[right, 2] + 40).all()
    head = (agent >= 0) & (up > NECK + 0.02)
    untouched = draw(looks, metal, regions(parted=True, tint=0.0))
    np.testing.assert_allclose(shown[head], untouched[head], rtol=0, atol=1)


def test_no_tint_leaves_the_file_as_it_is(draw: Draw) -> None:
    material = Material("metal", base_color=(0.1, 0.4, 0.2, 1.0))
    looks = plain((200, 30, 30))
    np.testing.assert_allclose(
        draw(looks, material, regions(parted=True, tint=0.0)),
        draw(looks, material, None),
        rtol=0,
        atol=1,
    )
