#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/core.glsl"

void run() {
    float fiber_twist = take_float();
    float phase = take_float();
    give(core_turns(fiber_twist, phase));
}
