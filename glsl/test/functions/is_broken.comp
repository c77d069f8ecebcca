#version 460
#extension GL_GOOGLE_include_directive : require
#include "../flyaway_kernel.glsl"

void run() {
    int exit = int(take_uint());
    int entry = int(take_uint());
    give(is_broken(exit, entry));
}
