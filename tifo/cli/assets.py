"""Build the files that tifo ships, from its own code.

``tifo assets build`` makes the built-in spectator anew: skeleton, meshes of three levels of detail
and all motions. With the versions that pyproject.toml pins the file comes out the same; with others
its surface is less than a millimetre away, and the command says how far.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of ``tifo assets``."""
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    build = actions.add_parser("build", help="build the spectator; takes some minutes")
    build.add_argument(
        "--out", metavar="FILE", help="a .glb file; the shipped one is replaced if absent"
    )
    build.add_argument("--json", action="store_true", help="print one JSON object")


def run(options: argparse.Namespace) -> int:
    """Build; the exit code: 1 if the surface is a millimetre or more from the shipped one."""
    from rich.console import Console

    from ..engine.assets.levels import grouped_by_level
    from ..engine.assets.load import load_character
    from ..engine.assets.spectator.build import SHIPPED, surfaces_apart, write_spectator

    console = Console(stderr=True, highlight=False)
    path = SHIPPED if options.out is None else Path(options.out)
    shipped_bytes = SHIPPED.read_bytes()
    shipped = grouped_by_level(load_character(SHIPPED))
    with console.status("building the spectator: skeleton, surfaces, motions"):
        write_spectator(path)
    same = path.read_bytes() == shipped_bytes
    apart = 0.0 if same else surfaces_apart(grouped_by_level(load_character(path)), shipped)
    if options.json:
        print(json.dumps({"file": str(path), "same": same, "metres_apart": apart}))
    elif same:
        print(f"{path}: the same as the shipped file")
    else:
        print(f"{path}: its surface is at most {1000 * apart:.3f} mm from the shipped one")
    return 0 if apart < 1e-3 else 1
