#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../lib/motion.glsl"

void run() {
    vec4 clip = take_vec4();
    vec4 clip_then = take_vec4();
    float near = take_float();
    vec2 motion = seen_motion(clip, clip_then, near);
    give(motion.x);
    give(motion.y);
}
