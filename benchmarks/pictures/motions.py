"""Every kind of motion that the built-in spectator has, as strips of frames on several sheets."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from PIL import Image

from ...engine.animation.clip import Clip
from ...engine.animation.clip_bank import ClipBank
from ...engine.animation.kinematics import Kinematics
from ...engine.assets.spectator import builtin_spectator
from .sheet import FAINT, Sheet
from .studio import HAIRS, SKINS, Model, take

FRAMES = 8
KINDS = 16
"""Strips of a sheet, in two columns."""
SHEETS = 5
YAW = 0.55
_BEATS = ("clap_contact", "shout")

_LOOKS = (
    ({"body": "man_shirt", "hair": "short"}, 0, 0, (198, 42, 50)),
    ({"body": "woman_shirt", "hair": "ponytail"}, 1, 1, (40, 120, 190)),
    ({"body": "man_sweater", "hair": "crop", "beard": "full"}, 2, 1, (214, 150, 40)),
    ({"body": "woman_sweater", "hair": "bob"}, 0, 3, (70, 140, 96)),
)
"""Variants, skin, hair and shirt of those who show the motions in turn."""


def kinds(clips: Sequence[Clip]) -> list[Clip]:
    """The first variant of each kind of motion.

    Standing motions are followed by the same ones on a seat.
    """
    by_kind: dict[str, list[Clip]] = {}
    for clip in clips:
        by_kind.setdefault(re.sub(r"_\d+$", "", clip.name), []).append(clip)
    order = sorted(by_kind, key=lambda name: _place(name, list(by_kind)))
    return [by_kind[name][0] for name in order]


def _place(name: str, names: list[str]) -> tuple[int, bool]:
    stem = name.removeprefix("sit_")
    seated = name.startswith("sit_") and stem in names
    return names.index(stem if seated else name), seated


def frame_times(clip: Clip, frames: int = FRAMES) -> list[float]:
    """Seconds of a strip's frames: all of the clip, or the first beats of a long rhythmic one."""
    beats = sorted({event.time for event in clip.events if event.name in _BEATS})
    if len(beats) > 3:
        return [beats[0] + 1.5 * (beats[1] - beats[0]) * k / frames for k in range(frames)]
    # A loop's end is its beginning, so it is left out there.
    return [clip.duration * k / (frames if clip.looping else frames - 1) for k in range(frames)]


def reaches(clips: Sequence[Clip]) -> list[float]:
    """Metres above the ground that the highest joint of each strip comes to."""
    skeleton = builtin_spectator().skeleton
    bank, kinematics = ClipBank(skeleton, clips), Kinematics(skeleton, 1)
    palettes = np.empty((1, skeleton.joint_count, 3, 4), np.float32)
    joints = np.arange(skeleton.joint_count)
    highest = []
    for number, clip in enumerate(clips):
        heights = []
        for time in frame_times(clip):
            kinematics.evaluate(bank.sample_one(number, time), palettes)
            heights.append(float(kinematics.joint_positions(joints)[..., 1].max()))
        highest.append(max(heights))
    return highest


def draw_motions(number: int, scale: float = 1.0) -> Image.Image:
    """One of the sheets, counted from 0."""
    whole = kinds(builtin_spectator().clips)
    clips = whole[number * KINDS : (number + 1) * KINDS]
    rows = -(-len(clips) // 2)
    wide, gap, metre = 106 * scale, 22 * scale, 92 * scale
    reach = reaches(clips)
    # Above the highest joint are hair or fingers, above those the words.
    high = [round(max(reach[k::rows]) * metre + 62 * scale) for k in range(rows)]
    tops = np.concatenate([[0], np.cumsum(high)])
    sheet = Sheet((round(2 * (FRAMES * wide + gap)), int(tops[-1])), scale=scale)
    for row in range(rows):
        top, bottom = int(tops[row]), int(tops[row + 1])
        sheet.floor(bottom - 26 * scale, bottom - 3 * scale)
        models = []
        for k in range(row, len(clips), rows):
            left = gap / 2 + (k // rows) * (FRAMES * wide + gap)
            models += _strip(clips[k], number + k, (left, high[row] - 16 * scale), wide)
            if _needs_seat(clips[k]):
                for frame in range(FRAMES):
                    place = (left + (frame + 0.5) * wide, bottom - 16 * scale)
                    sheet.seat(place, metre, YAW)
            kind = "loop" if clips[k].looping else "once"
            words = f"{clips[k].duration:.1f} s, {kind}"
            sheet.text((left + 8 * scale, top + 10 * scale), clips[k].name, 17, anchor="lm")
            end = left + FRAMES * wide - 12 * scale
            sheet.text((end, top + 10 * scale), words, 14, FAINT, "rm")
        # A row at a time, so that all are seen from the same height.
        shot = take(models, (sheet.size[0], high[row]), metre)
        sheet.put(shot, (0, top), metre=metre)
    return sheet.finish()


def _strip(clip: Clip, number: int, corner: tuple[float, float], wide: float) -> list[Model]:
    """Somebody in each frame of a clip, the first at a corner."""
    wears, skin, hair, shirt = _LOOKS[number % len(_LOOKS)]
    colours = {"skin": SKINS[skin], "hair": HAIRS[hair], "shirt": shirt}
    return [
        Model(
            at=(corner[0] + (frame + 0.5) * wide, corner[1]),
            clip=clip.name,
            time=time,
            yaw=YAW,
            wears=wears,
            colours=colours,
        )
        for frame, time in enumerate(frame_times(clip))
    ]


def _needs_seat(clip: Clip) -> bool:
    return clip.name.startswith("sit") or clip.name == "stand_up"
