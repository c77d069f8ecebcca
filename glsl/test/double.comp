#version 460
// value -> value * SCALE + OFFSET, over a buffer: exercises constants, sets and push constants.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint SCALE = 2u;
layout(constant_id = 1) const float OFFSET = 0.0;
layout(constant_id = 2) const bool NEGATE = false;

layout(set = 0, binding = 0) readonly buffer Values { float values[]; };
layout(set = 0, binding = 1) writeonly buffer Results { float results[]; };

layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) {
        return;
    }
    float result = values[i] * float(SCALE) + OFFSET;
    results[i] = NEGATE ? -result : result;
}
