#version 460
#extension GL_GOOGLE_include_directive : require
#include "../kernel.glsl"
#include "../../shading/light.glsl"

void run() {
    Light light;
    light.position = take_vec3();
    light.is_local = take_uint();
    light.toward = take_vec3();
    light.cone_scale = take_float();
    light.strength = take_vec3();
    light.cone_offset = take_float();
    vec3 position = take_vec3();
    Arriving arriving = light_at(light, position);
    give(arriving.to_light);
    give(arriving.irradiance);
}
