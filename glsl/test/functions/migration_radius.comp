#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/migration.glsl"

void run() {
    float radius = take_float();
    float phase = take_float();
    float migration_min = take_float();
    float migration_max = take_float();
    vec2 r = migration_radius(radius, phase, migration_min, migration_max);
    give(r.x);
    give(r.y);
}
