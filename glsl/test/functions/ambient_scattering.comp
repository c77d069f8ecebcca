#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../scattering_kernel.glsl"

void run() {
    Scattering s = take_scattering();
    vec3 tangent = take_vec3();
    vec3 to_eye = take_vec3();
    vec3 r, tt;
    ambient_scattering(tangent, to_eye, s, r, tt);
    give(r);
    give(tt);
}
