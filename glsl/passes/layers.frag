#version 460
// Writes the layers where a single fiber is seen.
#extension GL_GOOGLE_include_directive : require
#include "layered.glsl"

void main() {
    write_layers();
}
