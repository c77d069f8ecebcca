#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../yarn/fiber.glsl"

void run() {
    Yarn yarn;
    yarn.migration_max = take_float();
    give(surface_radius(yarn));
}
