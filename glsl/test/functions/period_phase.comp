#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Period period = take_period();
    float x = take_float();
    Yarn yarn = take_yarn();
    float phase = period_phase(period, x, yarn);
    give(vec3(cos(phase), sin(phase), 0.0));
}
