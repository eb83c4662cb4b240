"""A damaged file is loaded or refused; nothing else may happen."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tifo.engine.assets.bone_figure import bone_figure
from tifo.engine.assets.bvh import load_bvh
from tifo.engine.errors import AssetError

TEXT = b"""HIERARCHY
ROOT Hips
{
  OFFSET 0.0 90.5 0.0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Spine
  {
    OFFSET 0 50 0
    CHANNELS 3 Zrotation Yrotation Xrotation
    End Site
    {
      OFFSET 0 30 0
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.033333
0 90 0 0 0 0 10 20 30
1 90 -2 5 10 15 12 22 32
2.5 90 -4 9 20 29 14 24 34
"""
PIECES = (
    b"{ } nan 1e30 - \n \r \0 \xff 999999999999999999999999 End JOINT CHANNELS MOTION 0 e .".split(
        b" "
    )
)


def check(path: Path, data: bytes) -> None:
    path.write_bytes(data)
    try:
        motion = load_bvh(path)
    except AssetError as error:
        refusal = error
    else:
        figure = bone_figure(motion.skeleton, "fuzz", (motion.clip,), motion.end_sites)
        assert np.isfinite(figure.meshes[0].positions).all()
        return
    assert refusal.place.startswith("line ")
    assert "\n" not in str(refusal)


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("fuzz") / "fuzz.bvh"


LIMITS = settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


@LIMITS
@given(length=st.integers(0, len(TEXT)))
def test_truncated(path: Path, length: int) -> None:
    check(path, TEXT[:length])


@LIMITS
@given(
    changes=st.lists(
        st.tuples(st.integers(0, len(TEXT) - 1), st.integers(0, 255)), min_size=1, max_size=3
    )
)
def test_changed_bytes(path: Path, changes: list[tuple[int, int]]) -> None:
    data = bytearray(TEXT)
    for place, byte in changes:
        data[place] = byte
    check(path, bytes(data))


@LIMITS
@given(place=st.integers(0, len(TEXT)), piece=st.sampled_from(PIECES), removed=st.integers(0, 20))
def test_pieces_put_in_and_taken_out(path: Path, place: int, piece: bytes, removed: int) -> None:
    check(path, TEXT[:place] + piece + TEXT[place + removed :])
