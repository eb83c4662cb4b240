"""Thin OpenGL objects over `pyglet.gl`: one object per file, desktop GL 3.3 core, GLSL 330.

pyglet's own wrappers refuse buffer and shadow samplers, matrix attributes and float textures,
and cost tens of milliseconds per frame for crowds, so the passes of `engine/render` draw through
these. Importing this package loads neither a GL library nor a window system.

One thread creates, uses and deletes all of them. They change no state that pyglet relies on:
vertex arrays are unbound after each draw, texture unit 0 stays the active one.
"""

from .adopted import AdoptedContext, adopt_context
from .buffer import Buffer
from .context import ContextInfo, create_offscreen_context, describe_context, open_window
from .feedback import capture, capture_into
from .framebuffer import Framebuffer
from .objects import collect, live_objects
from .program import Program
from .query import GpuTimer
from .saved_state import SavedState, prepare_state
from .source import ShaderSource, compose
from .state import check_errors, gl_errors, reset_state, takes_srgb_bytes
from .texture import Texture2D
from .texture_array import TextureArray
from .texture_format import TextureFormat
from .vertex_array import Primitive, VertexArray
from .vertex_input import Attribute, VertexInput

__all__ = [
    "AdoptedContext",
    "Attribute",
    "Buffer",
    "ContextInfo",
    "Framebuffer",
    "GpuTimer",
    "Primitive",
    "Program",
    "SavedState",
    "ShaderSource",
    "Texture2D",
    "TextureArray",
    "TextureFormat",
    "VertexArray",
    "VertexInput",
    "adopt_context",
    "capture",
    "capture_into",
    "check_errors",
    "collect",
    "compose",
    "create_offscreen_context",
    "describe_context",
    "gl_errors",
    "live_objects",
    "open_window",
    "prepare_state",
    "reset_state",
    "takes_srgb_bytes",
]
