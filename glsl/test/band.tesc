#version 460
layout(vertices = 1) out;

layout(location = 0) in uint in_band[];
layout(location = 0) out uint out_band[];

void main() {
    out_band[gl_InvocationID] = in_band[gl_InvocationID];
    gl_TessLevelOuter[0] = 1.0;
    gl_TessLevelOuter[1] = 4.0;
}
