// Patterns of team shirts, in heights of the trunk of the bind pose: from its middle to the wearer's
// left, and from the waist. The same rule as engine/crowd/kits.py.
// Provides second_share() and mean_share().
const float STRIPE = 0.15;
const float HOOP = 0.19;
const float SASH = 0.13;
const float SASH_MIDDLE = 0.50;
const float SASH_SLOPE = 1.10;

// 0 outside of an edge, 1 inside, and between them over the width of a pixel.
float edge_share(float inside, float width)
{
    return clamp(0.5 + inside / max(width, 1e-6), 0.0, 1.0);
}

// Every other band of length 1 is inside; bands finer than a pixel are their mean.
float band_share(float place, float width)
{
    float wave = 0.5 - abs(mod(place, 2.0) - 1.5);
    wave = wave < -0.5 ? -1.0 - wave : wave;
    return 0.5 + (edge_share(wave, width) - 0.5) * clamp(2.0 - 2.0 * width, 0.0, 1.0);
}

// How much of the second colour is at a place; `width` is what a pixel covers.
float second_share(int pattern, vec2 place, vec2 width)
{
    if (pattern == 1)
        return band_share(place.x / STRIPE + 0.5, width.x / STRIPE);
    if (pattern == 2)
        return band_share(place.y / HOOP, width.y / HOOP);
    if (pattern == 3)
        return edge_share(place.x, width.x);
    if (pattern == 4)
        return edge_share(SASH - abs(place.y - SASH_MIDDLE - SASH_SLOPE * place.x),
                          width.y + SASH_SLOPE * width.x);
    return 0.0;
}

// The same for the whole shirt, as it is seen from far away, where a sash is too narrow to be seen.
float mean_share(int pattern)
{
    return pattern == 0 || pattern == 4 ? 0.0 : 0.5;
}
