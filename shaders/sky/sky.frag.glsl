#version 330 core
// A clear afternoon with a few clouds near the horizon.
#include "lib/frame.glsl"
#include "lib/output.glsl"

in vec3 f_ray;
out vec4 colour;

float hash(vec2 p)
{
    return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453);
}

float noise(vec2 p)
{
    vec2 i = floor(p);
    vec2 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y);
}

void main()
{
    vec3 ray = normalize(f_ray);
    float height = clamp(ray.y, 0.0, 1.0);
    vec3 sky = mix(vec3(0.62, 0.74, 0.86), vec3(0.16, 0.34, 0.66), pow(height, 0.55));
    vec2 p = ray.xz / max(ray.y + 0.08, 0.08) * 1.3;
    float cloud = 0.55 * noise(p) + 0.28 * noise(2.1 * p) + 0.17 * noise(4.3 * p);
    cloud = smoothstep(0.52, 0.85, cloud) * smoothstep(0.0, 0.12, ray.y);
    sky = mix(sky, vec3(0.95, 0.95, 0.96), 0.75 * cloud);
    sky += vec3(1.0, 0.85, 0.6) * pow(max(dot(ray, sun), 0.0), 220.0);
    colour = written(sky, 1.0);
}
