#version 460
// A horizontal band across the picture, one patch each: exercises every graphics stage.

layout(location = 0) out uint out_band;

void main() {
    out_band = gl_VertexIndex;
}
