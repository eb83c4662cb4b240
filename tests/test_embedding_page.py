"""The example of the page on embedding runs as it stands."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def test_the_example_runs(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "embedding.md").read_text("utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        timeout=120,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
    )
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.split()) >= 5


def test_the_examples_that_the_page_names_exist() -> None:
    page = (ROOT / "docs" / "embedding.md").read_text("utf-8")
    named = re.findall(r"^\| `(\w+\.py)`", page, re.MULTILINE)
    assert len(named) == 4
    assert all((ROOT / "examples" / name).is_file() for name in named)
