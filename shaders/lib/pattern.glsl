// Patterns that fade to their mean where a pixel covers more than one period, so nothing shimmers.
// Provides speckle(), mowing(), seat_gaps(), ribs().

float hash21(vec2 p)
{
    vec3 q = fract(vec3(p.xyx) * 0.1031);
    q += dot(q, q.yzx + 33.33);
    return fract((q.x + q.y) * q.z);
}

// 1 where a pattern with this coordinate is resolved, 0 where it is finer than a pixel.
float resolved(float coordinate)
{
    return clamp(1.5 - 2.0 * fwidth(coordinate), 0.0, 1.0);
}

// Smooth noise in [0, 1], 0.5 where it can't be seen.
float speckle(vec2 p)
{
    vec2 i = floor(p);
    vec2 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    float value = mix(mix(hash21(i), hash21(i + vec2(1, 0)), f.x),
                      mix(hash21(i + vec2(0, 1)), hash21(i + vec2(1, 1)), f.x), f.y);
    return mix(0.5, value, min(resolved(p.x), resolved(p.y)));
}

// Stripes of a mown pitch, 5.25 m wide.
float mowing(vec2 metres)
{
    float stripe = metres.x / 5.25;
    float edge = fwidth(stripe);
    float wave = abs(fract(stripe * 0.5) * 2.0 - 1.0) - 0.5;
    return 1.0 + 0.13 * clamp(wave / max(edge, 1e-4), -1.0, 1.0);
}

// Dark gaps between single seats; u counts seats.
float seat_gaps(float u)
{
    float edge = abs(fract(u) - 0.5);
    float width = fwidth(u);
    float gap = smoothstep(0.42 - width, 0.42 + width, edge);
    return 1.0 - 0.75 * mix(0.16, gap, resolved(u));
}

// Ribs of a metal roof, one a metre and a half.
float ribs(float u)
{
    float rib = smoothstep(0.40, 0.48, abs(fract(u / 1.5) - 0.5));
    return 1.0 - 0.25 * mix(0.15, rib, resolved(u / 1.5));
}
