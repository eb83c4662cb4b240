#version 330 core
// A skinned agent's surface.
#include "lib/frame.glsl"
#include "lib/light.glsl"
#include "lib/output.glsl"

in vec3 f_place;
in vec3 f_normal;
in vec2 f_uv;
in vec4 f_color;
flat in vec3 f_tint;

out vec4 colour;

#ifdef TEXTURED
uniform sampler2D image;       // sRGB
#endif

void main()
{
    vec4 albedo = f_color * vec4(f_tint, 1.0);
#ifdef TEXTURED
    albedo *= texture(image, f_uv);
    if (albedo.a < 0.5)
        discard;
#endif
    vec3 normal = normalize(gl_FrontFacing ? f_normal : -f_normal);
    vec3 light = shade(albedo.rgb, normal, 0.25, 0.92);
    // A little light from behind the rim keeps bodies apart in a full stand.
    float rim = pow(1.0 - max(dot(normal, normalize(eye - f_place)), 0.0), 3.0);
    light += 0.10 * rim * SKY_COLOUR;
    colour = written(haze(tone(light), f_place), 1.0);
}
