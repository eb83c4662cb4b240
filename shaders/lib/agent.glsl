// One agent's row of the crowd's tables, 256 agents a texture row.
// Provides Body, fetch_body(), seated(), to_stadium(), to_model(), agent_colour(), agent_second().
uniform sampler2D placement;   // 3 texels: x y z scale; sin and cos of the yaw; girth, head, legs
uniform vec3 seat;             // hips sitting and standing, model space; metres of the seat, or 0
uniform sampler2D looks;       // 6 texels, sRGB: skin hair shirt trousers shoes, second and pattern

struct Body {
    vec3 place;
    float scale;
    vec2 turn;                 // sin and cos of the yaw
    vec2 morph;                // metres of girth, growth of the head
    float legs;                // height of the hips of its body type, as a factor
};

ivec2 agent_texel(int agent, int texels, int texel)
{
    return ivec2((agent & 255) * texels + texel, agent >> 8);
}

Body fetch_body(int agent)
{
    vec4 first = texelFetch(placement, agent_texel(agent, 3, 0), 0);
    vec4 second = texelFetch(placement, agent_texel(agent, 3, 1), 0);
    vec4 third = texelFetch(placement, agent_texel(agent, 3, 2), 0);
    return Body(first.xyz, first.w, second.xy, third.xy, third.z);
}

// Moves a body up onto its seat, the more the lower its hips are; the rule of
// engine/crowd/physique.py. `hips` is their height in model space.
Body seated(Body body, float hips)
{
    if (seat.z > 0.0) {
        vec2 range = seat.xy * body.legs;
        float share = smoothstep(0.0, 1.0, (range.y - hips) / (range.y - range.x));
        body.place.y += share * (seat.z - body.scale * range.x);
    }
    return body;
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
    return texelFetch(looks, agent_texel(agent, 6, surface), 0).rgb;
}

// The shirt's other colour, and the number of the pattern.
vec4 agent_second(int agent)
{
    return texelFetch(looks, agent_texel(agent, 6, 5), 0) * vec4(1.0, 1.0, 1.0, 255.0);
}
