#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/core.glsl"

void run() {
    vec3 ply_normal = take_vec3();
    vec3 ply_binormal = take_vec3();
    vec3 ply_tangent = take_vec3();
    vec3 to_eye = take_vec3();
    float ellipse_short = take_float();
    float ellipse_long = take_float();
    CoreSection seen = core_section(ply_normal, ply_binormal, ply_tangent, to_eye, ellipse_short, ellipse_long);
    give(seen.side);
    give(seen.toward);
    give(vec3(seen.from_yarn, 0.0));
    give(seen.width);
    give(seen.depth);
    give(seen.shear);
    // A phase by its direction: those a turn apart are one.
    give(vec3(cos(seen.phase), sin(seen.phase), 0.0));
}
