// Which poses an agent shows when streams animate the crowd: the age formula and the two-source
// blend. The same rules as engine/streams/displayed.py and blending.py.
// Provides Shown and fetch_shown(); needs agent.glsl.
uniform sampler2DArray ring;       // 3 texels a joint, row = stream, layer = slice
uniform sampler2D statics;         // 3 texels a joint, row = static row
uniform sampler2D streams;         // a texel a stream, then a unique: head - n, place of the head, valid
uniform sampler2D animation;       // 3 texels an agent: target and source of its blend
uniform int stream_rows;
uniform int uniques;               // static row 0 is the bind pose, then two rows a unique, then slots
uniform int capacity;              // a power of two
uniform float tick;                // n minus the origin that the tables count from
uniform float alpha;

// A pose's place: a slice of its stream's ring, or -1 - k for static row k.
struct Shown {
    int row;
    int newer;
    int older;
    float weight;                  // share of the older pose
    float share;                   // share of this source in the agent's picture
};

Shown shown_pose(float row_index, float start, float target, float t0, float rate, float share)
{
    int row = int(row_index + 0.5);
    int still = row - stream_rows;
    bool unique = still > 0 && still <= 2 * uniques;
    if (still >= 0 && !unique)
        return Shown(row, -1 - still, -1 - still, 0.0, share);
    int number = (still - 1) / 2;
    vec4 stream = texelFetch(streams, ivec2(unique ? stream_rows + number : row, 0), 0);
    if (stream.z < 0.5)
        return Shown(row, -1, -1, 0.0, share);
    float shown = min(alpha - 1.0, stream.x);
    float moved = start + rate * max(shown + (tick - t0), 0.0);
    float offset = clamp(moved, min(start, target), max(start, target));
    float age = clamp(stream.x - shown + offset, 0.0, stream.z - 1.0);
    float whole = floor(age);
    int back = int(whole);
    int further = int(min(whole + 1.0, stream.z - 1.0));
    int head = int(stream.y + 0.5);
    if (unique) {
        int first = -2 - 2 * number;
        return Shown(row, first - (head + back & 1), first - (head + further & 1), age - whole, share);
    }
    int newer = (head - back + capacity) & (capacity - 1);
    int older = (head - further + capacity) & (capacity - 1);
    return Shown(row, newer, older, age - whole, share);
}

// Fills the one or two sources of a motion as motion tables hold it; returns how many.
// a: row start target t0; b: rate, begin, duration, source's rate; c: source's row start target t0
int motion_sources(vec4 a, vec4 b, vec4 c, out Shown sources[2])
{
    float s = 1.0;
    if (b.z > 0.0) {
        s = clamp((alpha - 1.0 + (tick - b.y)) / b.z, 0.0, 1.0);
        s = s * s * (3.0 - 2.0 * s);
    }
    sources[0] = shown_pose(a.x, a.y, a.z, a.w, b.x, s);
    if (s >= 1.0)
        return 1;
    sources[1] = shown_pose(c.x, c.y, c.z, c.w, b.w, 1.0 - s);
    return 2;
}

// Fills the one or two sources of an agent's pose; returns how many.
int fetch_shown(int agent, out Shown sources[2])
{
    vec4 a = texelFetch(animation, agent_texel(agent, 3, 0), 0);
    vec4 b = texelFetch(animation, agent_texel(agent, 3, 1), 0);
    vec4 c = texelFetch(animation, agent_texel(agent, 3, 2), 0);
    return motion_sources(a, b, c, sources);
}

vec4 place_texel(int row, int place, int x)
{
    if (place < 0)
        return texelFetch(statics, ivec2(x, -1 - place), 0);
    return texelFetch(ring, ivec3(x, row, place), 0);
}

vec4 pose_texel(Shown shown, int x)
{
    vec4 newer = place_texel(shown.row, shown.newer, x);
    if (shown.weight == 0.0)
        return newer;
    return mix(newer, place_texel(shown.row, shown.older, x), shown.weight);
}
