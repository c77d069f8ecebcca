#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/detail.glsl"

void run() {
    uint slot = take_uint();
    Yarn yarn;
    yarn.slot_stride = take_uint();
    yarn.fiber_count = take_uint();
    give(float(fiber_of_slot(slot, yarn)));
}
