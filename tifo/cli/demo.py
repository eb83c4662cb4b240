"""Play the stadium demo in a window; without a display, render a picture and a clip.

``--scene lab`` shows each feature of the animation on a few people, with captions.

Keys: G and H goals of the home and the away side, B or a click the ball into the crowd where the
mouse points, 1 2 3 cameras, C orbit or fly, WASD QE move, drag and scroll look, F fullscreen,
V vsync, P pause, F12 screenshot, F1 help, Esc quit.
"""

from __future__ import annotations

import argparse
import re
from dataclasses import fields
from typing import Any

from ..engine.crowd.spec import CrowdSpec

_FROM_SPEC = (
    "seats",
    "rows",
    "columns",
    "occupancy",
    "sides",
    "ultras",
    "behaviour",
    "embarrassment",
    "latecomers",
    "stewards",
    "children",
    "old",
    "women",
    "streams",
    "history",
    "slots",
    "props",
    "tint",
    "poses",
    "offsets",
    "seed",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of ``tifo demo``."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    add_crowd_arguments(parser)
    how = parser.add_argument_group("the picture")
    how.add_argument("--size", default="1280x720", metavar="WxH", help="pixels, 1280x720 if absent")
    how.add_argument(
        "--camera", choices=("tv", "close", "bowl"), default="tv", help="where to begin"
    )
    how.add_argument("--fullscreen", action="store_true", help="open the window fullscreen")
    how.add_argument("--no-vsync", action="store_true", help="draw as often as possible")
    how.add_argument("--headless", action="store_true", help="no window: render offscreen")
    how.add_argument(
        "--seconds", type=float, metavar="S", help="stop after S seconds (headless: 6 if absent)"
    )
    how.add_argument("--events", metavar="TOML", help="file with what happens, and when")
    how.add_argument("--screenshot", metavar="PNG", help="write the last picture")
    how.add_argument("--record", metavar="MP4", help="write a clip")


def add_crowd_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options that `spec_from` reads."""
    texts = {field.name: field.metadata["help"] for field in fields(CrowdSpec)}
    parser.add_argument(
        "--scene",
        choices=("stadium", "lab"),
        default="stadium",
        help="a match, or each feature of the animation on a few people; of the crowd's options "
        "below the lab takes only --seed",
    )
    what = parser.add_argument_group("the stadium and its crowd")
    what.add_argument("--spec", metavar="FILE", help="crowd spec in TOML; options override it")
    what.add_argument("--character", metavar="FILE", help=texts["character"] + " (.glb .gltf .bvh)")
    what.add_argument("--motions", metavar="FILE", nargs="+", help=texts["motions"])
    what.add_argument(
        "--scale",
        type=float,
        metavar="METRES",
        help="metres a unit of BVH files, guessed if absent",
    )
    kinds: dict[str, Any] = {"occupancy": float, "props": float, "ultras": float, "tint": float}
    kinds.update(
        {
            "latecomers": float,
            "embarrassment": float,
            "children": float,
            "old": float,
            "women": float,
        }
    )
    kinds.update({"poses": str, "offsets": str, "behaviour": str})
    for name in _FROM_SPEC:
        kind = kinds.get(name, int)
        what.add_argument(
            f"--{name}", type=kind, metavar=_metavar(kind), help=texts[name], default=None
        )
    what.add_argument("--lod", choices=("on", "off"), help=texts["lod"])


def run(options: argparse.Namespace) -> int:
    """Run the demo; the exit code."""
    from ..demo_game.app import Show, play

    show = Show(
        spec=spec_from(options),
        scale=options.scale,
        size=parse_size(options.size),
        camera=options.camera,
        seconds=_seconds(options.seconds),
        screenshot=options.screenshot,
        record=options.record,
        events=options.events,
        fullscreen=options.fullscreen,
        vsync=not options.no_vsync,
        scene=options.scene,
    )
    return play(show, headless=options.headless)


def spec_from(options: argparse.Namespace) -> CrowdSpec:
    """The crowd spec of a file and the options over it.

    Raises
    ------
    AssetError, ValueError
        For a spec file or a value that can't be used.
    """
    spec = CrowdSpec.from_toml(options.spec) if options.spec else CrowdSpec(sides=2)
    changes: dict[str, object] = {
        name: getattr(options, name) for name in _FROM_SPEC if getattr(options, name) is not None
    }
    if "rows" in changes or "columns" in changes:
        changes["layout"] = "stand"
    elif "seats" in changes:
        changes["layout"] = "bowl"
    if options.lod is not None:
        changes["lod"] = options.lod == "on"
    if options.character is not None:
        changes["character"] = options.character
    if options.motions is not None:
        changes["motions"] = tuple(options.motions)
    return spec.replace(**changes)


def parse_size(text: str) -> tuple[int, int]:
    """Pixels from ``"1280x720"``; ValueError for anything else."""
    match = re.fullmatch(r"(\d+)[xX](\d+)", text.strip())
    if match is None:
        raise ValueError(f"--size is '{text}', expected WIDTHxHEIGHT in pixels, such as 1280x720")
    width, height = int(match[1]), int(match[2])
    if not (16 <= width <= 16384 and 16 <= height <= 16384):
        raise ValueError(f"--size is {text}, expected 16x16 to 16384x16384 pixels")
    return width, height


def _seconds(value: float | None) -> float | None:
    if value is not None and not 0 < value <= 36000:
        raise ValueError(f"--seconds is {value}, expected more than 0 and at most 36000")
    return value


def _metavar(kind: Any) -> str:
    return {int: "N", float: "X", str: "WORD"}[kind]
