#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/frame.glsl"

void run() {
    uint bits = take_uint();
    give(unit_from_octahedral(bits));
}
