"""Agents of a few pixels: where the shader puts them, and what the picture shows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tifo.components import AgentAnimID, Appearance, Detail, Placement, Transition
from tifo.engine.animation import ClipBank
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.crowd.figure import make_figure
from tifo.engine.streams import StreamPool
from tifo.engine.streams.blending import agent_palettes, begin_blend
from tifo.engine.streams.pool import bind_positions
from tifo.scripting.camera import look_at, perspective

pytestmark = pytest.mark.gl

Array = NDArray[Any]
ARMS_UP = ("cheer", 0.9)
STANDING = ("stand_idle", 0.0)
SITTING = ("sit_idle", 0.0)


class Figures:
    """Spectators in a row, each on a stream of its own, all drawn as figures of strokes."""

    def __init__(self, shown: list[tuple[str, float]], spacing: float = 1.2) -> None:
        self.character = builtin_spectator()
        self.figure = make_figure(self.character)
        bank = ClipBank(self.character.skeleton, self.character.clips)
        self.pool = StreamPool(
            self.character.skeleton,
            bank,
            capacity=len(shown),
            history=14,
            markers=self.figure.joints,
        )
        for clip, time in shown:
            self.pool.add(clip, time=time - 4 / 30)
        for tick in range(5):
            self.pool.evaluate(tick)
            self.pool.commit(tick)
        count = len(shown)
        self.anim = AgentAnimID.allocate(1, count, 0)
        self.anim.row[0] = np.arange(count)
        self.transition = Transition.allocate(1, count)
        position = np.zeros((3, count), np.float32)
        position[0] = (np.arange(count) - (count - 1) / 2) * spacing
        zeros = np.zeros(count, np.float32)
        self.placement = Placement(position, zeros.copy(), zeros + np.float32(1.0))
        colours = ((205, 150, 120), (60, 40, 25), (200, 20, 30), (30, 40, 90), (20, 20, 20))
        painted = [np.tile(np.array([*rgb, 255], np.uint8), (count, 1)) for rgb in colours]
        self.appearance = Appearance(painted[0], painted[1], painted[2], painted[3], painted[4])

    def joints(self, tick: int, alpha: float) -> NDArray[np.float64]:
        """(N, 7, 3) markers in the stadium, from the palettes of the CPU."""
        agents = np.arange(len(self.placement.yaw))
        palettes = agent_palettes(
            self.pool, self.anim, self.transition, 0, agents, tick, alpha
        ).astype(float)
        chosen = self.figure.joints
        bind = bind_positions(self.character.skeleton)[chosen].astype(float)
        model = np.einsum("akij,kj->aki", palettes[:, chosen][..., :3], bind)
        model += palettes[:, chosen][..., 3]
        sin, cos = np.sin(self.placement.yaw), np.cos(self.placement.yaw)
        x, y, z = np.moveaxis(model, 2, 0)
        turned = np.stack(
            [cos[:, None] * x + sin[:, None] * z, y, cos[:, None] * z - sin[:, None] * x], axis=2
        )
        places: NDArray[np.float64] = (
            self.placement.position.T[:, None] + self.placement.scale[:, None, None] * turned
        )
        return places

    def renderer(self) -> Any:
        """The real renderer, with everybody at the farthest level."""
        from tifo.engine.render.crowd_renderer import CrowdColumns, CrowdRenderer

        nobody = np.zeros(0, np.uint32)
        detail = Detail(
            (nobody, nobody, nobody, np.arange(len(self.placement.yaw), dtype=np.uint32))
        )
        poses = (self.pool, self.anim, self.transition)
        columns = CrowdColumns(self.placement, self.appearance, detail, poses)
        return CrowdRenderer(self.character, self.figure.height, columns)


def camera(
    eye: tuple[float, float, float], size: tuple[int, int], high: float
) -> tuple[Array, Array]:
    """View and projection from `eye` to the middle of a standing body, `high` metres in view."""
    target = np.array([0.0, 0.9, 0.0])
    away = float(np.linalg.norm(np.array(eye) - target))
    field = 2.0 * np.arctan(high / 2.0 / away)
    return look_at(np.array(eye), target), perspective(field, size[0] / size[1], 0.5, 500.0)


def captured(
    figures: Figures,
    names: tuple[str, ...],
    tick: int,
    alpha: float,
    view: Array,
    projection: Array,
) -> Any:
    """Outputs of the figures' vertex shader, (N,) records."""
    from tifo.components import Detail
    from tifo.engine.gl import Program, VertexArray, capture
    from tifo.engine.render.crowd_inputs import CrowdColumns, CrowdInputs
    from tifo.engine.render.frame import Frame
    from tifo.engine.render.skinned_pass import InstanceList

    poses = (figures.pool, figures.anim, figures.transition)
    inputs = CrowdInputs(CrowdColumns(figures.placement, figures.appearance, Detail(), poses))
    inputs.update(tick)
    agents = InstanceList()
    agents.write(np.arange(len(figures.placement.yaw), dtype=np.uint32))
    program = Program("far/figure.vert.glsl", feedback=names)
    array = VertexArray(program, [agents.input(divisor=0)])
    size = (320, 180)
    frame = Frame(view, projection, size, tick, alpha)
    frame.apply(program)
    inputs.bind(program, tick, alpha, markers=True)
    program["body_height"] = figures.figure.height
    program["pixel"] = 2.0 / (float(projection[1, 1]) * size[1])
    program["viewport"] = (0.0, 0.0, *size)
    out = capture(program, array, agents.count)[0]
    for thing in (array, agents.buffer, program, inputs):
        thing.delete()
    return out


def turned_crowd() -> Figures:
    """Agents of several sizes, facings and poses, two of them in the middle of a blend."""
    figures = Figures([ARMS_UP, STANDING, SITTING, ("wave", 0.7), ("clap", 0.4), ("jump", 0.5)])
    figures.placement.yaw[:] = np.linspace(-3, 3, 6)
    figures.placement.scale[:] = np.linspace(0.8, 1.2, 6)
    figures.placement.position[1] = np.linspace(0, 1.2, 6)
    figures.anim.start[0] = figures.anim.target[0] = [0, 0.5, 1.25, 2, 0, 1]
    begin_blend(
        figures.anim,
        figures.transition,
        0,
        np.array([1, 3]),
        np.array([4, 5], np.int32),
        np.zeros(2, np.float32),
        2,
        np.array([4.0, 3.0], np.float32),
    )
    return figures


@pytest.mark.parametrize("eye", [(0.0, 1.0, 14.0), (9.0, 7.0, 9.0), (-12.0, 3.0, -2.0)])
@pytest.mark.parametrize("alpha", [0.0, 0.6])
def test_markers_are_where_the_joints_are(eye: tuple[float, float, float], alpha: float) -> None:
    figures = turned_crowd()
    view, projection = camera(eye, (320, 180), 6.0)
    names = ("f_hips", "f_head", "f_hands", "f_feet")
    out = captured(figures, names, 4, alpha, view, projection)
    joints = figures.joints(4, alpha)
    eyes = np.einsum("ij,akj->aki", view[:3, :3].astype(float), joints) + view[:3, 3]
    hips = eyes[:, 2]
    # Pixels of a metre at the hips, and everything about the hips in the picture plane.
    metre = projection[1, 1] * 180 / 2 / -hips[:, 2]
    at = metre[:, None, None] * (eyes - hips[:, None])[..., :2]
    window = np.stack(
        [
            160 + projection[0, 0] * 160 * hips[:, 0] / -(hips[:, 2] + 0.3),
            90 + projection[1, 1] * 90 * hips[:, 1] / -(hips[:, 2] + 0.3),
        ],
        axis=1,
    )
    np.testing.assert_allclose(out["f_hips"], window, rtol=0, atol=2e-3)
    np.testing.assert_allclose(out["f_hands"].reshape(-1, 2, 2), at[:, 3:5], rtol=0, atol=2e-3)
    np.testing.assert_allclose(out["f_feet"].reshape(-1, 2, 2), at[:, 5:7], rtol=0, atol=2e-3)
    spine, head = out["f_head"][:, :2], out["f_head"][:, 2:]
    np.testing.assert_allclose(spine, 0.65 * at[:, 1] + 0.35 * at[:, 0], rtol=0, atol=2e-3)
    # The middle of the head is a few centimetres above its joint.
    above = np.linalg.norm(head - at[:, 0], axis=1) / metre
    assert (above < 0.08).all()


@pytest.mark.parametrize("shift", [0.0, 4.0, 5.4])
def test_points_cover_the_strokes_also_at_the_border(shift: float) -> None:
    figures = turned_crowd()
    figures.placement.position[0] += shift
    view, projection = camera((0.0, 1.0, 14.0), (320, 180), 6.0)
    names = ("f_hips", "f_head", "f_hands", "f_feet", "f_radius", "gl_Position", "gl_PointSize")
    out = captured(figures, names, 4, 0.5, view, projection)
    clip = out["gl_Position"]
    assert (np.abs(clip[:, :2]) <= clip[:, 3:]).all(), "a middle outside would not be drawn"
    middle = (clip[:, :2] / clip[:, 3:] * 0.5 + 0.5) * [320, 180]
    half = out["gl_PointSize"][:, None] / 2
    ends = [out[name].reshape(-1, 2, 2) for name in ("f_head", "f_hands", "f_feet")]
    strokes = np.concatenate([*ends, np.zeros((len(out), 1, 2))], axis=1)
    places = out["f_hips"][:, None] + strokes
    radius = out["f_radius"].max(axis=1)[:, None] + 0.4
    inside = (places >= 0).all(axis=2) & (places <= [320, 180]).all(axis=2)
    covered = (np.abs(places - middle[:, None]) + radius[..., None] <= half[:, None] + 1e-3).all(2)
    assert covered[inside].all()
    if shift == 0.0:
        assert inside.all()
        # As small as may be: what a point covers beyond its figure costs as much as the figure.
        spread = np.ptp(places, axis=1).max(axis=1)
        assert (2 * half[:, 0] <= spread + 2 * radius[:, 0] + 1.5).all()


def draw(
    figures: Figures, size: tuple[int, int], eye: tuple[float, float, float], high: float
) -> NDArray[np.uint8]:
    """(H, W, 3) picture of the figures before a grey background."""
    from tifo.engine.gl import Framebuffer
    from tifo.engine.render.frame import Frame

    renderer = figures.renderer()
    target = Framebuffer(size, samples=4)
    view, projection = camera(eye, size, high)
    with target:
        target.clear((0.2, 0.2, 0.2, 1.0))
        renderer.update(4)
        renderer.draw(Frame(view, projection, size, 4, 1.0))
    picture: NDArray[np.uint8] = target.read_pixels()[..., :3]
    target.delete()
    renderer.delete()
    return picture


FRONT = (0.0, 1.0, 40.0)


def drawn(picture: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Pixels that are not background."""
    changed: NDArray[np.bool_] = np.abs(picture.astype(int) - picture[0, 0]).max(axis=2) > 12
    return changed


def test_a_few_figures(golden: Any) -> None:
    figures = Figures([ARMS_UP, STANDING, SITTING, ("wave", 0.7)])
    picture = draw(figures, (96, 48), FRONT, 3.0)
    golden.check("figures", picture, mean=2.0, share=0.05)
    columns = drawn(picture).any(axis=0)
    assert np.count_nonzero(np.diff(columns.astype(int)) == 1) == 4, "four figures, all apart"


def test_the_shirt_is_in_the_middle_and_the_head_on_top() -> None:
    picture = draw(Figures([STANDING]), (96, 96), FRONT, 2.4)
    rows = np.flatnonzero(drawn(picture).any(axis=1))
    columns = np.flatnonzero(drawn(picture).any(axis=0))
    top, bottom = rows[0], rows[-1]
    centre = (columns[0] + columns[-1]) // 2
    pixels = 1.75 / 2.4 * 96
    assert bottom - top == pytest.approx(pixels, rel=0.12)

    def at(share: float) -> NDArray[np.float64]:
        row = round(top + share * (bottom - top))
        patch = picture[row - 1 : row + 2, centre - 2 : centre + 3].astype(float)
        mean: NDArray[np.float64] = patch.mean(axis=(0, 1))
        return mean

    red, green, blue = at(0.35)
    assert red > 2.5 * max(green, blue), "the shirt"
    face = at(0.12)
    assert face[0] > face[1] > face[2] > 60, "skin"
    assert at(0.02).mean() < face.mean(), "hair"
    legs = picture[round(top + 0.75 * (bottom - top))]
    dark = legs[drawn(picture)[round(top + 0.75 * (bottom - top))]]
    assert dark[:, 2].mean() > 1.3 * dark[:, 0].mean(), "blue trousers"


def test_who_turns_away_shows_hair() -> None:
    figures = Figures([STANDING])
    front = draw(figures, (96, 96), FRONT, 2.4)
    figures.placement.yaw[:] = np.pi
    back = draw(figures, (96, 96), FRONT, 2.4)
    top = np.flatnonzero(drawn(front).any(axis=1))[0]
    head = (slice(top + 5, top + 9), slice(46, 50))
    assert front[head].mean() > 1.8 * back[head].mean()


def test_arms_up_is_taller_than_standing_and_standing_than_sitting() -> None:
    heights = []
    for pose in (ARMS_UP, STANDING, SITTING):
        rows = np.flatnonzero(drawn(draw(Figures([pose]), (96, 96), FRONT, 3.0)).any(axis=1))
        heights.append(96 - rows[0])
    assert heights[0] > heights[1] + 5
    assert heights[1] > heights[2] + 8


def test_figures_cut_by_the_border_are_still_drawn() -> None:
    figures = Figures([STANDING])
    whole = draw(figures, (96, 96), FRONT, 2.4)
    for shift in (0.9, 1.1, 1.2):
        figures.placement.position[0] = shift
        picture = draw(figures, (96, 96), FRONT, 2.4)
        moved = round(shift / 2.4 * 96)
        np.testing.assert_allclose(
            drawn(picture)[:, moved:].sum(), drawn(whole)[:, : 96 - moved].sum(), atol=25
        )
        assert drawn(picture)[:, -2:].any()


def test_the_viewport_may_lie_anywhere() -> None:
    """As in a game that draws into a part of its own framebuffer."""
    from tifo.engine.gl import Framebuffer
    from tifo.engine.gl.api import gl as api
    from tifo.engine.render.frame import Frame

    figures = Figures([ARMS_UP, STANDING, SITTING])
    alone = draw(figures, (96, 48), FRONT, 3.0)
    renderer = figures.renderer()
    target = Framebuffer((200, 100), samples=4)
    view, projection = camera(FRONT, (96, 48), 3.0)
    with target:
        target.clear((0.2, 0.2, 0.2, 1.0))
        api.glViewport(80, 40, 96, 48)
        renderer.update(4)
        renderer.draw(Frame(view, projection, (96, 48), 4, 1.0))
    picture = target.read_pixels()[100 - 88 : 100 - 40, 80:176, :3]
    target.delete()
    renderer.delete()
    np.testing.assert_array_equal(picture, alone)


def test_shirts_with_patterns_have_their_mean_colour() -> None:
    """Linear halves of 255 and 0 are 188 in sRGB; a sash is not seen."""
    figures = Figures([STANDING] * 5)
    shirt, second = figures.appearance.shirt, figures.appearance.second
    shirt[:, :3], second[:, :3] = (255, 0, 0), (0, 0, 255)
    shirt[3:, :3] = ((188, 0, 188), (255, 0, 0))
    figures.appearance.pattern[:] = (1, 2, 4, 0, 0)
    light = captured(figures, ("f_shirt",), 4, 1.0, *camera(FRONT, (320, 180), 2.4))["f_shirt"]
    # Haze grows a little with the distance.
    np.testing.assert_allclose(light[[0, 1]], light[[3, 3]], atol=0.006)
    np.testing.assert_allclose(light[2], light[4], atol=0.006)
    assert not np.allclose(light[3], light[4], atol=0.05)
