"""The drawing side's copy of a pose store."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..gl.program import Program
from ..gl.texture import Texture2D
from ..gl.texture_array import TextureArray
from ..gl.texture_format import TextureFormat
from ..streams.baked import BakedPoses
from ..streams.pool import StreamPool

RING_UNIT, STATIC_UNIT, STREAM_UNIT = 0, 1, 2
FRAMES_PER_LAYER = 256


class PoseTextures(Protocol):
    """A pose source on the GPU: shaders read it through ``lib/pose.glsl``."""

    defines: dict[str, int]

    def update(self, tick: int) -> int:
        """Copy what changed; bytes copied."""

    def bind(self, program: Program, *, markers: bool) -> None:
        """Bind the textures for palettes, or for the joints of the farthest level."""

    def delete(self) -> None:
        """Delete the textures."""


class StreamTextures:
    """Rings, static rows and stream table of a stream pool.

    A tick's slice is one contiguous upload; nothing else is copied while no stream is cut.
    """

    def __init__(self, pool: StreamPool) -> None:
        self.defines: dict[str, int] = {}
        self._pool = pool
        store = pool.store
        rows = store.stream_rows
        joints = store.ring.shape[2]
        markers = max(store.ring_markers.shape[2], 1)
        rgba = TextureFormat.RGBA32F
        self._ring = TextureArray((3 * joints, rows), store.capacity, rgba)
        self._statics = Texture2D((3 * joints, len(store.static)), rgba)
        self._ring_markers = TextureArray((markers, rows), store.capacity, rgba)
        self._static_markers = Texture2D((markers, len(store.static)), rgba)
        self._streams = Texture2D((rows + store.uniques, 1), rgba)
        self._dirty = store.mirror()

    def update(self, tick: int) -> int:
        """Copy the slices and rows that changed since the last call; bytes copied."""
        store = self._pool.store
        dirty = self._dirty.take()
        slices, statics = sorted(dirty.slices), sorted(dirty.static_rows)
        copied = 0
        for number in slices:
            flat = store.ring[number].reshape(store.stream_rows, -1, 4)
            self._ring.write(flat, layer=number)
            copied += flat.nbytes
            if store.ring_markers.shape[2]:
                self._ring_markers.write(store.ring_markers[number], layer=number)
                copied += store.ring_markers[number].nbytes
        # Rows that lie together go together: slots are given out lowest first.
        for first, stop in _runs(statics):
            poses = store.static[first:stop].reshape(stop - first, -1, 4)
            self._statics.write(poses, y=first)
            copied += poses.nbytes
            if store.static_markers.shape[1]:
                places = store.static_markers[first:stop]
                self._static_markers.write(places, y=first)
                copied += places.nbytes
        # The table counts from the current tick, so it changes every tick for stopped streams.
        table = self._table(tick)
        self._streams.write(table)
        return copied + table.nbytes

    def _table(self, tick: int) -> NDArray[np.float32]:
        pool, store = self._pool, self._pool.store
        table = np.zeros((1, store.stream_rows + store.uniques, 4), np.float32)
        streams, uniques = np.split(table[0], [store.stream_rows])
        streams[:, 0] = pool.head - tick
        streams[:, 1] = pool.head % store.capacity
        streams[:, 2] = pool.valid
        uniques[:, 0] = store.unique_head - tick
        uniques[:, 1] = store.unique_newest
        uniques[:, 2] = store.unique_valid
        return table

    def bind(self, program: Program, *, markers: bool) -> None:
        """Bind the textures for palettes, or for the joints of the farthest level."""
        (self._ring_markers if markers else self._ring).bind(RING_UNIT)
        (self._static_markers if markers else self._statics).bind(STATIC_UNIT)
        self._streams.bind(STREAM_UNIT)
        program["ring"] = RING_UNIT
        program["statics"] = STATIC_UNIT
        program["streams"] = STREAM_UNIT
        program["stream_rows"] = self._pool.store.stream_rows
        program["uniques"] = self._pool.store.uniques
        program["capacity"] = self._pool.store.capacity

    def delete(self) -> None:
        """Delete the textures."""
        for texture in (self._ring, self._ring_markers):
            texture.delete()
        for flat in (self._statics, self._static_markers, self._streams):
            flat.delete()


class BakedTextures:
    """All frames of all clips, uploaded once."""

    def __init__(self, baked: BakedPoses) -> None:
        self.defines = {"BAKED": 1}
        self._palettes = _layers(baked.palettes.reshape(len(baked.palettes), -1, 4))
        self._markers = _layers(baked.markers)

    def update(self, tick: int) -> int:
        """Baked poses never change."""
        return 0

    def bind(self, program: Program, *, markers: bool) -> None:
        """Bind the textures for palettes, or for the joints of the farthest level."""
        (self._markers if markers else self._palettes).bind(RING_UNIT)
        program["ring"] = RING_UNIT

    def delete(self) -> None:
        """Delete the textures."""
        self._palettes.delete()
        self._markers.delete()


def _runs(rows: Sequence[int]) -> Iterator[tuple[int, int]]:
    """First and stop of each run of neighbours in ascending rows: 3 4 5 9 gives (3, 6), (9, 10)."""
    numbers = np.asarray(rows, np.int64)
    for run in np.split(numbers, np.flatnonzero(np.diff(numbers) > 1) + 1):
        if len(run):
            yield int(run[0]), int(run[-1]) + 1


def _layers(frames: NDArray[np.float32]) -> TextureArray:
    """(F, W, 4) float32 rows as an array texture with 256 rows a layer."""
    layers = -(-len(frames) // FRAMES_PER_LAYER)
    if layers > FRAMES_PER_LAYER:
        raise ValueError(
            f"{len(frames)} baked frames, at most {FRAMES_PER_LAYER**2} can be drawn; "
            "bake fewer clips or use streams"
        )
    width = max(frames.shape[1], 1)
    texture = TextureArray((width, FRAMES_PER_LAYER), layers, TextureFormat.RGBA32F)
    for layer in range(layers):
        part = frames[layer * FRAMES_PER_LAYER : (layer + 1) * FRAMES_PER_LAYER]
        texture.write(np.ascontiguousarray(part), layer=layer)
    return texture
