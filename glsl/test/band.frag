#version 460
layout(push_constant) uniform Push { vec4 colors[2]; };

layout(location = 0) flat in uint in_band;
layout(location = 0) out vec4 out_color;

void main() {
    out_color = colors[min(in_band, 1u)];
}
