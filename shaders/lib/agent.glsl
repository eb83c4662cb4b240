// One agent's row of the crowd's tables, 256 agents a texture row.
// Provides Body, fetch_body(), to_stadium(), to_model(), agent_colour().
uniform sampler2D placement;   // 2 texels: x y z scale; sin yaw, cos yaw, unused, unused
uniform sampler2D looks;       // 5 texels, sRGB: skin hair shirt trousers shoes

struct Body {
    vec3 place;
    float scale;
    vec2 turn;                 // sin and cos of the yaw
};

ivec2 agent_texel(int agent, int texels, int texel)
{
    return ivec2((agent & 255) * texels + texel, agent >> 8);
}

Body fetch_body(int agent)
{
    vec4 first = texelFetch(placement, agent_texel(agent, 2, 0), 0);
    vec4 second = texelFetch(placement, agent_texel(agent, 2, 1), 0);
    return Body(first.xyz, first.w, second.xy);
}

// Yaw 0 faces +Z; positive turns about +Y.
vec3 turned(Body body, vec3 v)
{
    return vec3(body.turn.y * v.x + body.turn.x * v.z, v.y, body.turn.y * v.z - body.turn.x * v.x);
}

vec3 to_stadium(Body body, vec3 model)
{
    return body.place + body.scale * turned(body, model);
}

vec3 to_model(Body body, vec3 stadium)
{
    vec3 v = (stadium - body.place) / body.scale;
    return vec3(body.turn.y * v.x - body.turn.x * v.z, v.y, body.turn.x * v.x + body.turn.y * v.z);
}

vec3 agent_colour(int agent, int surface)
{
    return texelFetch(looks, agent_texel(agent, 5, surface), 0).rgb;
}
