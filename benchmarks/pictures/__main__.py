"""Write all pictures of docs/, or those that are named.

Run with ``python -m tifo.benchmarks.pictures [--to FOLDER] [NAME ...]``.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from PIL import Image

from .blend_space import draw_blend_space
from .crowds import draw_block, draw_relative
from .details import draw_levels, draw_props
from .gangway import draw_gangway
from .lab import draw_lab
from .machine import draw_machine
from .motions import SHEETS, draw_motions
from .overlay import draw_overlay
from .people import draw_bodies, draw_hair, draw_shirts
from .reactions import draw_before_and_after, draw_long_and_short, draw_one_side
from .ring import draw_ring

PICTURES: dict[str, Callable[[], Image.Image]] = {
    "blend_space": draw_blend_space,
    "state_machine": draw_machine,
    "ring": draw_ring,
    "overlay": draw_overlay,
    "lab": draw_lab,
    "bodies": draw_bodies,
    "hair": draw_hair,
    "levels": draw_levels,
    "shirts": draw_shirts,
    "props": draw_props,
    "block": draw_block,
    "relative": draw_relative,
    **{f"motions-{k + 1}": partial(draw_motions, k) for k in range(SHEETS)},
    "before_and_after": draw_before_and_after,
    "long_and_short": draw_long_and_short,
    "one_side": draw_one_side,
    "walking": draw_gangway,
}
"""By the names of their files; those of spectators need OpenGL."""


def main(words: Sequence[str] | None = None) -> None:
    """Draw and write what the command line asks for."""
    parser = argparse.ArgumentParser(prog="tifo.benchmarks.pictures", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(PICTURES))
    parser.add_argument("--to", type=Path, default=Path("docs"), metavar="FOLDER")
    options = parser.parse_args(words)
    for name in options.names or PICTURES:
        if name not in PICTURES:
            parser.error(f"there is no picture '{name}'; there are {', '.join(PICTURES)}")
        file = options.to / f"{name}.png"
        PICTURES[name]().save(file, optimize=True)
        print(f"wrote {file}")


if __name__ == "__main__":
    main()
