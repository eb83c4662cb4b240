"""The drawing side of overrides: their texts in the shaders, their steps, uniforms and values."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from ..errors import GraphicsError
from ..gl.program import Program
from ..gl.texture import Texture2D
from ..gl.texture_format import TextureFormat
from ..overrides.declarations import renamed
from ..overrides.override import JointOverride
from ..overrides.override_set import OverrideSet
from .agent_tables import AGENTS_PER_ROW, table_rows

TABLE_UNIT, VALUES_UNIT = 10, 11
TEXTS = "lib/override_texts.glsl"
_TEXELS_PER_ROW = 256
_OWN_NAME = re.compile(r"\boverride\d+_(?=\w)")


class OverrideTables:
    """What programs need of a crowd's overrides.

    Parameters
    ----------
    overrides
        The crowd's; read at every update.

    Attributes
    ----------
    revision
        Of the overrides that the tables were made for; programs made before it changed are stale.
    """

    def __init__(self, overrides: OverrideSet) -> None:
        self.revision = -1
        self._overrides = overrides
        self._version = -1
        self._table: Texture2D | None = None
        self._values: Texture2D | None = None

    @property
    def defines(self) -> dict[str, int]:
        """What programs are made with; nothing while there is no override."""
        count = len(self._overrides.overrides)
        return {"OVERRIDES": count} if count else {}

    @property
    def includes(self) -> dict[str, str]:
        """Texts that programs are made with."""
        return _texts(self._overrides.overrides)

    @property
    def reached(self) -> NDArray[np.bool_] | None:
        """(J,) joints that are posed or follow; None while there is no override."""
        overrides = self._overrides
        return np.array([*map(bool, overrides.chains)]) if overrides.overrides else None

    def update(self) -> int:
        """Copy what changed; bytes copied."""
        overrides, copied = self._overrides, 0
        if self.revision != overrides.revision:
            self.revision = overrides.revision
            self._delete()
            if overrides.overrides:
                copied += self._upload_steps()
                size = (
                    AGENTS_PER_ROW * len(overrides.overrides),
                    table_rows(len(overrides.values)),
                )
                self._values = Texture2D(size, TextureFormat.RGBA32F)
                self._version = -1
        if self._values is not None and self._version != overrides.version:
            self._version = overrides.version
            width, rows = self._values.size
            table = np.zeros((rows * AGENTS_PER_ROW, width // AGENTS_PER_ROW, 4), np.float32)
            table[: len(overrides.values)] = overrides.values
            self._values.write(table.reshape(rows, width, 4))
            copied += table.nbytes
        return copied

    def bind(self, program: Program) -> None:
        """Bind the tables and set the uniforms, for a program made after the last update."""
        if self._table is None or self._values is None:
            return
        self._table.bind(TABLE_UNIT)
        self._values.bind(VALUES_UNIT)
        program["override_table"] = TABLE_UNIT
        program["override_values"] = VALUES_UNIT
        program["override_steps"] = self._overrides.skeleton.joint_count
        for number, override in enumerate(self._overrides.overrides):
            for name, value in override.uniforms.items():
                own = _own_name(number, name)
                if own in program.uniforms:  # else the compiler found it unused
                    program[own] = value

    def delete(self) -> None:
        """Delete the textures; the next update makes them anew."""
        self._delete()
        self.revision = -1

    @contextmanager
    def blaming(self, vertex: str) -> Iterator[None]:
        """Around the making of a program: let its errors name the override that is at fault.

        Parameters
        ----------
        vertex
            Name of the program's vertex shader.

        Raises
        ------
        GraphicsError
            Begins with ``override 'NAME', line N`` where the compiler says so, and else with the
            first override that can't be compiled on its own.
        """
        try:
            yield
        except GraphicsError as error:
            said = _OWN_NAME.sub("", str(error))
            lines = said.split("\n")
            first = next((k for k, line in enumerate(lines) if line.startswith("override '")), None)
            if first is not None:
                raise GraphicsError("\n".join(lines[first:])) from None
            for override in self._overrides.overrides:
                complaint = self._complaint(override, vertex)
                if complaint is not None:
                    raise GraphicsError(
                        f"{override} does not compile with the shaders around it; is something "
                        f"not closed? {complaint}"
                    ) from None
            raise

    def _complaint(self, override: JointOverride, vertex: str) -> str | None:
        try:
            Program(vertex, defines={"OVERRIDES": 1}, includes=_texts([override])).delete()
        except GraphicsError as error:
            return _OWN_NAME.sub("", str(error))
        return None

    def _upload_steps(self) -> int:
        overrides = self._overrides
        numbers = [k for chain in sorted(set(overrides.chains)) for k in chain]
        joints = overrides.skeleton.joint_count
        texels = joints + 2 * len(numbers)
        rows = -(-texels // _TEXELS_PER_ROW)
        table = np.zeros((rows * _TEXELS_PER_ROW, 4), np.float32)
        first = 0
        for chain in sorted(set(overrides.chains)):
            for joint, own in enumerate(overrides.chains):
                if own == chain:
                    table[joint, :2] = first, len(chain)
            first += len(chain)
        if numbers:
            steps = table[joints : joints + 2 * len(numbers)].reshape(-1, 2, 4)
            steps[:, 0, :3] = [overrides.steps[k] for k in numbers]
            steps[:, 1, :3] = overrides.pivots[numbers]
        self._table = Texture2D((_TEXELS_PER_ROW, rows), TextureFormat.RGBA32F)
        self._table.write(table.reshape(rows, _TEXELS_PER_ROW, 4))
        return table.nbytes

    def _delete(self) -> None:
        for texture in (self._table, self._values):
            if texture is not None:
                texture.delete()
        self._table = self._values = None


def _own_name(number: int, name: str) -> str:
    """What a text's name is called in the shader."""
    return f"override{number}_{name}"


def _texts(overrides: Sequence[JointOverride]) -> dict[str, str]:
    """Includes: each override's text under a name that messages can show, and what calls them."""
    includes: dict[str, str] = {}
    lines: list[str] = []
    cases: list[str] = []
    for number, override in enumerate(overrides):
        declared = override.declarations
        includes[str(override)] = renamed(override.glsl, declared, _own_name(number, ""))
        lines.append(f'#include "{override}"')
        lines += [f"#undef {name}" for name in sorted(declared.macros)]
        call = _own_name(number, override.name)
        cases.append(f"    if (number == {number}) return {call}(joint);")
    lines.append("mat4 apply_override(int number, OverriddenJoint joint)")
    lines += ["{", *cases, "    return joint.pose;", "}"]
    if overrides:
        includes[TEXTS] = "\n".join(lines) + "\n"
    return includes
