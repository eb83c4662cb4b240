"""The gallery's pictures: everybody is in them, whole, and shows what the words below say."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tifo.benchmarks.pictures import crowds, details, motions, people
from tifo.benchmarks.pictures.__main__ import PICTURES
from tifo.benchmarks.pictures.motions import FRAMES, KINDS, SHEETS, frame_times, kinds
from tifo.benchmarks.pictures.sheet import Sheet, with_few_colours
from tifo.benchmarks.pictures.studio import Model, Shot, take, to_linear, to_srgb
from tifo.engine.assets.retarget import retarget
from tifo.engine.assets.spectator import builtin_spectator
from tifo.engine.crowd.body_types import CHILD

DOCS = Path(__file__).resolve().parents[2] / "docs"

SHEETS_OF = {
    "bodies": (people, people.draw_bodies, True),
    "hair": (people, people.draw_hair, False),
    "shirts": (people, people.draw_shirts, False),
    "levels": (details, details.draw_levels, False),
    "props": (details, details.draw_props, True),
    "motions": (motions, lambda scale: motions.draw_motions(SHEETS - 1, scale), True),
}
"""Module, function, and whether everybody is seen down to the feet."""


@pytest.mark.gl
@pytest.mark.parametrize(
    "name",
    [
        "bodies",
        "props",
        pytest.param("hair", marks=pytest.mark.slow),
        pytest.param("shirts", marks=pytest.mark.slow),
        pytest.param("levels", marks=pytest.mark.slow),
        pytest.param("motions", marks=pytest.mark.slow),
    ],
)
def test_nobody_is_clipped_and_no_picture_empty(
    name: str, gl: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    module, draw, whole = SHEETS_OF[name]
    shots: list[Shot] = []

    def taken(*arguments: Any, **options: Any) -> Shot:
        shots.append(take(*arguments, **options))
        return shots[-1]

    monkeypatch.setattr(module, "take", taken)
    # Levels are also shown as small as they are used: in a small picture nothing would be left.
    tiny = name == "levels"
    picture = draw(1.0 if tiny else 0.22)
    for shot in shots:
        assert shot.cover.max() > 0.9
        assert shot.cover.sum() > 60 if tiny else shot.cover.mean() > 0.004
        border = [shot.cover[0], shot.cover[:, 0], shot.cover[:, -1]]
        border += [shot.cover[-1]] if whole else []
        assert max(float(edge.max()) for edge in border) < 0.05
    pixels = np.asarray(picture.convert("RGB")).astype(int)
    drawn = np.abs(pixels - pixels[2, 2]).max(axis=2) > 60
    assert 0.03 < drawn.mean() < 0.7
    assert not any(drawn[:, edge].any() for edge in (0, -1))


@pytest.mark.gl
def test_the_studio_puts_people_where_they_are_asked_for(gl: Any) -> None:
    models = [
        Model(at=(40, 150), colours={"shirt": (220, 30, 30)}),
        Model(at=(120, 150), kind=CHILD, scale=0.7, wears={"body": "child_shirt"}),
        Model(at=(200, 150), level=3),
    ]
    shot = take(models, (240, 170), 70)
    tops = []
    for x in (40, 120, 200):
        rows = np.flatnonzero(shot.cover[:, x - 35 : x + 35].max(axis=1) > 0.5)
        assert rows[-1] == pytest.approx(150, abs=6)
        tops.append(rows[0])
    # 1.75 m are 122 pixels; a child of 0.7 has shorter legs as well.
    assert tops[0] == pytest.approx(150 - 122, abs=5)
    assert 68 < 150 - tops[1] < 0.72 * 122
    red = to_srgb(shot.light)
    chest = red[150 - 90, 40]
    assert chest[0] > 2.5 * chest[1]
    # The joints that shadows are made for are where the bodies are.
    head = builtin_spectator().skeleton.index("head")
    assert shot.joints[0, head] == pytest.approx((40, 150 - 1.54 * 70), abs=4)
    assert shot.height[0, head] == pytest.approx(1.54, abs=0.04)


def test_every_kind_of_motion_is_on_one_sheet() -> None:
    clips = builtin_spectator().clips
    shown = [clip.name for clip in kinds(clips)]
    assert len(set(shown)) == len(shown)
    assert {re.sub(r"_\d+$", "", clip.name) for clip in clips} == set(shown)
    assert (SHEETS - 1) * KINDS < len(shown) <= SHEETS * KINDS
    assert shown.index("sit_wave") == shown.index("wave") + 1
    loop, once = (next(c for c in clips if c.name == name) for name in ("jump", "kick"))
    assert frame_times(loop)[-1] == pytest.approx(loop.duration * 7 / 8)
    assert frame_times(once)[-1] == pytest.approx(once.duration)
    assert len(frame_times(once)) == FRAMES


def _places(absolute: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Seats (N, 3), hips in the stadium's frame (N, 3), and lengths (N,) of the thighs."""
    simulation = crowds.relative_crowd(absolute=absolute)
    crowd, clock = simulation.crowd, simulation.clock
    skeleton = crowd.character.skeleton
    palettes = crowd.palettes(np.arange(len(crowd)), clock.pose_tick, clock.alpha).astype(float)
    bind = -skeleton.inverse_bind[:, :, 3].astype(float)
    points = np.einsum("njrc,jc->njr", palettes[..., :3], bind) + palettes[..., 3]
    points *= crowd.placement.scale[:, None, None]
    seats = crowd.placement.position.T.astype(float)
    upper, lower = skeleton.index("upper_leg_l"), skeleton.index("lower_leg_l")
    thigh = np.linalg.norm(points[:, upper] - points[:, lower], axis=1)
    world = points + seats[:, None]
    camera = crowds.relative_camera(absolute=absolute)
    size = (900, 900)
    clip = np.concatenate([world, np.ones((*world.shape[:2], 1))], axis=2)
    clip = clip @ (camera.projection(size).astype(float) @ camera.view().astype(float)).T
    assert np.abs(clip[..., :2] / clip[..., 3:]).max() < 0.98, "somebody is out of the picture"
    simulation.close()
    return seats, world[:, skeleton.index("hips")], thigh


def test_relative_motion_stays_in_the_seats_and_absolute_motion_leaves_them() -> None:
    seats, hips, thighs = _places(absolute=False)
    away = (hips - seats)[:, [0, 2]]
    assert np.linalg.norm(away, axis=1).max() < 0.25
    assert np.ptp(thighs) > 0.08
    seats, hips, thighs = _places(absolute=True)
    moved = (hips - seats)[:, [0, 2]]
    x, z, _ = crowds.RECORDED
    assert moved == pytest.approx(np.tile((x, z), (len(moved), 1)), abs=0.25)
    assert np.ptp(thighs) < 1e-5


def test_the_recorded_clip_is_the_built_in_one_elsewhere() -> None:
    """Taken back to the agent it is what it was made from, up to where the body faces at first."""
    character = builtin_spectator()
    skeleton, clip = crowds.recorded(character, crowds.CLIP)
    assert skeleton.parents[0] == -1
    back = retarget(clip, skeleton, character.skeleton)
    own = character.clip(crowds.CLIP)
    for joint in ("lower_arm_r", "lower_leg_l", "upper_arm_r"):
        index = character.skeleton.index(joint)
        dots = np.abs((back.rotation[:, index] * own.rotation[:, index]).sum(axis=1))
        assert dots.min() > 0.99


@pytest.mark.gl
@pytest.mark.slow
@pytest.mark.parametrize("draw", [crowds.draw_block, crowds.draw_relative])
def test_crowds_fill_their_pictures(draw: Callable[[float], Image.Image], gl: Any) -> None:
    pixels = np.asarray(draw(0.15).convert("RGB")).astype(int)
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 60
    assert pixels.std() > 35


def test_few_colours_are_like_all() -> None:
    grey = np.linspace(0, 255, 64 * 64 * 3).reshape(64, 64, 3).astype(np.uint8)
    few = with_few_colours(Image.fromarray(grey))
    assert few.mode == "P"
    assert np.abs(np.asarray(few.convert("RGB")).astype(int) - grey).mean() < 6
    assert to_srgb(to_linear(np.array([0.0, 0.02, 0.5, 1.0]))) == pytest.approx([0, 0.02, 0.5, 1])


def test_a_sheet_mixes_light_and_not_bytes() -> None:
    half = np.full((4, 4), 0.5)
    none = np.zeros((0, 1, 2))
    sheet = Sheet((4, 4), colour=(0, 0, 0))
    sheet.put(Shot(np.full((4, 4, 3), 0.5), half, none, none, np.zeros((0, 1))))
    # Half white on black is 188, not 128.
    assert np.asarray(sheet.finish().convert("RGB"))[0, 0] == pytest.approx([188] * 3, abs=2)


def test_the_page_shows_every_picture() -> None:
    page = (DOCS / "gallery.md").read_text("utf-8")
    shown = set(re.findall(r"!\[[^\]]+\]\(([\w-]+)\.png\)", page))
    new = {"bodies", "hair", "levels", "shirts", "props", "block", "relative", "walking"}
    assert shown == new | {f"motions-{k + 1}" for k in range(SHEETS)}
    assert shown <= set(PICTURES)
    assert sum((DOCS / f"{name}.png").stat().st_size for name in shown) < 6_000_000
