#version 330 core
// The stadium itself: pitch, stands, seats, boards, roof.
#include "lib/frame.glsl"
#include "lib/srgb.glsl"

in vec3 position;
in vec3 normal;
in vec2 uv;                    // metres along and across the surface
in vec4 color;                 // sRGB
in uint surface;

out vec3 f_place;
out vec3 f_normal;
out vec2 f_uv;
out vec3 f_color;
flat out int f_surface;

const int LINE = 3;

void main()
{
    f_place = position;
    f_normal = normal;
    f_uv = uv;
    f_color = to_linear(color.rgb);
    f_surface = int(surface);
    gl_Position = projection * view * vec4(position, 1.0);
    // Lines lie 2 cm above the grass, which far away is less than depth can tell.
    if (f_surface == LINE)
        gl_Position.z -= 4e-6 * gl_Position.w;
}
