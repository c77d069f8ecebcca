#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/tube.glsl"

void run() {
    give(tube_row(take_uint()));
}
