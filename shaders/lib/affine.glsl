// Affine matrices as the pose store has them: three rows of four, in the columns of a mat3x4.
// Provides after(), inverted(), transformed().

// The matrix of `first` and then `second`.
mat3x4 after(mat3x4 second, mat3x4 first)
{
    mat3x4 rows;
    for (int i = 0; i < 3; ++i)
        rows[i] = second[i].x * first[0] + second[i].y * first[1] + second[i].z * first[2]
                + vec4(0.0, 0.0, 0.0, second[i].w);
    return rows;
}

mat3x4 inverted(mat3x4 rows)
{
    // inverse() of the transpose is the transpose of the inverse: rows stay rows.
    mat3 linear = inverse(mat3(rows));
    vec3 moved = vec3(rows[0].w, rows[1].w, rows[2].w) * linear;
    return mat3x4(vec4(linear[0], -moved.x), vec4(linear[1], -moved.y), vec4(linear[2], -moved.z));
}

vec3 transformed(mat3x4 rows, vec3 point)
{
    return vec4(point, 1.0) * rows;
}
