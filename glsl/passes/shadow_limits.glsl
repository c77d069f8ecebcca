// Counts the pieces of yarn on which a limit of shadows acts: for statistics alone.
#ifndef WORSTED_SHADOW_LIMITS
#define WORSTED_SHADOW_LIMITS

#include "bindings.glsl"
#include "../lib/frame.glsl"
#include "../shading/light.glsl"
#include "../shading/shadow_map.glsl"

// Whether a light shines so nearly along a piece of yarn that its own tube is told from others only in part.
bool is_along_light(vec3 along, vec3 to_light) {
    float cosine = dot(direction_or(along, to_light), to_light);
    float across = sqrt(max(1.0 - cosine * cosine, 0.0));
    return abs(cosine) > SHADOW_STEEPEST * across;
}

// Whether what hides a place from a light that spans an angle is looked for less widely than it may lie.
bool is_wider_than_searched(Light light, vec3 position) {
    uint index = light.shadow_view + (light.shadow_view_count > 1u ? shadow_face(position - light.position) : 0u);
    ShadowView view = shadow_views[index];
    float depth = dot(view.depth_axis.xyz, position) + view.depth_axis.w;
    float texel_mm = view.toward.w > 0.0 ? view.texel * depth : view.texel;
    return light.angular_tangent * depth > SHADOW_WIDEST * texel_mm;
}

// As shadow_map_light of shadowed.glsl takes the piece whose control points begin with this one.
void count_shadow_limits(uint first_point) {
    if (!SHADOW_MAP || LIGHT_COUNT == 0u) {
        return;
    }
    vec3 from = control_points[first_point + 1u].position;
    vec3 to = control_points[first_point + 2u].position;
    vec3 middle = 0.5 * (from + to);
    bool along = false;
    bool wider = false;
    for (uint k = 0u; k < frame.light_count; ++k) {
        Light light = lights[k];
        if (light.shadow_view_count > 0u) {
            along = along || is_along_light(to - from, light_at(light, middle).to_light);
            wider = wider || (SOFT_SHADOWS && is_wider_than_searched(light, middle));
        }
    }
    if (along) {
        atomicAdd(statistics.patches_along_light, 1);
    }
    if (wider) {
        atomicAdd(statistics.patches_softer_than_searched, 1);
    }
}

#endif
