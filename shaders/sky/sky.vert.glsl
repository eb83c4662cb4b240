#version 330 core
// One triangle that covers the picture, at the far plane.
#include "lib/frame.glsl"

out vec3 f_ray;

void main()
{
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0;
    vec3 ray = vec3(corner.x / projection[0][0], corner.y / projection[1][1], -1.0);
    f_ray = ray * mat3(view);
    gl_Position = vec4(corner, 1.0, 1.0);
}
