// Linear blend skinning, equation 1 of Streams 2017, from the pose store.
// Provides skin_matrix(); needs posture.glsl.

// Rows of the affine matrix that takes a bind-pose vertex to model space. Skinning is linear in the
// matrices, so the four joints add up in one.
mat3x4 skin_matrix(Posture posture, uvec4 joints, vec4 weights)
{
    mat3x4 rows = mat3x4(0.0);
    for (int k = 0; k < 4; ++k)
        if (weights[k] > 0.0)
            rows += weights[k] * joint_rows(posture, int(joints[k]));
    return rows;
}
