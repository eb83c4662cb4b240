"""An override: GLSL for marked joints, its uniforms, and the same in Python."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .declarations import Declarations, UniformType, read_declarations
from .posed_joints import OverriddenJoints

Array = NDArray[np.float32]
PythonForm = Callable[[OverriddenJoints, Mapping[str, NDArray[Any]]], Array]

_NAME = re.compile(r"(?!gl_)(?!\w*__)[A-Za-z]\w*")
_PARAMETER = re.compile(r"\s*(?:(?:const|in)\s+)*OverriddenJoint\s+\w+\s*")
_DTYPES = {"f": np.float32, "i": np.int32, "u": np.uint32, "b": np.bool_}


class Uniforms(Mapping[str, NDArray[Any]]):
    """Values of an override's uniforms: set them like a dictionary's, at any time.

    Parameters
    ----------
    owner
        The override, for messages.
    types
        Declared uniforms.
    """

    __slots__ = ("_owner", "_types", "_values")

    def __init__(self, owner: str, types: Mapping[str, UniformType]) -> None:
        self._owner = owner
        self._types = types
        self._values: dict[str, NDArray[Any]] = {}

    def __getitem__(self, name: str) -> NDArray[Any]:
        """The value, read-only."""
        self._check(name)
        return self._values[name]

    def __setitem__(self, name: str, value: ArrayLike) -> None:
        """Set a uniform from the next picture on.

        Raises
        ------
        ValueError
            For a name that the text doesn't declare, or numbers that don't fit its type.
        """
        self._check(name)
        kind = self._types[name]
        array = np.array(value)
        fits = array.dtype.kind in ("fiub" if kind.kind == "f" else "iub")
        if array.shape != kind.shape or not fits or not np.isfinite(array).all():
            wanted = "finite numbers" if kind.kind == "f" else "whole numbers"
            raise ValueError(
                f"{self._owner}: uniform '{name}' takes {wanted} of shape {kind.shape}, "
                f"got {value!r}"
            )
        dtype = _DTYPES[kind.kind]
        stored: NDArray[Any] = array.astype(dtype)
        exact = kind.kind in "fb" or (stored.astype(np.int64) == array).all()
        if not exact or not np.isfinite(stored).all():
            raise ValueError(f"{self._owner}: uniform '{name}' can't hold {value!r}")
        stored.flags.writeable = False
        self._values[name] = stored

    def __iter__(self) -> Iterator[str]:
        """Names in the order of their declarations."""
        return iter(self._types)

    def __len__(self) -> int:
        """How many there are."""
        return len(self._types)

    def _check(self, name: str) -> None:
        if name in self._types:
            return
        near = difflib.get_close_matches(name, self._types, 3) or list(self._types)
        hint = f"; near: {', '.join(near)}" if near else ", and no other"
        raise ValueError(f"{self._owner} declares no uniform '{name}'{hint}")


class JointOverride:
    """Poses marked joints by code of your own, for every agent that is drawn as a mesh.

    Parameters
    ----------
    name
        Of the override, and of its function.
    joints
        Names of the joints that it poses; joints below them follow.
    glsl
        GLSL 330 text with a function ``mat4 NAME(OverriddenJoint joint)`` that returns the joint's
        new palette. It can declare uniforms, functions, structs and constants; they meet nobody
        else's, whatever they are called.
    uniforms
        First values of all uniforms that the text declares.
    python
        The same for K agents at once: ``python(joints, uniforms)`` returns (K, 4, 4) palettes.
        Without it what agents show can't be asked for on the CPU.
    values
        Four numbers that each agent begins with; see `Crowd.override_values`.

    Raises
    ------
    ValueError
        For a name that GLSL can't have, no or repeated joints, a text without the function, or
        uniforms without values.

    Examples
    --------
    >>> nod = JointOverride(
    ...     "nod",
    ...     ["head"],
    ...     '''
    ...     uniform float angle;
    ...     mat4 nod(OverriddenJoint joint)
    ...     {
    ...         return turn_about(joint.pose, joint.pivot, vec3(1, 0, 0), angle);
    ...     }
    ...     ''',
    ...     uniforms={"angle": 0.2},
    ... )
    >>> nod.uniforms["angle"] = 0.3
    """

    __slots__ = ("declarations", "glsl", "joints", "name", "python", "uniforms", "values")

    def __init__(
        self,
        name: str,
        joints: Iterable[str],
        glsl: str,
        *,
        uniforms: Mapping[str, ArrayLike] | None = None,
        python: PythonForm | None = None,
        values: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0),
    ) -> None:
        if not isinstance(name, str) or not _NAME.fullmatch(name):
            raise ValueError(f"name is {name!r}, expected one that a GLSL function can have")
        self.name = name
        self.joints = (joints,) if isinstance(joints, str) else tuple(joints)
        self.glsl = glsl
        self.python = python
        self.values = np.array(values, np.float32)
        if not self.joints or len(set(self.joints)) != len(self.joints):
            raise ValueError(f"{self}: joints is {self.joints}, expected names, each of them once")
        if self.values.shape != (4,) or not np.isfinite(self.values).all():
            raise ValueError(f"{self}: values is {values!r}, expected four finite numbers")
        try:
            self.declarations: Declarations = read_declarations(glsl)
        except ValueError as error:
            raise ValueError(f"{self}: {error}") from None
        self._check_function()
        self.uniforms = Uniforms(str(self), self.declarations.uniforms)
        given = dict(uniforms or {})
        for key, value in given.items():
            self.uniforms[key] = value
        missing = [key for key in self.uniforms if key not in given]
        if missing:
            raise ValueError(f"{self}: uniforms has no value for '{missing[0]}'")

    def __str__(self) -> str:
        """How messages call it."""
        return f"override '{self.name}'"

    def _check_function(self) -> None:
        declared = self.declarations
        parameter = declared.functions.get(self.name)
        if parameter is None or not _PARAMETER.fullmatch(parameter):
            raise ValueError(
                f"{self}: glsl defines no function 'mat4 {self.name}(OverriddenJoint joint)'"
            )
