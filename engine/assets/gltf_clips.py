"""From the animations of a glTF file to the clips of a skeleton."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..animation.clip import MIN_KEY_RATE, Clip
from ..animation.skeleton import Skeleton
from ..errors import AssetError
from .gltf_accessor import read_floats
from .gltf_animation import Track, resample
from .gltf_document import GltfDocument
from .gltf_fields import Fields
from .gltf_transforms import FloatArray, Transforms

WIDTHS = {"rotation": 4, "translation": 3, "scale": 3}
"""Paths that move a node, with the numbers of one value."""

INTERPOLATIONS = ("LINEAR", "STEP", "CUBICSPLINE")

LONGEST_CLIP = 3600.0
"""Seconds; a file with keys beyond that is refused."""

MOST_CELLS = 8_000_000
"""Keys times joints of one clip beyond which the file is refused: 25 minutes of 82 joints."""


def animated_nodes(document: GltfDocument) -> set[int]:
    """Nodes that any animation of the file moves, turns or scales."""
    count = len(document.items("nodes"))
    found = set()
    for animation in document.items("animations"):
        for channel in animation.children("channels"):
            target = channel.child("target")
            node = target.index("node", count)
            if node is not None and target.text("path") in WIDTHS:
                found.add(node)
    return found


def unique_names(wanted: list[str]) -> list[str]:
    """Keep names apart: of ``["a", "a", "b"]`` the second becomes ``"a 2"``."""
    taken = set(wanted)
    used: set[str] = set()
    result = []
    for name in wanted:
        candidate, number = name, 2
        while candidate in used or (candidate != name and candidate in taken):
            candidate = f"{name} {number}"
            number += 1
        used.add(candidate)
        result.append(candidate)
    return result


def read_clips(
    document: GltfDocument,
    skeleton: Skeleton,
    rest: Transforms,
    joint_of_node: Mapping[int, int],
    notes: list[str],
) -> tuple[Clip, ...]:
    """Read all animations.

    Parameters
    ----------
    document
        The file.
    skeleton
        The joints.
    rest
        (J, ...) their local transforms in float64.
    joint_of_node
        Which node is which joint.
    notes
        Takes what was dropped or changed.

    Returns
    -------
    tuple of Clip
        In the file's order. An animation that moves no joint has no clip.

    Raises
    ------
    AssetError
        For anything that contradicts the format.
    """
    animations = document.items("animations")
    names = unique_names(
        [fields.text("name") or f"clip {k}" for k, fields in enumerate(animations)]
    )
    reader = _TrackReader(document, joint_of_node, notes)
    clips = []
    late = 0
    for fields, name in zip(animations, names, strict=True):
        tracks = reader.tracks(fields)
        if not tracks:
            notes.append(f"Clip '{name}' moves no joint and is left out.")
            continue
        start = min(float(track.times[0]) for track in tracks)
        duration = max(float(track.times[-1]) for track in tracks) - start
        if duration > LONGEST_CLIP:
            fields.fail("", f"lasts {duration:.0f} seconds, more than {LONGEST_CLIP:.0f}")
        if duration * MIN_KEY_RATE * skeleton.joint_count > MOST_CELLS:
            fields.fail("", f"lasts {duration:.0f} seconds, too long for its many joints")
        late += start > 1e-3
        try:
            clips.append(resample(name, tracks, skeleton, rest))
        except ValueError as error:
            raise AssetError(document.path, fields.place, str(error)) from None
    if late:
        notes.append(
            f"{late} clips begin after 0 s in the file; here they begin at their first key."
        )
    if reader.weight_channels:
        notes.append(f"{reader.weight_channels} channels of morph target weights are left out.")
    if reader.idle_channels:
        notes.append(f"{reader.idle_channels} channels of nodes that move no mesh are left out.")
    return tuple(clips)


class _TrackReader:
    """Reads channels and groups those with the same key times."""

    def __init__(
        self, document: GltfDocument, joint_of_node: Mapping[int, int], notes: list[str]
    ) -> None:
        """Start with no times read."""
        self._document = document
        self._joint_of_node = joint_of_node
        self._notes = notes
        self._times: dict[int, FloatArray] = {}
        self.weight_channels = 0
        self.idle_channels = 0

    def tracks(self, animation: Fields) -> list[Track]:
        """Read the channels of one animation that move a joint."""
        samplers = animation.children("samplers")
        chosen: dict[tuple[int, str], Fields] = {}
        for channel in animation.children("channels"):
            sampler = channel.index("sampler", len(samplers))
            if sampler is None:
                channel.fail("sampler", "is missing")
            target = channel.child("target")
            node = target.index("node", len(self._document.items("nodes")))
            path = target.text("path")
            if path not in WIDTHS:
                self.weight_channels += path == "weights"
                continue
            if node is None or node not in self._joint_of_node:
                self.idle_channels += 1
                continue
            key = (self._joint_of_node[node], path)
            if key in chosen:
                self._notes.append(f"{channel.place} replaces an earlier one of its target.")
            chosen[key] = samplers[sampler]
        groups: dict[tuple[bytes, str, str], list[tuple[int, FloatArray]]] = {}
        for (joint, path), fields in chosen.items():
            times, interpolation, values = self._keys(fields, path)
            group = groups.setdefault((times.tobytes(), interpolation, path), [])
            group.append((joint, values))
        return [
            Track(
                path=path,
                interpolation=interpolation,
                times=np.frombuffer(times, dtype=np.float64),
                values=_checked(animation, path, interpolation, np.stack(values, axis=-2)),
                joints=np.array(joints),
            )
            for (times, interpolation, path), members in groups.items()
            for joints, values in [zip(*members, strict=True)]
        ]

    def _keys(self, sampler: Fields, path: str) -> tuple[FloatArray, str, FloatArray]:
        """Times (K,), interpolation and values (K, n) or (K, 3, n) of a sampler."""
        count = len(self._document.items("accessors"))
        source, target = sampler.index("input", count), sampler.index("output", count)
        if source is None or target is None:
            sampler.fail("input" if source is None else "output", "is missing")
        if source not in self._times:
            self._times[source] = self._read_times(source)
        times = self._times[source]
        interpolation = sampler.text("interpolation", "LINEAR")
        if interpolation not in INTERPOLATIONS:
            sampler.fail("interpolation", f"is '{interpolation[:20]}', which is unknown")
        values = read_floats(self._document, target, f"VEC{WIDTHS[path]}")
        expected = len(times) * (3 if interpolation == "CUBICSPLINE" else 1)
        if len(values) != expected:
            sampler.fail("output", f"has {len(values)} values, expected {expected}")
        if interpolation == "CUBICSPLINE":
            return times, interpolation, values.reshape(len(times), 3, -1)
        return times, interpolation, values

    def _read_times(self, accessor: int) -> FloatArray:
        times = read_floats(self._document, accessor, "SCALAR")[:, 0]
        place = f"accessors[{accessor}]"
        if times[0] < 0:
            self._document.fail(place, f"has the key time {times[0]:.6g}, expected 0 or later")
        late = np.flatnonzero(np.diff(times) <= 0)
        if len(late):
            self._document.fail(place, f"has key times that do not increase after key {late[0]}")
        return times


def _checked(
    animation: Fields, path: str, interpolation: str, values: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Refuse rotation keys of length zero and bring the others to unit length."""
    if path != "rotation":
        return values
    spline = interpolation == "CUBICSPLINE"
    length = np.linalg.norm(values[:, 1] if spline else values, axis=-1, keepdims=True)
    if length.min() < 1e-9:
        animation.fail(
            "", f"has the zero quaternion as rotation key {int(length.min((1, 2)).argmin())}"
        )
    return values if spline else values / length
