// Materials of other people's characters in the colours of an agent: hue and saturation are the
// agent's, brightness is the material's, so that what is painted on it stays visible.
// Where the parts are: engine/crowd/regions.py.
// Provides tinted_cloth() and tinted_head(); needs srgb.glsl.

// Hue in turns, saturation, brightness; of sRGB.
vec3 to_hsb(vec3 c)
{
    float high = max(c.r, max(c.g, c.b));
    float chroma = high - min(c.r, min(c.g, c.b));
    float d = max(chroma, 1e-6);
    float sixth = high == c.r ? (c.g - c.b) / d
        : high == c.g ? 2.0 + (c.b - c.r) / d : 4.0 + (c.r - c.g) / d;
    return vec3(fract(sixth / 6.0), chroma / max(high, 1e-6), high);
}

vec3 from_hsb(vec3 hsb)
{
    vec3 pure = clamp(abs(6.0 * fract(hsb.x + vec3(0.0, 2.0 / 3.0, 1.0 / 3.0)) - 3.0) - 1.0, 0.0, 1.0);
    return hsb.z * (1.0 + hsb.y * (pure - 1.0));
}

// Skin is a narrow range of hue, neither grey nor strong, and not dark.
float likeness_to_skin(vec3 hsb)
{
    float hue = 1.0 - smoothstep(0.055, 0.075, abs(hsb.x - 0.062));
    float saturation = smoothstep(0.14, 0.20, hsb.y) * (1.0 - smoothstep(0.62, 0.70, hsb.y));
    return hue * saturation * smoothstep(0.40, 0.50, hsb.z);
}

// `own` is as bright as the colour where it is `usual`; `least` of its brightness is kept.
vec3 dyed(vec3 own, vec3 colour, float usual, float least)
{
    float saturation = mix(own.y, colour.y, 0.8);
    float brightness = own.z * min(least + (1.0 - least) * colour.z / usual, 1.4);
    return from_hsb(vec3(colour.x, saturation, min(brightness, 1.0)));
}

// All colours are linear light.
vec3 tinted_cloth(vec3 own, vec3 cloth, vec3 skin)
{
    vec3 hsb = to_hsb(to_srgb(own));
    vec3 dress = dyed(hsb, to_hsb(to_srgb(cloth)), 0.75, 0.3);
    vec3 bare = dyed(hsb, to_hsb(to_srgb(skin)), 0.95, 0.0);
    return to_linear(mix(dress, bare, likeness_to_skin(hsb)));
}

// Above the neck greys stay: eyes, teeth, helmets.
vec3 tinted_head(vec3 own, vec3 hair, vec3 skin)
{
    vec3 srgb = to_srgb(own);
    vec3 hsb = to_hsb(srgb);
    vec3 top = mix(srgb, dyed(hsb, to_hsb(to_srgb(hair)), 0.5, 0.3), smoothstep(0.12, 0.3, hsb.y));
    vec3 bare = dyed(hsb, to_hsb(to_srgb(skin)), 0.95, 0.0);
    return to_linear(mix(top, bare, likeness_to_skin(hsb)));
}
