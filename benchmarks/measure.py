"""Medians and spreads, and the machine they were taken on."""

from __future__ import annotations

import gc
import os
import platform
import sys
from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any

import numpy as np


def time_calls(call: Callable[[int], object], count: int, warm_up: int = 10) -> list[float]:
    """Seconds of `count` calls after `warm_up` calls that aren't counted.

    Parameters
    ----------
    call
        Gets the number of the call, counting the warm-up.
    """
    for number in range(warm_up):
        call(number)
    seconds = []
    gc.collect()
    gc.disable()
    try:
        for number in range(warm_up, warm_up + count):
            begin = perf_counter()
            call(number)
            seconds.append(perf_counter() - begin)
    finally:
        gc.enable()
    return seconds


def spread(seconds: Sequence[float]) -> dict[str, float]:
    """Median, lowest, 10th and 90th percentile in milliseconds, and how many were taken."""
    values = 1e3 * np.asarray(seconds)
    low, high = np.percentile(values, [10, 90])
    return {
        "median_ms": round(float(np.median(values)), 4),
        "min_ms": round(float(values.min()), 4),
        "p10_ms": round(float(low), 4),
        "p90_ms": round(float(high), 4),
        "runs": len(values),
    }


def environment() -> dict[str, Any]:
    """What a figure depends on."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    return {
        "python": platform.python_version(),
        "numpy": np.__version__,
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "processor": _processor(),
        "cores": os.cpu_count(),
        "load_1_min": None if load is None else round(load, 2),
    }


def _processor() -> str:
    if sys.platform.startswith("linux"):
        try:
            with open("/proc/cpuinfo", encoding="utf-8") as lines:
                for line in lines:
                    if line.startswith("model name"):
                        return line.partition(":")[2].strip()
        except OSError:
            pass
    return platform.processor() or "unknown"
