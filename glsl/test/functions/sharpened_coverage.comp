#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/coverage.glsl"

void run() {
    float alpha = take_float();
    float texels = take_float();
    give(sharpened_coverage(alpha, texels));
}
