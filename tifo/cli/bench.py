"""Measure how fast it runs here: medians and spread, with the environment.

evaluate: all streams for one pose tick (sampling, kinematics, palettes, store); with --tree deep,
  trees of five clips and four blends, and the same streams with clips beside them.
tick: a whole tick of a stadium without drawing, system by system.
frame: pictures of a stadium from each camera.
memory: what poses and clips take, streamed and baked, and what a tick copies.
variety: how alike neighbours look and move, before and after casting.
scripting: a frame of many nodes with `_process`, and emissions of a signal.
scaling: behaviour alone, quiet and after goals, of 1,000 agents to 1,000,000 or --agents.
behaviour: applause, rhythm, waves, emotions and parties: what comes out of the models beside what
  is published of people, and what a tick of them and of walking costs; --plot draws curves, and
  moods over a match, which takes a minute or two.
soak: a match of --minutes with --events random events, without poses, as fast as it goes: whether
  people end up doing what they did in the beginning, and nothing gets stuck or grows.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from typing import Any

from .demo import parse_size

BENCHMARKS = (
    "evaluate",
    "tick",
    "frame",
    "memory",
    "variety",
    "behaviour",
    "scripting",
    "scaling",
    "soak",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the options of ``tifo bench``."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("benchmark", choices=BENCHMARKS, help="what to measure")
    parser.add_argument("--agents", type=int, metavar="N", help="seats, all taken (65000)")
    parser.add_argument("--streams", type=int, default=256, metavar="N", help="animation streams")
    parser.add_argument("--joints", type=int, default=82, metavar="N", help="joints (not in frame)")
    parser.add_argument("--history", type=int, default=60, metavar="N", help="poses a stream keeps")
    parser.add_argument(
        "--slots", type=int, default=800, metavar="N", help="transition slots (tick, memory)"
    )
    parser.add_argument(
        "--runs", type=int, metavar="N", help="how many to time (300; frame: 10; soak: 1)"
    )
    parser.add_argument(
        "--tree", choices=("plain", "deep"), default="plain", help="what streams play (evaluate)"
    )
    parser.add_argument("--nodes", type=int, default=10_000, metavar="N", help="nodes (scripting)")
    parser.add_argument(
        "--listeners", type=int, default=10, metavar="N", help="of a signal (scripting)"
    )
    parser.add_argument("--size", default="1280x720", metavar="WxH", help="pixels (frame)")
    parser.add_argument("--minutes", type=float, default=90.0, help="of the match (soak)")
    parser.add_argument("--events", type=int, default=300, metavar="N", help="random ones (soak)")
    parser.add_argument("--plot", metavar="FILE.png", help="draw curves (behaviour)")
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object and nothing else"
    )


def run(options: argparse.Namespace) -> int:
    """Run a benchmark and print its figures; the exit code."""
    if options.runs is not None and not 1 <= options.runs <= 100_000:
        raise ValueError(f"--runs is {options.runs}, expected 1 to 100000")
    if options.agents is None:
        options.agents = 1_000_000 if options.benchmark == "scaling" else 65_000
    if options.json:
        print(json.dumps(_measure(options)))
        return 0
    from rich.console import Console

    console = Console(highlight=False)
    with console.status(f"measuring {options.benchmark}"):
        result = _measure(options)
    _report(console, result)
    return 0


def _measure(options: argparse.Namespace) -> dict[str, Any]:
    common = {"streams": options.streams, "history": options.history}
    measure: Callable[[], dict[str, Any]]
    if options.benchmark == "evaluate":
        from ..benchmarks.evaluate import evaluate

        def measure() -> dict[str, Any]:
            return evaluate(
                joints=options.joints, tree=options.tree, runs=options.runs or 300, **common
            )

    elif options.benchmark == "tick":
        from ..benchmarks.tick import tick

        def measure() -> dict[str, Any]:
            return tick(
                agents=options.agents,
                joints=options.joints,
                slots=options.slots,
                runs=options.runs or 300,
                **common,
            )

    elif options.benchmark == "memory":
        from ..benchmarks.memory import memory

        def measure() -> dict[str, Any]:
            return memory(
                agents=options.agents,
                joints=options.joints,
                slots=options.slots,
                runs=options.runs or 60,
                **common,
            )

    elif options.benchmark == "scripting":
        from ..benchmarks.scripting import scripting

        def measure() -> dict[str, Any]:
            return scripting(
                nodes=options.nodes, listeners=options.listeners, runs=options.runs or 300
            )
    elif options.benchmark == "behaviour":
        from ..benchmarks.behaviour import behaviour

        def measure() -> dict[str, Any]:
            return behaviour(agents=options.agents, runs=options.runs or 200, plot=options.plot)

    elif options.benchmark == "scaling":
        from ..benchmarks.scaling import scaling

        def measure() -> dict[str, Any]:
            return scaling(agents=options.agents, runs=options.runs or 60)

    elif options.benchmark == "soak":
        from ..benchmarks.soak import soak

        def measure() -> dict[str, Any]:
            return soak(
                agents=options.agents,
                minutes=options.minutes,
                events=options.events,
                runs=options.runs or 1,
            )

    elif options.benchmark == "variety":
        from ..benchmarks.variety import variety

        def measure() -> dict[str, Any]:
            return variety(agents=options.agents, **common)

    else:
        from ..benchmarks.frame import frame

        def measure() -> dict[str, Any]:
            size = parse_size(options.size)
            return frame(agents=options.agents, size=size, runs=options.runs or 10, **common)

    return measure()


def _report(console: Any, result: dict[str, Any]) -> None:
    from rich.table import Table

    facts = (
        *("agents", "streams", "joints", "history_poses", "width_pixels", "height_pixels"),
        *("nodes", "listeners"),
    )
    sizes = ", ".join(f"{result[k]:,} {k.split('_')[0]}" for k in facts if k in result)
    console.print(f"[bold]{result['benchmark']}[/]: {sizes}")
    if result["benchmark"] == "memory":
        _report_memory(console, result)
        return
    if result["benchmark"] == "variety":
        _report_variety(console, result)
        return
    if result["benchmark"] == "soak":
        _report_soak(console, result)
        return
    table = Table("", "median ms", "10 %", "90 %", "lowest", "runs")
    for column in table.columns[1:]:
        column.justify = "right"

    def row(name: str, figures: dict[str, Any]) -> None:
        keys = ("median_ms", "p10_ms", "p90_ms", "min_ms")
        table.add_row(name, *(f"{figures[key]:.3f}" for key in keys), str(figures["runs"]))

    if result["benchmark"] not in ("behaviour", "scaling"):
        row("whole", result)
    for group in ("systems", "cameras", "situations"):
        for name, figures in result.get(group, {}).items():
            row(f"  {name.replace('_', ' ')}", figures)
    if "frame_after_adding" in result:
        row("after a node was added", result["frame_after_adding"])
    console.print(table)
    if "figures" in result:
        _report_figures(console, result["figures"])
    if "emit_us" in result:
        console.print(
            f"{result['emits_per_second']:,} emissions a second, {result['emit_us']:.2f} us each; "
            f"to add a node: {result['add_node_us']:.1f} us"
        )
    if "ratio" in result:
        console.print(
            f"{result['ratio']:.2f} times as long as plain clips, "
            f"{result['plain_median_ms']:.3f} ms; to add a stream: {result['add_stream_ms']:.3f} ms"
        )
    if "goal_tick_ms" in result:
        console.print(
            f"the tick of a goal: {result['goal_tick_ms']:.2f} ms (median), "
            f"behaviour {result['goal_behaviour_ms']:.2f} ms of it"
        )
    for name, figures in result.get("cameras", {}).items():
        levels = ", ".join(f"{count:,}" for count in figures["agents_at_level"])
        console.print(
            f"{name}: {figures['triangles']:,} triangles, {figures['uploaded_bytes']:,} bytes "
            f"copied, agents by level {levels}"
        )
    if "slots_in_use" in result:
        console.print(f"transition slots in use: {result['slots_in_use']:,} (median)")
    for key in ("slice_bytes", "ring_bytes"):
        if key in result:
            console.print(f"{key.replace('_', ' ')}: {result[key]:,}")
    _report_environment(console, result)


def _report_memory(console: Any, result: dict[str, Any]) -> None:
    from rich.table import Table

    table = Table("", "bytes")
    table.columns[1].justify = "right"
    for key in ("pose", "clip_streamed", "clip_baked", "ring", "unique", "slot", "marker"):
        table.add_row(key.replace("_", ", "), f"{result[f'{key}_bytes']:,}")
    table.add_row("copied in a quiet tick", f"{result['copied_bytes_quiet_tick']:,}")
    table.add_row("copied after a goal, at most", f"{result['copied_bytes_goal_tick']:,}")
    console.print(table)
    console.print(
        f"{result['budget_bytes'] // 2**20} MB hold {result['clips_streamed']:,} streamed clips "
        f"of {result['ring_poses']} poses, or {result['clips_baked']:,} baked ones of "
        f"{result['clip_baked_frames']:.0f} frames"
    )
    _report_environment(console, result)


def _report_figures(console: Any, figures: list[dict[str, str]]) -> None:
    from rich.table import Table

    table = Table("", "measured here", "published")
    for figure in figures:
        table.add_row(figure["name"], figure["measured"], figure["published"])
    console.print(table)


def _report_variety(console: Any, result: dict[str, Any]) -> None:
    from rich.table import Table

    columns = ("clone score", "worst", "found", "same look", "same motion", "both")
    table = Table("", *columns)
    for column in table.columns[1:]:
        column.justify = "right"
    for name, figures in result["moments"].items():
        shares = (f"{figures[key]:.4%}" for key in ("same_look", "same_motion", "same_both"))
        score, worst = f"{figures['score']:.5f}", f"{figures['worst']:.3f}"
        table.add_row(name, score, worst, f"{figures['found']:.0f}", *shares)
    console.print(table)
    pairs = next(iter(result["moments"].values()))["pairs"]
    console.print(f"{pairs:,.0f} pairs of neighbours within 3 seats; shares are of these")
    _report_environment(console, result)


def _report_soak(console: Any, result: dict[str, Any]) -> None:
    from rich.table import Table

    console.print(
        f"{result['minutes']:g} minutes with {result['events']} events in {result['seconds']:,} s, "
        f"{result['times_faster']:g} times as fast as they pass"
    )
    table = Table("states that changed most", "first 2 minutes", "last 2 minutes")
    for name, (before, after) in result["shares"].items():
        table.add_row(name, f"{before:.2%}", f"{after:.2%}")
    console.print(table)
    warm, end = (result[f"memory_{when}_bytes"] / 2**20 for when in ("warm", "end"))
    before, after = result["mean_excitement"]
    for what, value in (
        ("states entered", f"{result['states_entered']} of {result['states']}"),
        ("reacting at once, at most", f"{result['most_reacting']:.0%}"),
        ("clapping at once, at most", f"{result['most_clapping']:.0%}"),
        ("mean excitement", f"{before:.3f} before, {after:.3f} after"),
        ("longer in a state than its limit, at most", f"{result['overstayed_seconds']:.2f} s"),
        ("memory after a quarter of the events", f"{warm:,.1f} MB"),
        ("memory at the end", f"{end:,.1f} MB"),
        ("state", result["state_hash"]),
    ):
        console.print(f"{what}: {value}")
    if result["runs"] > 1:
        same = "the same state" if result["same_hash"] else "[bold red]different states[/]"
        console.print(f"{result['runs']} runs ended in {same}")
    _report_environment(console, result)


def _report_environment(console: Any, result: dict[str, Any]) -> None:
    where = ", ".join(f"{key} {value}" for key, value in result["environment"].items())
    console.print(f"[dim]{where}[/]")
