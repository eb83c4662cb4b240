// What an agent's joints do: the palette of any joint, with all that is mixed into it.
// Provides Posture, fetch_posture(), joint_rows(); needs agent.glsl and pose.glsl.
#include "lib/affine.glsl"

// What one vertex shader invocation needs to know of its agent to find any joint.
struct Posture {
    Shown sources[2];
    int count;
#ifdef OVERRIDES
    int agent;
    Body body;
#endif
};

Posture fetch_posture(int agent)
{
    Posture posture;
    posture.count = fetch_shown(agent, posture.sources);
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

// What animation makes of a joint.
mat3x4 animated_rows(Posture posture, int joint)
{
    return mixed_rows(posture.sources, posture.count, joint);
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
