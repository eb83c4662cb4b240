// What an agent's joints do: the palette of any joint, with all that is mixed into it.
// Provides Posture, fetch_posture(), hips_height(), joint_rows(); needs agent.glsl and pose.glsl.
#include "lib/affine.glsl"
#ifdef OVERLAYS
#include "lib/overlay.glsl"
#endif

// What one vertex shader invocation needs to know of its agent to find any joint.
struct Posture {
    Shown sources[2];
    int count;
#ifdef OVERLAYS
    Layer layers[2];
#endif
#ifdef OVERRIDES
    int agent;
    Body body;
#endif
};

Posture fetch_posture(int agent)
{
    Posture posture;
    posture.count = fetch_shown(agent, posture.sources);
#ifdef OVERLAYS
    posture.layers[0].count = posture.layers[1].count = 0;
    if (overlaid) {
        vec2 entries = texelFetch(overlay_index, agent_texel(agent, 1, 0), 0).xy;
        posture.layers[0] = fetch_layer(int(entries.x + 0.5));
        posture.layers[1] = fetch_layer(int(entries.y + 0.5));
    }
#endif
#ifdef OVERRIDES
    posture.agent = agent;
    posture.body = fetch_body(agent);
#endif
    return posture;
}

// Rows of the affine matrix that takes the bind pose to model space for a joint. Palettes mix
// linearly, so the two slices and the two sources of a blend add up in one.
mat3x4 mixed_rows(Shown sources[2], int count, int joint)
{
    mat3x4 rows = mat3x4(0.0);
    for (int s = 0; s < count; ++s)
        for (int i = 0; i < 3; ++i)
            rows[i] += sources[s].share * pose_texel(sources[s], 3 * joint + i);
    return rows;
}

#ifdef OVERLAYS
// A layer's motion of a joint, hung up at its anchor, whose palette under the layer is `anchor_rows`.
mat3x4 laid_rows(Layer layer, int joint, int anchor, mat3x4 anchor_rows)
{
    mat3x4 rows = mixed_rows(layer.sources, layer.count, joint);
    if (anchor < 0)
        return rows;
    mat3x4 loose = inverted(mixed_rows(layer.sources, layer.count, anchor));
    return after(anchor_rows, after(loose, rows));
}

mat3x4 first_layer_rows(Posture posture, int joint)
{
    mat3x4 rows = mixed_rows(posture.sources, posture.count, joint);
    vec2 share = layer_share(posture.layers[0], joint);
    if (share.x > 0.0) {
        int anchor = int(round(share.y));
        mat3x4 under = mat3x4(0.0);
        if (anchor >= 0)
            under = mixed_rows(posture.sources, posture.count, anchor);
        rows += share.x * (laid_rows(posture.layers[0], joint, anchor, under) - rows);
    }
    return rows;
}

mat3x4 layered_rows(Posture posture, int joint)
{
    mat3x4 rows = first_layer_rows(posture, joint);
    vec2 share = layer_share(posture.layers[1], joint);
    if (share.x > 0.0) {
        int anchor = int(round(share.y));
        mat3x4 under = mat3x4(0.0);
        if (anchor >= 0)
            under = first_layer_rows(posture, anchor);
        rows += share.x * (laid_rows(posture.layers[1], joint, anchor, under) - rows);
    }
    return rows;
}
#endif

uniform int hips_joint;
uniform vec3 hips_bind;            // its place in the bind pose

// Height of the hips in model space. Only one row of their palette is fetched.
float hips_height(Posture posture)
{
    vec4 row = vec4(0.0);
    for (int s = 0; s < posture.count; ++s)
        row += posture.sources[s].share * pose_texel(posture.sources[s], 3 * hips_joint + 1);
    return dot(row, vec4(hips_bind, 1.0));
}

// What animation makes of a joint.
mat3x4 animated_rows(Posture posture, int joint)
{
#ifdef OVERLAYS
    return layered_rows(posture, joint);
#else
    return mixed_rows(posture.sources, posture.count, joint);
#endif
}

#ifdef OVERRIDES
#include "lib/overrides.glsl"
#endif

// With UNTOUCHED only for joints that no override reaches.
mat3x4 joint_rows(Posture posture, int joint)
{
#if defined(OVERRIDES) && !defined(UNTOUCHED)
    return overridden_rows(posture, joint);
#else
    return animated_rows(posture, joint);
#endif
}
