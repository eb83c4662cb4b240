"""The command ``tifo``.

What a command needs is imported when it runs, so that ``tifo --help`` answers at once. Errors that
a user can mend are one sentence on standard error and exit code 1; wrong options, exit code 2.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module

from .. import __version__
from ..engine.errors import TifoError

_COMMANDS = {
    "demo": "play the stadium demo, or render it to a picture and a clip",
    "bench": "measure how fast it runs here",
    "export": "write spectators to a glTF or USD file for Blender, Maya and others",
    "inspect": "say what is in a glTF or BVH file",
    "assets": "build the files that tifo ships, from its own code",
    "doctor": "check graphics, drivers and dependencies, and say what to fix",
}


def build_parser() -> argparse.ArgumentParser:
    """The parser of all commands."""
    parser = argparse.ArgumentParser(
        prog="tifo", description="Whole stadiums of animated spectators in real time."
    )
    parser.add_argument("--version", action="version", version=f"tifo {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for name, summary in _COMMANDS.items():
        module = import_module(f"tifo.cli.{name}")
        command = commands.add_parser(name, help=summary, description=module.__doc__)
        module.add_arguments(command)
        command.set_defaults(run=module.run)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit code."""
    options = build_parser().parse_args(arguments)
    try:
        return int(options.run(options))
    except TifoError as error:
        return _refuse(str(error))
    except ValueError as error:
        return _refuse(str(error))
    except KeyboardInterrupt:
        return 130


def _refuse(message: str) -> int:
    print(f"tifo: {message}", file=sys.stderr)
    return 1
