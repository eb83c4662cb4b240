#version 330 core
// Surfaces of the stadium; the ids are those of engine/crowd/stadium_mesh.py.
#include "lib/frame.glsl"
#include "lib/light.glsl"
#include "lib/output.glsl"
#include "lib/pattern.glsl"

in vec3 f_place;
in vec3 f_normal;
in vec2 f_uv;
in vec3 f_color;
flat in int f_surface;

out vec4 colour;

const int CONCRETE = 0;
const int SEATS = 1;
const int GRASS = 2;
const int BOARD = 4;
const int ROOF = 5;
const int WALL = 6;
const int STAIRS = 7;
const int GROUND = 9;

void main()
{
    vec3 albedo = f_color;
    vec3 normal = normalize(gl_FrontFacing ? f_normal : -f_normal);
    float open_sky = 1.0;
    if (f_surface == GRASS) {
        albedo *= mowing(f_uv) * (0.92 + 0.16 * speckle(f_uv * 3.0));
    } else if (f_surface == SEATS) {
        albedo *= seat_gaps(f_uv.x);
        open_sky = 0.85;
    } else if (f_surface == CONCRETE || f_surface == WALL || f_surface == GROUND) {
        albedo *= 0.94 + 0.12 * speckle(f_uv * 1.7);
        open_sky = 0.85;
    } else if (f_surface == STAIRS) {
        open_sky = 0.9;
    } else if (f_surface == ROOF) {
        albedo *= ribs(f_uv.x);
        open_sky = normal.y < 0.0 ? 0.55 : 1.0;
    }
    vec3 light = shade(albedo, normal, 0.0, open_sky);
    if (f_surface == BOARD)
        light = max(light, 0.75 * albedo);
    colour = written(haze(tone(light), f_place), 1.0);
}
