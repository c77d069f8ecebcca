#version 460
layout(isolines, equal_spacing) in;

// Clip-space depth of the first band; each later one lies DEPTH_STEP further.
layout(constant_id = 0) const float DEPTH = 0.5;
layout(constant_id = 1) const float DEPTH_STEP = 0.0;

layout(location = 0) in uint in_band[];
layout(location = 0) flat out uint out_band;

void main() {
    float x = gl_TessCoord.x * 2.0 - 1.0;
    out_band = in_band[0];
    gl_Position = vec4(x, 0.0, DEPTH + DEPTH_STEP * float(in_band[0]), 1.0);
}
