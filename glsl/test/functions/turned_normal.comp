#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/fiber.glsl"

void run() {
    vec3 from = take_vec3();
    vec3 to = take_vec3();
    vec3 normal = take_vec3();
    give(turned_normal(from, to, normal));
}
