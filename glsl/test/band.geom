#version 460
layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;

// Half of the band's height in clip space.
layout(constant_id = 0) const float HALF_HEIGHT = 0.25;

layout(location = 0) flat in uint in_band[];
layout(location = 0) flat out uint out_band;

void main() {
    for (int end = 0; end < 2; ++end) {
        for (int side = -1; side <= 1; side += 2) {
            out_band = in_band[end];
            gl_Position = gl_in[end].gl_Position + vec4(0.0, float(side) * HALF_HEIGHT, 0.0, 0.0);
            EmitVertex();
        }
    }
}
