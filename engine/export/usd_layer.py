"""Small steps of writing a USD layer, as specs, of which a thousand agents cost little."""

from __future__ import annotations

from errno import EIO
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

KINDS = (".usd", ".usda", ".usdc")


def import_pxr() -> Any:
    """The package of usd-core, with the modules that are used; ImportError if it is missing."""
    import pxr
    from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdShade, UsdSkel, Vt  # noqa: F401

    return pxr


class Layer:
    """A layer that is being written.

    Parameters
    ----------
    fps
        Frames, which are time codes, a second.
    frames
        How many; with one, values have no time.
    """

    def __init__(self, fps: float, frames: int) -> None:
        pxr = import_pxr()
        self.pxr, self.sdf, self.vt = pxr, pxr.Sdf, pxr.Vt
        self.layer = self.sdf.Layer.CreateAnonymous(".usdc")
        self._moving = frames > 1
        root = self.layer.pseudoRoot
        root.SetInfo("metersPerUnit", 1.0)
        root.SetInfo("upAxis", "Y")
        if self._moving:
            self.layer.timeCodesPerSecond = self.layer.framesPerSecond = fps
            self.layer.startTimeCode, self.layer.endTimeCode = 0.0, frames - 1.0

    def write(self, path: Path) -> None:
        """Write the layer; OSError if that is not possible."""
        try:
            self.layer.Export(str(path))
        except self.pxr.Tf.ErrorException as error:
            raise OSError(EIO, "USD has no access to the folder") from error

    def prim(
        self, path: str, kind: str = "", *, abstract: bool = False, apis: tuple[str, ...] = ()
    ) -> Any:
        """Define a prim of a type; its parent is there already."""
        spec = self.sdf.CreatePrimInLayer(self.layer, path)
        spec.specifier = self.sdf.SpecifierClass if abstract else self.sdf.SpecifierDef
        if kind:
            spec.typeName = kind
        if apis:
            schemas = self.sdf.TokenListOp()
            schemas.prependedItems = list(apis)
            spec.SetInfo("apiSchemas", schemas)
        return spec

    def over(self, path: str, *, apis: tuple[str, ...] = ()) -> Any:
        """A prim that only adds to what is referenced."""
        spec = self.prim(path, apis=apis)
        spec.specifier = self.sdf.SpecifierOver
        return spec

    def set(self, prim: Any, name: str, kind: str, value: Any, *, uniform: bool = False) -> Any:
        """Author an attribute's value; the attribute."""
        spec = self._attribute(prim, name, kind, uniform=uniform)
        spec.default = value
        return spec

    def animate(self, prim: Any, name: str, kind: str, values: list[Any]) -> None:
        """Author one value a frame, or a single one if they are all the same or there is one."""
        spec = self._attribute(prim, name, kind, uniform=False)
        if not self._moving or all(value == values[0] for value in values[1:]):
            spec.default = values[0]
            return
        for frame, value in enumerate(values):
            self.layer.SetTimeSample(spec.path, float(frame), value)

    def connect(self, prim: Any, name: str, kind: str, source: str) -> None:
        """Connect an input to an output."""
        spec = self._attribute(prim, name, kind, uniform=False)
        spec.connectionPathList.explicitItems = [self.sdf.Path(source)]

    def relate(self, prim: Any, name: str, *targets: str) -> None:
        """Author a relationship."""
        spec = self.sdf.RelationshipSpec(prim, name, False)
        spec.targetPathList.explicitItems = [self.sdf.Path(target) for target in targets]

    def refer(self, prim: Any, path: str, *, instance: bool = False) -> None:
        """Let a prim reference another of the same file."""
        prim.referenceList.prependedItems = [self.sdf.Reference("", path)]
        if instance:
            prim.instanceable = True

    def primvar(
        self, prim: Any, name: str, kind: str, value: Any, interpolation: str, size: int = 0
    ) -> None:
        """Author a primvar."""
        spec = self.set(prim, f"primvars:{name}", kind, value)
        spec.SetInfo("interpolation", interpolation)
        if size:
            spec.SetInfo("elementSize", size)

    def tokens(self, names: tuple[str, ...]) -> Any:
        """An array of tokens."""
        return self.vt.TokenArray(list(names))

    def vectors(self, values: NDArray[Any]) -> Any:
        """(N, 3) or (N, 2) as float vectors, (N, 3) float16 as half ones."""
        kind = "h" if values.dtype == np.float16 else "f"
        kept = values if kind == "h" else values.astype(np.float32)
        array = getattr(self.vt, f"Vec{values.shape[1]}{kind}Array")
        return array.FromNumpy(np.ascontiguousarray(kept))

    def turns(self, values: NDArray[np.float32]) -> Any:
        """(N, 4) quaternions xyzw."""
        return self.vt.QuatfArray.FromNumpy(np.ascontiguousarray(values, np.float32))

    def matrices(self, values: NDArray[np.float64]) -> Any:
        """(N, 4, 4) column-vector matrices, transposed as USD has them."""
        rows = np.ascontiguousarray(values.swapaxes(-1, -2), np.float64)
        return self.vt.Matrix4dArray.FromNumpy(rows)

    def integers(self, values: NDArray[Any]) -> Any:
        """(N,) integers."""
        return self.vt.IntArray.FromNumpy(np.ascontiguousarray(values, np.int32))

    def floats(self, values: NDArray[Any]) -> Any:
        """(N,) floats."""
        return self.vt.FloatArray.FromNumpy(np.ascontiguousarray(values, np.float32))

    def extent(self, points: NDArray[np.float32]) -> Any:
        """Corners of the box around points."""
        return self.vectors(np.stack([points.min(axis=0), points.max(axis=0)]))

    def _attribute(self, prim: Any, name: str, kind: str, *, uniform: bool) -> Any:
        variability = self.sdf.VariabilityUniform if uniform else self.sdf.VariabilityVarying
        types = self.sdf.ValueTypeNames
        return self.sdf.AttributeSpec(prim, name, types.Find(kind), variability)


@cache
def identifiers(names: tuple[str, ...]) -> tuple[str, ...]:
    """Unique names of prims for any names: ``"mixamorig:Hips"`` becomes ``"mixamorig_Hips"``."""
    made: list[str] = []
    taken: set[str] = set()
    for name in names:
        plain = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in name)
        if not plain or plain[0].isdigit():
            plain = "_" + plain
        unique, number = plain, 1
        while unique in taken:
            number += 1
            unique = f"{plain}_{number}"
        taken.add(unique)
        made.append(unique)
    return tuple(made)
