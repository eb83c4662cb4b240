"""What a linked program reads and writes: attributes, uniforms, blocks, feedback outputs.

pyglet's introspection raises for buffer and shadow samplers, matrix attributes and others, and
mangles array names; this one knows every GLSL 330 type.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .api import gl

BaseKind = Literal["float", "int", "uint", "bool", "sampler"]

_NAME_BYTES = 256
_SUFFIX: dict[BaseKind, str] = {"float": "fv", "int": "iv", "uint": "uiv", "bool": "iv"}
_COMMENTS = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_DECLARATION = re.compile(r"\buniform\b([^;{]*)([;{])")


@dataclass(frozen=True, slots=True)
class ShaderType:
    """A GLSL type: ``mat4`` is 4 columns of 4 rows of float, ``ivec2`` 1 column of 2 rows of int.

    Samplers are 1 x 1.
    """

    base: BaseKind
    rows: int = 1
    columns: int = 1

    @property
    def dtype(self) -> np.dtype[Any]:
        """The NumPy type of one number."""
        if self.base == "float":
            return np.dtype(np.float32)
        return np.dtype(np.uint32 if self.base == "uint" else np.int32)

    @property
    def setter(self) -> str:
        """The GL function that sets such a uniform."""
        if self.columns > 1:
            size = f"{self.columns}" if self.columns == self.rows else f"{self.columns}x{self.rows}"
            return f"glUniformMatrix{size}fv"
        return f"glUniform{self.rows}{_SUFFIX.get(self.base, 'iv')}"


@dataclass(frozen=True, slots=True)
class Variable:
    """An attribute, uniform or feedback output of a program.

    `size` counts the array's elements, 1 for what is no array. `location` is -1 for outputs.
    """

    name: str
    type: ShaderType
    size: int
    location: int


@dataclass(frozen=True, slots=True)
class Block:
    """A uniform block: its index and its size in bytes."""

    name: str
    index: int
    nbytes: int


def read_attributes(program: int) -> dict[str, Variable]:
    """Return the vertex attributes that the program reads, without built-in ones."""
    found = {}
    for name, kind, size in _active(program, "GL_ACTIVE_ATTRIBUTES", "glGetActiveAttrib"):
        location = int(gl.glGetAttribLocation(program, name.encode()))
        if location >= 0:
            found[name] = Variable(name, kind, size, location)
    return found


def read_uniforms(program: int) -> dict[str, Variable]:
    """Return the uniforms outside of blocks; an array's name comes without ``[0]``."""
    found = {}
    for name, kind, size in _active(program, "GL_ACTIVE_UNIFORMS", "glGetActiveUniform"):
        location = int(gl.glGetUniformLocation(program, name.encode()))
        if location >= 0:
            short = name.removesuffix("[0]")
            found[short] = Variable(short, kind, size, location)
    return found


def read_blocks(program: int) -> dict[str, Block]:
    """Return the uniform blocks that the program reads."""
    found = {}
    for index in range(_get(program, "GL_ACTIVE_UNIFORM_BLOCKS")):
        text = (gl.GLchar * _NAME_BYTES)()
        gl.glGetActiveUniformBlockName(program, index, _NAME_BYTES, None, text)
        nbytes = gl.GLint(0)
        gl.glGetActiveUniformBlockiv(program, index, gl.GL_UNIFORM_BLOCK_DATA_SIZE, nbytes)
        name = text.value.decode()
        found[name] = Block(name, index, int(nbytes.value))
    return found


def read_outputs(program: int) -> tuple[Variable, ...]:
    """Return the transform feedback outputs in the order of capture."""
    outputs = _active(program, "GL_TRANSFORM_FEEDBACK_VARYINGS", "glGetTransformFeedbackVarying")
    return tuple(Variable(name, kind, size, -1) for name, kind, size in outputs)


def declared_uniforms(text: str) -> frozenset[str]:
    """Return the names of all uniforms and uniform blocks that GLSL text declares.

    Also those in branches that are compiled away, so that setting them can be ignored.
    """
    names: set[str] = set()
    for body, end in _DECLARATION.findall(_COMMENTS.sub(" ", text)):
        words = re.sub(r"\[[^\]]*\]|=[^,;]*", " ", body).split(",")
        if end == "{":
            names.update(words[0].split()[-1:])
        else:
            names.update(word.split()[-1] for word in words if word.split())
    return frozenset(names)


def as_uniform(name: str, kind: ShaderType, size: int, value: Any) -> NDArray[Any]:
    """Return a value copied to the (n, components) array that the GL setter takes.

    Matrices come out column by column.

    Parameters
    ----------
    name
        For messages.
    kind, size
        Of the uniform.
    value
        A number, a vector, a matrix, or an array of up to `size` of them. A matrix is
        (rows, columns) in the column-vector convention, or flat, column by column, as pyglet's
        matrices are.

    Raises
    ------
    ValueError
        For a wrong shape, too many elements, or numbers that the type can't hold.
    """
    array = np.asarray(value)
    allowed = {"float": "fiub", "int": "iub", "uint": "iub", "sampler": "iu", "bool": "iub"}
    if array.dtype.kind not in allowed[kind.base]:
        raise ValueError(f"uniform '{name}' holds {kind.base}, got {array.dtype} {value!r}")
    if kind.base != "float" and array.size:
        limits = np.iinfo(kind.dtype)
        if array.min() < limits.min or array.max() > limits.max:
            raise ValueError(
                f"uniform '{name}' holds {kind.base}, {limits.min} to {limits.max}; got {value!r}"
            )
    rows, columns = kind.rows, kind.columns
    components = rows * columns
    shape = array.shape
    if columns > 1 and shape[-2:] == (rows, columns) and array.ndim <= 3:
        flat = array.reshape(-1, rows, columns).swapaxes(1, 2).reshape(-1, components)
    elif (components == 1 and array.ndim <= 1) or (shape[-1:] == (components,) and array.ndim <= 2):
        flat = array.reshape(-1, components)
    else:
        one = f"({rows}, {columns}) or ({components},)" if columns > 1 else f"({components},)"
        raise ValueError(f"uniform '{name}' takes shape {one}, or up to {size}; got {shape}")
    if not 1 <= len(flat) <= size:
        raise ValueError(f"uniform '{name}' holds 1 to {size} elements, got {len(flat)}")
    return np.array(flat, kind.dtype, order="C")


def _active(program: int, count: str, getter: str) -> list[tuple[str, ShaderType, int]]:
    """Return (name, type, array size) of everything that a GL getter enumerates."""
    types = _types()
    found = []
    for index in range(_get(program, count)):
        size, kind = gl.GLint(0), gl.GLenum(0)
        text = (gl.GLchar * _NAME_BYTES)()
        if getter == "glGetTransformFeedbackVarying":
            size = gl.GLsizei(0)
        getattr(gl, getter)(program, index, _NAME_BYTES, None, size, kind, text)
        # What is no plain number is a sampler of some sort: it is set like an int.
        found.append(
            (text.value.decode(), types.get(int(kind.value), ShaderType("sampler")), size.value)
        )
    return found


def _get(program: int, parameter: str) -> int:
    value = gl.GLint(0)
    gl.glGetProgramiv(program, getattr(gl, parameter), value)
    return int(value.value)


@cache
def _types() -> dict[int, ShaderType]:
    """Return GL's type constants and what they mean; samplers are the rest."""
    types: dict[int, ShaderType] = {}
    bases: tuple[tuple[str, BaseKind], ...] = (
        ("FLOAT", "float"),
        ("INT", "int"),
        ("UNSIGNED_INT", "uint"),
        ("BOOL", "bool"),
    )
    for prefix, base in bases:
        types[getattr(gl, f"GL_{prefix}")] = ShaderType(base)
        for rows in (2, 3, 4):
            types[getattr(gl, f"GL_{prefix}_VEC{rows}")] = ShaderType(base, rows)
    for columns in (2, 3, 4):
        for rows in (2, 3, 4):
            size = f"{columns}" if columns == rows else f"{columns}x{rows}"
            types[getattr(gl, f"GL_FLOAT_MAT{size}")] = ShaderType("float", rows, columns)
    return types
