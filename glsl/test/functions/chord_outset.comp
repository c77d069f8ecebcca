#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/level.glsl"

void run() {
    give(chord_outset(take_float()));
}
