#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/density.glsl"

void run() {
    give(one_minus_exp(take_float()));
}
