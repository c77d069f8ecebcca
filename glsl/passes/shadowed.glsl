// How much of a light other yarns let through, by the shadow map.
#ifndef WORSTED_SHADOWED
#define WORSTED_SHADOWED

#include "bindings.glsl"
#include "../lib/frame.glsl"
#include "../lib/hash.glsl"
#include "../shading/shadow_map.glsl"
#include "../yarn/pieces.glsl"

layout(set = 0, binding = 4) uniform usampler2DArray shadow_map;

// Share of the four texels around a place, weighed by their nearness, that does not hide the fiber.
float unhidden(vec2 place, float layer, float depth, uint piece, float window) {
    vec2 size = vec2(textureSize(shadow_map, 0).xy);
    vec2 corner = floor(place - 0.5);
    vec2 share = place - 0.5 - corner;
    vec3 at = vec3((corner + 1.0) / size, layer);
    // Gathered from the lower left, against the clock from the upper left.
    uvec4 depths = textureGather(shadow_map, at, 0);
    uvec4 pieces = textureGather(shadow_map, at, 1);
    vec4 weight = vec4((1.0 - share.x) * share.y, share.x * share.y, share.x * (1.0 - share.y),
                       (1.0 - share.x) * (1.0 - share.y));
    float sum = 0.0;
    for (int k = 0; k < 4; ++k) {
        sum += shadow_hides(uvec2(depths[k], pieces[k]), depth, piece, window) ? 0.0 : weight[k];
    }
    return sum;
}

// Mean distance of what hides the fiber within `radius` texels from it, in mm; 0 where nothing does.
float hidden_by(vec2 place, float layer, float depth, uint piece, float window, float radius, float turn) {
    ivec2 most = textureSize(shadow_map, 0).xy - 1;
    float sum = 0.0;
    float count = 0.0;
    for (uint tap = 0u; tap < SHADOW_TAPS; ++tap) {
        ivec2 at = clamp(ivec2(floor(place + radius * shadow_tap(tap, turn))), ivec2(0), most);
        uvec2 texel = texelFetch(shadow_map, ivec3(at, int(layer)), 0).xy;
        if (shadow_hides(texel, depth, piece, window)) {
            sum += depth - uintBitsToFloat(texel.x);
            count += 1.0;
        }
    }
    return count > 0.0 ? sum / count : 0.0;
}

// Percentage-closer soft shadows (Fernando 2005): first how far what hides is, from which follows how wide its
// shadow's edge is, then the share that is hidden over that width.
float softly_unhidden(vec2 place, float layer, float depth, uint piece, float window, float tangent, float texel_mm) {
    float turn = TWO_PI * uniform_from_word(hash_words(uvec4(floatBitsToUint(place), piece, frame.index)).x);
    float search = clamp(tangent * depth / texel_mm, 1.0, SHADOW_WIDEST);
    float away = hidden_by(place, layer, depth, piece, window, search, turn);
    if (away <= 0.0) {
        return 1.0;
    }
    float radius = clamp(tangent * away / texel_mm, 0.5, SHADOW_WIDEST);
    float sum = 0.0;
    for (uint tap = 0u; tap < SHADOW_TAPS; ++tap) {
        sum += unhidden(place + radius * shadow_tap(tap, turn), layer, depth, piece, window);
    }
    return sum / float(SHADOW_TAPS);
}

// Share of a light that no other yarn takes from a fiber at `position`, `from_center` mm from the centre of its
// yarn, in piece `segment`.
float shadow_map_light(Light light, vec3 position, float from_center, vec3 to_light, uint segment) {
    uint index = light.shadow_view;
    if (light.shadow_view_count > 1u) {
        index += shadow_face(position - light.position);
    }
    ShadowView view = shadow_views[index];
    float resolution = float(textureSize(shadow_map, 0).x);
    vec3 place = shadow_place(view, position, resolution);
    if (any(lessThan(place.xy, vec2(1.0))) || any(greaterThan(place.xy, vec2(resolution - 1.0)))) {
        return 1.0;
    }
    float depth = place.z - SHADOW_BIAS * yarn.outer_radius;
    // A hair stands farther out than the tube, behind more of it.
    float radius = max(yarn.outer_radius, from_center);
    // The piece's middle points lie along it in every basis.
    uint first = first_point_of(segment);
    vec3 along = direction_or(control_points[first + 2u].position - control_points[first + 1u].position, to_light);
    float window = shadow_window(dot(along, to_light), radius, length_mm_of(segment));
    uint piece = yarn.first_piece + segment;
    if (!SOFT_SHADOWS || light.angular_tangent <= 0.0) {
        return unhidden(place.xy, float(index), depth, piece, window);
    }
    float texel_mm = view.toward.w > 0.0 ? view.texel * place.z : view.texel;
    return softly_unhidden(place.xy, float(index), depth, piece, window, light.angular_tangent, texel_mm);
}

#endif
