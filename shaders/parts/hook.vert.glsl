#version 330 core
// Where a part is on an agent: run once for every agent that shows it, captured into a buffer.
#include "lib/agent.glsl"
#include "lib/pose.glsl"
#include "lib/posture.glsl"

in uint agent;

uniform int joint;             // of the crowd's skeleton; -1: the agent's own frame
uniform mat3x4 place;          // rows of the part's place under the joint's palette

out mat3x4 hook;               // rows that take the part's model space to the agent's

void main()
{
    hook = joint < 0 ? place : after(joint_rows(fetch_posture(int(agent)), joint), place);
}
