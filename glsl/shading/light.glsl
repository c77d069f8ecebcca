// What arrives of a light at a place; twin: src/scene/light.rs.
#ifndef WORSTED_LIGHT
#define WORSTED_LIGHT

#include "../lib/frame.glsl"
#include "../shared/layouts.glsl"

// The unit direction toward a light, and the irradiance on a surface that faces it.
struct Arriving {
    vec3 to_light;
    vec3 irradiance;
};

// Falls off with the square of the distance, and in a spot by KHR_lights_punctual's angle, written in
// v = 1 - cos = half the squared chord: cosines of narrow cones differ by too little for f32. Nearer than
// LIGHT_RADIUS a light is as bright as at it, so that a fiber that touches a light stays finite.
Arriving light_at(Light light, vec3 position) {
    if (light.is_local == 0u) {
        return Arriving(light.toward, light.strength);
    }
    vec3 offset = light.position - position;
    vec3 to_light = direction_or(offset, light.toward);
    float distance_m = 1e-3 * max(length(offset), LIGHT_RADIUS);
    vec3 chord = to_light - light.toward;
    float share = clamp(light.cone_offset - light.cone_scale * (0.5 * dot(chord, chord)), 0.0, 1.0);
    share /= distance_m;
    return Arriving(to_light, light.strength * (share * share));
}

#endif
