"""Write spectators to a file for Blender, Maya and others: glTF or USD, skinned or baked.

With --schedule, write which clips they play, from when to when: CSV or JSON.

The crowd is the one that tifo demo shows with the same options. Examples:

  tifo export --rows 10 --columns 30 --agents "rows 0-2" --seconds 4 --goal home --out crowd.glb
  tifo export --seats 20000 --baked --level 2 --out stadium.glb
  tifo export --agents 12 "3|45" "section 5" --seconds 2 --out stand.usdc
  tifo export --seats 5000 --seconds 60 --goal home --schedule clips.csv
"""

from __future__ import annotations

import argparse
from pathlib import Path

from ..engine.errors import AssetError
from .demo import add_crowd_arguments, spec_from

_ENDINGS = {"gltf": (".glb", ".gltf"), "usd": (".usd", ".usda", ".usdc")}
_SIDES = {"home": 0, "away": 1}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of ``tifo export``."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    what = parser.add_argument_group("what is written")
    files = what.add_mutually_exclusive_group(required=True)
    files.add_argument("--out", metavar="FILE", help=".glb .gltf .usd .usda .usdc")
    files.add_argument("--schedule", metavar="FILE", help=".csv .json: clips, no geometry")
    what.add_argument("--format", choices=tuple(_ENDINGS), help="by the ending of FILE if absent")
    what.add_argument(
        "--agents",
        nargs="+",
        metavar="WHO",
        help="ids, or seats such as '12|3', 'rows 0-2', 'section 5'; everybody if absent",
    )
    what.add_argument("--start", type=float, default=1.0, metavar="S", help="when it begins (1)")
    what.add_argument(
        "--seconds", type=float, default=0.0, metavar="S", help="how long; a moment if absent"
    )
    what.add_argument("--fps", type=float, default=30.0, metavar="N", help="keys a second (30)")
    what.add_argument("--goal", choices=tuple(_SIDES), help="a goal falls when it begins")
    what.add_argument("--level", type=int, default=0, metavar="N", help="level of detail, 0 finest")
    what.add_argument("--baked", action="store_true", help="surfaces without skeletons")
    what.add_argument("--rigid", action="store_true", help="bones without stretch, less exact")
    what.add_argument("--split", action="store_true", help="glTF: an animation for each agent")
    what.add_argument(
        "--no-instances", action="store_true", help="USD: a prim of its own for each agent"
    )
    add_crowd_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Write the file; the exit code."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    from ..engine.behaviour.events import Goal
    from ..engine.export.targets import check_target
    from ..engine.export.usd import check_usd
    from ..systems.export import export_gltf, export_usd
    from ..systems.recording import check_times, present_agents
    from ..systems.simulation import Simulation, character_of

    if options.schedule is not None:
        return _write_schedule(options)
    kind = _kind(options)
    path = check_target(options.out, _ENDINGS[kind])
    _check_switches(options, kind)
    if kind == "usd":
        check_usd(path)
    check_times(options.start, options.seconds, options.fps)
    console = Console(highlight=False)
    spec = spec_from(options)
    with console.status("building the stadium"):
        simulation = Simulation(spec, character_of(spec, options.scale))
    agents = present_agents(simulation.crowd, _chosen(options.agents))
    with console.status(f"{options.start:g} s pass"):
        simulation.run(seconds=options.start)
    if options.goal is not None:
        simulation.send(Goal(side=_SIDES[options.goal]))
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=console) as bars:
        tasks = {name: bars.add_task(name, total=None) for name in ("frames", "agents")}

        def show(name: str, done: int, total: int) -> None:
            bars.update(tasks[name], completed=done, total=total)

        shared = {"agents": agents, "seconds": options.seconds, "fps": options.fps}
        shared |= {"level": options.level, "baked": options.baked, "rigid": options.rigid}
        if kind == "gltf":
            done = export_gltf(simulation, path, split=options.split, progress=show, **shared)
        else:
            own = options.no_instances
            done = export_usd(simulation, path, instances=not own, progress=show, **shared)
    simulation.close()
    console.print(
        f"wrote [bold]{done.path.resolve()}[/] ({done.size / 1e6:.1f} MB): {done.agents:,} agents, "
        f"{done.frames:,} {'frame' if done.frames == 1 else 'frames'}, "
        f"{done.triangles:,} triangles",
        soft_wrap=True,
    )
    if options.rigid:
        console.print(f"vertices are up to {1000 * done.deviation:.0f} mm off, bones are rigid")
    return 0


def _write_schedule(options: argparse.Namespace) -> int:
    """Write which clips are played; the exit code."""
    from rich.console import Console

    from ..engine.behaviour.events import Goal
    from ..engine.export.clip_schedule import KINDS
    from ..engine.export.targets import check_target
    from ..systems.recording import check_times
    from ..systems.simulation import Simulation, character_of

    path = check_target(options.schedule, KINDS)
    check_times(options.start, options.seconds, options.fps)
    if options.seconds == 0:
        raise ValueError("--seconds is 0, but a schedule needs a time")
    console = Console(highlight=False)
    spec = spec_from(options)
    with console.status("building the stadium"):
        simulation = Simulation(spec, character_of(spec, options.scale))
    with console.status(f"{options.start + options.seconds:g} s pass"):
        simulation.run(seconds=options.start)
        if options.goal is not None:
            simulation.send(Goal(side=_SIDES[options.goal]))
        schedule = simulation.crowd.schedule(options.seconds, _chosen(options.agents))
    simulation.close()
    schedule.write(path)
    console.print(
        f"wrote [bold]{path.resolve()}[/]: {len(schedule.agents):,} agents, {len(schedule):,} "
        f"clip instances of {len(schedule.clips)} clips",
        soft_wrap=True,
    )
    return 0


def _kind(options: argparse.Namespace) -> str:
    """The format: as asked for, or by the file's name."""
    if options.format is not None:
        return str(options.format)
    ending = Path(options.out).suffix.lower()
    for kind, endings in _ENDINGS.items():
        if ending in endings:
            return kind
    known = ", ".join(name for endings in _ENDINGS.values() for name in endings)
    raise AssetError(options.out, "", f"its name must end in one of {known}")


def _check_switches(options: argparse.Namespace, kind: str) -> None:
    if options.split and kind == "usd":
        raise ValueError("--split is for glTF; in USD every agent has an animation of its own")
    if options.no_instances and kind == "gltf":
        raise ValueError("--no-instances is for USD; glTF has no instances of skins")
    if options.baked and options.rigid:
        raise ValueError("--rigid is about skeletons, and --baked writes none")
    if options.baked and kind == "gltf" and options.seconds > 0:
        raise ValueError(
            f"--seconds is {options.seconds:g}, but baked glTF holds one moment; write USD, or "
            "leave --baked or --seconds out"
        )


def _chosen(texts: list[str] | None) -> list[int | str] | None:
    """Ids and seats from the command line."""
    if texts is None:
        return None
    return [int(text) if text.strip().isdecimal() else text for text in texts]
