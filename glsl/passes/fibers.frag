#version 460
// Shades a fiber: Wu & Yuksel 2019's simple model under one directional light and constant ambient.
#extension GL_GOOGLE_include_directive : require
#include "bindings.glsl"
#include "../bsdf/simple.glsl"
#include "../lib/strip.glsl"
#include "../shading/occlusion.glsl"
#include "../shared/debug_views.glsl"

layout(location = 0) centroid in vec3 fragment_position;
layout(location = 1) centroid in vec3 fragment_tangent;
layout(location = 2) centroid in vec4 fragment_side;
layout(location = 3) centroid in float fragment_distance;
layout(location = 4) flat in uvec2 fragment_fiber;  // index, what a debug view shows

layout(location = 0) out vec4 radiance;

// Wu & Yuksel 2019, Fig. 4: migration dark, loops green, hairs red.
const vec3 KIND_COLORS[3] = vec3[3](vec3(0.08), vec3(0.1, 0.75, 0.15), vec3(0.85, 0.08, 0.05));

vec3 shade(vec3 tangent, vec3 normal, vec3 to_eye, float visibility) {
    vec3 sum = vec3(0.0);
    if (LIGHT) {
        vec3 to_light = frame.light_direction_world.xyz;
        vec3 scattering = simple_diffuse(yarn.diffuse.rgb, normal, to_light);
        if (SPECULAR) {
            scattering += yarn.specular.rgb * simple_specular_cos(tangent, to_light, to_eye, yarn.specular.a);
        }
        sum += scattering * frame.light_irradiance.rgb;
    }
    if (AMBIENT) {
        // Constant light from everywhere: the diffuse lobe's integral is its strength.
        sum += yarn.diffuse.rgb * frame.ambient_radiance.rgb * visibility;
    }
    return sum;
}

vec3 ply_color(uint ply) {
    return 0.5 + 0.45 * cos(TWO_PI * (float(ply) / float(yarn.ply_count) + vec3(0.0, 1.0, 2.0) / 3.0));
}

// Lets a flat colour show a round fiber.
float rounding(vec3 normal, vec3 to_eye) {
    return 0.35 + 0.65 * max(0.0, dot(normal, to_eye));
}

void main() {
    vec3 tangent = direction_or(fragment_tangent, vec3(1.0, 0.0, 0.0));
    vec3 side = normal_perpendicular_to(tangent, fragment_side.xyz);
    vec3 normal = strip_normal(tangent, side, clamp(fragment_side.w, -1.0, 1.0));
    vec3 to_eye = direction_or(frame.eye_world.xyz - fragment_position, vec3(0.0, 0.0, 1.0));
    float visibility = DISTANCE_OCCLUSION ? distance_occlusion(yarn.occlusion, fragment_distance) : 1.0;

    vec3 color;
    switch (DEBUG_VIEW) {
        case VIEW_NORMAL: color = 0.5 + 0.5 * normal; break;
        case VIEW_TANGENT: color = 0.5 + 0.5 * tangent; break;
        case VIEW_OCCLUSION: color = vec3(visibility); break;
        case VIEW_PLY: color = ply_color(fibers[fragment_fiber.x].ply); break;
        case VIEW_KIND: color = KIND_COLORS[min(fragment_fiber.y, 2u)] * rounding(normal, to_eye); break;
        case VIEW_FRAME:
        case VIEW_LENGTH: color = unpackUnorm4x8(fragment_fiber.y).rgb * rounding(normal, to_eye); break;
        default: color = shade(tangent, normal, to_eye, visibility); break;
    }
    radiance = vec4(color, 1.0);
}
