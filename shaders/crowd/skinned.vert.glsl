#version 330 core
// A skinned agent: one vertex of the bind pose to the stadium.
#include "lib/frame.glsl"
#include "lib/agent.glsl"
#include "lib/pose.glsl"
#include "lib/posture.glsl"
#include "lib/skin.glsl"

in vec3 position;
in vec3 normal;
in vec2 uv;
in vec4 color;                 // sRGB
in uvec4 joints;
in vec4 weights;
in uint surface;               // 0 to 4: the agent's colour; 255: the material's
in uint agent;
#ifdef HOOKED
in mat3x4 hook;                // rows from the part's model space to the agent's
#endif

out vec3 f_place;
out vec3 f_normal;
out vec2 f_uv;
out vec4 f_color;
flat out vec3 f_tint;

#include "lib/srgb.glsl"

void main()
{
    int id = int(agent);
    mat3x4 rows = skin_matrix(fetch_posture(id), joints, weights);
#ifdef HOOKED
    rows = after(hook, rows);
#endif
    vec3 model = transformed(rows, position);
    Body body = fetch_body(id);
    f_place = to_stadium(body, model);
    f_normal = turned(body, normal * mat3(rows));
    f_uv = uv;
    f_color = vec4(to_linear(color.rgb), color.a);
    f_tint = surface < 5u ? agent_colour(id, int(surface)) : vec3(1.0);
    gl_Position = projection * view * vec4(f_place, 1.0);
}
