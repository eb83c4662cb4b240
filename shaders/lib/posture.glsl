// What an agent's joints do: the palette of any joint, with all that is mixed into it.
// Provides Posture, fetch_posture(), joint_rows(); needs pose.glsl.
#include "lib/affine.glsl"

// What one vertex shader invocation needs to know of its agent to find any joint.
struct Posture {
    Shown sources[2];
    int count;
};

Posture fetch_posture(int agent)
{
    Posture posture;
    posture.count = fetch_shown(agent, posture.sources);
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

mat3x4 joint_rows(Posture posture, int joint)
{
    return mixed_rows(posture.sources, posture.count, joint);
}
