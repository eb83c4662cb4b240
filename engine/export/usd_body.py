"""What all agents of a USD file share: meshes, blend shapes, skeletons and materials."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..animation.skeleton import Skeleton
from ..assets.character import Material, SkinnedMesh
from ..assets.gltf_transforms import Transforms
from .paints import has_coordinates
from .pixels import png
from .rig import Rig, bind_matrices
from .targets import replacing
from .usd_layer import Layer, identifiers

_SEEN = 1e-7
DARK = 0.5
"""Vertex colours below are a drawing on the surface, such as eyes, and not its shade."""
_BINDING = "MaterialBindingAPI"


def add_mesh(layer: Layer, path: str, mesh: SkinnedMesh, *, apis: tuple[str, ...] = ()) -> Any:
    """Write triangles, texture coordinates and vertex colours, without points."""
    prim = layer.prim(path, "Mesh", apis=(_BINDING, *apis))
    layer.set(prim, "subdivisionScheme", "token", "none", uniform=True)
    layer.set(prim, "orientation", "token", "rightHanded", uniform=True)
    corners = layer.integers(mesh.triangles.reshape(-1))
    layer.set(prim, "faceVertexIndices", "int[]", corners)
    counts = layer.integers(np.full(len(mesh.triangles), 3))
    layer.set(prim, "faceVertexCounts", "int[]", counts)
    if has_coordinates(mesh):
        uvs = np.stack([mesh.uvs[:, 0], 1.0 - mesh.uvs[:, 1]], axis=1)
        layer.primvar(prim, "st", "texCoord2f[]", layer.vectors(uvs), "vertex")
    return prim


def set_points(
    layer: Layer, prim: Any, points: NDArray[np.float32], normals: NDArray[np.float32]
) -> None:
    """Author points (T, V, 3) and normals, with the box around them, at each frame."""
    layer.animate(prim, "points", "point3f[]", [layer.vectors(frame) for frame in points])
    spec = [layer.vectors(frame) for frame in normals]
    layer.animate(prim, "normals", "normal3f[]", spec)
    prim.attributes["normals"].SetInfo("interpolation", "vertex")
    layer.animate(prim, "extent", "float3[]", [layer.extent(frame) for frame in points])


def add_skinned_mesh(
    layer: Layer,
    path: str,
    mesh: SkinnedMesh,
    names: tuple[str, ...],
    offsets: tuple[NDArray[np.float32], ...],
) -> Any:
    """Write a mesh in the bind pose, bound to the skeleton's joints, with its blend shapes."""
    prim = add_mesh(layer, path, mesh, apis=("SkelBindingAPI",))
    set_points(layer, prim, mesh.positions[None], mesh.normals[None])
    width = mesh.joints.shape[1]
    bind_joints(layer, prim, mesh.joints)
    weights = layer.floats(mesh.weights.reshape(-1))
    layer.primvar(prim, "skel:jointWeights", "float[]", weights, "vertex", width)
    layer.set(prim, "primvars:skel:geomBindTransform", "matrix4d", layer.pxr.Gf.Matrix4d(1.0))
    shapes = []
    for name, offset in zip(names, offsets, strict=True):
        moved = np.flatnonzero(np.abs(offset).max(axis=1) > _SEEN)
        if not len(moved):
            continue
        shape = layer.prim(f"{path}/{name}", "BlendShape")
        layer.set(shape, "offsets", "vector3f[]", layer.vectors(offset[moved]), uniform=True)
        layer.set(shape, "pointIndices", "int[]", layer.integers(moved), uniform=True)
        shapes.append(name)
    if shapes:
        tokens = layer.tokens(tuple(shapes))
        layer.set(prim, "skel:blendShapes", "token[]", tokens, uniform=True)
        layer.relate(prim, "skel:blendShapeTargets", *(f"{path}/{name}" for name in shapes))
    return prim


def bind_joints(layer: Layer, prim: Any, joints: NDArray[Any]) -> None:
    """Author which joints (V, n) of a rig move each vertex."""
    indices = layer.integers(joints.reshape(-1))
    layer.primvar(prim, "skel:jointIndices", "int[]", indices, "vertex", joints.shape[1])


def joint_paths(rig: Rig) -> tuple[str, ...]:
    """Each joint as USD names it, with all that are above it: ``"hips/spine"``."""
    paths: list[str] = []
    for name, parent in zip(identifiers(rig.names), rig.parents, strict=True):
        paths.append(name if parent < 0 else f"{paths[parent]}/{name}")
    return tuple(paths)


def add_skeleton(layer: Layer, path: str, skeleton: Skeleton, rig: Rig) -> None:
    """Write a rig with its bind and rest pose."""
    prim = layer.prim(path, "Skeleton")
    layer.set(prim, "joints", "token[]", layer.tokens(joint_paths(rig)), uniform=True)
    count = skeleton.joint_count
    bind = np.tile(np.eye(4), (len(rig), 1, 1))
    bind[:count] = bind_matrices(skeleton)
    for joint in range(count, len(rig)):
        bind[joint] = bind[rig.parents[joint]]
    rest = np.tile(np.eye(4), (len(rig), 1, 1))
    rest[:count] = Transforms(
        skeleton.rest_rotation.astype(np.float64),
        skeleton.rest_translation.astype(np.float64),
        skeleton.rest_scale.astype(np.float64),
    ).matrices()
    layer.set(prim, "bindTransforms", "matrix4d[]", layer.matrices(bind), uniform=True)
    layer.set(prim, "restTransforms", "matrix4d[]", layer.matrices(rest), uniform=True)


def primvar_of(surface: str) -> str:
    """The primvar that holds an agent's colour of a surface: ``"shirtColor"``."""
    return f"{surface}Color"


def add_material(
    layer: Layer, path: str, material: Material, primvar: str, image: str | None
) -> None:
    """Write a material.

    Parameters
    ----------
    primvar
        From where it has its colour in linear light.
    image
        The picture, relative to the file; it takes the place of the primvar.
    """
    shader = add_surface_shader(layer, path)
    rgb = layer.pxr.Gf.Vec3f(*map(float, material.base_color[:3]))
    if image is not None:
        _add_texture(layer, path, shader, image, rgb, masked=_is_masked(material))
        return
    reader = layer.prim(f"{path}/Color", "Shader")
    layer.set(reader, "info:id", "token", "UsdPrimvarReader_float3", uniform=True)
    layer.set(reader, "inputs:varname", "string", primvar)
    layer.set(reader, "inputs:fallback", "float3", rgb)
    layer.set(reader, "outputs:result", "float3", None)
    layer.connect(shader, "inputs:diffuseColor", "color3f", f"{path}/Color.outputs:result")


def add_surface_shader(layer: Layer, path: str) -> Any:
    """Write a material with a shader that has no colour yet; the shader."""
    prim = layer.prim(path, "Material")
    shader = layer.prim(f"{path}/Surface", "Shader")
    layer.set(shader, "info:id", "token", "UsdPreviewSurface", uniform=True)
    layer.set(shader, "inputs:roughness", "float", 0.9)
    layer.set(shader, "inputs:metallic", "float", 0.0)
    layer.set(shader, "outputs:surface", "token", None)
    layer.connect(prim, "outputs:surface", "token", f"{path}/Surface.outputs:surface")
    return shader


def add_reader(layer: Layer, path: str, image: str, primvar: str) -> Any:
    """Write what reads a picture at the coordinates of a primvar; the texture."""
    reader = layer.prim(f"{path}/Coordinates", "Shader")
    layer.set(reader, "info:id", "token", "UsdPrimvarReader_float2", uniform=True)
    layer.set(reader, "inputs:varname", "string", primvar)
    layer.set(reader, "outputs:result", "float2", None)
    texture = layer.prim(f"{path}/Texture", "Shader")
    layer.set(texture, "info:id", "token", "UsdUVTexture", uniform=True)
    layer.set(texture, "inputs:file", "asset", layer.sdf.AssetPath(image))
    layer.connect(texture, "inputs:st", "float2", f"{path}/Coordinates.outputs:result")
    layer.set(texture, "outputs:rgb", "float3", None)
    return texture


def set_display_color(layer: Layer, prim: Any, mesh: SkinnedMesh, rgb: NDArray[Any]) -> None:
    """Author a mesh's vertex colours times a colour (3,), as one value where they are the same."""
    colors = np.clip(mesh.colors[:, :3] * rgb, 0.0, 1.0)
    same = bool((colors == colors[0]).all())
    values = layer.vectors(colors[:1] if same else colors)
    interpolation = "constant" if same else "vertex"
    layer.primvar(prim, "displayColor", "color3f[]", values, interpolation)


def split_by_shade(layer: Layer, path: str, mesh: SkinnedMesh) -> None:
    """Part a mesh into light faces and dark ones, as eyes are, if it has any of these.

    A preview surface can't multiply vertex colours by an agent's, so light faces lose their shades
    to the agent's colour; dark ones keep the mesh's.
    """
    dark = _dark_faces(mesh)
    if not dark.any():
        return
    prim = layer.layer.GetPrimAtPath(path)
    layer.set(prim, "subsetFamily:materialBind:familyType", "token", "partition", uniform=True)
    for name, faces in (("light", ~dark), ("dark", dark)):
        subset = layer.prim(f"{path}/{name}", "GeomSubset", apis=(_BINDING,))
        layer.set(subset, "elementType", "token", "face", uniform=True)
        layer.set(subset, "familyName", "token", "materialBind", uniform=True)
        layer.set(subset, "indices", "int[]", layer.integers(np.flatnonzero(faces)))


def bind_shades(layer: Layer, path: str, mesh: SkinnedMesh, light: str | None, dark: str) -> None:
    """Bind what references a mesh of `split_by_shade` to the materials of its faces.

    Light faces have the material of what is above them if `light` is None.
    """
    dark_faces = _dark_faces(mesh).any()
    if light is not None:
        layer.relate(layer.layer.GetPrimAtPath(path), "material:binding", light)
        if dark_faces:
            layer.relate(layer.over(f"{path}/light"), "material:binding", light)
    if dark_faces:
        layer.relate(layer.over(f"{path}/dark"), "material:binding", dark)


def _dark_faces(mesh: SkinnedMesh) -> NDArray[np.bool_]:
    dark: NDArray[np.bool_] = mesh.colors[:, :3].max(axis=1)[mesh.triangles].mean(axis=1) < DARK
    return dark


def _add_texture(
    layer: Layer, path: str, shader: Any, image: str, rgb: Any, *, masked: bool
) -> None:
    texture = add_reader(layer, path, image, "st")
    layer.set(texture, "inputs:sourceColorSpace", "token", "sRGB")
    layer.set(texture, "inputs:wrapS", "token", "repeat")
    layer.set(texture, "inputs:wrapT", "token", "repeat")
    tint = layer.pxr.Gf.Vec4f(rgb[0], rgb[1], rgb[2], 1.0)
    layer.set(texture, "inputs:scale", "float4", tint)
    layer.connect(shader, "inputs:diffuseColor", "color3f", f"{path}/Texture.outputs:rgb")
    if masked:
        layer.set(texture, "outputs:a", "float", None)
        layer.set(shader, "inputs:opacityThreshold", "float", 0.5)
        layer.connect(shader, "inputs:opacity", "float", f"{path}/Texture.outputs:a")


def _is_masked(material: Material) -> bool:
    return material.image is not None and int(material.image[..., 3].min()) < 128


def write_images(path: Path, materials: Sequence[Material], used: set[int]) -> dict[int, str]:
    """Write pictures beside a file: for each material that has one, its name."""
    names: dict[int, str] = {}
    for number in sorted(used):
        image = materials[number].image
        if image is not None:
            name = f"{path.stem}_{number}.png"
            with replacing(path.with_name(name)) as part:
                part.write_bytes(png(image))
            names[number] = f"./{name}"
    return names
