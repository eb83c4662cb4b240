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
#if defined(PATTERNED) || defined(PARTED)
#include "lib/shirt.glsl"

in vec2 f_trunk;
flat in vec4 f_second;
#endif
#ifdef PARTED
#include "lib/agent.glsl"
#include "lib/srgb.glsl"
#include "lib/tint.glsl"

uniform float tint;
flat in int f_agent;
#endif

out vec4 colour;

#ifdef TEXTURED
uniform sampler2D image;       // sRGB
#endif

void main()
{
    vec4 albedo = f_color * vec4(f_tint, 1.0);
#if defined(PATTERNED) || defined(PARTED)
    float second = second_share(int(f_second.a + 0.5), f_trunk, fwidth(f_trunk));
#endif
#ifdef PATTERNED
    albedo.rgb = mix(albedo.rgb, f_color.rgb * f_second.rgb, second);
#endif
#ifdef TEXTURED
    albedo *= texture(image, f_uv);
    if (albedo.a < 0.5)
        discard;
#endif
#ifdef PARTED
    if (f_agent >= 0) {
        vec3 skin = agent_colour(f_agent, 0);
        vec3 own = albedo.rgb;
        if (f_trunk.y >= 1.0) {
            own = tinted_head(own, agent_colour(f_agent, 1), skin);
        } else {
            vec3 cloth = f_trunk.y < 0.0 ? agent_colour(f_agent, 3)
                : mix(agent_colour(f_agent, 2), f_second.rgb, second);
            own = tinted_cloth(own, cloth, skin);
        }
        albedo.rgb = mix(albedo.rgb, own, tint);
    }
#endif
    vec3 normal = normalize(gl_FrontFacing ? f_normal : -f_normal);
    vec3 light = shade(albedo.rgb, normal, 0.25, 0.92);
    // A little light from behind the rim keeps bodies apart in a full stand.
    float rim = pow(1.0 - max(dot(normal, normalize(eye - f_place)), 0.0), 3.0);
    light += 0.10 * rim * SKY_COLOUR;
    colour = written(haze(tone(light), f_place), 1.0);
}
