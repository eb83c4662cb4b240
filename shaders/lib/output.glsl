// What a fragment writes: linear light, or sRGB where the framebuffer doesn't encode by itself.
// Provides written(); needs frame.glsl.
vec4 written(vec3 light, float alpha)
{
    vec3 c = clamp(light, 0.0, 1.0);
    vec3 encoded = mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
    return vec4(encode ? encoded : light, alpha);
}
