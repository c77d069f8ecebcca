#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    Period period = take_period();
    int base = int(take_uint());
    float u = take_float();
    float u_neighbour = take_float();
    float tip;
    bool meets = meets_tip(period, base, u, u_neighbour, tip);
    give(meets);
    give(meets ? tip : 0.0);
}
