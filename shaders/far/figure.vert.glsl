#version 330 core
// A spectator of a few pixels: a quad around seven joints, which the fragments draw as strokes.
#include "lib/frame.glsl"
#include "lib/agent.glsl"
#include "lib/pose.glsl"

in uint agent;

uniform float body_height;     // metres, before the agent's scale
uniform float pixel;           // size of a pixel one metre before the camera

flat out vec2 f_joint[7];      // about the hips, in the picture plane, metres
flat out vec3 f_skin;
flat out vec3 f_hair;
flat out vec3 f_shirt;
flat out vec3 f_trousers;
flat out float f_size;         // the agent's height, metres
flat out float f_pixel;        // size of a pixel at the agent, metres
flat out float f_facing;       // 1 faces the camera, -1 turns its back
flat out vec3 f_place;
out vec2 f_at;

const int HIPS = 2;

void main()
{
    int id = int(agent);
    Body body = fetch_body(id);
    Shown sources[2];
    int count = fetch_shown(id, sources);
    mat3 rotation = mat3(view);
    vec3 hips = vec3(0.0);
    vec2 low = vec2(1e9);
    vec2 high = vec2(-1e9);
    vec3 joint[7];
    for (int k = 0; k < 7; ++k) {
        vec3 model = vec3(0.0);
        for (int s = 0; s < count; ++s)
            model += sources[s].share * pose_texel(sources[s], k).xyz;
        joint[k] = to_stadium(body, model);
    }
    hips = joint[HIPS];
    for (int k = 0; k < 7; ++k) {
        f_joint[k] = (rotation * (joint[k] - hips)).xy;
        low = min(low, f_joint[k]);
        high = max(high, f_joint[k]);
    }
    vec4 centre = view * vec4(hips, 1.0);
    f_size = body_height * body.scale;
    f_pixel = pixel * -centre.z;
    float border = 0.12 * f_size + f_pixel;
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    f_at = mix(low - border, high + border, corner);
    vec3 forward = vec3(body.turn.x, 0.0, body.turn.y);
    f_facing = dot(forward, normalize(eye - hips));
    f_place = hips;
    f_skin = agent_colour(id, 0);
    f_hair = agent_colour(id, 1);
    f_shirt = agent_colour(id, 2);
    f_trousers = agent_colour(id, 3);
    // Drawn at the front of the body, so that seats and steps don't cut into it.
    vec4 clip = projection * (centre + vec4(f_at, 0.3, 0.0));
    gl_Position = clip;
}
