#version 460
#extension GL_GOOGLE_include_directive : require
#include "entries.glsl"

void run() {
    vec3 to_eye = take_vec3();
    Scattering s = take_scattering();
    vec3 r, tt;
    ambient_scattering(vec3(0.0, 0.0, 1.0), to_eye, s, r, tt);
    give(r);
    give(tt);
}
