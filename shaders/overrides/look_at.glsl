// Heads follow a point. Needs lib/overrides.glsl; the same rules as engine/overrides/look_at.py.
uniform vec3 trail[16];        // where the point was, 0, 0.05, 0.1 ... seconds ago; stadium frame
uniform vec2 limits;           // radians that the joints turn at most: sideways, up and down
uniform vec2 shares[4];        // of each joint: what those before it do of the turn, and its own part

const float SPACING = 0.05;
const vec2 BEHIND = vec2(1.7, 2.7);    // radians, between which heads give up and look ahead

// Where the point was `lag` seconds ago.
vec3 remembered(float lag)
{
    float place = clamp(lag / SPACING, 0.0, 15.0);
    int before = min(int(place), 14);
    return mix(trail[before], trail[before + 1], place - float(before));
}

// values: how much the agent cares, 0 to 1; seconds that its attention lags behind
mat4 look_at(OverriddenJoint joint)
{
    float care = clamp(joint.values.x, 0.0, 1.0);
    vec3 ahead = normalize(joint.pose[2].xyz);
    vec3 aside = normalize(cross(joint.pose[1].xyz, ahead));
    vec3 above = cross(ahead, aside);
    vec3 way = to_model(joint.body, remembered(joint.values.y)) - joint.pivot;
    float metres = length(way);
    way = metres > 1e-4 ? way / metres : ahead;

    // Which way the head has to turn, and how far.
    vec2 off = vec2(dot(way, aside), dot(way, above));
    float across = length(off);
    vec2 heading = across > 1e-5 ? off / across : vec2(1.0, 0.0);
    float angle = atan(across, dot(way, ahead));

    // This joint's part of what the joints before it have left, softly limited.
    vec2 share = shares[joint.order];
    float wanted = angle * care * share.y / max(1.0 - care * share.x, 1e-3);
    float limit = share.y / length(heading / limits);
    float strain = wanted / limit;
    strain *= strain;
    float turn = wanted / sqrt(sqrt(1.0 + strain * strain));
    turn *= 1.0 - smoothstep(BEHIND.x, BEHIND.y, angle);
    return turn_about(joint.pose, joint.pivot, heading.x * above - heading.y * aside, turn);
}
