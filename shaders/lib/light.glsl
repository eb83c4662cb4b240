// Light in linear space: one sun, a sky that is brighter than the ground, and a soft shoulder.
// Provides shade() and tone(); needs frame.glsl.
const vec3 SUN_COLOUR = vec3(1.16, 1.06, 0.90);
const vec3 SKY_COLOUR = vec3(0.34, 0.41, 0.50);
const vec3 GROUND_COLOUR = vec3(0.17, 0.16, 0.14);

// Wrapped Lambert for soft bodies (wrap > 0) or plain Lambert for hard ones (wrap = 0).
vec3 shade(vec3 albedo, vec3 normal, float wrap, float open_sky)
{
    float lit = max((dot(normal, sun) + wrap) / (1.0 + wrap), 0.0);
    vec3 ambient = mix(GROUND_COLOUR, SKY_COLOUR, 0.5 + 0.5 * normal.y) * open_sky;
    return albedo * (SUN_COLOUR * lit * open_sky + ambient);
}

// Keeps the dark half straight and rolls off towards white, so that skin in the sun keeps its colour.
vec3 tone(vec3 light)
{
    vec3 bright = max(light - 0.45, 0.0);
    return min(light, vec3(0.45)) + 0.55 * (1.0 - exp(-bright / 0.55));
}

// Air between the eye and what is seen: far stands turn slightly blue.
vec3 haze(vec3 light, vec3 place)
{
    float share = 1.0 - exp(-max(distance(place, eye) - 60.0, 0.0) / 2200.0);
    return mix(light, vec3(0.60, 0.70, 0.82), share);
}
