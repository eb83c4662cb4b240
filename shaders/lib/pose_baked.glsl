// Which pose an agent shows when all clips are baked: frame = round(t * speed * fps) mod frames.
// The same rule as engine/streams/baked.py. Provides Shown and fetch_shown(); needs agent.glsl.
uniform sampler2DArray ring;       // 3 texels a joint, 256 frames a layer
uniform sampler2D animation;       // 1 texel an agent: first frame, frames, frames a tick, begin
uniform float tick;                // n minus the origin that the tables count from
uniform float alpha;

struct Shown {
    int row;
    int newer;
    float share;
};

int fetch_shown(int agent, out Shown sources[2])
{
    vec4 a = texelFetch(animation, agent_texel(agent, 1, 0), 0);
    float played = floor((alpha - 1.0 + (tick - a.w)) * a.z + 0.5);
    int frame = int(a.x + played - a.y * floor(played / a.y) + 0.5);
    sources[0] = Shown(frame & 255, frame >> 8, 1.0);
    return 1;
}

vec4 pose_texel(Shown shown, int x)
{
    return texelFetch(ring, ivec3(x, shown.row, shown.newer), 0);
}
