// Marked joints are posed by their user's own code, and what hangs below them follows. The same
// rules as engine/overrides/override_set.py.
// Provides OverriddenJoint, turn_about(), overridden_rows(); needs affine.glsl, agent.glsl, and
// Posture with animated_rows().
uniform sampler2D override_table;  // 256 texels a row: for each joint its first step and how many;
                                   // then for each step joint, override, order, and its bind pivot
uniform sampler2D override_values; // OVERRIDES texels an agent
uniform int override_steps;        // texel of the first step

// One marked joint of one agent.
struct OverriddenJoint {
    mat4 pose;        // palette: bind-pose model space to model space, with all that came before
    vec3 pivot;       // the joint's place in model space now
    vec3 bind_pivot;  // its place in the bind pose
    Body body;        // where the agent is: place, scale, turn; see to_model() and to_stadium()
    vec4 values;      // the agent's, for this override
    int joint;        // in the skeleton
    int order;        // which of the override's joints it is
};

// A palette, turned about an axis (a unit vector) through a point, both in model space.
mat4 turn_about(mat4 pose, vec3 pivot, vec3 axis, float angle)
{
    float s = sin(angle);
    float c = cos(angle);
    mat3 turn = outerProduct((1.0 - c) * axis, axis)
              + mat3(c, s * axis.z, -s * axis.y, -s * axis.z, c, s * axis.x, s * axis.y, -s * axis.x, c);
    mat4 moving = mat4(turn);
    moving[3].xyz = pivot - turn * pivot;
    return moving * pose;
}

#include "lib/override_texts.glsl"

// Less than a thousandth of the volume of its edges' box: a blend of opposite poses has squeezed
// the joint flat, so nothing could be said of what follows it.
bool is_flat(mat3 m)
{
    return !(abs(determinant(m)) > 1e-3 * length(m[0]) * length(m[1]) * length(m[2]));
}

vec4 override_texel(int texel)
{
    return texelFetch(override_table, ivec2(texel & 255, texel >> 8), 0);
}

mat3x4 overridden_rows(Posture posture, int joint)
{
    mat3x4 rows = animated_rows(posture, joint);
    vec4 chain = override_texel(joint);
    int steps = int(chain.y);
    if (steps == 0)
        return rows;
    // What the joints above have been moved by.
    mat3x4 moved = mat3x4(1.0);
    for (int k = 0; k < steps; ++k) {
        int texel = override_steps + 2 * (int(chain.x) + k);
        vec4 mark = override_texel(texel);
        int marked = int(mark.x);
        mat3x4 animated = marked == joint ? rows : animated_rows(posture, marked);
        if (is_flat(mat3(animated)))
            continue;
        mat3x4 before = after(moved, animated);
        OverriddenJoint posed;
        posed.pose = transpose(mat4(before[0], before[1], before[2], vec4(0.0, 0.0, 0.0, 1.0)));
        posed.bind_pivot = override_texel(texel + 1).xyz;
        posed.pivot = transformed(before, posed.bind_pivot);
        posed.body = posture.body;
        posed.values = texelFetch(
            override_values, agent_texel(posture.agent, OVERRIDES, int(mark.y)), 0);
        posed.joint = marked;
        posed.order = int(mark.z);
        mat4 now = transpose(apply_override(int(mark.y), posed));
        moved = after(mat3x4(now[0], now[1], now[2]), inverted(animated));
    }
    return after(moved, rows);
}
