"""A crowd inside a moderngl program, which knows neither esper nor pyglet.

Run with ``python examples/in_moderngl.py``; it needs ``pip install moderngl`` and no display, and
writes in_moderngl.png. With a window of moderngl, GLFW or SDL only the context differs.
"""

from __future__ import annotations

import moderngl
import numpy as np
from PIL import Image

import tifo

SIZE = (640, 360)

VERTEX = """
#version 330
in vec3 position;
uniform mat4 to_clip;
out vec3 place;
void main() { place = position; gl_Position = to_clip * vec4(position, 1.0); }
"""
FRAGMENT = """
#version 330
in vec3 place;
out vec4 colour;
void main() {
    float tile = mod(floor(place.x) + floor(place.z), 2.0);
    colour = vec4(mix(vec3(0.16, 0.32, 0.15), vec3(0.20, 0.38, 0.18), tile), 1.0);
}
"""


def main() -> None:
    context = moderngl.create_context(standalone=True, backend="egl", require=330)
    adopted = tifo.adopt_context()  # once, for each context that pyglet didn't make

    # A flat ground that this program draws itself.
    ground = context.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    corners = np.array([[-60, 0, -60], [60, 0, -60], [-60, 0, 60], [60, 0, 60]], np.float32)
    plane = context.vertex_array(ground, context.buffer(corners.tobytes()), "position")
    target = context.framebuffer(context.texture(SIZE, 4), context.depth_texture(SIZE))

    simulation = tifo.Simulation(
        tifo.CrowdSpec(layout="stand", rows=5, columns=16, rise=0.0, depth=1.6, streams=48, seed=2)
    )
    camera = tifo.FreeCamera.looking((12.0, 4.5, 8.0), (11.5, 0.8, -3.0))
    view, projection = camera.view(), camera.projection(SIZE)
    simulation.send(tifo.Goal(side=0))
    for _ in range(120):  # two seconds of a game loop; only the last picture is kept
        simulation.advance(1 / 60)

    target.use()
    target.clear(0.55, 0.68, 0.82, 1.0, depth=1.0)
    context.enable(moderngl.DEPTH_TEST)
    ground["to_clip"].write((projection @ view).T.astype("f4").tobytes())
    plane.render(moderngl.TRIANGLE_STRIP)
    simulation.crowd.draw(view, projection)
    plane.render(moderngl.TRIANGLE_STRIP)  # whatever is drawn now finds GL as it left it

    pixels = np.frombuffer(target.read(components=3), np.uint8).reshape(SIZE[1], SIZE[0], 3)
    Image.fromarray(pixels[::-1]).save("in_moderngl.png")
    print(f"in_moderngl.png: {len(simulation.crowd)} seats, GL errors: {context.error}")
    simulation.crowd.release_graphics()
    simulation.close()
    adopted.close()
    context.release()


if __name__ == "__main__":
    main()
