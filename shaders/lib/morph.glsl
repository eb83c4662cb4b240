// Bind-pose morphs: the same rule as engine/crowd/morphs.py.
// Provides morphed(); needs agent.glsl.
uniform vec3 head_centre;          // from where heads grow, bind pose

const vec3 OUTWARD = vec3(1.0, 0.2, 1.0);

vec3 morphed(Body body, vec3 position, vec3 normal, vec2 share)
{
    position += body.morph.x * share.x * OUTWARD * normal;
    return position + body.morph.y * share.y * (position - head_centre);
}
