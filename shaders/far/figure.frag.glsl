#version 330 core
// Strokes between seven joints: head, top of the spine, hips, hands and feet.
#include "lib/frame.glsl"
#include "lib/output.glsl"

flat in vec2 f_hips;
flat in vec4 f_head;
flat in vec4 f_hands;
flat in vec4 f_feet;
flat in vec4 f_radius;
flat in vec3 f_skin;
flat in vec3 f_hair;
flat in vec3 f_shirt;
flat in vec3 f_trousers;
flat in vec2 f_side;

out vec4 colour;

// Squared distance of p to the stroke from the origin to `end`, and how far along it that is.
vec2 stroke(vec2 p, vec2 end)
{
    float t = clamp(dot(p, end) / max(dot(end, end), 1e-6), 0.0, 1.0);
    vec2 off = p - t * end;
    return vec2(dot(off, off), t);
}

void main()
{
    vec2 p = gl_FragCoord.xy - f_hips;
    vec2 top = f_head.xy;
    float torso = sqrt(stroke(p, top).x) - f_radius.x;
    float head = length(p - f_head.zw) - f_radius.y;
    vec2 left = stroke(p - top, f_hands.xy - top);
    vec2 right = stroke(p - top, f_hands.zw - top);
    vec2 nearer = left.x < right.x ? left : right;
    float arm = sqrt(nearer.x) - f_radius.z;
    float leg = sqrt(min(stroke(p, f_feet.xy).x, stroke(p, f_feet.zw).x)) - f_radius.w;
    float clothed = min(torso, arm);
    float body = min(min(clothed, head), leg);
    if (body > 0.42)
        discard;
    vec3 light = leg < clothed ? f_trousers : f_shirt;
    if (arm < min(torso, leg) && nearer.y > 0.85)
        light = f_skin;
    if (head < clothed)
        light = p.y > f_side.y ? f_hair : f_skin;
    light *= 1.0 + f_side.x * clamp(p.x - top.x, -f_radius.x, f_radius.x);
    colour = written(light, clamp(0.5 - body, 0.0, 1.0));
}
