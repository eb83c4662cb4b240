"""The examples of the page on controllers run as they stand."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

PAGE = Path(__file__).resolve().parents[4] / "docs" / "controllers.md"


def test_the_examples_run(capsys: Any) -> None:
    first, second = re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    names: dict[str, Any] = {}
    exec(first, names)
    assert capsys.readouterr().out.startswith("True [0.")
    exec(second, names)
    pool = names["pool"]
    stream = pool.add(names["fan"])
    pool.set(stream, "rise", True)
    seconds = 0.1 + sum(c.duration for c in names["spectator"].clips if c.name == "stand_up")
    for tick in range(30, 34 + int(np.ceil(seconds * 30))):
        pool.evaluate(tick)
        pool.commit(tick)
    assert pool.get(stream, "current") == "stand"
