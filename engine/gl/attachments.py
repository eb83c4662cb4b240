"""The images of framebuffers: making multisampled ones, attaching, and saying what is wrong."""

from __future__ import annotations

from collections.abc import Iterable

from ..errors import GraphicsError
from .api import gl
from .objects import GLObject
from .texture import Texture2D
from .texture_array import TextureArray
from .texture_format import TextureFormat

_STATUS = {
    0x8CD6: "an attachment can't be rendered to",
    0x8CD7: "nothing is attached",
    0x8CDD: "the driver can't render to this combination of formats",
    0x8D56: "the attachments have different numbers of samples",
}


class Renderbuffer(GLObject):
    """Multisampled memory that is only drawn to and resolved."""

    __slots__ = ()

    def __init__(self, size: tuple[int, int], format: TextureFormat, samples: int) -> None:
        super().__init__("renderbuffer")
        gl.glBindRenderbuffer(gl.GL_RENDERBUFFER, self.name)
        gl.glRenderbufferStorageMultisample(gl.GL_RENDERBUFFER, samples, format.internal, *size)
        gl.glBindRenderbuffer(gl.GL_RENDERBUFFER, 0)


Image = Texture2D | TextureArray | Renderbuffer


def check_layer(images: Iterable[Image | None], layer: int) -> None:
    """Raise ValueError when an array texture among the images lacks the layer."""
    for image in images:
        if isinstance(image, TextureArray) and not 0 <= layer < image.layers:
            raise ValueError(f"layer is {layer}, expected 0 to {image.layers - 1}")


def attach(color: Image | None, depth: Image | None, layer: int) -> None:
    """Attach the images, array textures with one layer, to the bound framebuffer."""
    for image, point in ((color, gl.GL_COLOR_ATTACHMENT0), (depth, gl.GL_DEPTH_ATTACHMENT)):
        if isinstance(image, TextureArray):
            gl.glFramebufferTextureLayer(gl.GL_FRAMEBUFFER, point, image.name, 0, layer)
        elif isinstance(image, Texture2D):
            gl.glFramebufferTexture2D(gl.GL_FRAMEBUFFER, point, gl.GL_TEXTURE_2D, image.name, 0)
        elif image is not None:
            gl.glFramebufferRenderbuffer(gl.GL_FRAMEBUFFER, point, gl.GL_RENDERBUFFER, image.name)


def check_status(
    status: int, size: tuple[int, int], color: TextureFormat | None, samples: int
) -> None:
    """Raise GraphicsError unless GL calls the framebuffer complete."""
    if status != gl.GL_FRAMEBUFFER_COMPLETE:
        cause = _STATUS.get(status, f"framebuffer status 0x{status:04x}")
        name = "no colour" if color is None else color.name
        raise GraphicsError(
            f"this driver can't draw to a framebuffer of {size[0]} x {size[1]} with "
            f"{name} and {samples} samples: {cause}"
        )


def as_texture(image: Image | None, what: str) -> Texture2D | TextureArray:
    """Return an image that shaders can read.

    Raises
    ------
    ValueError
        When there is none, or it is multisampled.
    """
    if isinstance(image, Texture2D | TextureArray):
        return image
    cause = f"no {what} image" if image is None else f"a multisampled {what} image: resolve first"
    raise ValueError(f"this framebuffer has {cause}")
