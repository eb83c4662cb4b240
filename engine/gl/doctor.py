"""Finds out what graphics this machine can do, without being harmed by what it finds.

A broken driver may kill or hang the process that loads it, so each way of drawing is tried in a
process of its own; a crash is a finding like any other.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from dataclasses import asdict, dataclass
from typing import Any, Literal

from ..errors import GraphicsError
from .context import ContextInfo, create_offscreen_context, describe_context, open_window
from .framebuffer import Framebuffer

Way = Literal["offscreen", "window"]

_MARK = "tifo-finding:"
_CODE = f"from {__name__} import probe; probe(%r)"
_CHECKS: dict[Way, str] = {"offscreen": "drawing off screen", "window": "drawing in a window"}

# Linear 0.5 is 188 in sRGB; drivers round differently by one.
_LINEAR, _ENCODED = 0.5, 188


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check.

    Parameters
    ----------
    check
        What was tried.
    ok
        Whether it works.
    message
        One sentence: what works with which renderer, or what is wrong and what to do.
    info
        What the context can do, None when there was none.
    """

    check: str
    ok: bool
    message: str
    info: ContextInfo | None = None


def diagnose(timeout: float = 60.0) -> list[Finding]:
    """Try to draw off screen and in a window and return what happened; never raises.

    Parameters
    ----------
    timeout
        Seconds that each try may take.
    """
    return [_try(way, timeout) for way in _CHECKS]


def probe(way: Way) -> None:
    """Print one finding as a marked line of JSON; runs in the tried process.

    Draws one colour and reads it back, as some drivers make contexts that can't draw.
    """
    try:
        window = (
            create_offscreen_context()
            if way == "offscreen"
            else open_window((64, 64), samples=0, visible=False, vsync=False)
        )
        info = describe_context()
        target = Framebuffer((4, 4))
        with target:
            target.clear((_LINEAR, _LINEAR, _LINEAR, 1.0))
        drawn = int(target.read_pixels()[0, 0, 0])
        window.close()
    except GraphicsError as error:
        result: dict[str, Any] = {"ok": False, "message": str(error)}
    else:
        ok = abs(drawn - _ENCODED) <= 1
        name = f"{info.renderer}, OpenGL {info.version[0]}.{info.version[1]}"
        message = f"works with {name}"
        if not ok:
            message = f"{name} draws wrong colours ({drawn} instead of {_ENCODED}): update it"
        elif info.is_software:
            message += "; this is a software renderer, so expect few spectators in real time"
        result = {"ok": ok, "message": message, "info": asdict(info)}
    print(_MARK + json.dumps(result), flush=True)


def _try(way: Way, timeout: float) -> Finding:
    check = _CHECKS[way]
    try:
        process = subprocess.run(
            [sys.executable, "-c", _CODE % way],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)},
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Finding(check, False, f"the driver did not answer within {timeout:g} s: update it")
    except OSError as error:
        return Finding(check, False, f"could not start a process to try it ({error})")
    for line in process.stdout.splitlines():
        if line.startswith(_MARK):
            return _parse(check, json.loads(line.removeprefix(_MARK)))
    return Finding(check, False, _describe_crash(process))


def _parse(check: str, result: dict[str, Any]) -> Finding:
    info = result.get("info")
    if info is not None:
        info = ContextInfo(**{**info, "version": tuple(info["version"])})
    return Finding(check, result["ok"], result["message"], info)


def _describe_crash(process: subprocess.CompletedProcess[str]) -> str:
    """Return why a process ended without a finding."""
    code = process.returncode
    if code < 0:
        try:
            cause = signal.Signals(-code).name
        except ValueError:
            cause = f"signal {-code}"
        return f"the graphics driver crashed ({cause}): update it"
    last = process.stderr.strip().splitlines()[-1:] or ["it said nothing"]
    return f"the process that tried it ended with code {code}: {last[0]}"
