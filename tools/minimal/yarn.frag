#version 460
#extension GL_GOOGLE_include_directive : require
#include "yarn.glsl"
#include "../lib/strip.glsl"
#include "../bsdf/simple.glsl"

layout(location = 0) centroid in vec3 fragment_position;
layout(location = 1) centroid in vec3 fragment_tangent;
layout(location = 2) centroid in vec3 fragment_side;
layout(location = 3) noperspective in float fragment_across;

layout(location = 0) out vec4 radiance;

void main() {
    vec3 tangent = direction_or(fragment_tangent, vec3(1.0, 0.0, 0.0));
    vec3 side = normal_perpendicular_to(tangent, fragment_side);
    vec3 toward = cross(side, tangent);
    vec3 to_eye = direction_or(frame.eye_world.xyz - fragment_position, vec3(0.0, 0.0, 1.0));
    vec4 normals = strip_normals(clamp(fragment_across, -1.0, 1.0));
    vec3 to_light = look.to_light.xyz;
    vec3 scattered = simple_diffuse(look.diffuse.rgb, normals, side, toward, to_light)
                   + look.specular.rgb * simple_specular_cos(tangent, to_light, to_eye, look.specular.a, 0.0);
    radiance = vec4(scattered * look.irradiance.rgb, 1.0);
}
