"""The text of a BVH file: what is read as what, and which line a refusal names."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tifo.engine.assets.bvh_document import BvhDocument, parse_bvh
from tifo.engine.errors import AssetError

GOOD = """HIERARCHY
ROOT Hips
{
  OFFSET 1 2 3
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Knee
  {
    OFFSET 0 -4 0
    CHANNELS 1 Xrotation
    End Site
    {
      OFFSET 0 -5 .5
    }
  }
}
MOTION
Frames: 2
Frame Time: .0083333
1 2 3 4 5 6 7
-1 -2e0 -3 -4 -5 -6 +7.5
"""


def parse(tmp_path: Path, text: str | bytes) -> BvhDocument:
    path = tmp_path / "file.bvh"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return parse_bvh(path)


def refusal(tmp_path: Path, text: str | bytes) -> AssetError:
    with pytest.raises(AssetError) as caught:
        parse(tmp_path, text)
    return caught.value


def test_everything_of_a_small_file(tmp_path: Path) -> None:
    document = parse(tmp_path, GOOD)
    assert document.names == ("Hips", "Knee")
    assert document.parents == (-1, 0)
    np.testing.assert_array_equal(document.offsets, [[1, 2, 3], [0, -4, 0]])
    assert document.channels == (
        ("xposition", "yposition", "zposition", "zrotation", "xrotation", "yrotation"),
        ("xrotation",),
    )
    assert [(end.joint, end.offset) for end in document.end_sites] == [(1, (0.0, -5.0, 0.5))]
    assert document.frame_time == 0.0083333
    np.testing.assert_array_equal(
        document.values, [[1, 2, 3, 4, 5, 6, 7], [-1, -2, -3, -4, -5, -6, 7.5]]
    )
    assert document.notes == ()


@pytest.mark.parametrize(
    "variant",
    [
        GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\r"),
        "\ufeff" + GOOD,
        GOOD.replace("  ", "\t").replace(" ", "\t").replace("End\tSite", "End Site"),
        GOOD.replace("Frames: 2", "Frames:2").replace("Time: ", "Time:"),
        GOOD.replace("Frames: 2", "FRAMES :  2"),
        GOOD.replace("\n{", " {"),
        GOOD.replace("Hips\n{", "Hips{"),
        GOOD.replace("JOINT", "Joint").replace("OFFSET", "offset").replace("End Site", "End site"),
        GOOD.replace("ROOT", "\n\nROOT").replace("Frames", "\n\n Frames") + "\n \n",
        GOOD.replace("Xposition", "XPOSITION"),
        GOOD.removesuffix("\n"),
    ],
    ids=range(12),
)
def test_other_ways_to_write_the_same(tmp_path: Path, variant: str) -> None:
    expected, found = parse(tmp_path, GOOD), parse(tmp_path, variant)
    assert found.names == expected.names
    assert found.channels == expected.channels
    assert found.end_sites == expected.end_sites
    np.testing.assert_array_equal(found.offsets, expected.offsets)
    np.testing.assert_array_equal(found.values, expected.values)


def test_offset_may_follow_channels_and_children(tmp_path: Path) -> None:
    text = GOOD.replace("  OFFSET 1 2 3\n", "", 1).replace("  }\n}", "  }\n  OFFSET 1 2 3\n}")
    np.testing.assert_array_equal(parse(tmp_path, text).offsets, [[1, 2, 3], [0, -4, 0]])


def test_names_may_hold_blanks_and_other_letters(tmp_path: Path) -> None:
    document = parse(tmp_path, GOOD.replace("Hips", "Lower  Hüfte 1"))
    assert document.names[0] == "Lower Hüfte 1"
    latin = parse(tmp_path, GOOD.replace("Hips", "Hüfte").encode("latin-1"))
    assert latin.names[0] == "Hüfte"


def test_a_repeated_name_gets_a_number_and_a_note(tmp_path: Path) -> None:
    text = GOOD.replace("Knee", "Hips")
    document = parse(tmp_path, text)
    assert document.names == ("Hips", "Hips_2")
    assert document.notes == (
        "1 joints bear an earlier joint's name and got a number: 'Hips_2' (line 6)",
    )


def test_joints_without_channels(tmp_path: Path) -> None:
    nothing = GOOD.replace("CHANNELS 1 Xrotation", "CHANNELS 0").replace(" 7\n", "\n")
    nothing = nothing.replace(" +7.5", "")
    document = parse(tmp_path, nothing)
    assert document.channels[1] == ()
    assert document.values.shape == (2, 6)
    absent = parse(tmp_path, nothing.replace("    CHANNELS 0\n", ""))
    assert absent.channels[1] == ()


def test_rows_beyond_the_declared_ones_are_noted(tmp_path: Path) -> None:
    document = parse(tmp_path, GOOD + "1 2 3 4 5 6 7\nrubbish\n")
    assert document.values.shape == (2, 7)
    assert document.notes == ("2 rows beyond the 2 that 'Frames' declares were ignored",)


@pytest.mark.parametrize(
    ("old", "new", "place", "cause"),
    [
        ("HIERARCHY", "glTF", "line 1", "expected HIERARCHY, found 'glTF'"),
        ("ROOT Hips", "JOINT Hips", "line 2", "expected MOTION or ROOT, found 'JOINT'"),
        ("ROOT Hips", "ROOT", "line 3", "a joint has no name"),
        ("ROOT Hips\n{", "ROOT Hips", "line 3", "expected '{' after 'Hips'"),
        ("OFFSET 1 2 3", "OFFSET 1 2", "line 5", "expected a number, found 'CHANNELS'"),
        ("OFFSET 1 2 3", "OFFSET 1 2 3 4", "line 4", "found '4'"),
        ("OFFSET 1 2 3", "OFFSET 1 nan 3", "line 4", "'nan' is not a finite number"),
        ("OFFSET 1 2 3", "OFFSET 1 2e9 3", "line 4", "'2e9' is not a finite number"),
        ("OFFSET 1 2 3", "OFFSET 1 1_0 3", "line 4", "expected a number, found '1_0'"),
        ("  OFFSET 1 2 3\n", "", "line 14", "joint 'Hips' has no OFFSET"),
        ("OFFSET 0 -4 0", "OFFSET 0 -4 0 OFFSET 0 0 0", "line 8", "second OFFSET of joint 'Knee'"),
        ("CHANNELS 1 X", "CHANNELS 2 X", "line 10", "expected 2 channel names, found 'End'"),
        ("CHANNELS 1 X", "CHANNELS -1 X", "line 9", "CHANNELS '-1', expected a count"),
        ("CHANNELS 1 X", "CHANNELS 7 X", "line 9", "CHANNELS '7', expected a count"),
        ("CHANNELS 1 Xrotation", "CHANNELS 1 Xscale", "line 9", "found 'Xscale'; known are"),
        ("Zrotation X", "Xrotation X", "line 5", "channel 'Xrotation' is listed twice"),
        ("OFFSET 0 -5 .5", "", "line 13", "expected OFFSET of an End Site, found '}'"),
        ("    }\n  }", "  }", "line 15", "expected CHANNELS or END or JOINT"),
        ("}\nMOTION", "}\n}\nMOTION", "line 16", "expected MOTION or ROOT, found '}'"),
        ("MOTION", "", "line 17", "expected MOTION or ROOT, found 'Frames:'"),
        ("Frames: 2", "Frames: two", "line 17", "Frames is 'two', expected a count"),
        ("Frames: 2", "Frames: -2", "line 17", "Frames is '-2', expected a count"),
        ("Frames: 2", "Frames: 0", "line 17", "Frames is '0', expected a count of at least 1"),
        ("Frames: 2", f"Frames: {'9' * 5000}", "line 17", "expected a count"),
        ("Frames: 2\n", "", "line 17", "expected 'Frames:' and a number, found 'Frame Time:"),
        ("Frame Time: .0083333\n", "", "line 18", "expected 'Frame Time:' and a number"),
        (".0083333", "0", "line 18", "Frame Time is 0, expected seconds a frame"),
        (".0083333", "-0.01", "line 18", "Frame Time is -0.01, expected"),
        (".0083333", "30", "line 18", "Frame Time is 30, expected seconds"),
        (".0083333", "nan", "line 18", "'nan' is not a finite number"),
        (".0083333", "fast", "line 18", "expected a number, found 'fast'"),
        ("1 2 3 4 5 6 7", "1 2 3 4 5 6", "line 19", "6 values, expected 7 (one a channel)"),
        ("1 2 3 4 5 6 7", "1 2 3 4 5 6 7 8", "line 19", "8 values, expected 7"),
        ("1 2 3 4 5 6 7", "1 2 3 4 inf 6 7", "line 19", "'inf' is not a finite number"),
        ("+7.5", "1e999", "line 20", "'inf' is not a finite number"),
        ("+7.5", "7,5", "line 20", "expected a number, found '7,5'; decimals need a point"),
        ("+7.5", "7_5", "line 20", "expected a number, found '7_5'"),
        ("+7.5", "x" * 99, "line 20", f"found '{'x' * 21}...'"),
        ("Frames: 2", "Frames: 999999999999999", "line 20", "after 2 rows, but 'Frames' declares"),
    ],
)
def test_refusals_name_the_line_and_the_cause(
    tmp_path: Path, old: str, new: str, place: str, cause: str
) -> None:
    assert old in GOOD
    error = refusal(tmp_path, GOOD.replace(old, new, 1))
    assert error.place == place
    assert cause in error.cause


def test_a_file_that_ends_early(tmp_path: Path) -> None:
    assert "expected HIERARCHY, but the file ends" in refusal(tmp_path, "").cause
    assert "MOTION comes before any ROOT" in refusal(tmp_path, "HIERARCHY\nMOTION\n").cause
    assert "but the file ends here" in refusal(tmp_path, GOOD[: GOOD.index("MOTION")]).cause
    assert "expected 'Frames:'" in refusal(tmp_path, GOOD[: GOOD.index("Frames")]).cause


def test_a_file_in_which_nothing_moves(tmp_path: Path) -> None:
    text = "HIERARCHY ROOT a { OFFSET 0 0 0 }\nMOTION\nFrames: 1\nFrame Time: 1\n\n"
    assert "no joint has channels" in refusal(tmp_path, text).cause


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(AssetError, match="can't be read: No such file"):
        parse_bvh(tmp_path / "none.bvh")
    with pytest.raises(AssetError, match="can't be read: Is a directory"):
        parse_bvh(tmp_path)
    with pytest.raises(AssetError, match="can't be read"):
        parse_bvh("a\0b.bvh")
