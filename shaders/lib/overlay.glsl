// Motions laid over some joints of an agent: the same rules as engine/streams/overlaying.py.
// Provides Layer, fetch_layer(), layer_share(); needs pose_streams.glsl and agent.glsl.
uniform bool overlaid;             // whether anybody has an overlay
uniform sampler2D overlay_index;   // a texel an agent: 1 + entry of layer 0 and 1, or 0
uniform sampler2D overlays;        // 5 texels an entry: mask, weights, begin; duration; its motion
uniform sampler2D masks;           // a row a mask: weight and anchor of each joint, then the markers

struct Layer {
    Shown sources[2];
    int count;                     // 0 where nothing is laid over
    int mask;
    float weight;
};

Layer fetch_layer(int entry)
{
    Layer layer;
    layer.count = 0;
    if (entry == 0)
        return layer;
    vec4 head = texelFetch(overlays, agent_texel(entry - 1, 5, 0), 0);
    float duration = texelFetch(overlays, agent_texel(entry - 1, 5, 1), 0).x;
    float s = 1.0;
    if (duration > 0.0) {
        s = clamp((alpha - 1.0 + (tick - head.w)) / duration, 0.0, 1.0);
        s = s * s * (3.0 - 2.0 * s);
    }
    layer.weight = mix(head.y, head.z, s);
    if (layer.weight <= 0.0)
        return layer;
    layer.mask = int(head.x + 0.5);
    layer.count = motion_sources(texelFetch(overlays, agent_texel(entry - 1, 5, 2), 0),
                                 texelFetch(overlays, agent_texel(entry - 1, 5, 3), 0),
                                 texelFetch(overlays, agent_texel(entry - 1, 5, 4), 0),
                                 layer.sources);
    return layer;
}

// How much of a joint follows a layer, and its anchor: column `place` of the mask's row.
vec2 layer_share(Layer layer, int place)
{
    if (layer.count == 0)
        return vec2(0.0);
    vec2 share = texelFetch(masks, ivec2(place, layer.mask), 0).xy;
    return vec2(layer.weight * share.x, share.y);
}
