"""What one spectator is drawn with: levels of detail side by side, and props."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PIL import Image

from ...components import Level
from ...engine.assets.character import Character
from ...engine.assets.spectator import builtin_spectator
from ...engine.assets.variants import one_look
from ...engine.crowd.detail import MESH_PIXELS
from ...engine.crowd.kits import KITS
from .sheet import FAINT, Sheet
from .studio import HAIRS, SKINS, Array, Model, Shot, take

WEARS: Mapping[str, str | None] = {"body": "man_shirt", "hair": "short", "beard": "full"}
"""Whose levels are shown."""


def triangles(character: Character, wears: Mapping[str, str | None]) -> tuple[int, ...]:
    """Triangles of somebody at each level that has meshes."""
    look = one_look(character, wears)
    return tuple(
        sum(len(mesh.triangles) for mesh in level) for level in (look.meshes, *look.lower_levels)
    )


def draw_levels(scale: float = 1.0) -> Image.Image:
    """Heads and bodies at each level, equally large, and as large as they are drawn at most."""
    wide, gap = 372 * scale, 8 * scale
    head, body = 360 * scale, 560 * scale
    foot = 200 * scale
    sheet = Sheet((round(4 * wide), round(head + body + foot)), scale=scale)
    counts = triangles(builtin_spectator(), WEARS)
    names = ("near", "mid", "low", "far")
    metre, close = 232 * scale, 640 * scale
    ground = head + body - 76 * scale
    sheet.floor(ground - 26 * scale, ground + 22 * scale)
    bust = (round(wide), round(head - gap / 2))
    whole = (round(wide), round(body - 50 * scale))
    for level in Level:
        left = round(level * wide)
        sheet.card((left + gap / 2, gap / 2), (wide - gap, head - gap))
        # No driver draws points as large as this, so the far figure is enlarged.
        shot = _large(bust, head * 0.54 + 1.60 * close, close, level, 8)
        sheet.put(shot, (left, 0))
        shot = _large(whole, ground - head, metre, level, 4)
        sheet.put(shot, (left, round(head)), metre=metre)
    for level in Level:
        x = (level + 0.5) * wide
        count = f"{counts[level]:,} triangles" if level < Level.FAR else "one point"
        sheet.text((x, ground + 44 * scale), names[level], 22)
        sheet.text((x, head + body), count, 18, FAINT)
    _as_in_a_crowd(sheet, wide, head + body + foot, scale)
    return sheet.finish()


def _large(size: tuple[int, int], feet: float, metre: float, level: int, factor: int) -> Shot:
    """Somebody in the middle of a shot; the far figure is drawn smaller and enlarged."""
    k = factor if level == Level.FAR else 1
    small = (-(-size[0] // k), -(-size[1] // k))
    shot = take([_model((0.5 * size[0] / k, feet / k), level)], small, metre / k)

    def enlarged(pixels: Array) -> Array:
        return pixels.repeat(k, axis=0).repeat(k, axis=1)[: size[1], : size[0]]

    light, cover = enlarged(shot.light), enlarged(shot.cover)
    return Shot(light, cover, k * shot.joints, k * shot.ground, shot.height)


def _as_in_a_crowd(sheet: Sheet, wide: float, bottom: float, scale: float) -> None:
    """Four of each level in the size below which the next one takes over."""
    for level in Level:
        pixels = MESH_PIXELS[min(level, len(MESH_PIXELS) - 1)]
        pixels *= 1.0 if level < Level.FAR else 0.7
        metre = pixels / 1.75 * scale
        x = (level + 0.5) * wide
        step = max(0.75 * metre, 10 * scale)
        models = [_model((wide / 2 + (k - 1.5) * step, 150 * scale), level, k) for k in range(4)]
        shot = take(models, (round(wide), round(170 * scale)), metre)
        sheet.put(shot, (round(level * wide), round(bottom - 202 * scale)))
        words = f"from {pixels:.0f} pixels" if level < Level.FAR else "below that"
        sheet.text((x, bottom - 24 * scale), words, 16, FAINT)


def _model(at: tuple[float, float], level: int, time: float = 0.3) -> Model:
    return Model(
        at=at, clip="stand_idle", time=time, yaw=0.45, level=level, wears=WEARS, kit=KITS[0]
    )


_ROWS: tuple[tuple[tuple[str, Mapping[str, Any]], ...], ...] = (
    (
        ("cap", {"clip": "clap", "time": 0.2, "props": {"cap": ""}, "yaw": 0.5}),
        (
            "scarf",
            {
                "props": {"scarf": "hang"},
                "wears": {"body": "woman_sweater", "hair": "bob"},
                "scale": 0.94,
                "yaw": 0.3,
            },
        ),
        (
            "flag, hanging",
            {
                "props": {"flag": "hang"},
                "clip": "sit_idle",
                "wears": {"beard": "moustache", "hair": "crop"},
                "yaw": -0.2,
            },
        ),
        (
            "flag, in the wind",
            {
                "props": {"flag": "wave", "scarf": "swing"},
                "clip": "fist_pump",
                "time": 0.62,
                "wears": {"body": "woman_shirt", "hair": "ponytail"},
                "scale": 0.94,
                "yaw": -0.5,
            },
        ),
        ("foam hand", {"props": {"foam_hand": ""}, "clip": "fist_pump", "time": 0.62, "yaw": 0.1}),
    ),
    (
        (
            "foam hand, waved",
            {
                "props": {"foam_hand": "", "cap": ""},
                "clip": "wave",
                "time": 0.4,
                "wears": {"body": "woman_shirt", "hair": "long"},
                "scale": 0.94,
                "yaw": -0.2,
            },
        ),
        ("drum, right hand", {"props": {"drum": "0.0"}, "yaw": 0.45}),
        ("drum, left hand", {"props": {"drum": "0.5"}, "yaw": 0.45}),
        (
            "drum, from aside",
            {
                "props": {"drum": "1.5", "cap": ""},
                "yaw": 1.35,
                "wears": {"body": "woman_sweater", "hair": "ponytail"},
                "scale": 0.94,
            },
        ),
        (
            "drum, while singing",
            {"props": {"drum": "1.25"}, "clip": "chant", "time": 1.8, "yaw": -0.5},
        ),
    ),
)


def draw_props(scale: float = 1.0) -> Image.Image:
    """Everything that spectators have with them."""
    wide, high, metre = 310 * scale, 656 * scale, 222 * scale
    sheet = Sheet((round(5 * wide), round(2 * high)), scale=scale)
    models = []
    for row, people in enumerate(_ROWS):
        ground = (row + 1) * high - 74 * scale
        sheet.floor(ground - 24 * scale, ground + 22 * scale)
        for k, (name, who) in enumerate(people):
            x = (k + 0.5) * wide
            kit = KITS[(0, 3, 1, 4, 6)[(k + 2 * row) % 5]]
            number = k + 5 * row
            colours = {
                "skin": SKINS[(number + number // 4) % 4],
                "hair": HAIRS[1] if number % 3 else HAIRS[0],
                "shirt": kit.colour,
            }
            if str(who.get("clip", "")).startswith("sit"):
                sheet.seat((x, ground), metre, float(who["yaw"]))
            models.append(Model(at=(x, ground), **{"colours": colours, **who}))
            sheet.text((x, ground + 46 * scale), name, 20)
    sheet.put(take(models, sheet.size, metre), metre=metre)
    return sheet.finish()
