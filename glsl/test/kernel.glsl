// What every kernel of glsl/test/functions shares: rows of words in, rows of floats out. A kernel
// defines `run`, which takes one function's arguments in order, calls it and gives what it returned;
// its f64 side is a case of tests/gpu_vs_cpu.
#ifndef WORSTED_KERNEL
#define WORSTED_KERNEL

layout(local_size_x = 64) in;

// Words, not floats: a float register may change the bits of what is no number.
layout(std430, set = 0, binding = 0) readonly buffer Inputs { uint inputs[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Results { float results[]; };
layout(push_constant) uniform Shape { uint rows; uint input_words; uint result_words; };

uint next_input;
uint next_result;

uint take_uint() {
    return inputs[next_input++];
}

float take_float() {
    return uintBitsToFloat(take_uint());
}

vec3 take_vec3() {
    float x = take_float();
    float y = take_float();
    float z = take_float();
    return vec3(x, y, z);
}

vec4 take_vec4() {
    vec3 xyz = take_vec3();
    float w = take_float();
    return vec4(xyz, w);
}

void take_piece(out vec3 p[4]) {
    for (int k = 0; k < 4; ++k) {
        p[k] = take_vec3();
    }
}

void give(float value) {
    results[next_result++] = value;
}

void give(vec3 value) {
    give(value.x);
    give(value.y);
    give(value.z);
}

void run();

void main() {
    uint row = gl_GlobalInvocationID.x;
    if (row >= rows) {
        return;
    }
    next_input = row * input_words;
    next_result = row * result_words;
    run();
}

#endif
