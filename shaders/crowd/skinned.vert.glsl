#version 330 core
// A skinned agent: one vertex of the bind pose to the stadium.
#include "lib/frame.glsl"
#include "lib/agent.glsl"
#include "lib/pose.glsl"
#include "lib/posture.glsl"
#include "lib/skin.glsl"
#include "lib/morph.glsl"

in vec3 position;
in vec3 normal;
in vec2 uv;
in vec4 color;                 // sRGB
in uvec4 joints;
in vec4 weights;
in vec2 morph;                 // how much the vertex takes part in girth and head
in uint surface;               // 0 to 4: the agent's colour; 254: by height; 255: the material's
in uint agent;
#ifdef HOOKED
in mat3x4 hook;                // rows from the part's model space to the agent's
#endif

out vec3 f_place;
out vec3 f_normal;
out vec2 f_uv;
out vec4 f_color;
flat out vec3 f_tint;
#if defined(PATTERNED) || defined(PARTED)
uniform vec3 trunk_across;     // of x, z and 1: the place across the trunk
uniform vec2 trunk_up;         // of y and 1: the place above the waist; both in heights of the trunk

out vec2 f_trunk;
flat out vec4 f_second;        // the shirt's other colour, and the number of the pattern
#endif
#ifdef PARTED
flat out int f_agent;          // -1: keeps its colour
#endif

#include "lib/srgb.glsl"

void main()
{
    int id = int(agent);
    Posture posture = fetch_posture(id);
    mat3x4 rows = skin_matrix(posture, joints, weights);
#ifdef HOOKED
    rows = after(hook, rows);
#endif
    Body body = fetch_body(id);
    vec3 model = transformed(rows, morphed(body, position, normal, morph));
    if (seat.z > 0.0)
        body = seated(body, hips_height(posture));
    f_place = to_stadium(body, model);
    f_normal = turned(body, normal * mat3(rows));
    f_uv = uv;
    f_color = vec4(to_linear(color.rgb), color.a);
    f_tint = surface < 5u ? agent_colour(id, int(surface)) : vec3(1.0);
#if defined(PATTERNED) || defined(PARTED)
    f_trunk = vec2(dot(trunk_across, vec3(position.xz, 1.0)), dot(trunk_up, vec2(position.y, 1.0)));
    f_second = surface == 2u || surface == 254u ? agent_second(id) : vec4(0.0);
#endif
#ifdef PARTED
    f_agent = surface == 254u ? id : -1;
#endif
    gl_Position = projection * view * vec4(f_place, 1.0);
}
