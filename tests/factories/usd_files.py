"""USD files as UsdSkel and USD's own validators see them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


def skinned_points(path: Path, agent: int, frame: float | None = None) -> Array:
    """Vertices of all meshes of an agent, in the scene, by UsdSkel's own skinning."""
    from pxr import Usd, UsdGeom, UsdSkel, Vt

    stage = Usd.Stage.Open(str(path))
    time = Usd.TimeCode.Default() if frame is None else Usd.TimeCode(frame)
    root = UsdSkel.Root.Get(stage, f"/Crowd/agent_{agent}")
    assert root
    proxies = Usd.TraverseInstanceProxies()
    cache = UsdSkel.Cache()
    assert cache.Populate(root, proxies)
    (binding,) = cache.ComputeSkelBindings(root, proxies)
    skeleton = cache.GetSkelQuery(binding.GetSkeleton())
    animation = skeleton.GetAnimQuery()
    assert animation
    moves = skeleton.ComputeSkinningTransforms(time)
    place = np.array(UsdGeom.XformCache(time).GetLocalToWorldTransform(root.GetPrim()))
    found = []
    for query in sorted(binding.GetSkinningTargets(), key=_order):
        points = Vt.Vec3fArray(UsdGeom.Mesh(query.GetPrim()).GetPointsAttr().Get())
        if query.HasBlendShapes():
            weights = query.GetBlendShapeMapper().Remap(animation.ComputeBlendShapeWeights(time))
            shapes = UsdSkel.BlendShapeQuery(UsdSkel.BindingAPI(query.GetPrim()))
            sub, which, over = shapes.ComputeSubShapeWeights(weights)
            indices = shapes.ComputeBlendShapePointIndices()
            offsets = shapes.ComputeSubShapePointOffsets()
            assert shapes.ComputeDeformedPoints(sub, which, over, indices, offsets, points)
        mapper = query.GetJointMapper()
        own = mapper.RemapTransforms(moves) if mapper else moves
        assert query.ComputeSkinnedPoints(own, points, time)
        found.append(np.array(points))
    local = np.concatenate(found).astype(float)
    return np.column_stack([local, np.ones(len(local))]) @ place[:, :3]


def mesh_points(path: Path, agent: int, frame: float | None = None) -> Array:
    """Vertices of the meshes below an agent's prim, in the scene, as they are."""
    from pxr import Usd, UsdGeom

    stage = Usd.Stage.Open(str(path))
    time = Usd.TimeCode.Default() if frame is None else Usd.TimeCode(frame)
    prim = stage.GetPrimAtPath(f"/Crowd/agent_{agent}")
    place = np.array(UsdGeom.XformCache(time).GetLocalToWorldTransform(prim))
    meshes = [child for child in prim.GetChildren() if child.IsA(UsdGeom.Mesh)]
    local = np.concatenate([np.array(UsdGeom.Mesh(m).GetPointsAttr().Get(time)) for m in meshes])
    return np.column_stack([local.astype(float), np.ones(len(local))]) @ place[:, :3]


def complaints(path: Path) -> list[str]:
    """What USD's validators, or the older compliance checker, find wrong."""
    from pxr import Usd, UsdUtils

    try:
        from pxr import UsdValidation
    except ImportError:
        checker = UsdUtils.ComplianceChecker()
        checker.CheckCompliance(str(path))
        return [*checker.GetErrors(), *checker.GetFailedChecks(), *checker.GetWarnings()]
    registry = UsdValidation.ValidationRegistry()
    context = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators())
    stage = Usd.Stage.Open(str(path))
    return [f"{error.GetName()}: {error.GetMessage()}" for error in context.Validate(stage)]


def _order(query: Any) -> int:
    """Place of a mesh among its siblings."""
    from pxr import Usd

    prim = query.GetPrim()
    siblings = prim.GetParent().GetFilteredChildren(Usd.TraverseInstanceProxies())
    return [child.GetName() for child in siblings].index(prim.GetName())
