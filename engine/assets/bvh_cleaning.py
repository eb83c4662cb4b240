"""Judges what a BVH file leaves unsaid: its unit, calibration rows at its start, whether it loops.

BVH has no unit, and converters put a T-pose or rows of zeros in front of captured motion. Both
would be plain to see in a stadium (giants, a twitch at every restart), so they are found here by
rules that are stated with the functions, and every guess becomes a note for the user.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .bvh_document import BvhDocument
from .rotations import angle_between

UNITS = (
    (1.0, "metre"),
    (0.1, "decimetre"),
    (0.0254 / 0.45, "CMU unit (2.54/0.45 cm)"),
    (0.0254, "inch"),
    (0.01, "centimetre"),
    (0.001, "millimetre"),
)
"""Metres a unit, and its name: what files are known to use."""

HUMAN_HEIGHT = 1.75
PLAUSIBLE_HEIGHTS = (1.0, 2.3)

LEADING_ROWS = 10
"""Calibration rows are looked for in so many rows at the start, at most half of the file."""

JUMP_ANGLE = np.radians(15.0)
"""Root mean square over the joints of their turn from one row to the next: captured motion at 30
to 120 Hz stays below 10 degrees, a change from a T-pose to a walk is 27 to 44."""

TELEPORT_DISTANCE = 0.3
TELEPORT_SPEED = 25.0
"""Metres and metres a second of a root from one row to the next: twice a sprinter's speed."""

CONTRAST = 8.0
"""A glitch is so many times as large as the file's median step, or the file is a list of poses."""


def rest_positions(document: BvhDocument) -> NDArray[np.float64]:
    """(J, 3) model-space positions of the joints with no rotation, in the file's unit."""
    positions = document.offsets.copy()
    for joint, parent in enumerate(document.parents):
        if parent >= 0:
            positions[joint] += positions[parent]
    return positions


def guess_scale(document: BvhDocument) -> tuple[float, str]:
    """Metres a file unit, guessed from the size of the skeleton, and a note that says so.

    The largest extent of the rest pose, tips included, is a person's height in most files, lying
    or standing, arms down or stretched out. Of `UNITS` the one is taken that makes it nearest to
    1.75 m and keeps it between 1 and 2.3 m; if there is none, the skeleton is scaled to 1.75 m.
    A skeleton of 178 units is in centimetres.
    """
    extent = float(_rest_extents(document).max())
    if extent < 1e-6:
        return 1.0, "BVH states no unit and the skeleton has no size: 1 unit is taken as 1 m"
    heights = [(extent * metres, metres, name) for metres, name in UNITS]
    fitting = [h for h in heights if PLAUSIBLE_HEIGHTS[0] <= h[0] <= PLAUSIBLE_HEIGHTS[1]]
    if not fitting:
        scale = HUMAN_HEIGHT / extent
        return scale, (
            f"BVH states no unit and no usual one gives a person's height: 1 unit is taken as "
            f"{scale:.4g} m, so that the skeleton is {HUMAN_HEIGHT} m tall (a scale overrides this)"
        )
    height, scale, name = min(fitting, key=lambda h: abs(h[0] - HUMAN_HEIGHT))
    return scale, (
        f"BVH states no unit: 1 unit is taken as 1 {name}, {scale:.4g} m, so that the skeleton is "
        f"{height:.2f} m tall (a scale overrides this)"
    )


def rest_notes(document: BvhDocument) -> list[str]:
    """Sentences on a rest pose that lies down and on position channels that undo the bones."""
    notes: list[str] = []
    _, height, depth = _rest_extents(document).tolist()
    if height < 0.5 * depth:
        notes.append(
            "the rest pose is longer along Z than it is high: the file may mean Z up, but +Y is "
            "taken as up"
        )
    shares: list[float] = []
    column = 0
    for joint, names in enumerate(document.channels):
        positions = [column + k for k, name in enumerate(names) if name.endswith("position")]
        column += len(names)
        length = float(np.linalg.norm(document.offsets[joint]))
        if len(positions) == 3 and document.parents[joint] >= 0 and length > 0:
            shares.append(float(np.linalg.norm(document.values[0, positions])) / length)
    if shares and np.median(shares) < 0.1:
        notes.append(
            f"the position channels of {len(shares)} joints put them onto their parents: the file "
            "seems to mean displacements from OFFSET, but they are taken as positions"
        )
    return notes


def leading_glitch(
    rotation: NDArray[np.float64], root: NDArray[np.float64], frame_time: float
) -> int:
    """Number of rows at the start that are a T-pose or zeros put in front of the motion.

    They end at the last jump of the whole body (`JUMP_ANGLE`) or of a root (`TELEPORT_DISTANCE`)
    within the first `LEADING_ROWS` rows, if that is `CONTRAST` times the median step of the file.

    Parameters
    ----------
    rotation
        (F, J, 4) float64 local rotations.
    root
        (F, R, 3) float64 positions of the R roots in metres.
    frame_time
        Seconds between rows.
    """
    rows = min(LEADING_ROWS, len(rotation) // 2)
    jumps = np.flatnonzero(_pose_jumps(rotation)[:rows] | _teleports(root, frame_time)[:rows])
    return int(jumps[-1]) + 1 if len(jumps) else 0


def glitch_notes(
    rotation: NDArray[np.float64], root: NDArray[np.float64], frame_time: float, first: int
) -> list[str]:
    """Sentences on the `first` rows that were dropped and on teleports that were kept."""
    notes: list[str] = []
    if first:
        rows = "row 0 is" if first == 1 else f"rows 0 to {first - 1} are"
        notes.append(f"{rows} a calibration pose, not motion (the body jumps behind), and dropped")
    kept = np.flatnonzero(_teleports(root, frame_time)[first:]) + first + 1
    if len(kept):
        shown = ", ".join(str(row) for row in kept[:5]) + (" ..." if len(kept) > 5 else "")
        notes.append(f"the root teleports at row {shown}; kept as the file has it")
    return notes


def loops(rotation: NDArray[np.float64], root: NDArray[np.float64]) -> bool:
    """Whether the last pose continues into the first, as in a walk cycle keyed as a loop.

    The step from the last pose to the first must be no larger than the median step of the file
    (or 1 degree and 1 cm), both in the root mean square of the joints' turns and in the way of
    every root. A capture of a walk ends elsewhere than it starts and does not loop.
    """
    if len(rotation) < 2:
        return False
    turn = float(np.sqrt(np.mean(angle_between(rotation[-1], rotation[0]) ** 2)))
    way = float(np.linalg.norm(root[0] - root[-1], axis=-1).max())
    turn_allowed = max(float(np.median(_turns(rotation))), float(np.radians(1.0)))
    return turn <= turn_allowed and way <= max(float(np.median(_ways(root))), 0.01)


def _rest_extents(document: BvhDocument) -> NDArray[np.float64]:
    """(3,) size of the box around the rest pose, tips included, in the file's unit."""
    joints = rest_positions(document)
    tips = [joints[end.joint] + end.offset for end in document.end_sites]
    return np.asarray(np.ptp(np.concatenate([joints, np.reshape(tips, (-1, 3))]), axis=0))


def _turns(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """(F - 1,) root mean square over the joints of the angle from each row to the next."""
    angles = angle_between(rotation[:-1], rotation[1:])
    return np.asarray(np.sqrt(np.mean(angles**2, axis=1)))


def _ways(root: NDArray[np.float64]) -> NDArray[np.float64]:
    """(F - 1,) largest distance that a root moves from each row to the next, metres."""
    return np.asarray(np.linalg.norm(np.diff(root, axis=0), axis=-1).max(axis=1))


def _pose_jumps(rotation: NDArray[np.float64]) -> NDArray[np.bool_]:
    turns = _turns(rotation)
    if not len(turns):
        return np.zeros(0, dtype=np.bool_)
    return turns > max(float(JUMP_ANGLE), CONTRAST * float(np.median(turns)))


def _teleports(root: NDArray[np.float64], frame_time: float) -> NDArray[np.bool_]:
    ways = _ways(root)
    if not len(ways):
        return np.zeros(0, dtype=np.bool_)
    least = max(TELEPORT_DISTANCE, TELEPORT_SPEED * frame_time)
    return ways > max(least, CONTRAST * float(np.median(ways)))
