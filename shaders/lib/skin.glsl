// Linear blend skinning, equation 1 of Streams 2017, from the pose store.
// Provides skin_matrix(); needs pose.glsl.

// Rows of the affine matrix that takes a bind-pose vertex to model space. Skinning is linear in the
// matrices, so the two slices, the two sources of a blend and the four joints add up in one.
mat3x4 skin_matrix(int agent, uvec4 joints, vec4 weights)
{
    Shown sources[2];
    int count = fetch_shown(agent, sources);
    mat3x4 rows = mat3x4(0.0);
    for (int s = 0; s < count; ++s) {
        for (int k = 0; k < 4; ++k) {
            float weight = weights[k] * sources[s].share;
            if (weight == 0.0)
                continue;
            int x = 3 * int(joints[k]);
            rows[0] += weight * pose_texel(sources[s], x);
            rows[1] += weight * pose_texel(sources[s], x + 1);
            rows[2] += weight * pose_texel(sources[s], x + 2);
        }
    }
    return rows;
}
