"""A linked GLSL program: compiled from packaged files or text, set by name."""

from __future__ import annotations

import ctypes
import difflib
import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from .api import gl, require_context
from .compiler import link
from .introspect import (
    Block,
    Variable,
    as_uniform,
    declared_uniforms,
    read_attributes,
    read_blocks,
    read_outputs,
    read_uniforms,
)
from .objects import GLObject
from .source import Defines, ShaderSource, compose


class Program(GLObject):
    """A vertex shader and, unless it only captures, a fragment shader.

    Parameters
    ----------
    vertex, fragment
        Names of packaged shader files, shader texts, or composed sources; see `compose`. Without
        a fragment shader the program serves depth-only passes and transform feedback.
    defines
        Inserted into every shader; each must be used by at least one of them.
    includes
        A user's own texts for ``#include``, by name.
    feedback
        Names of vertex outputs to capture, interleaved in this order.

    Raises
    ------
    GraphicsError
        When a shader does not compile or the program does not link; the message names the file
        and line of each complaint and quotes the line.
    ValueError
        For a define that no shader uses.

    Examples
    --------
    >>> program = Program("far/sprite.vert.glsl", "far/sprite.frag.glsl", defines={"VIEWS": 4})
    >>> program["view"] = view_matrix
    >>> program["palette"] = 2  # texture unit
    """

    __slots__ = (
        "_attributes",
        "_blocks",
        "_declared",
        "_label",
        "_outputs",
        "_setters",
        "_uniforms",
    )

    def __init__(
        self,
        vertex: str | ShaderSource,
        fragment: str | ShaderSource | None = None,
        *,
        defines: Defines | None = None,
        includes: Mapping[str, str] | None = None,
        feedback: Sequence[str] = (),
    ) -> None:
        require_context()
        stages = [("GL_VERTEX_SHADER", _composed(vertex, defines, includes, "<vertex shader>"))]
        if fragment is not None:
            source = _composed(fragment, defines, includes, "<fragment shader>")
            stages.append(("GL_FRAGMENT_SHADER", source))
        texts = [source.text for _, source in stages]
        _check_defines(defines or {}, texts)
        self._label = " + ".join(source.name for _, source in stages)
        self._declared = frozenset[str]().union(*map(declared_uniforms, texts))
        super().__init__("program", link(stages, self._label, feedback))
        self._attributes = MappingProxyType(read_attributes(self._name))
        self._uniforms = MappingProxyType(read_uniforms(self._name))
        self._setters = {
            name: getattr(gl, uniform.type.setter) for name, uniform in self._uniforms.items()
        }
        self._blocks = MappingProxyType(read_blocks(self._name))
        self._outputs = read_outputs(self._name) if feedback else ()

    @property
    def label(self) -> str:
        """The names of its shaders, for messages."""
        return self._label

    @property
    def attributes(self) -> Mapping[str, Variable]:
        """The vertex attributes that the compiler kept."""
        return self._attributes

    @property
    def uniforms(self) -> Mapping[str, Variable]:
        """The uniforms outside of blocks that the compiler kept; arrays without ``[0]``."""
        return self._uniforms

    @property
    def blocks(self) -> Mapping[str, Block]:
        """The uniform blocks that the compiler kept."""
        return self._blocks

    @property
    def outputs(self) -> tuple[Variable, ...]:
        """The captured vertex outputs in order."""
        return self._outputs

    def use(self) -> None:
        """Make it the program that draws."""
        gl.glUseProgram(self.name)

    def set(self, name: str, value: Any) -> None:
        """Set a uniform and leave the program in use.

        Parameters
        ----------
        name
            Of the uniform. One that is declared but that the compiler removed is ignored.
        value
            A number, bool, vector, or matrix, or an array of them; for a sampler the texture
            unit. A NumPy matrix is (rows, columns) in the column-vector convention; pyglet's
            matrices and other flat sequences go column by column.

        Raises
        ------
        KeyError
            When the shaders declare no such uniform.
        ValueError
            When the value does not fit the type.
        """
        uniform = self._uniforms.get(name)
        if uniform is None:
            self._check_declared(name, "uniform")
            return
        kind = uniform.type
        data = as_uniform(name, kind, uniform.size, value)
        self.use()
        pointer = (_C_TYPES[kind.base] * data.size).from_buffer(data)
        setter = self._setters[name]
        if kind.columns > 1:
            setter(uniform.location, len(data), False, pointer)
        else:
            setter(uniform.location, len(data), pointer)

    def __setitem__(self, name: str, value: Any) -> None:
        """Set a uniform; see `set`."""
        self.set(name, value)

    def bind_block(self, name: str, binding: int) -> None:
        """Let a uniform block read the buffer bound to a binding point.

        A block that is declared but that the compiler removed is ignored.

        Raises
        ------
        KeyError
            When the shaders declare no such block.
        """
        block = self._blocks.get(name)
        if block is None:
            self._check_declared(name, "uniform block")
            return
        gl.glUniformBlockBinding(self.name, block.index, binding)

    def _check_declared(self, name: str, what: str) -> None:
        """Raise KeyError unless the shaders' text declares the name."""
        if re.split(r"[.\[]", name, maxsplit=1)[0] in self._declared:
            return
        near = difflib.get_close_matches(name, self._declared, 3)
        hint = f"; near: {', '.join(near)}" if near else ""
        raise KeyError(f"{self._label} declares no {what} '{name}'{hint}")


_C_TYPES: dict[str, Any] = {
    "float": ctypes.c_float,
    "int": ctypes.c_int,
    "bool": ctypes.c_int,
    "sampler": ctypes.c_int,
    "uint": ctypes.c_uint,
}


def _composed(
    source: str | ShaderSource,
    defines: Defines | None,
    includes: Mapping[str, str] | None,
    name: str,
) -> ShaderSource:
    if isinstance(source, ShaderSource):
        return source
    return compose(source, defines=defines, includes=includes, name=name)


def _check_defines(defines: Defines, texts: Sequence[str]) -> None:
    """Raise for a define that is only defined, never used: most likely a slip of the pen."""
    words: set[str] = set()
    for text in texts:
        words.update(re.findall(r"\w+", re.sub(r"(?m)^#define \w+", "", text)))
    for name in defines:
        if name not in words:
            near = difflib.get_close_matches(name, words, 1)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise ValueError(f"define {name} is used by none of the shaders{hint}")
