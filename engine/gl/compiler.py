"""Compiling and linking shaders, with messages that name the user's file and line."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

from ..errors import GraphicsError
from .api import gl
from .source import ShaderSource


def link(stages: Sequence[tuple[str, ShaderSource]], label: str, feedback: Sequence[str]) -> int:
    """Compile the stages and return the name of the linked program."""
    shaders: list[int] = []
    program = 0
    try:
        for stage, source in stages:
            shaders.append(_compile(stage, source))
        program = int(gl.glCreateProgram())
        for shader in shaders:
            gl.glAttachShader(program, shader)
        if feedback:
            encoded = [ctypes.create_string_buffer(name.encode()) for name in feedback]
            pointer = ctypes.POINTER(gl.GLchar)
            names = (pointer * len(encoded))(*(ctypes.cast(text, pointer) for text in encoded))
            gl.glTransformFeedbackVaryings(program, len(encoded), names, gl.GL_INTERLEAVED_ATTRIBS)
        gl.glLinkProgram(program)
        for shader in shaders:
            gl.glDetachShader(program, shader)
        status = gl.GLint(0)
        gl.glGetProgramiv(program, gl.GL_LINK_STATUS, status)
        if not status.value:
            log = _log(program, "glGetProgramiv", "glGetProgramInfoLog")
            raise GraphicsError(f"shader program {label} does not link:\n{log.strip()}")
    except BaseException:
        if program:
            gl.glDeleteProgram(program)
        raise
    finally:
        for shader in shaders:
            gl.glDeleteShader(shader)
    return program


def _compile(stage: str, source: ShaderSource) -> int:
    shader = int(gl.glCreateShader(getattr(gl, stage)))
    encoded = source.text.encode()
    text = ctypes.create_string_buffer(encoded)
    pointer = ctypes.cast(text, ctypes.POINTER(gl.GLchar))
    gl.glShaderSource(shader, 1, ctypes.byref(pointer), gl.GLint(len(encoded)))
    gl.glCompileShader(shader)
    status = gl.GLint(0)
    gl.glGetShaderiv(shader, gl.GL_COMPILE_STATUS, status)
    if not status.value:
        log = source.translate_log(_log(shader, "glGetShaderiv", "glGetShaderInfoLog"))
        gl.glDeleteShader(shader)
        raise GraphicsError(f"shader {source.name} does not compile:\n{log}")
    return shader


def _log(name: int, getter: str, log_getter: str) -> str:
    length = gl.GLint(0)
    getattr(gl, getter)(name, gl.GL_INFO_LOG_LENGTH, length)
    text = (gl.GLchar * max(1, length.value))()
    getattr(gl, log_getter)(name, len(text), None, text)
    return bytes(text.value).decode("utf-8", "replace")
