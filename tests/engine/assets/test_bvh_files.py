"""Real BVH files against independent readers, and damaged ones against what is expected."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tifo.engine.assets.bvh import load_bvh, local_transforms
from tifo.engine.assets.bvh_document import BvhDocument, parse_bvh
from tifo.engine.errors import AssetError

DATA = Path(__file__).resolve().parents[4] / "shared" / "data"
if not DATA.is_dir():
    pytest.skip(f"the motion files are not at {DATA}", allow_module_level=True)

GOOD = sorted((DATA / "bvh").glob("*.bvh")) + sorted((DATA / "bad" / "bvh").glob("*.bvh"))
DERIVED = DATA / "bad" / "bvh_derived"
CMU_UNIT = 0.0254 / 0.45


def world_positions(document: BvhDocument) -> np.ndarray:
    """(F, J, 3) by 4x4 matrices, joint by joint: slow and plain."""
    from scipy.spatial.transform import Rotation

    rotation, translation = local_transforms(document)
    frames, joints = translation.shape[:2]
    world = np.zeros((frames, joints, 4, 4))
    for joint, parent in enumerate(document.parents):
        local = np.tile(np.eye(4), (frames, 1, 1))
        local[:, :3, :3] = Rotation.from_quat(rotation[:, joint]).as_matrix()
        local[:, :3, 3] = translation[:, joint]
        world[:, joint] = local if parent < 0 else world[:, parent] @ local
    return world[:, :, :3, 3]


def few_frames(path: Path, folder: Path, count: int = 6) -> Path:
    """A copy with `count` rows spread over the file, for readers that are slow."""
    lines = [line for line in path.read_text("utf-8-sig").splitlines() if line.strip()]
    motion = next(number for number, line in enumerate(lines) if line.strip() == "MOTION")
    rows = lines[motion + 3 :]
    chosen = sorted({round(place) for place in np.linspace(0, len(rows) - 1, count)})
    copy = folder / path.name
    copy.write_text(
        "\n".join(
            [
                *lines[: motion + 1],
                f"Frames: {len(chosen)}",
                lines[motion + 2],
                *(rows[place] for place in chosen),
            ]
        )
        + "\n"
    )
    return copy


@pytest.mark.parametrize("path", GOOD, ids=lambda path: path.stem)
def test_world_positions_equal_those_of_bvhio(path: Path, tmp_path: Path) -> None:
    bvhio = pytest.importorskip("bvhio")
    copy = few_frames(path, tmp_path)
    document = parse_bvh(copy)
    ours = world_positions(document)
    root = bvhio.readAsHierarchy(str(copy))
    theirs = np.zeros_like(ours)
    for frame in range(len(ours)):
        root.loadPose(frame)
        for joint, _, _ in root.layout():
            place = document.names.index(joint.Name)
            theirs[frame, place] = [*joint.PositionWorld]
    size = np.ptp(theirs[0], axis=0).max()
    assert np.abs(ours - theirs).max() < 1e-4 * size


@pytest.mark.parametrize("path", GOOD, ids=lambda path: path.stem)
def test_world_positions_equal_those_of_pybvh(path: Path, tmp_path: Path) -> None:
    pybvh = pytest.importorskip("pybvh")
    copy = few_frames(path, tmp_path)
    document = parse_bvh(copy)
    if any("xposition" in names for names in document.channels[1:]):
        pytest.skip("pybvh refuses position channels below the root")
    theirs = pybvh.read_bvh_file(copy)
    places = [theirs.joint_names.index(name) for name in document.names]
    expected = theirs.joint_positions()[:, places]
    size = np.ptp(expected[0], axis=0).max()
    assert np.abs(world_positions(document) - expected).max() < 1e-4 * size


@pytest.mark.parametrize("path", GOOD, ids=lambda path: path.stem)
def test_the_clip_holds_the_frames_of_the_file(path: Path) -> None:
    document = parse_bvh(path)
    motion = load_bvh(path)
    rotation, translation = local_transforms(document)
    order = [document.names.index(name) for name in motion.skeleton.names]
    assert [order[end.joint] for end in motion.end_sites] == [
        end.joint for end in document.end_sites
    ]
    step = max(round(1 / 60 / document.frame_time), round(document.frame_time * 60 + 0.49), 1)
    if document.frame_time <= 0.0167:
        step = 1
    kept = motion.clip.rotation[::step].astype(float)
    first = len(rotation) - len(kept)
    assert 0 <= first <= 5
    dots = np.abs(np.sum(kept * rotation[first:, order], axis=-1))
    assert dots.min() > 1 - 1e-6
    np.testing.assert_allclose(
        motion.clip.translation[::step],
        motion.scale * translation[first:, order],
        rtol=1e-6,
        atol=1e-6,
    )


@pytest.mark.parametrize(
    ("name", "unit", "dropped", "keys", "rate", "looping"),
    [
        ("100style_elated", 0.01, 0, 1800, 60, False),
        ("cmu_02_01", CMU_UNIT, 1, 343, 120, False),
        ("cmu_02_06", CMU_UNIT, 1, 2235, 120, False),
        ("cmu_02_02_daz43", 0.01, 0, 299, 120, False),
        ("cmu_09_06", CMU_UNIT, 1, 141, 120, False),
        ("cmu_09_10", CMU_UNIT, 5, 128, 120, False),
        ("cmu_09_12", CMU_UNIT, 1, 1918, 120, False),
        ("cmu_10_01_soccerkick_30fps", 0.0254, 1, 399, 60, False),
        ("cmu_12_01_crlf", CMU_UNIT, 1, 523, 120, False),
        ("cmu_131_01_max", CMU_UNIT, 0, 994, 120, False),
        ("mh_tpose", 0.1, 0, 1, 72, False),
        ("mh_walk1", 0.1, 0, 40, 72, True),
        ("pybvh_test1_mixedorder", 0.0254, 0, 149, 60, False),
    ],
)
def test_what_is_made_of_each_kind_of_file(
    name: str, unit: float, dropped: int, keys: int, rate: int, looping: bool
) -> None:
    motion = load_bvh(DATA / "bvh" / f"{name}.bvh")
    assert motion.scale == unit
    assert motion.clip.frame_count == keys
    assert motion.clip.looping is looping
    if keys > 1:
        assert (keys - 1) / motion.clip.duration == pytest.approx(rate, rel=1e-3)
    notes = [note for note in motion.notes if "calibration pose" in note]
    starts = {0: [], 1: ["row 0 is"], 5: ["rows 0 to 4 are"]}[dropped]
    assert [note[: note.index(" a cal")] for note in notes] == starts
    assert not any("teleports" in note for note in motion.notes)


def test_rows_that_teleport_at_the_start_are_dropped() -> None:
    motion = load_bvh(DATA / "bad" / "bvh" / "jlpm_tpose_teleport.bvh")
    assert motion.clip.frame_count == 8
    assert np.ptp(motion.clip.translation[:, 0], axis=0).max() < 0.01


REJECTED = {
    "02_frames_declared_20_have_12": ("line 131", "12 rows, but 'Frames' declares 20"),
    "04_short_row": ("line 125", "57 values, expected 60"),
    "06_nan_inf": ("line 124", "'nan' is not a finite number"),
    "08_no_motion": ("line 116", "expected MOTION"),
    "10_frame_time_zero": ("line 119", "Frame Time is 0"),
    "12_zero_frames": ("line 118", "Frames is '0'"),
    "14_extra_brace": ("line 117", "found '}'"),
    "16_channel_count_mismatch": ("line 10", "expected 3 channel names, found 'JOINT'"),
    "22_decimal_comma": ("line 120", "decimals need a point"),
    "30_truncated": ("line 125", "11 values, expected 60"),
    "32_binary": ("line 1", "this is not a BVH file"),
}
LOADED = {
    "18_two_roots": 38,
    "20_utf8_bom": 19,
    "24_name_with_space": 19,
    "26_no_space_after_colon": 19,
    "28_channels_zero": 19,
    "34_deep_3000": 3000,
}


def test_every_damaged_file_has_an_expectation() -> None:
    assert {path.stem for path in DERIVED.glob("*.bvh")} == REJECTED.keys() | LOADED.keys()


@pytest.mark.parametrize("name", REJECTED)
def test_a_damaged_file_is_refused_with_line_and_cause(name: str) -> None:
    place, cause = REJECTED[name]
    with pytest.raises(AssetError) as caught:
        load_bvh(DERIVED / f"{name}.bvh")
    assert caught.value.place == place
    assert cause in caught.value.cause


@pytest.mark.parametrize("name", LOADED)
def test_an_odd_but_legal_file_is_loaded(name: str) -> None:
    motion = load_bvh(DERIVED / f"{name}.bvh")
    assert motion.skeleton.joint_count == LOADED[name]
    assert motion.clip.frame_count == (1 if "deep" in name else 21)
