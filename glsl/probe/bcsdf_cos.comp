#version 460
#extension GL_GOOGLE_include_directive : require
#include "entries.glsl"

void run() {
    vec3 to_light = take_vec3();
    vec3 to_eye = take_vec3();
    Scattering s = take_scattering();
    vec3 r, tt;
    bcsdf_cos(vec3(0.0, 0.0, 1.0), to_light, to_eye, 0.0, s, r, tt);
    give(r);
    give(tt);
}
