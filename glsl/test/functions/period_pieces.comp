#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/level.glsl"

void run() {
    uint pieces = take_uint();
    float periods = take_float();
    uint largest = take_uint();
    give(float(period_pieces(pieces, periods, largest)));
}
