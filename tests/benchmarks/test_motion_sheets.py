"""Contact sheets: what they show, and that every clip is on one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tifo.benchmarks.motion_sheets import (
    CELL,
    FRAMES,
    PoseStrip,
    draw_sheets,
    strip_times,
)
from tifo.engine.assets.spectator import builtin_spectator


def test_times_show_a_clip_once() -> None:
    character = builtin_spectator()
    loop, once, claps = (character.clip(name) for name in ("look_left", "duck", "clap_2"))
    np.testing.assert_allclose(strip_times(loop), np.arange(6) * 0.4, atol=1e-6)
    np.testing.assert_allclose(strip_times(once), np.arange(6) * 0.44, atol=1e-6)
    # One and a half claps of half a second, not six contacts.
    np.testing.assert_allclose(strip_times(claps), np.arange(6) * 0.125, atol=1e-6)


@pytest.mark.gl
def test_a_strip_shows_each_pose_in_its_cell(gl: Any) -> None:
    strip = PoseStrip(builtin_spectator())
    picture = strip.draw("stand_up", [0.0] * 3 + [1.9] * 3).astype(int)
    strip.delete()
    width, height = CELL
    assert picture.shape == (height, FRAMES * width, 3)
    drawn = np.abs(picture - picture[0, 0]).max(axis=2) > 12
    tops = []
    for k in range(FRAMES):
        cell = drawn[:, k * width : (k + 1) * width]
        rows = np.flatnonzero(cell.any(axis=1))
        # Feet on the ground line, a margin on both sides.
        assert rows[-1] == pytest.approx(height * 2.42 / 2.54, abs=4)
        assert not cell[:, [0, -1]].any()
        tops.append(rows[0])
    assert max(tops[:3]) - min(tops[:3]) <= 1
    assert tops[0] - tops[5] > 0.3 / 2.54 * height


@pytest.mark.gl
def test_sheets_have_all_the_clips_that_were_asked_for(gl: Any, tmp_path: Path) -> None:
    from PIL import Image

    character = builtin_spectator()
    few = replace(character, clips=character.clips[:12])
    paths = draw_sheets(few, tmp_path / "sheets", rows=4)
    assert [path.name for path in paths] == ["motions-1.png", "motions-2.png"]
    with Image.open(paths[0]) as first, Image.open(paths[1]) as second:
        assert first.size[0] == 2 * (FRAMES * CELL[0] + 6)
        assert second.size == (first.size[0] // 2, first.size[1])
    (only,) = draw_sheets(character, tmp_path / "one", ["kick"], rows=4)
    with Image.open(only) as sheet:
        assert sheet.size[1] == 2 * (CELL[1] + 20)
