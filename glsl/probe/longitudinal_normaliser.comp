#version 460
#extension GL_GOOGLE_include_directive : require
#include "entries.glsl"

// G as `longitudinal` divides by it.
void run() {
    float cos_theta = take_float();
    float width = take_float();
    uint entries = take_entries(LOBE_R);
    float ratio = scattering_table_at(LOBE_R, normaliser_position(cos_theta, width), entries).x;
    give(gaussian_normaliser(cos_theta, width) * ratio);
}
