#version 460
// Writes what the shadow map holds: how far from the light, and which piece of yarn.
layout(location = 0) in float depth_mm;
layout(location = 1) flat in uint piece;

layout(location = 0) out uvec2 texel;

void main() {
    texel = uvec2(floatBitsToUint(depth_mm), piece + 1u);
}
