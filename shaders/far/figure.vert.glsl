#version 330 core
// A spectator of a few pixels: a point sprite around seven joints, which the fragments draw as
// strokes. One vertex an agent, and light and air are worked out here: software rasterisers spend
// most of their time on whatever is done a vertex more, or a fragment more, than needed.
#include "lib/frame.glsl"
#include "lib/light.glsl"
#include "lib/agent.glsl"
#include "lib/pose.glsl"
#include "lib/shirt.glsl"
#ifdef OVERLAYS
#include "lib/overlay.glsl"

uniform int joint_count;       // masks have the figure's joints behind the skeleton's
#endif

in uint agent;

uniform float body_height;     // metres, before the agent's scale
uniform float pixel;           // size of a pixel one metre before the camera
uniform vec4 viewport;         // left, bottom, width, height in pixels

// In the picture plane, pixels about the hips.
flat out vec2 f_hips;          // pixels from the framebuffer's corner
flat out vec4 f_head;          // top of the spine, middle of the head
flat out vec4 f_hands;
flat out vec4 f_feet;
flat out vec4 f_radius;        // torso, head, arm, leg
flat out vec3 f_skin;
flat out vec3 f_hair;
flat out vec3 f_shirt;
flat out vec3 f_trousers;
flat out vec2 f_side;          // how much lighter a pixel to the right is; height of the hairline

const int HEAD = 0;
const int CHEST = 1;
const int HIPS = 2;

#ifdef OVERLAYS
// Overlays a few pixels tall: limbs keep their place on the body, but don't turn with it.
void lay_over(inout vec3 joint[7], Layer layer)
{
    int root = layer_share(layer, joint_count + CHEST).x > 0.0 ? HIPS : CHEST;
    vec3 laid[7];
    for (int k = 0; k < 7; ++k)
        laid[k] = vec3(0.0);
    for (int s = 0; s < layer.count; ++s)
        for (int k = 0; k < 7; ++k)
            laid[k] += layer.sources[s].share * pose_texel(layer.sources[s], k).xyz;
    vec3 moved = joint[root] - laid[root];
    for (int k = 0; k < 7; ++k)
        joint[k] = mix(joint[k], laid[k] + moved, layer_share(layer, joint_count + k).x);
}
#endif

vec3 lit(vec3 albedo, vec3 normal, float open_sky, vec3 place)
{
    return haze(tone(shade(albedo, normal, 0.3, open_sky)), place);
}

void main()
{
    int id = int(agent);
    Body body = fetch_body(id);
    Shown sources[2];
    int count = fetch_shown(id, sources);
    vec3 joint[7];
    for (int k = 0; k < 7; ++k)
        joint[k] = vec3(0.0);
    for (int s = 0; s < count; ++s)
        for (int k = 0; k < 7; ++k)
            joint[k] += sources[s].share * pose_texel(sources[s], k).xyz;

#ifdef OVERLAYS
    if (overlaid) {
        vec2 entries = texelFetch(overlay_index, agent_texel(id, 1, 0), 0).xy;
        for (int k = 0; k < 2; ++k) {
            Layer layer = fetch_layer(int(entries[k] + 0.5));
            if (layer.count > 0)
                lay_over(joint, layer);
        }
    }
#endif

    body = seated(body, joint[HIPS].y);
    mat3 rotation = mat3(view);
    vec3 hips = to_stadium(body, joint[HIPS]);
    vec4 centre = view * vec4(hips, 1.0);
    float metre = 1.0 / max(pixel * -centre.z, 1e-6);
    vec2 at[7];
    for (int k = 0; k < 7; ++k)
        at[k] = metre * body.scale * (rotation * turned(body, joint[k] - joint[HIPS])).xy;
    float unit = metre * body_height * body.scale / 1.75;
    vec2 up = unit * vec2(view[1][0], view[1][1]);
    f_head = vec4(mix(at[CHEST], at[HEAD], 0.35), at[HEAD] + 0.05 * up);
    f_hands = vec4(at[3], at[4]);
    f_feet = vec4(at[5], at[6]);
    // Strokes are never thinner than the picture can hold.
    f_radius = max(unit * vec4(0.165, 0.125, 0.055, 0.085), 0.4);

    vec2 low = min(min(min(at[3], at[4]), min(at[5], at[6])), min(f_head.zw, vec2(0.0)));
    vec2 high = max(max(max(at[3], at[4]), max(at[5], at[6])), max(f_head.zw, vec2(0.0)));
    float border = max(f_radius.x, f_radius.y) + 0.5;

    // The picture plane's right and back, and a little up, as a round body's normals.
    vec3 right = vec3(view[0][0], view[1][0], view[2][0]);
    vec3 towards = vec3(view[0][2], view[1][2], view[2][2]) + vec3(0.0, 0.35, 0.0);
    vec3 normal = normalize(towards);
    vec3 grey = vec3(0.4);
    float left_light = dot(shade(grey, normalize(towards - 0.8 * right), 0.3, 0.95), vec3(1.0));
    float right_light = dot(shade(grey, normalize(towards + 0.8 * right), 0.3, 0.95), vec3(1.0));
    f_side.x = (right_light - left_light) / (right_light + left_light) / f_radius.x;
    f_skin = lit(agent_colour(id, 0), normal, 0.95, hips);
    f_hair = lit(agent_colour(id, 1), normal, 0.95, hips);
    vec4 second = agent_second(id);
    vec3 shirt = mix(agent_colour(id, 2), second.rgb, mean_share(int(second.a + 0.5)));
    f_shirt = lit(shirt, normal, 0.95, hips);
    // Legs lie in the shade of the people around.
    f_trousers = lit(agent_colour(id, 3), normal, 0.6, hips);
    bool away = dot(vec3(body.turn.x, 0.0, body.turn.y), eye - hips) < 0.0;
    f_side.y = away ? -1e3 : f_head.w + 0.02 * unit;

    // Drawn at the front of the body, so that seats and steps don't cut into it.
    vec4 clip = projection * (centre + vec4(0.0, 0.0, 0.3, 0.0));
    f_hips = viewport.xy + viewport.zw * (0.5 * clip.xy / clip.w + 0.5);
    // A point whose middle is out of the picture is not drawn at all, so the middle is moved to the
    // border, from where the point covers what of the figure is in the picture.
    vec2 middle = f_hips + 0.5 * (low + high) - viewport.xy;
    vec2 inside = clamp(middle, vec2(0.5), viewport.zw - 0.5);
    vec2 reach = 0.5 * (high - low) + border;
    gl_PointSize = 2.0 * max(reach.x, reach.y);
    gl_Position = vec4((2.0 * inside / viewport.zw - 1.0) * clip.w, clip.zw);
}
