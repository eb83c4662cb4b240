"""Who the spectators are: bodies of all ages and girths, hair and beards; and their shirts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from PIL import Image

from ...engine.assets.spectator import builtin_spectator
from ...engine.assets.variants import variant_groups
from ...engine.crowd.body_types import CHILD, OLD
from ...engine.crowd.kits import KITS, PATTERNS, Kit
from .sheet import FAINT, Sheet
from .studio import GREY, HAIRS, SKINS, Model, take

FRONT, SIDE = 0.30, 1.35
"""Radians that people are turned to be seen from the front and from the side."""

PEOPLE: tuple[tuple[str, Mapping[str, Any]], ...] = (
    ("man", {"wears": {"body": "man_shirt", "beard": "full"}}),
    (
        "woman",
        {
            "scale": 0.94,
            "wears": {"body": "woman_skirt", "hair": "long"},
            "colours": {"shirt": (40, 120, 150), "trousers": (150, 52, 78), "hair": HAIRS[2]},
        },
    ),
    (
        "boy",
        {
            "kind": CHILD,
            "scale": 0.74,
            "wears": {"body": "child_shorts", "hair": "crop"},
            "colours": {"skin": SKINS[1], "hair": HAIRS[1], "shirt": (236, 178, 48)},
        },
    ),
    (
        "girl",
        {
            "kind": CHILD,
            "scale": 0.72,
            "wears": {"body": "child_shirt", "hair": "ponytail"},
            "colours": {"skin": SKINS[2], "hair": HAIRS[3], "shirt": (120, 84, 164)},
        },
    ),
    (
        "old man",
        {
            "kind": OLD,
            "scale": 0.97,
            "girth": 0.03,
            "wears": {"body": "man_sweater", "hair": "ring", "beard": "moustache"},
            "colours": {"hair": GREY, "shirt": (74, 98, 84), "trousers": (104, 92, 78)},
        },
    ),
    (
        "old woman",
        {
            "kind": OLD,
            "scale": 0.91,
            "girth": 0.02,
            "wears": {"body": "woman_sweater", "hair": "bun"},
            "colours": {
                "skin": SKINS[1],
                "hair": GREY,
                "shirt": (156, 96, 72),
                "trousers": (66, 66, 82),
            },
        },
    ),
)
GIRTHS = (-0.025, 0.0, 0.03, 0.06, 0.09)


def draw_bodies(scale: float = 1.0) -> Image.Image:
    """Everybody from the front and from the side, and from slim to wide."""
    width, metre = round(1500 * scale), 236 * scale
    sheet = Sheet((width, round(1560 * scale)), scale=scale)
    step = width / len(PEOPLE)
    models = []
    for row, yaw in enumerate((FRONT, SIDE)):
        y = (470 + 500 * row) * scale
        sheet.floor(y - 26 * scale, y + 24 * scale)
        for k, (name, who) in enumerate(PEOPLE):
            x = step * (k + 0.5)
            models.append(Model(at=(x, y), yaw=yaw, time=0.8 * k, **who))
            sheet.text((x, y + 38 * scale), name)
    y = 1494 * scale
    sheet.floor(y - 26 * scale, y + 24 * scale)
    for k, girth in enumerate(GIRTHS):
        for half, (body, hair) in enumerate((("man_shirt", "short"), ("woman_shirt", "bob"))):
            x = width / 10 * (k + 5 * half + 0.5)
            colours = {"shirt": (46, 125, 190)} if half else {"shirt": (214, 92, 56)}
            models.append(
                Model(
                    at=(x, y),
                    yaw=FRONT,
                    scale=0.94 if half else 1.0,
                    girth=girth,
                    wears={"body": body, "hair": hair},
                    colours={**colours, "hair": HAIRS[1], "skin": SKINS[half]},
                )
            )
            sheet.text((x, y + 40 * scale), f"{1000 * girth:+.0f} mm" if girth else "0 mm")
    sheet.put(take(models, sheet.size, metre), metre=metre)
    return sheet.finish()


def draw_hair(scale: float = 1.0) -> Image.Image:
    """Each hair and each beard close up, from the front and from the side."""
    groups = variant_groups(builtin_spectator())
    looks: list[tuple[str, Mapping[str, str | None]]] = [
        (choice.choice, {"body": _BODY_OF.get(choice.choice, "man_shirt"), "hair": choice.choice})
        for choice in groups["hair"]
    ]
    looks += [
        (choice.choice, {"hair": hair, "beard": choice.choice})
        for choice, hair in zip(groups["beard"], ("crop", "ring"), strict=False)
    ]
    columns, metre, gap = 5, 540 * scale, 8 * scale
    cell = (round(300 * scale), round(306 * scale))
    sheet = Sheet((columns * cell[0], 4 * cell[1]), scale=scale)
    for row in range(4):
        yaw = SIDE if row % 2 else FRONT
        models = []
        for column in range(columns):
            k = columns * (row // 2) + column
            corner = (column * cell[0] + gap / 2, row * cell[1] + gap / 2)
            sheet.card(corner, (cell[0] - gap, cell[1] - gap))
            hair, skin = HAIRS[_HAIR_COLOURS[k]], SKINS[_SKINS[k]]
            models.append(
                # The feet are far below the card, so that the head is in its middle.
                Model(
                    at=((column + 0.5) * cell[0], cell[1] * 0.50 + 1.62 * metre),
                    yaw=yaw,
                    wears=looks[k][1],
                    colours={"hair": hair, "skin": skin, "shirt": _SHIRTS[k % 5]},
                )
            )
        shot = take(models, (sheet.size[0], round(cell[1] - gap / 2)), metre)
        sheet.put(shot, (0, row * cell[1]))
        for column in range(columns if row % 2 == 0 else 0):
            name = looks[columns * (row // 2) + column][0]
            sheet.text(((column + 0.5) * cell[0], (row + 0.09) * cell[1]), name, 20)
    return sheet.finish()


_HAIR_COLOURS = (0, 1, 1, 3, 2, 1, 2, 3, 0, 1)
_SKINS = (0, 2, 1, 0, 2, 1, 0, 2, 1, 0)
_BODY_OF = dict.fromkeys(("bob", "long", "ponytail", "bun"), "woman_shirt")
_SHIRTS = ((46, 125, 190), (214, 92, 56), (70, 150, 92), (214, 162, 40), (132, 96, 176))


def draw_shirts(scale: float = 1.0) -> Image.Image:
    """Each pattern of team shirts in the colours of every team."""
    metre, gap = 284 * scale, 8 * scale
    cell = (round(188 * scale), round(252 * scale))
    left, top = round(104 * scale), round(16 * scale)
    sheet = Sheet((left + len(KITS) * cell[0], top + len(PATTERNS) * cell[1]), scale=scale)
    for row, pattern in enumerate(PATTERNS):
        models = []
        for k, kit in enumerate(KITS):
            woman = (row + k) % 2 == 1
            corner = (left + k * cell[0] + gap / 2, top + row * cell[1] + gap / 2)
            sheet.card(corner, (cell[0] - gap, cell[1] - gap))
            models.append(
                Model(
                    at=(cell[0] * (k + 0.5), cell[1] * 0.16 + 1.70 * metre),
                    yaw=float(np.linspace(0.5, -0.5, len(KITS))[k]),
                    time=0.9 * k,
                    scale=0.94 if woman else 1.0,
                    wears=_worn(k, woman=woman),
                    colours={
                        "skin": SKINS[(k + k // 2 + row) % 4],
                        "hair": HAIRS[(k + row // 2) % 4 if (k + k // 2 + row) % 2 == 0 else 1],
                    },
                    kit=Kit(kit.colour, kit.second, pattern),
                )
            )
        size = (len(KITS) * cell[0], round(cell[1] - gap / 2))
        sheet.put(take(models, size, metre), (left, top + row * cell[1]))
        sheet.text((0.5 * left, top + (row + 0.5) * cell[1]), pattern, 20, FAINT)
    return sheet.finish()


def _worn(k: int, *, woman: bool) -> Mapping[str, str | None]:
    hairs: Sequence[str] = (
        ("bob", "long", "ponytail", "bun") if woman else ("short", "crop", "curly")
    )
    beard = None if woman or k % 3 else "full"
    body = "woman_shirt" if woman else "man_shirt"
    return {"body": body, "hair": hairs[k % len(hairs)], "beard": beard}
