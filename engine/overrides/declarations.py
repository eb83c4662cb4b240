"""What a user's GLSL declares, so that several texts can live in one shader.

Each text is written as if it were alone. Its uniforms, functions, structs and constants get names
of their own in the shader; for that they have to be found. This reads no more of the language than
declarations outside of functions.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\\n?)*", re.MULTILINE)
_MACRO = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)", re.MULTILINE)
_UNIFORM = re.compile(r"uniform\s+(?:(?:lowp|mediump|highp)\s+)?(\w+)(.*)", re.DOTALL)
_DECLARED = re.compile(r"(\w+)\s*(?:\[\s*(\d+)\s*\])?")
_FUNCTION = re.compile(r"(?:\w|\])\s+(\w+)\s*\(([^()]*)\)\s*(?:\{\}|$)", re.DOTALL)
_STRUCT = re.compile(r"struct\s+(\w+)")
_GLOBAL = re.compile(
    r"(?:(?:const|lowp|mediump|highp)\s+)*\w+(?:\s*\[[^\]]*\])?\s+(\w.*)", re.DOTALL
)
_MATRIX = re.compile(r"mat([234])(?:x([234]))?")
_VECTOR = re.compile(r"([iub]?)vec([234])")
_FOREIGN = re.compile(
    r"(?:in|out|inout|varying|attribute|flat|smooth|noperspective|centroid|invariant|layout|precision)"
    r"\b.*",
    re.DOTALL,
)
_SCALARS = {"float": "f", "int": "i", "uint": "u", "bool": "b"}


@dataclass(frozen=True, slots=True)
class UniformType:
    """A uniform's kind of number (``f``, ``i``, ``u`` or ``b``, as NumPy has them) and shape.

    ``mat4`` is (4, 4), ``mat3x2`` (2, 3): rows and columns of the column-vector convention. An
    array's length comes first: ``vec3 a[5]`` is (5, 3).
    """

    kind: str
    shape: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Declarations:
    """What a text declares outside of its functions.

    Attributes
    ----------
    uniforms
        Types by name.
    functions
        Parameter lists by name.
    names
        Everything that must not meet a name of another text, but macros.
    macros
        Names that the text defines itself.
    """

    uniforms: dict[str, UniformType]
    functions: dict[str, str]
    names: frozenset[str]
    macros: frozenset[str]


def read_declarations(text: str) -> Declarations:
    """Find what GLSL text declares.

    Raises
    ------
    ValueError
        For a uniform that can't be set from Python: a sampler, a block, one with a value in the
        text, or an array whose size is no plain number; and for what only whole shaders have.
    """
    plain = _COMMENT.sub(lambda found: "\n" * found[0].count("\n") + " ", text)
    macros = frozenset(_MACRO.findall(plain))
    uniforms: dict[str, UniformType] = {}
    functions: dict[str, str] = {}
    names: set[str] = set()
    for statement in _statements(_DIRECTIVE.sub("", plain)):
        if _FOREIGN.fullmatch(statement):
            written = " ".join(statement.split())
            raise ValueError(f"'{written}' is for whole shaders, not for a text among others")
        function = _FUNCTION.search(statement)
        if found := _UNIFORM.match(statement):
            for name, kind in _uniforms(found[1], found[2]):
                uniforms[name] = kind
        elif struct := _STRUCT.match(statement):
            names.add(struct[1])
        elif function:
            functions[function[1]] = function[2]
        elif found := _GLOBAL.match(statement):
            flat, nested = found[1], 1
            while nested:  # commas in brackets part no names
                flat, nested = re.subn(r"\([^()]*\)|\[[^\[\]]*\]", "", flat)
            names.update(re.findall(r"(?:^|,)\s*(\w+)", flat))
    names.update(uniforms, functions)
    return Declarations(uniforms, functions, frozenset(names) - macros, macros)


def renamed(text: str, declared: Declarations, prefix: str) -> str:
    """The text with a prefix before all names that it declares; its lines stay where they are.

    Members of structs and vectors keep their names, so that a uniform may be called ``scale``.
    """
    if not declared.names:
        return text
    names = "|".join(sorted(declared.names))
    return re.sub(rf"(?<![.\w])({names})\b", rf"{prefix}\1", text)


def _statements(text: str) -> list[str]:
    """What stands outside of braces, split at semicolons and at ends of bodies."""
    found: list[str] = []
    current: list[str] = []
    depth = 0
    for character in text:
        if character == "{":
            depth += 1
        elif character == "}":
            depth = max(depth - 1, 0)
            if depth == 0:
                current.append("{}")
                # A body ends a function, but not a struct or a list of values.
                if "(" in "".join(current) and "=" not in current:
                    found.append("".join(current))
                    current = []
        elif depth == 0:
            if character == ";":
                found.append("".join(current))
                current = []
            else:
                current.append(character)
    return [statement.strip() for statement in found if statement.strip()]


def _uniforms(kind: str, names: str) -> list[tuple[str, UniformType]]:
    base = _base(kind)
    found = []
    for part in names.split(","):
        declared = _DECLARED.fullmatch(part.strip())
        if base is None or declared is None:
            written = " ".join(f"uniform {kind} {names}".split())
            raise ValueError(
                f"'{written}' can't be set: uniforms are numbers, vectors, matrices or arrays of "
                "plain sizes, and get their values from Python"
            )
        size = () if declared[2] is None else (int(declared[2]),)
        found.append((declared[1], UniformType(base.kind, (*size, *base.shape))))
    return found


def _base(kind: str) -> UniformType | None:
    if kind in _SCALARS:
        return UniformType(_SCALARS[kind], ())
    if vector := _VECTOR.fullmatch(kind):
        return UniformType(vector[1] or "f", (int(vector[2]),))
    if matrix := _MATRIX.fullmatch(kind):
        columns = int(matrix[1])
        return UniformType("f", (int(matrix[2] or columns), columns))
    return None
