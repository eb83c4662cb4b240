"""The texel formats that the passes use, and what GL and NumPy call them."""

from __future__ import annotations

from enum import Enum
from typing import Any

import numpy as np

from .api import gl


class TextureFormat(Enum):
    """How texels are stored, as (internal format, format, type, channels, dtype)."""

    R8 = ("GL_R8", "GL_RED", "GL_UNSIGNED_BYTE", 1, "u1")
    RG8 = ("GL_RG8", "GL_RG", "GL_UNSIGNED_BYTE", 2, "u1")
    RGBA8 = ("GL_RGBA8", "GL_RGBA", "GL_UNSIGNED_BYTE", 4, "u1")
    SRGB8_ALPHA8 = ("GL_SRGB8_ALPHA8", "GL_RGBA", "GL_UNSIGNED_BYTE", 4, "u1")
    RGBA16 = ("GL_RGBA16", "GL_RGBA", "GL_UNSIGNED_SHORT", 4, "u2")
    RGBA16F = ("GL_RGBA16F", "GL_RGBA", "GL_HALF_FLOAT", 4, "f2")
    R32F = ("GL_R32F", "GL_RED", "GL_FLOAT", 1, "f4")
    RG32F = ("GL_RG32F", "GL_RG", "GL_FLOAT", 2, "f4")
    RGBA32F = ("GL_RGBA32F", "GL_RGBA", "GL_FLOAT", 4, "f4")
    R32UI = ("GL_R32UI", "GL_RED_INTEGER", "GL_UNSIGNED_INT", 1, "u4")
    RG32UI = ("GL_RG32UI", "GL_RG_INTEGER", "GL_UNSIGNED_INT", 2, "u4")
    RGBA32UI = ("GL_RGBA32UI", "GL_RGBA_INTEGER", "GL_UNSIGNED_INT", 4, "u4")
    DEPTH24 = ("GL_DEPTH_COMPONENT24", "GL_DEPTH_COMPONENT", "GL_FLOAT", 1, "f4")

    @property
    def internal(self) -> int:
        """GL's sized internal format."""
        return int(getattr(gl, self.value[0]))

    @property
    def transfer(self) -> tuple[int, int]:
        """GL's format and type of texels in client memory."""
        return int(getattr(gl, self.value[1])), int(getattr(gl, self.value[2]))

    @property
    def channels(self) -> int:
        """Numbers a texel."""
        return self.value[3]

    @property
    def dtype(self) -> np.dtype[Any]:
        """NumPy type of one number."""
        return np.dtype(self.value[4])

    @property
    def is_integer(self) -> bool:
        """Whether shaders read it through an integer sampler, which can't filter."""
        return "_INTEGER" in self.value[1]

    @property
    def is_depth(self) -> bool:
        """Whether it holds depth."""
        return self is TextureFormat.DEPTH24
