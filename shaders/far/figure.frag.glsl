#version 330 core
// Strokes between seven joints: head, chest, hips, hands and feet.
#include "lib/frame.glsl"
#include "lib/light.glsl"

flat in vec2 f_joint[7];
flat in vec3 f_skin;
flat in vec3 f_hair;
flat in vec3 f_shirt;
flat in vec3 f_trousers;
flat in float f_size;
flat in float f_pixel;
flat in float f_facing;
flat in vec3 f_place;
in vec2 f_at;

out vec4 colour;

const int HEAD = 0;
const int CHEST = 1;
const int HIPS = 2;

// Distance to a stroke from a to b.
float stroke(vec2 a, vec2 b, float radius)
{
    vec2 along = b - a;
    float t = clamp(dot(f_at - a, along) / max(dot(along, along), 1e-9), 0.0, 1.0);
    return length(f_at - a - t * along) - radius;
}

void main()
{
    // Strokes are never thinner than the picture can hold.
    float thin = 0.4 * f_pixel;
    float u = f_size / 1.75;
    vec2 shoulders = mix(f_joint[CHEST], f_joint[HEAD], 0.35);
    float torso = stroke(f_joint[HIPS], shoulders, max(0.165 * u, thin));
    float head = stroke(f_joint[HEAD], f_joint[HEAD] + vec2(0.0, 0.1 * u), max(0.105 * u, thin));
    float arm = 1e9;
    float leg = 1e9;
    float hand = 1e9;
    for (int k = 3; k < 5; ++k) {
        arm = min(arm, stroke(shoulders, f_joint[k], max(0.055 * u, thin)));
        hand = min(hand, stroke(f_joint[k], f_joint[k], max(0.065 * u, thin)));
    }
    for (int k = 5; k < 7; ++k)
        leg = min(leg, stroke(f_joint[HIPS], f_joint[k], max(0.085 * u, thin)));
    float body = min(min(torso, head), min(min(arm, hand), leg));
    float cover = clamp(0.5 - body / f_pixel, 0.0, 1.0);
    if (cover < 0.08)
        discard;
    vec3 albedo = f_trousers;
    if (arm < leg || torso < leg)
        albedo = f_shirt;
    if (hand < min(torso, leg) && hand < 0.0)
        albedo = f_skin;
    if (head < min(torso, hand)) {
        bool hair = f_facing < 0.0 || f_at.y > f_joint[HEAD].y + 0.10 * u;
        albedo = hair ? f_hair : f_skin;
    }
    // A round body under the same sun as the meshes: the picture plane's x and the height shade it.
    float side = clamp((f_at.x - shoulders.x) / (0.24 * u), -1.0, 1.0);
    vec3 right = vec3(view[0][0], view[1][0], view[2][0]);
    vec3 back = vec3(view[0][2], view[1][2], view[2][2]);
    vec3 normal = normalize(right * side + back * sqrt(max(1.0 - side * side, 0.15)) + vec3(0.0, 0.35, 0.0));
    // Legs lie in the shade of the people around.
    float open_sky = mix(0.5, 0.95, smoothstep(-0.55 * u, 0.25 * u, f_at.y));
    colour = vec4(haze(tone(shade(albedo, normal, 0.3, open_sky)), f_place), cover);
}
