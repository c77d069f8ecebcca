#version 460
// Writes the layers where a core fiber is seen: where its texture covers the pixel's centre, as in the picture.
#extension GL_GOOGLE_include_directive : require
#include "core_seen.glsl"
#include "layered.glsl"

void main() {
    if (seen_core().mask == 0u) {
        discard;
    }
    write_layers();
}
