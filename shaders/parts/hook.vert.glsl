#version 330 core
// Where a part is on an agent: run once for every agent that shows it, captured into a buffer.
#include "lib/agent.glsl"
#include "lib/pose.glsl"
#include "lib/posture.glsl"

in uint agent;

uniform int joint;             // of the crowd's skeleton; -1: the agent's own frame
uniform mat3x4 place;          // rows of the part's place under the joint's palette
uniform float growth;          // how much the joint takes part in the growth of heads
uniform vec3 head_centre;      // from where they grow, bind pose

out mat3x4 hook;               // rows that take the part's model space to the agent's

// What sits on a head grows with it.
mat3x4 grown(Body body, mat3x4 rows)
{
    float factor = 1.0 + growth * body.morph.y;
    rows *= factor;
    for (int i = 0; i < 3; ++i)
        rows[i].w += (1.0 - factor) * head_centre[i];
    return rows;
}

void main()
{
    Body body = fetch_body(int(agent));
    hook = place;
    if (joint >= 0 || seat.z > 0.0) {
        Posture posture = fetch_posture(int(agent));
        if (joint >= 0)
            hook = after(joint_rows(posture, joint), grown(body, place));
        // The part is drawn without the seat's lift.
        if (seat.z > 0.0)
            hook[1].w += (seated(body, hips_height(posture)).place.y - body.place.y) / body.scale;
    }
}
